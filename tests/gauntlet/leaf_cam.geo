// A leaf spring 60 long and 2 thick, clamped at x = 0, over an eccentric of radius 4 whose centre is 2 beside the axis that it turns about.
DefineConstant[ n = 2, m = 12 ];
Point(1) = {0, 0, 0}; Point(2) = {60, 0, 0}; Point(3) = {60, 2, 0}; Point(4) = {0, 2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 6*n + 1; Transfinite Curve {2, 4} = n + 1; Transfinite Surface {1};
x = 48; y = -4.05; r = 4; // centre, beside the axis at (50, -4.05)
Point(10) = {x, y, 0};
Point(11) = {x + r, y, 0}; Point(12) = {x, y + r, 0}; Point(13) = {x - r, y, 0}; Point(14) = {x, y - r, 0};
Point(21) = {x + r/2, y, 0}; Point(22) = {x, y + r/2, 0}; Point(23) = {x - r/2, y, 0}; Point(24) = {x, y - r/2, 0};
For k In {0:3}
  Circle(11 + k) = {11 + k, 10, 11 + (k + 1) % 4}; Line(21 + k) = {21 + k, 21 + (k + 1) % 4}; Line(31 + k) = {11 + k, 21 + k};
EndFor
For k In {0:3}
  Curve Loop(11 + k) = {11 + k, 31 + (k + 1) % 4, -(21 + k), -(31 + k)}; Plane Surface(11 + k) = {11 + k};
EndFor
Curve Loop(20) = {21:24}; Plane Surface(20) = {20};
Transfinite Curve {11:14, 21:24} = m/2 + 1; Transfinite Curve {31:34} = 2; Transfinite Surface {11:14, 20}; Recombine Surface {1, 11:14, 20};
Physical Surface("leaf") = {1}; Physical Surface("cam") = {11:14, 20};
Physical Curve("clamp") = {4}; Physical Curve("under") = {1}; Physical Curve("skin") = {11:14};
