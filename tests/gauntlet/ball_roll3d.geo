// A ball of radius 0.5 between two plates; s: cells of it, n: cells to the unit of the plates
DefineConstant[ n = 5 ];
R = 0.5; c = 0.25;
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
Transfinite Curve {:} = 5; Transfinite Surface {:}; Recombine Surface {:}; Transfinite Volume {:};
Point(201) = {-0.5, -0.4, -0.8}; Point(202) = {0.7, -0.4, -0.8}; Point(203) = {0.7, 0.4, -0.8}; Point(204) = {-0.5, 0.4, -0.8};
Point(211) = {-0.7, -0.4, 0.5}; Point(212) = {0.5, -0.4, 0.5}; Point(213) = {0.5, 0.4, 0.5}; Point(214) = {-0.7, 0.4, 0.5};
For q In {0 : 3}
  Line(201 + q) = {201 + q, 201 + (q + 1) % 4}; Line(211 + q) = {211 + q, 211 + (q + 1) % 4};
EndFor
Curve Loop(201) = {201:204}; Plane Surface(201) = {201}; Curve Loop(211) = {211:214}; Plane Surface(211) = {211};
Transfinite Curve {201, 203, 211, 213} = 1.2 * n + 1; Transfinite Curve {202, 204, 212, 214} = 0.8 * n + 1; Transfinite Surface {201}; Transfinite Surface {211}; Recombine Surface {201, 211};
v[] = Extrude {0, 0, 0.3} { Surface{201}; Layers{2}; Recombine; };
u[] = Extrude {0, 0, 0.3} { Surface{211}; Layers{2}; Recombine; };
Physical Volume("ball") = {1:7}; Physical Volume("lower") = {v[1]}; Physical Volume("upper") = {u[1]};
Physical Surface("skin") = {21:26}; Physical Surface("bed") = {v[0]}; Physical Surface("bottom") = {201}; Physical Surface("ceiling") = {211}; Physical Surface("top") = {u[0]};
