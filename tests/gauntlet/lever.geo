// A drum of radius 1, a pad with a hollow of radius q, and a lever on it
DefineConstant[ s = 0.15, q = 1.05 ];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0, s}; Point(3) = {0, 1, 0, s}; Point(4) = {-1, 0, 0, s}; Point(5) = {0, -1, 0, s};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
c = 1 - q; x = 0.5; y = c + Sqrt(q * q + 0 * x); z = c + Sqrt(q * q - x * x);
c += 0.01; z += 0.01;
Point(10) = {0, c, 0}; Point(11) = {-x, z, 0}; Point(12) = {x, z, 0}; Point(13) = {x, 1.25, 0}; Point(14) = {-x, 1.25, 0};
Circle(11) = {12, 10, 11}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {12, 13, 14, -11}; Plane Surface(11) = {11};
Transfinite Curve {11, 13} = 11; Transfinite Curve {12, 14} = 4; Transfinite Surface {11};
Point(21) = {-2, 1.25, 0}; Point(22) = {0.8, 1.25, 0}; Point(23) = {0.8, 1.4, 0}; Point(24) = {-2, 1.4, 0};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(21) = {21:24}; Plane Surface(21) = {21};
Transfinite Curve {21, 23} = 14; Transfinite Curve {22, 24} = 2; Transfinite Surface {21};
Recombine Surface {1, 11, 21};
Physical Surface("drum") = {1}; Physical Surface("pad") = {11}; Physical Surface("lever") = {21};
Physical Curve("rim") = {1:4}; Physical Curve("front") = {11}; Physical Curve("back") = {13}; Physical Curve("under") = {21};
