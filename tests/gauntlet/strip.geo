// A strip between two blocks; s: size of cells
DefineConstant[ s = 0.1 ];
Point(1) = {-1.5, -0.1, 0, s}; Point(2) = {1.5, -0.1, 0, s}; Point(3) = {1.5, 0.1, 0, s}; Point(4) = {-1.5, 0.1, 0, s};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {-0.5, 0.1, 0, 1.3 * s}; Point(12) = {0.5, 0.1, 0, 1.3 * s}; Point(13) = {0.5, 0.6, 0, 2 * s}; Point(14) = {-0.5, 0.6, 0, 2 * s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Point(21) = {-0.5, -0.1, 0, 1.3 * s}; Point(22) = {0.5, -0.1, 0, 1.3 * s}; Point(23) = {0.5, -0.6, 0, 2 * s}; Point(24) = {-0.5, -0.6, 0, 2 * s};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Recombine Surface {1:3};
Physical Surface("strip") = {1}; Physical Surface("upper") = {2}; Physical Surface("lower") = {3};
Physical Curve("over") = {3}; Physical Curve("under") = {1}; Physical Curve("end") = {2}; Physical Curve("atop") = {13}; Physical Curve("foot") = {23};
Physical Curve("jaw") = {11}; Physical Curve("bed") = {21};
