// A slender strut (thickness d, length l) between two rigid walls at a distance g on either side.
DefineConstant[ d = 0.08, l = 1.6, g = 0.15, n = 2, m = 24 ];
Point(1) = {-d / 2, 0, 0}; Point(2) = {d / 2, 0, 0}; Point(3) = {d / 2, l, 0}; Point(4) = {-d / 2, l, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1}; Recombine Surface {1};
a = d / 2 + g;
Point(11) = {a, -0.2, 0}; Point(12) = {a + 0.1, -0.2, 0}; Point(13) = {a + 0.1, l + 0.2, 0}; Point(14) = {a, l + 0.2, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Point(21) = {-a - 0.1, -0.2, 0}; Point(22) = {-a, -0.2, 0}; Point(23) = {-a, l + 0.2, 0}; Point(24) = {-a - 0.1, l + 0.2, 0};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Transfinite Curve {11, 13, 21, 23} = 2; Transfinite Curve {12, 14, 22, 24} = 5; Transfinite Surface {2, 3}; Recombine Surface {2, 3};
Physical Surface("strut") = {1}; Physical Surface("right_wall") = {2}; Physical Surface("left_wall") = {3};
Physical Curve("foot") = {1}; Physical Curve("right_side") = {2}; Physical Curve("head") = {3}; Physical Curve("left_side") = {4}; Physical Curve("right_face") = {14}; Physical Curve("left_face") = {22};
