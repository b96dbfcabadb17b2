// Ring (bore a, outside b) on a shaft (radius c > a), a quarter of both.
DefineConstant[ a = 0.4, b = 0.9, c = 0.5, n = 12, m = 12, k = 8 ];
Point(1) = {0, 0, 0}; Point(2) = {a, 0, 0}; Point(3) = {b, 0, 0}; Point(4) = {0, b, 0}; Point(5) = {0, a, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1};
Point(11) = {0.2*c, 0, 0}; Point(12) = {c, 0, 0}; Point(13) = {0, c, 0}; Point(14) = {0, 0.2*c, 0};
Line(11) = {11, 12}; Circle(12) = {12, 1, 13}; Line(13) = {13, 14}; Circle(14) = {14, 1, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11, 13} = 4; Transfinite Curve {12, 14} = k + 1; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("ring") = {1}; Physical Surface("shaft") = {2}; Physical Curve("bore") = {4}; Physical Curve("seat") = {12}; Physical Curve("y0") = {1}; Physical Curve("x0") = {3}; Physical Curve("rim") = {2};
