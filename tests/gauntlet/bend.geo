// Half of a sheet (length l, thickness d) under a rigid punch (radius q) on a rigid roller (radius p) at x = w.
DefineConstant[ l = 1.4, d = 0.1, q = 0.25, p = 0.15, w = 0.8, n = 28, m = 2 ];
Point(1) = {0, 0, 0}; Point(2) = {l, 0, 0}; Point(3) = {l, d, 0}; Point(4) = {0, d, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1};
Point(11) = {0, d + q, 0, 0.1}; Point(12) = {0, d, 0, 0.1}; Point(13) = {q, d + q, 0, 0.1};
Circle(11) = {12, 11, 13}; Line(12) = {13, 11}; Line(13) = {11, 12}; Curve Loop(2) = {11:13}; Plane Surface(2) = {2};
Point(21) = {w, -p, 0, 0.06}; Point(22) = {w + p, -p, 0, 0.06}; Point(23) = {w, 0, 0, 0.06}; Point(24) = {w - p, -p, 0, 0.06};
Circle(21) = {22, 21, 23}; Circle(22) = {23, 21, 24}; Line(23) = {24, 22}; Curve Loop(3) = {21:23}; Plane Surface(3) = {3}; Recombine Surface {1:3};
Physical Surface("sheet") = {1}; Physical Surface("punch") = {2}; Physical Surface("roller") = {3};
Physical Curve("under") = {1}; Physical Curve("over") = {3}; Physical Curve("middle") = {4}; Physical Curve("nose") = {11}; Physical Curve("rim") = {21, 22};
