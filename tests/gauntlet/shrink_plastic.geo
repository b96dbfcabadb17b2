// A quarter of a shaft of radius 1 in a ring of radii 1 and 2; n: cells across the ring
DefineConstant[ n = 6 ];
Point(1) = {0, 0, 0}; Point(2) = {0.4, 0, 0}; Point(3) = {1, 0, 0}; Point(4) = {0, 1, 0}; Point(5) = {0, 0.4, 0};
Point(11) = {1, 0, 0}; Point(12) = {2, 0, 0}; Point(13) = {0, 2, 0}; Point(14) = {0, 1, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Line(11) = {11, 12}; Circle(12) = {12, 1, 13}; Line(13) = {13, 14}; Circle(14) = {14, 1, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {1, 3} = 3; Transfinite Curve {2, 4} = 8; Transfinite Curve {11, 13} = n + 1; Transfinite Curve {12, 14} = n + 1; Transfinite Surface {1}; Transfinite Surface {11}; Recombine Surface {1, 11};
Physical Surface("shaft") = {1}; Physical Surface("ring") = {11};
Physical Curve("skin") = {2}; Physical Curve("bore") = {14}; Physical Curve("sx") = {3, 13}; Physical Curve("sy") = {1, 11}; Physical Curve("rim") = {12};
