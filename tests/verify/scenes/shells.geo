// An octant of two hollow spheres one in the other, or a narrower part of its hemisphere: radii 5 to 10 and 10 to 20. Three blocks each, around the middle; or the
// one of them at the x axis.
DefineConstant[
  n = 2,     // cells along half a quarter circle of the inner sphere; the outer one has 3n/2
  m = 2,     // cells through each wall
  third = 0, // 1: one block, between the planes y = 0, z = 0, x = y and x = z
  angle = 90 // between the planes plane_x and plane_y, through the z axis
];
c1 = Cos(angle * Pi / 180);  s1 = Sin(angle * Pi / 180);
c2 = Cos(angle * Pi / 360);  s2 = Sin(angle * Pi / 360);
d = Sqrt(3 + 2 * c1); // length of the sum of the three corners' directions
For b In {0:1} // numbers of sphere 1 are 1000 larger; no extrusion: it would join the two
  t = 1000 * b;
  For h In {0:1} // inside and outside
    c = t + 100 * h;
    r = 5 * (b + 1) * (h + 1);
    s = r / Sqrt(2);
    Point(c + 10) = {0, 0, 0};
    Point(c + 1) = {r, 0, 0};  Point(c + 2) = {r * c1, r * s1, 0};  Point(c + 3) = {0, 0, r};
    Point(c + 4) = {r * c2, r * s2, 0};  Point(c + 5) = {s * c1, s * s1, s};  Point(c + 6) = {s, 0, s};
    Point(c + 7) = {r * (1 + c1) / d, r * s1 / d, r / d};
    Circle(c + 1) = {c + 1, c + 10, c + 4};  Circle(c + 2) = {c + 4, c + 10, c + 2};
    Circle(c + 3) = {c + 2, c + 10, c + 5};  Circle(c + 4) = {c + 5, c + 10, c + 3};
    Circle(c + 5) = {c + 3, c + 10, c + 6};  Circle(c + 6) = {c + 6, c + 10, c + 1};
    Circle(c + 7) = {c + 4, c + 10, c + 7};  Circle(c + 8) = {c + 5, c + 10, c + 7};  Circle(c + 9) = {c + 6, c + 10, c + 7};
    Curve Loop(c + 1) = {c + 1, c + 7, -(c + 9), c + 6};  Surface(c + 1) = {c + 1} In Sphere {c + 10};
    Curve Loop(c + 2) = {c + 3, c + 8, -(c + 7), c + 2};  Surface(c + 2) = {c + 2} In Sphere {c + 10};
    Curve Loop(c + 3) = {c + 5, c + 9, -(c + 8), c + 4};  Surface(c + 3) = {c + 3} In Sphere {c + 10};
    Transfinite Curve {(c + 1):(c + 9)} = (b == 0 ? n : Ceil(1.5 * n)) + 1;
  EndFor
  For i In {1:7}
    Line(t + 200 + i) = {t + i, t + 100 + i};
  EndFor
  Transfinite Curve {(t + 201):(t + 207)} = m + 1;
  from[] = {1, 4, 2, 5, 3, 6, 4, 5, 6};
  to[]   = {4, 2, 5, 3, 6, 1, 7, 7, 7};
  For k In {1:9} // between the two circles k
    Curve Loop(t + 200 + k) = {t + k, t + 200 + to[k - 1], -(t + 100 + k), -(t + 200 + from[k - 1])};
    Plane Surface(t + 200 + k) = {t + 200 + k};
  EndFor
  Surface Loop(t + 1) = {t + 1, t + 101, t + 201, t + 207, t + 209, t + 206};  Volume(t + 1) = {t + 1};
  Surface Loop(t + 2) = {t + 2, t + 102, t + 203, t + 208, t + 207, t + 202};  Volume(t + 2) = {t + 2};
  Surface Loop(t + 3) = {t + 3, t + 103, t + 205, t + 209, t + 208, t + 204};  Volume(t + 3) = {t + 3};
  Transfinite Surface {(t + 1):(t + 3), (t + 101):(t + 103), (t + 201):(t + 209)};
  Recombine Surface {(t + 1):(t + 3), (t + 101):(t + 103), (t + 201):(t + 209)};
  Transfinite Volume {(t + 1):(t + 3)};
EndFor
If (third)
  Physical Volume("inner") = {1};
  Physical Volume("outer") = {1001};
  Physical Surface("inner_shell") = {101};
  Physical Surface("outer_bore")  = {1001};
  Physical Surface("plane_y")  = {206, 1206};
  Physical Surface("plane_z")  = {201, 1201};
  Physical Surface("plane_xy") = {207, 1207};
  Physical Surface("plane_zx") = {209, 1209};
Else
  Physical Volume("inner") = {1, 2, 3};
  Physical Volume("outer") = {1001, 1002, 1003};
  Physical Surface("inner_shell") = {101, 102, 103};
  Physical Surface("outer_bore")  = {1001, 1002, 1003};
  Physical Surface("plane_x") = {203, 204, 1203, 1204};
  Physical Surface("plane_y") = {205, 206, 1205, 1206};
  Physical Surface("plane_z") = {201, 202, 1201, 1202};
EndIf
