// A ring (radii a < b) and two jaws, half discs of radius r that touch it from above and below.
DefineConstant[ a = 0.9, b = 1, r = 0.5, n = 1, k = 8 ];
Point(1) = {0, 0, 0};
Point(11) = {a, 0, 0}; Point(12) = {0, a, 0}; Point(13) = {-a, 0, 0}; Point(14) = {0, -a, 0};
Point(21) = {b, 0, 0}; Point(22) = {0, b, 0}; Point(23) = {-b, 0, 0}; Point(24) = {0, -b, 0};
For i In {1:4}
  j = i < 4 ? i + 1 : 1;
  Line(i) = {10 + i, 20 + i}; Circle(10 + i) = {10 + i, 1, 10 + j}; Circle(20 + i) = {20 + i, 1, 20 + j};
EndFor
For i In {1:4}
  j = i < 4 ? i + 1 : 1;
  Curve Loop(i) = {i, 20 + i, -j, -(10 + i)}; Plane Surface(i) = {i};
EndFor
Transfinite Curve {1:4} = n + 1; Transfinite Curve {11:14, 21:24} = k + 1; Transfinite Surface {1:4};
For i In {0:1}
  s = i ? -1 : 1; p = 30 + 20 * i; y = s * (b + r);
  Point(p) = {0, y, 0};
  Point(p + 1) = {-r, y, 0}; Point(p + 2) = {0, s * b, 0}; Point(p + 3) = {r, y, 0};
  Point(p + 4) = {-r / 2, y, 0}; Point(p + 5) = {0, y - s * r / 2, 0}; Point(p + 6) = {r / 2, y, 0};
  Circle(p + 1) = {p + 1, p, p + 2}; Circle(p + 2) = {p + 2, p, p + 3}; Circle(p + 3) = {p + 4, p, p + 5}; Circle(p + 4) = {p + 5, p, p + 6};
  Line(p + 5) = {p + 1, p + 4}; Line(p + 6) = {p + 2, p + 5}; Line(p + 7) = {p + 3, p + 6};
  Curve Loop(p + 1) = {p + 1, p + 6, -(p + 3), -(p + 5)}; Plane Surface(p + 1) = {p + 1};
  Curve Loop(p + 2) = {p + 2, p + 7, -(p + 4), -(p + 6)}; Plane Surface(p + 2) = {p + 2};
  Transfinite Curve {p + 1:p + 4} = 9; Transfinite Curve {p + 5:p + 7} = 2; Transfinite Surface {p + 1, p + 2};
EndFor
Recombine Surface {1:4, 31, 32, 51, 52};
Physical Surface("ring") = {1:4}; Physical Surface("upper") = {31, 32}; Physical Surface("lower") = {51, 52};
Physical Curve("bore") = {11:14}; Physical Curve("outside") = {21:24}; Physical Curve("upper_face") = {31, 32}; Physical Curve("lower_face") = {51, 52};
Physical Curve("upright") = {2, 4}; Physical Curve("level") = {1, 3};
