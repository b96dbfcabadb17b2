// A belt around a drum of radius 1 (centre at the origin), from the drum's right counterclockwise, with straight ends that leave it along its tangents.
// Quadrilaterals only.
DefineConstant[
  phi = 90, // angle that it touches, degrees
  t = 0.02, // thickness of the belt
  l = 0.3,  // length of its straight ends
  n = 16,   // cells along a quarter of the drum, of the belt; the drum has 1.25 times as many
  m = 1     // cells across the belt
];
r = 1; R = 1 + t; d = 0.9; a = phi * Pi / 180;
// from the slack end, at the angle a, by the middle to the drawn end at the right; radii r and R
For i In {0:1}
  q = i ? R : r; k = 10 * i;
  Point(1 + k) = {q * Cos(a) - l * Sin(a), q * Sin(a) + l * Cos(a), 0};
  Point(2 + k) = {q * Cos(a), q * Sin(a), 0}; Point(3 + k) = {q * Cos(a / 2), q * Sin(a / 2), 0}; Point(4 + k) = {q, 0, 0}; Point(5 + k) = {q, -l, 0};
EndFor
Point(100) = {0, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 100, 3}; Circle(3) = {3, 100, 4}; Line(4) = {4, 5};
Line(5) = {11, 12}; Circle(6) = {12, 100, 13}; Circle(7) = {13, 100, 14}; Line(8) = {14, 15};
For i In {0:4}
  Line(11 + i) = {1 + i, 11 + i};
EndFor
For i In {0:3}
  Curve Loop(1 + i) = {1 + i, 12 + i, -(5 + i), -(11 + i)}; Plane Surface(1 + i) = {1 + i};
EndFor
// the drum goes on a little beyond both ends; radii r and d
b = 0.2;
For i In {0:1}
  q = i ? d : r; k = 10 * i;
  Point(21 + k) = {q * Cos(a + b), q * Sin(a + b), 0}; Point(22 + k) = {q * Cos(a), q * Sin(a), 0}; Point(23 + k) = {q * Cos(a / 2), q * Sin(a / 2), 0};
  Point(24 + k) = {q, 0, 0}; Point(25 + k) = {q * Cos(-b), q * Sin(-b), 0};
  For j In {0:3}
    Circle(21 + k + j) = {21 + k + j, 100, 22 + k + j};
  EndFor
EndFor
For i In {0:4}
  Line(41 + i) = {21 + i, 31 + i};
EndFor
For i In {0:3}
  Curve Loop(11 + i) = {21 + i, 42 + i, -(31 + i), -(41 + i)}; Plane Surface(11 + i) = {11 + i};
EndFor
Transfinite Curve {1, 4, 5, 8} = Ceil(n * 2 * l / Pi) + 1;
Transfinite Curve {2, 3, 6, 7} = Ceil(n * phi / 180) + 1;
Transfinite Curve {11:15} = m + 1;
Transfinite Curve {22, 23, 32, 33} = Ceil(1.25 * n * phi / 180) + 1;
Transfinite Curve {21, 24, 31, 34} = Ceil(n / 6) + 1;
Transfinite Curve {41:45} = 2;
Transfinite Surface {1:4, 11:14};
Recombine Surface {1:4, 11:14};
Physical Surface("belt") = {1:4};
Physical Surface("drum") = {11:14};
Physical Curve("inside") = {1:4};
Physical Curve("rim") = {21:24};
Physical Curve("slack") = {11};
Physical Curve("drawn") = {15};
