// A plug of radius R in a ring; n, m cells round the plug and the ring
DefineConstant[ R = 0.5, Q = 1, n = 16, m = 20 ];
Point(1) = {0, 0, 0};
Point(2) = {R, 0, 0}; Point(3) = {0, R, 0}; Point(4) = {-R, 0, 0}; Point(5) = {0, -R, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = n / 4 + 1; Transfinite Surface {1}; Recombine Surface {1};
Point(12) = {R, 0, 0}; Point(13) = {0, R, 0}; Point(14) = {-R, 0, 0}; Point(15) = {0, -R, 0};
Point(22) = {Q, 0, 0}; Point(23) = {0, Q, 0}; Point(24) = {-Q, 0, 0}; Point(25) = {0, -Q, 0};
Circle(11) = {12, 1, 13}; Circle(12) = {13, 1, 14}; Circle(13) = {14, 1, 15}; Circle(14) = {15, 1, 12};
Circle(21) = {22, 1, 23}; Circle(22) = {23, 1, 24}; Circle(23) = {24, 1, 25}; Circle(24) = {25, 1, 22};
Line(31) = {12, 22}; Line(32) = {13, 23}; Line(33) = {14, 24}; Line(34) = {15, 25};
Curve Loop(11) = {31, 21, -32, -11}; Plane Surface(11) = {11}; Curve Loop(12) = {32, 22, -33, -12}; Plane Surface(12) = {12};
Curve Loop(13) = {33, 23, -34, -13}; Plane Surface(13) = {13}; Curve Loop(14) = {34, 24, -31, -14}; Plane Surface(14) = {14};
Transfinite Curve {11:14, 21:24} = m / 4 + 1; Transfinite Curve {31:34} = 5; Transfinite Surface {11:14}; Recombine Surface {11:14};
Physical Surface("plug") = {1}; Physical Surface("ring") = {11:14};
Physical Curve("skin") = {1:4}; Physical Curve("bore") = {11:14}; Physical Curve("rim") = {21:24};
