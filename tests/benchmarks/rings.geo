// A quarter of two rings: radii 0.2 to 0.6 (inner) and 0.6 to 1 (outer); n and m cells around them.
DefineConstant[n = 8, m = 10];
Point(1) = {0, 0, 0};
Point(2) = {0.2, 0, 0}; Point(3) = {0.6, 0, 0}; Point(4) = {0, 0.6, 0}; Point(5) = {0, 0.2, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(12) = {0.6, 0, 0}; Point(13) = {1, 0, 0}; Point(14) = {0, 1, 0}; Point(15) = {0, 0.6, 0};
Line(11) = {12, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 15}; Circle(14) = {15, 1, 12};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {2, 4} = n + 1; Transfinite Curve {12, 14} = m + 1; Transfinite Curve {1, 3, 11, 13} = 5;
Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Physical Surface("inner") = {1}; Physical Surface("outer") = {2};
Physical Curve("inner_face") = {2}; Physical Curve("outer_face") = {14}; Physical Curve("rim") = {12};
Physical Curve("axis_x") = {1, 11}; Physical Curve("axis_y") = {3, 13};
