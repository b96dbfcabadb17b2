// Blank (radius b, thickness d) over a rigid ring (bore a, shoulder p) under a rigid punch (radius c, edge q).
DefineConstant[ b = 0.85, d = 0.06, a = 0.5, p = 0.15, c = 0.4, q = 0.12, n = 30, m = 2 ];
Point(1) = {0, 0, 0}; Point(2) = {b, 0, 0}; Point(3) = {b, d, 0}; Point(4) = {0, d, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1};
Point(11) = {0, d, 0, 0.1}; Point(12) = {c - q, d, 0, 0.05}; Point(13) = {c - q, d + q, 0}; Point(14) = {c, d + q, 0, 0.05}; Point(15) = {c, d + 0.9, 0, 0.2}; Point(16) = {0, d + 0.9, 0, 0.2};
Line(11) = {11, 12}; Circle(12) = {12, 13, 14}; Line(13) = {14, 15}; Line(14) = {15, 16}; Line(15) = {16, 11}; Curve Loop(2) = {11:15}; Plane Surface(2) = {2};
Point(21) = {1.2, 0, 0, 0.2}; Point(22) = {a + p, 0, 0, 0.05}; Point(23) = {a + p, -p, 0}; Point(24) = {a, -p, 0, 0.05}; Point(25) = {a, -0.6, 0, 0.2}; Point(26) = {1.2, -0.6, 0, 0.2};
Line(21) = {21, 22}; Circle(22) = {22, 23, 24}; Line(23) = {24, 25}; Line(24) = {25, 26}; Line(25) = {26, 21}; Curve Loop(3) = {21:25}; Plane Surface(3) = {3}; Recombine Surface {1:3};
Physical Surface("blank") = {1}; Physical Surface("punch") = {2}; Physical Surface("ring") = {3};
Physical Curve("under") = {1}; Physical Curve("over") = {3}; Physical Curve("axis") = {4}; Physical Curve("nose") = {11, 12, 13}; Physical Curve("shoulder") = {21, 22, 23};
