// A wedge of 120 degrees in a valley that it fills
a = 0.21132486540518713; b = 0.78867513459481287;
Point(1) = {-1, 0, 0}; Point(2) = {0, 0, 0}; Point(3) = {1, 0, 0}; Point(4) = {1, b, 0}; Point(5) = {0, a, 0}; Point(6) = {-1, b, 0};
Point(7) = {-1, b, 0}; Point(8) = {0, a, 0}; Point(9) = {1, b, 0}; Point(10) = {1, 1.2, 0}; Point(11) = {0, 1.2, 0}; Point(12) = {-1, 1.2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {2, 5};
Line(8) = {7, 8}; Line(9) = {8, 9}; Line(10) = {9, 10}; Line(11) = {10, 11}; Line(12) = {11, 12}; Line(13) = {12, 7}; Line(14) = {8, 11};
Transfinite Curve {1:7} = 4; Transfinite Curve {8:14} = 5;
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1}; Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};
Curve Loop(3) = {8, 14, 12, 13}; Plane Surface(3) = {3}; Curve Loop(4) = {9, 10, 11, -14}; Plane Surface(4) = {4};
Transfinite Surface {1:4}; Recombine Surface {1:4};
Physical Surface("low") = {1, 2}; Physical Surface("up") = {3, 4};
Physical Curve("bottom") = {1, 2}; Physical Curve("under") = {4, 5}; Physical Curve("over") = {8, 9}; Physical Curve("top") = {11, 12};
