// A unit square on a long rigid plane.
DefineConstant[n = 1];
Point(1) = {-2.5, 0, 0}; Point(2) = {-1.5, 0, 0}; Point(3) = {-1.5, 1, 0}; Point(4) = {-2.5, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = n + 1; Transfinite Surface {1};
Point(11) = {-4, -0.5, 0}; Point(12) = {4, -0.5, 0}; Point(13) = {4, 0, 0}; Point(14) = {-4, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11, 13} = 9; Transfinite Curve {12, 14} = 2; Transfinite Surface {2};
Recombine Surface {1, 2};
Physical Surface("block") = {1}; Physical Surface("plane") = {2};
Physical Curve("foot") = {1}; Physical Curve("top") = {3}; Physical Curve("ground") = {13};
