// A ball above a block
DefineConstant[ n = 4 ];
R = 0.3; c = 0.15;
Point(100) = {0, 0, 0}; i = 1;
For z In {-1 : 1 : 2}
  Point(i) = {-c, -c, z * c}; Point(i + 1) = {c, -c, z * c}; Point(i + 2) = {c, c, z * c}; Point(i + 3) = {-c, c, z * c}; i += 4;
EndFor
d = R / Sqrt(3);
For z In {-1 : 1 : 2}
  Point(i) = {-d, -d, z * d}; Point(i + 1) = {d, -d, z * d}; Point(i + 2) = {d, d, z * d}; Point(i + 3) = {-d, d, z * d}; i += 4;
EndFor
For k In {0 : 1}
  For q In {0 : 3}
    Line(1 + 4 * k + q) = {1 + 4 * k + q, 1 + 4 * k + (q + 1) % 4};
    Circle(21 + 4 * k + q) = {9 + 4 * k + q, 100, 9 + 4 * k + (q + 1) % 4};
    Line(41 + 4 * k + q) = {1 + 4 * k + q, 9 + 4 * k + q};
  EndFor
EndFor
For q In {0 : 3}
  Line(11 + q) = {1 + q, 5 + q}; Circle(31 + q) = {9 + q, 100, 13 + q};
EndFor
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Curve Loop(21) = {21:24}; Surface(21) = {21} In Sphere {100}; Curve Loop(22) = {25:28}; Surface(22) = {22} In Sphere {100};
For q In {0 : 3}
  Curve Loop(3 + q) = {1 + q, 11 + (q + 1) % 4, -(5 + q), -(11 + q)}; Plane Surface(3 + q) = {3 + q};
  Curve Loop(23 + q) = {21 + q, 31 + (q + 1) % 4, -(25 + q), -(31 + q)}; Surface(23 + q) = {23 + q} In Sphere {100};
  Curve Loop(33 + q) = {1 + q, 41 + (q + 1) % 4, -(21 + q), -(41 + q)}; Plane Surface(33 + q) = {33 + q};
  Curve Loop(37 + q) = {5 + q, 45 + (q + 1) % 4, -(25 + q), -(45 + q)}; Plane Surface(37 + q) = {37 + q};
  Curve Loop(41 + q) = {11 + q, 45 + q, -(31 + q), -(41 + q)}; Plane Surface(41 + q) = {41 + q};
EndFor
Surface Loop(1) = {1, 2, 3, 4, 5, 6}; Volume(1) = {1};
Surface Loop(2) = {1, 21, 33, 34, 35, 36}; Volume(2) = {2}; Surface Loop(3) = {2, 22, 37, 38, 39, 40}; Volume(3) = {3};
For q In {0 : 3}
  Surface Loop(4 + q) = {3 + q, 23 + q, 33 + q, 37 + q, 41 + q, 41 + (q + 1) % 4}; Volume(4 + q) = {4 + q};
EndFor
Transfinite Curve {:} = 3 + 1; Transfinite Surface {:}; Recombine Surface {:}; Transfinite Volume {:};
Translate {0, 0, 0.301} { Volume{1:7}; }
Point(501) = {-0.5, -0.5, -0.5}; Point(502) = {0.5, -0.5, -0.5}; Point(503) = {0.5, 0.45, -0.5}; Point(504) = {-0.5, 0.45, -0.5};
Line(501) = {501, 502}; Line(502) = {502, 503}; Line(503) = {503, 504}; Line(504) = {504, 501}; Curve Loop(501) = {501:504}; Plane Surface(501) = {501};
Transfinite Curve {501, 503} = 5 + 1; Transfinite Curve {502, 504} = 5 + 1; Transfinite Surface {501}; Recombine Surface {501};
k500[] = Extrude {0, 0, 0.5} { Surface{501}; Layers{3}; Recombine; };
Physical Volume("ball") = {1:7};
Physical Surface("sphere") = {21:26};
Physical Volume("block") = {k500[1]};
Physical Surface("foot") = {501};
Physical Surface("hull") = {k500[0], k500[2], k500[3], k500[4], k500[5]};
