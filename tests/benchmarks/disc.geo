// A quarter of a disc (radius 0.6) in a ring (0.6 to 1); n and m cells around them.
DefineConstant[n = 8, m = 10];
Point(1) = {0, 0, 0}; c = 0.6 * Cos(Pi/4);
Point(2) = {0.3, 0, 0}; Point(3) = {0.6, 0, 0}; Point(4) = {c, c, 0}; Point(5) = {0, 0.6, 0}; Point(6) = {0, 0.3, 0}; Point(7) = {0.25, 0.25, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Circle(3) = {3, 1, 4}; Circle(4) = {4, 1, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Line(7) = {2, 7}; Line(8) = {7, 6}; Line(9) = {4, 7};
Curve Loop(1) = {1, 7, 8, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 9, -7}; Plane Surface(2) = {2};
Curve Loop(3) = {-9, 4, 5, -8}; Plane Surface(3) = {3};
Point(12) = {0.6, 0, 0}; Point(13) = {1, 0, 0}; Point(14) = {0, 1, 0}; Point(15) = {0, 0.6, 0};
Line(11) = {12, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 15}; Circle(14) = {15, 1, 12};
Curve Loop(4) = {11:14}; Plane Surface(4) = {4};
Transfinite Curve {1, 3, 4, 6, 7, 8} = n/2 + 1; Transfinite Curve {2, 5, 9} = 4; Transfinite Curve {12, 14} = m + 1; Transfinite Curve {11, 13} = 5;
Transfinite Surface {1:4}; Recombine Surface {1:4};
Physical Surface("inner") = {1:3}; Physical Surface("outer") = {4};
Physical Curve("inner_face") = {3, 4}; Physical Curve("outer_face") = {14}; Physical Curve("rim") = {12};
Physical Curve("axis_x") = {1, 2, 11}; Physical Curve("axis_y") = {5, 6, 13};
