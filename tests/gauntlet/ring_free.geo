// a ring in the round hole of a housing, beside its middle
Geometry.AutoCoherence = 0;
h = 0.1;
Point(1) = {0, 0, 0, h};
Point(2) = {0.9, 0, 0, h}; Point(3) = {0, 0.9, 0, h}; Point(4) = {-0.9, 0, 0, h}; Point(5) = {0, -0.9, 0, h};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4};
Point(6) = {0.6, 0, 0, h}; Point(7) = {0, 0.6, 0, h}; Point(8) = {-0.6, 0, 0, h}; Point(9) = {0, -0.6, 0, h};
Circle(5) = {6, 1, 7}; Circle(6) = {7, 1, 8}; Circle(7) = {8, 1, 9}; Circle(8) = {9, 1, 6}; Curve Loop(2) = {5:8};
Plane Surface(1) = {1, 2};
Point(11) = {-1.3, -1.2, 0, 2 * h}; Point(12) = {1.5, -1.2, 0, 2 * h}; Point(13) = {1.5, 1.2, 0, 2 * h}; Point(14) = {-1.3, 1.2, 0, 2 * h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(3) = {11:14};
Point(22) = {0.9, 0, 0, 2 * h}; Point(23) = {0, 0.9, 0, 2 * h}; Point(24) = {-0.9, 0, 0, 2 * h}; Point(25) = {0, -0.9, 0, 2 * h};
Circle(21) = {22, 1, 23}; Circle(22) = {23, 1, 24}; Circle(23) = {24, 1, 25}; Circle(24) = {25, 1, 22}; Curve Loop(4) = {21:24};
Plane Surface(2) = {3, 4};
Physical Surface("ring") = {1}; Physical Surface("housing") = {2};
Physical Curve("outside") = {1:4}; Physical Curve("hole") = {21:24}; Physical Curve("held") = {11:14};
