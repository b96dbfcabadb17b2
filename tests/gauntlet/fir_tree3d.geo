// fir_tree.geo, drawn out.
DefineConstant[size = 0.27];
Point(1) = {0, -0.9, 0, size}; Point(2) = {0.28, -0.9, 0, size}; Point(3) = {0.42, -0.7, 0, size}; Point(4) = {0.25, -0.45, 0, size};
Point(5) = {0.55, -0.25, 0, size}; Point(6) = {0.35, 0.05, 0, size}; Point(7) = {0.35, 0.5, 0, size}; Point(8) = {0, 0.5, 0, size};
For i In {1:8}
  Line(i) = {i, i % 8 + 1};
EndFor
Curve Loop(1) = {1:8}; Plane Surface(1) = {1};
Point(11) = {0, -1.4, 0, size}; Point(12) = {1.1, -1.4, 0, size}; Point(13) = {1.1, 0.05, 0, size}; Point(14) = {0.362, 0.05, 0, size};
Point(15) = {0.562, -0.25, 0, size}; Point(16) = {0.262, -0.45, 0, size}; Point(17) = {0.432, -0.7, 0, size}; Point(18) = {0.292, -0.92, 0, size};
Point(19) = {0, -0.92, 0, size};
For i In {11:18}
  Line(i) = {i, i + 1};
EndFor
Line(19) = {19, 11};
Curve Loop(2) = {11:19}; Plane Surface(2) = {2};
Mesh.RecombinationAlgorithm = 2; Recombine Surface{1, 2};
a[] = Extrude {0, 0, 0.3} { Surface{1}; Layers{1}; Recombine; };
b[] = Extrude {0, 0, 0.3} { Surface{2}; Layers{1}; Recombine; };
Physical Volume("blade") = {a[1]}; Physical Volume("disk") = {b[1]};
Physical Surface("root") = {a[3], a[4], a[5], a[6]}; Physical Surface("top") = {a[8]}; Physical Surface("middle") = {a[9], b[10]};
Physical Surface("held") = {b[2], b[3]}; Physical Surface("groove") = {b[5], b[6], b[7], b[8]}; Physical Surface("front") = {1, 2};
Physical Surface("blade_skin") = {1, a[0], a[2], a[3], a[4], a[5], a[6], a[7]}; Physical Surface("disk_skin") = {2, b[0], b[4], b[5], b[6], b[7], b[8]};
