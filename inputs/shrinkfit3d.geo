// The two tubes of shrinkfit.geo in three dimensions, a quarter of a ring: radii 5 to 10 and 10 to 20, 0 <= z <= d.
DefineConstant[
  n = 6, // cells along the quarter of the inner tube; the outer one has 3n/2
  m = 4, // cells through each wall
  d = 2, // depth
  l = 1  // cells along it
];
For b In {0:1} // numbers of tube 1 are 100 larger; no extrusion: it would join the two tubes
  t = 100 * b;
  r = 5 * (b + 1);
  For h In {0:1}
    c = t + 10 * h;
    Point(c + 1) = {0, 0, d * h};
    Point(c + 2) = {r, 0, d * h};      Point(c + 3) = {2 * r, 0, d * h};
    Point(c + 4) = {0, 2 * r, d * h};  Point(c + 5) = {0, r, d * h};
    Line(c + 1) = {c + 2, c + 3};  Circle(c + 2) = {c + 3, c + 1, c + 4};
    Line(c + 3) = {c + 4, c + 5};  Circle(c + 4) = {c + 5, c + 1, c + 2};
    Curve Loop(c + 1) = {(c + 1):(c + 4)};  Plane Surface(c + 1) = {c + 1};
    Transfinite Curve {c + 1, c + 3} = m + 1;
    Transfinite Curve {c + 2, c + 4} = (b == 0 ? n : Ceil(1.5 * n)) + 1;
  EndFor
  For i In {1:4} // at the start of curve i
    Line(t + 20 + i) = {t + 1 + i, t + 11 + i};
  EndFor
  For i In {1:4} // side of curve i
    Curve Loop(t + 20 + i) = {t + i, t + 21 + i % 4, -(t + 10 + i), -(t + 20 + i)};
    Surface(t + 20 + i) = {t + 20 + i};
  EndFor
  Transfinite Curve {(t + 21):(t + 24)} = l + 1;
  Surface Loop(b + 1) = {t + 1, t + 11, (t + 21):(t + 24)};
  Volume(b + 1) = {b + 1};
  Transfinite Surface {t + 1, t + 11, (t + 21):(t + 24)};
  Recombine Surface {t + 1, t + 11, (t + 21):(t + 24)};
  Transfinite Volume {b + 1};
EndFor
Physical Volume("inner") = {1};
Physical Volume("outer") = {2};
Physical Surface("plane_y")     = {21, 121};
Physical Surface("inner_shell") = {22};
Physical Surface("shell")       = {122};
Physical Surface("plane_x")     = {23, 123};
Physical Surface("bore")        = {24};
Physical Surface("outer_bore")  = {124};
Physical Surface("ends")        = {1, 11, 101, 111};
