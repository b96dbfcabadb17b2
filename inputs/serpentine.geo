// A strip of thickness h that turns back twice: three limbs of length l, two half turns whose middle line has radius r.
DefineConstant[ r = 0.2, h = 0.2, l = 1, n = 3, m = 12, k = 6 ];
a = r - h / 2; b = r + h / 2;
// limbs from below at y = 0, 2 r, 4 r; right turn about (l, r), left turn about (0, 3 r)
For i In {0:2}
  y = 2 * r * i; p = 10 * i;
  Point(p + 1) = {0, y - h / 2, 0}; Point(p + 2) = {l, y - h / 2, 0}; Point(p + 3) = {l, y + h / 2, 0}; Point(p + 4) = {0, y + h / 2, 0};
  Line(p + 1) = {p + 1, p + 2}; Line(p + 2) = {p + 2, p + 3}; Line(p + 3) = {p + 3, p + 4}; Line(p + 4) = {p + 4, p + 1};
  Curve Loop(p + 1) = {p + 1, p + 2, p + 3, p + 4}; Plane Surface(p + 1) = {p + 1};
EndFor
Point(40) = {l, r, 0}; Point(41) = {l + a, r, 0}; Point(42) = {l + b, r, 0};
Point(50) = {0, 3 * r, 0}; Point(51) = {-a, 3 * r, 0}; Point(52) = {-b, 3 * r, 0};
Line(41) = {41, 42}; Line(51) = {52, 51};
Circle(42) = {3, 40, 41}; Circle(43) = {2, 40, 42}; Circle(44) = {41, 40, 12}; Circle(45) = {42, 40, 13};
Circle(52) = {14, 50, 51}; Circle(53) = {11, 50, 52}; Circle(54) = {51, 50, 21}; Circle(55) = {52, 50, 24};
Curve Loop(41) = {43, -41, -42, -2}; Plane Surface(41) = {41};
Curve Loop(42) = {41, 45, -12, -44}; Plane Surface(42) = {42};
Curve Loop(51) = {53, 51, -52, 14}; Plane Surface(51) = {51};
Curve Loop(52) = {-51, 55, 24, -54}; Plane Surface(52) = {52};
Transfinite Curve {2, 4, 12, 14, 22, 24, 41, 51} = n + 1;
Transfinite Curve {1, 3, 11, 13, 21, 23} = m + 1;
Transfinite Curve {42:45, 52:55} = k / 2 + 1;
Transfinite Surface {1, 11, 21, 41, 42, 51, 52}; Recombine Surface {1, 11, 21, 41, 42, 51, 52};
Physical Surface("strip") = {1, 11, 21, 41, 42, 51, 52};
Physical Curve("sole") = {1}; Physical Curve("head") = {23};
Physical Curve("skin") = {3, 4, 11, 13, 21, 22, 42:45, 52:55};
