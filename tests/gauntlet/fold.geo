// A horseshoe: half of a ring (radii ri, ro) with two straight legs, thickness ro - ri, open to the right; and a rigid plate above it.
DefineConstant[ ri = 0.2, ro = 0.4, l = 1, n = 3, m = 8, k = 6 ];
Point(1) = {0, 0, 0}; Point(2) = {0, ri, 0}; Point(3) = {0, ro, 0}; Point(4) = {-ri, 0, 0}; Point(5) = {-ro, 0, 0}; Point(6) = {0, -ri, 0}; Point(7) = {0, -ro, 0};
Point(8) = {l, ri, 0}; Point(9) = {l, ro, 0}; Point(10) = {l, -ri, 0}; Point(11) = {l, -ro, 0};
Line(1) = {2, 3}; Line(2) = {4, 5}; Line(3) = {6, 7}; Line(4) = {8, 9}; Line(5) = {10, 11};
Circle(6) = {2, 1, 4}; Circle(7) = {3, 1, 5}; Circle(8) = {4, 1, 6}; Circle(9) = {5, 1, 7};
Line(10) = {8, 2}; Line(11) = {9, 3}; Line(12) = {6, 10}; Line(13) = {7, 11};
Curve Loop(1) = {1, 7, -2, -6}; Plane Surface(1) = {1}; Curve Loop(2) = {2, 9, -3, -8}; Plane Surface(2) = {2};
Curve Loop(3) = {4, 11, -1, -10}; Plane Surface(3) = {3}; Curve Loop(4) = {3, 13, -5, -12}; Plane Surface(4) = {4};
Transfinite Curve {1:5} = n + 1; Transfinite Curve {6:9} = k + 1; Transfinite Curve {10:13} = m + 1; Transfinite Surface {1:4};
Point(21) = {-ro, ro, 0}; Point(22) = {l + 0.2, ro, 0}; Point(23) = {l + 0.2, ro + 0.2, 0}; Point(24) = {-ro, ro + 0.2, 0};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(5) = {21:24}; Plane Surface(5) = {5};
Transfinite Curve {21:24} = 2; Transfinite Surface {5}; Recombine Surface {1:5};
Physical Surface("shoe") = {1:4}; Physical Surface("plate") = {5};
Physical Curve("sole") = {13}; Physical Curve("outside") = {11, 7, 9}; Physical Curve("inside") = {10, 6, 8, 12}; Physical Curve("plate_face") = {21};
