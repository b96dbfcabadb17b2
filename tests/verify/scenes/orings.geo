// three O-rings of radius 0.5, one on the other, between floor, piston, shaft and bore
DefineConstant[n = 3];
For i In {0:2}
  p = 100*i;
  Point(p) = {2, i + 0.5, 0};
  For k In {0:3}
    c = Cos((45 + 90*k) * Pi / 180); s = Sin((45 + 90*k) * Pi / 180);
    Point(p + 1 + k) = {2 + 0.25*c, i + 0.5 + 0.25*s, 0}; Point(p + 5 + k) = {2 + 0.5*c, i + 0.5 + 0.5*s, 0};
  EndFor
  For k In {0:3}
    l = (k + 1) % 4;
    Line(p + 11 + k) = {p + 1 + k, p + 1 + l}; Circle(p + 21 + k) = {p + 5 + k, p, p + 5 + l};
    Line(p + 31 + k) = {p + 1 + k, p + 5 + k};
    Transfinite Curve {p + 11 + k, p + 21 + k} = n + 1; Transfinite Curve {p + 31 + k} = Max(1, Round(n/2)) + 1;
  EndFor
  Curve Loop(p + 41) = {p + 11, p + 12, p + 13, p + 14}; Plane Surface(p + 41) = {p + 41};
  For k In {0:3}
    Curve Loop(p + 51 + k) = {p + 31 + k, p + 21 + k, -(p + 31 + (k + 1) % 4), -(p + 11 + k)}; Plane Surface(p + 51 + k) = {p + 51 + k};
  EndFor
  Transfinite Surface {p + 41, p + 51 : p + 54}; Recombine Surface {p + 41, p + 51 : p + 54};
  Physical Surface(Sprintf("o%g", i)) = {p + 41, p + 51 : p + 54};
  Physical Curve(Sprintf("o%g_o", i)) = {p + 21 : p + 24};
EndFor
// walls: corners, and cells along and across
x0() = {1.495, 1.495, 1.2, 2.51}; x1() = {2.505, 2.505, 1.49, 2.8}; y0() = {-0.3, 3, -0.2, -0.2}; y1() = {0, 3.3, 3.2, 3.2};
nx() = {4, 4, 1, 1}; ny() = {1, 1, 8, 8};
For i In {0:3}
  p = 400 + 10*i;
  Point(p) = {x0(i), y0(i), 0}; Point(p + 1) = {x1(i), y0(i), 0}; Point(p + 2) = {x1(i), y1(i), 0}; Point(p + 3) = {x0(i), y1(i), 0};
  For k In {0:3}
    Line(p + k) = {p + k, p + (k + 1) % 4};
  EndFor
  Transfinite Curve {p, p + 2} = nx(i) + 1; Transfinite Curve {p + 1, p + 3} = ny(i) + 1;
  Curve Loop(p) = {p : p + 3}; Plane Surface(p) = {p}; Transfinite Surface {p}; Recombine Surface {p};
EndFor
Physical Surface("floor") = {400}; Physical Surface("piston") = {410}; Physical Surface("shaft") = {420}; Physical Surface("bore") = {430};
Physical Curve("floor_t") = {402}; Physical Curve("piston_b") = {410}; Physical Curve("shaft_r") = {421}; Physical Curve("bore_l") = {433};
