// Tube (radius r, thickness d) over the corner at the origin of a block; a rigid plate above.
DefineConstant[ r = 0.4, d = 0.06, n = 48, m = 2, s = 1 ];
y = r;
Point(1) = {0, y, 0}; Point(2) = {r, y, 0}; Point(3) = {0, y + r, 0}; Point(4) = {-r, y, 0}; Point(5) = {0, y - r, 0};
q = r - d; Point(12) = {q, y, 0}; Point(13) = {0, y + q, 0}; Point(14) = {-q, y, 0}; Point(15) = {0, y - q, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Circle(11) = {12, 1, 13}; Circle(12) = {13, 1, 14}; Circle(13) = {14, 1, 15}; Circle(14) = {15, 1, 12};
Line(21) = {12, 2}; Line(22) = {13, 3}; Line(23) = {14, 4}; Line(24) = {15, 5};
Curve Loop(1) = {21, 1, -22, -11}; Curve Loop(2) = {22, 2, -23, -12}; Curve Loop(3) = {23, 3, -24, -13}; Curve Loop(4) = {24, 4, -21, -14}; Plane Surface(1) = {1}; Plane Surface(2) = {2}; Plane Surface(3) = {3}; Plane Surface(4) = {4};
Transfinite Curve {1:4, 11:14} = n/4 + 1; Transfinite Curve {21:24} = m + 1; Transfinite Surface {1:4};
Point(31) = {-1, 0, 0, 0.2*s}; Point(32) = {-1, -0.6, 0, 0.2*s}; Point(33) = {0.1, -0.6, 0, 0.2*s}; Point(34) = {0.1, 0, 0, 0.06*s};
Line(31) = {31, 32}; Line(32) = {32, 33}; Line(33) = {33, 34}; Line(34) = {34, 31}; Curve Loop(5) = {31:34}; Plane Surface(5) = {5};
Recombine Surface {1:5};
Physical Surface("tube") = {1:4}; Physical Surface("block") = {5}; Physical Curve("outside") = {1:4}; Physical Curve("crown") = {11}; Physical Curve("hull") = {33, 34}; Physical Curve("foot") = {32};
