// Half of a section: plate of radius 20 and height 4, ball of radius 10, ball of radius 5, plate of radius 10 and height 2. n: cells to a quarter of an arc.
DefineConstant[n = 8];
Point(1) = {0, 0, 0}; Point(2) = {20, 0, 0}; Point(3) = {20, 4, 0}; Point(4) = {0, 4, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 21; Transfinite Curve {2, 4} = 5; Transfinite Surface {1};
Point(61) = {0, 34, 0}; Point(62) = {10, 34, 0}; Point(63) = {10, 36, 0}; Point(64) = {0, 36, 0};
Line(61) = {61, 62}; Line(62) = {62, 63}; Line(63) = {63, 64}; Line(64) = {64, 61};
Curve Loop(60) = {61:64}; Plane Surface(60) = {60};
Transfinite Curve {61, 63} = 11; Transfinite Curve {62, 64} = 3; Transfinite Surface {60};
Macro Ball
  // a half disc of radius r around (0, c), numbers from b on
  Point(b) = {0, c, 0}; Point(b + 1) = {0, c - r, 0}; Point(b + 2) = {r * Sqrt(0.5), c - r * Sqrt(0.5), 0}; Point(b + 3) = {r, c, 0};
  Point(b + 4) = {r * Sqrt(0.5), c + r * Sqrt(0.5), 0}; Point(b + 5) = {0, c + r, 0};
  Point(b + 6) = {0, c - r / 2, 0}; Point(b + 7) = {0.4 * r, c - 0.4 * r, 0}; Point(b + 8) = {r / 2, c, 0}; Point(b + 9) = {0.4 * r, c + 0.4 * r, 0};
  Point(b + 10) = {0, c + r / 2, 0};
  For k In {0:3}
    Circle(b + k) = {b + 1 + k, b, b + 2 + k};
    Line(b + 4 + k) = {b + 6 + k, b + 7 + k};
  EndFor
  For k In {0:4}
    Line(b + 8 + k) = {b + 6 + k, b + 1 + k};
  EndFor
  Line(b + 13) = {b, b + 6}; Line(b + 14) = {b, b + 8}; Line(b + 15) = {b, b + 10};
  For k In {0:3}
    Curve Loop(b + k) = {b + 8 + k, b + k, -(b + 9 + k), -(b + 4 + k)}; Plane Surface(b + k) = {b + k};
  EndFor
  Curve Loop(b + 4) = {b + 13, b + 4, b + 5, -(b + 14)}; Plane Surface(b + 4) = {b + 4};
  Curve Loop(b + 5) = {b + 14, b + 6, b + 7, -(b + 15)}; Plane Surface(b + 5) = {b + 5};
  Transfinite Curve {b : b + 7, b + 13 : b + 15} = n + 1; Transfinite Curve {b + 8 : b + 12} = n + 1;
  Transfinite Surface {b : b + 5};
Return
b = 100; r = 10; c = 14; Call Ball;
b = 200; r = 5; c = 29; Call Ball;
Recombine Surface {1, 60, 100:105, 200:205};
Physical Surface("lower") = {1}; Physical Surface("upper") = {60}; Physical Surface("ball") = {100:105}; Physical Surface("small") = {200:205};
Physical Curve("edge") = {2}; Physical Curve("top") = {63};
Physical Curve("lower_face") = {3}; Physical Curve("upper_face") = {61};
Physical Curve("ball_under") = {100, 101}; Physical Curve("ball_over") = {102, 103}; Physical Curve("small_under") = {200, 201}; Physical Curve("small_over") = {202, 203};
Physical Curve("axis") = {4, 64, 108, 113, 115, 112, 208, 213, 215, 212};
