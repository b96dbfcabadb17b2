// A square of 40 mm on a rigid plane; cells narrow towards the loaded side x = 0.
DefineConstant[n = 16];
Point(1) = {0, 0, 0}; Point(2) = {0.04, 0, 0}; Point(3) = {0.04, 0.04, 0}; Point(4) = {0, 0.04, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = n + 1; Transfinite Surface {1};
Point(11) = {-0.02, -0.01, 0}; Point(12) = {0.06, -0.01, 0}; Point(13) = {0.06, 0, 0}; Point(14) = {-0.02, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11:14} = 2; Transfinite Surface {2};
Recombine Surface {1, 2};
Physical Surface("plate") = {1}; Physical Surface("plane") = {2};
Physical Curve("foot") = {1}; Physical Curve("symmetry") = {2}; Physical Curve("top") = {3}; Physical Curve("side") = {4}; Physical Curve("ground") = {13};
