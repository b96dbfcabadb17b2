// Tube (bore a, thickness d, height h) under a rigid cone (half angle 25 degrees).
DefineConstant[ a = 0.5, d = 0.08, h = 0.8, n = 2, m = 20 ];
Point(1) = {a, 0, 0}; Point(2) = {a + d, 0, 0}; Point(3) = {a + d, h, 0}; Point(4) = {a, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1};
t = Tan(25 * Pi / 180);
Point(11) = {a - 0.3 * t, h - 0.3, 0}; Point(12) = {a + 0.6 * t, h + 0.6, 0}; Point(13) = {0, h + 0.6, 0}; Point(14) = {0, h - 0.3, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11:14} = 4; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("tube") = {1}; Physical Surface("plug") = {2};
Physical Curve("foot") = {1}; Physical Curve("skin") = {3, 4}; Physical Curve("cone") = {11};
