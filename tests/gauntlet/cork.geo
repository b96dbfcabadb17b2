// A cork over the mouth of a bottle, r-z plane; s: size of cells
DefineConstant[ s = 0.1 ];
Point(1) = {0, 0, 0, s}; Point(2) = {0.9, 0, 0, s}; Point(3) = {1.0, 0.1, 0, s}; Point(6) = {0.9, 0.1, 0}; Point(4) = {1.0, 1.2, 0, s}; Point(5) = {0, 1.2, 0, s};
Line(1) = {1, 2}; Circle(2) = {2, 6, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1}; Curve Loop(1) = {1:5}; Plane Surface(1) = {1};
Point(11) = {0.93, -1.5, 0, s}; Point(12) = {1.4, -1.5, 0, 2 * s}; Point(13) = {1.4, 0, 0, 2 * s}; Point(14) = {1.13, 0, 0, s}; Point(15) = {0.93, -0.2, 0, s}; Point(16) = {1.13, -0.2, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Circle(14) = {14, 16, 15}; Line(15) = {15, 11}; Curve Loop(2) = {11:15}; Plane Surface(2) = {2};
Recombine Surface {1, 2};
Physical Surface("cork") = {1}; Physical Surface("neck") = {2};
Physical Curve("side") = {1, 2, 3}; Physical Curve("axis") = {5}; Physical Curve("head") = {4}; Physical Curve("mouth") = {13, 14, 15}; Physical Curve("foot") = {11};
