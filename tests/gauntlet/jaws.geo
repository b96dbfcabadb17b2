// a disc between two jaws that turn about the origin, and the stop that it is squeezed against
DefineConstant[s = 1];
Geometry.AutoCoherence = 0;
r = 0.3; x = 1.6; h = 0.12 * s;
Point(1) = {x + r, 0, 0, h}; Point(2) = {x, r, 0, h}; Point(3) = {x - r, 0, 0, h}; Point(4) = {x, -r, 0, h}; Point(5) = {x, 0, 0, h};
Circle(1) = {1, 5, 2}; Circle(2) = {2, 5, 3}; Circle(3) = {3, 5, 4}; Circle(4) = {4, 5, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {0.5, 0.32, 0}; Point(12) = {2.2, 0.32, 0}; Point(13) = {2.2, 0.47, 0}; Point(14) = {0.5, 0.47, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Point(21) = {0.5, -0.47, 0}; Point(22) = {2.2, -0.47, 0}; Point(23) = {2.2, -0.32, 0}; Point(24) = {0.5, -0.32, 0};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Point(31) = {1.2, -0.15, 0}; Point(32) = {1.27, -0.15, 0}; Point(33) = {1.27, 0.15, 0}; Point(34) = {1.2, 0.15, 0};
Line(31) = {31, 32}; Line(32) = {32, 33}; Line(33) = {33, 34}; Line(34) = {34, 31}; Curve Loop(4) = {31:34}; Plane Surface(4) = {4};
Transfinite Curve{11, 13, 21, 23} = Ceil(6 / s) + 1; Transfinite Curve{12, 14, 22, 24, 31:34} = 2; Transfinite Surface{2, 3, 4}; Recombine Surface{2, 3, 4};
Physical Surface("disc") = {1}; Physical Surface("upper") = {2}; Physical Surface("lower") = {3}; Physical Surface("stop") = {4};
Physical Curve("skin") = {1:4}; Physical Curve("above") = {11}; Physical Curve("below") = {23}; Physical Curve("end") = {32};
