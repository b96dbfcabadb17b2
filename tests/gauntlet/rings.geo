// A quarter of a ring in a ring; n, m: cells along the arc of the inner and the outer one
DefineConstant[ n = 4, m = 32 ];
Point(1) = {0, 0, 0}; Point(2) = {0.8, 0, 0}; Point(3) = {1, 0, 0}; Point(4) = {0, 1, 0}; Point(5) = {0, 0.8, 0}; Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(12) = {1, 0, 0}; Point(13) = {1.3, 0, 0}; Point(14) = {0, 1.3, 0}; Point(15) = {0, 1, 0}; Line(11) = {12, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 15}; Circle(14) = {15, 1, 12}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {2, 4} = n + 1; Transfinite Curve {12, 14} = m + 1; Transfinite Curve {1, 3, 11, 13} = 4; Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Physical Surface("inner") = {1};
Physical Surface("outer") = {2};
Physical Curve("face") = {2};
Physical Curve("bore") = {14};
Physical Curve("inside") = {4};
Physical Curve("x0") = {3, 13};
Physical Curve("y0") = {1, 11};
