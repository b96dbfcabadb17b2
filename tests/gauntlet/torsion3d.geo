// A cylinder of radius 0.5 and height 1 and a plate on it; n: cells round a quarter
DefineConstant[ n = 2, m = 3 ];
R = 0.5; c = 0.22;
Point(1) = {R * Sqrt(0.5), R * Sqrt(0.5), 0}; Point(2) = {-R * Sqrt(0.5), R * Sqrt(0.5), 0}; Point(3) = {-R * Sqrt(0.5), -R * Sqrt(0.5), 0}; Point(4) = {R * Sqrt(0.5), -R * Sqrt(0.5), 0}; Point(5) = {0, 0, 0};
Point(11) = {c, c, 0}; Point(12) = {-c, c, 0}; Point(13) = {-c, -c, 0}; Point(14) = {c, -c, 0};
Point(21) = {0.6, 0.6, 1.2}; Point(22) = {-0.6, 0.6, 1.2}; Point(23) = {-0.6, -0.6, 1.2}; Point(24) = {0.6, -0.6, 1.2};
For i In {0 : 3}
  j = (i + 1) % 4;
  Circle(1 + i) = {1 + i, 5, 1 + j}; Line(11 + i) = {11 + i, 11 + j}; Line(21 + i) = {11 + i, 1 + i}; Line(31 + i) = {21 + i, 21 + j};
  Transfinite Curve {1 + i, 11 + i} = n + 1; Transfinite Curve {21 + i} = 2; Transfinite Curve {31 + i} = 4;
EndFor
For i In {0 : 3}
  j = (i + 1) % 4;
  Curve Loop(1 + i) = {21 + i, 1 + i, -(21 + j), -(11 + i)}; Plane Surface(1 + i) = {1 + i};
EndFor
Curve Loop(5) = {11:14}; Plane Surface(5) = {5}; Curve Loop(6) = {31:34}; Plane Surface(6) = {6};
Transfinite Surface {1}; Transfinite Surface {2}; Transfinite Surface {3}; Transfinite Surface {4}; Transfinite Surface {5}; Transfinite Surface {6}; Recombine Surface {1:6};
v[] = Extrude {0, 0, 1} { Surface{1, 2, 3, 4, 5}; Layers{m}; Recombine; };
u[] = Extrude {0, 0, -0.2} { Surface{6}; Layers{1}; Recombine; };
Physical Volume("rod") = {v[1], v[7], v[13], v[19], v[25]}; Physical Volume("plate") = {u[1]};
Physical Surface("foot") = {1:5}; Physical Surface("head") = {v[0], v[6], v[12], v[18], v[24]}; Physical Surface("face") = {u[0]};
