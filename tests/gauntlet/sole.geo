// A stiff block on a soft sole of other cells, on a floor; s: size of cells
DefineConstant[ s = 0.1 ];
Point(1) = {-1, -0.2, 0, 3 * s}; Point(2) = {2, -0.2, 0, 3 * s}; Point(3) = {2, 0, 0, 3 * s}; Point(4) = {-1, 0, 0, 3 * s};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {-0.5, 0, 0, 0.7 * s}; Point(12) = {0.5, 0, 0, 0.7 * s}; Point(13) = {0.5, 0.2, 0, s}; Point(14) = {-0.5, 0.2, 0, s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Point(21) = {-0.6, 0.2, 0, 1.7 * s}; Point(22) = {0.6, 0.2, 0, 1.7 * s}; Point(23) = {0.6, 0.5, 0, 2 * s}; Point(24) = {-0.6, 0.5, 0, 2 * s};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Recombine Surface {1:3};
Physical Surface("floor") = {1}; Physical Surface("sole") = {2}; Physical Surface("shoe") = {3};
Physical Curve("ground") = {3}; Physical Curve("tread") = {11}; Physical Curve("skin") = {11, 12, 14}; Physical Curve("bond") = {13}; Physical Curve("seat") = {21}; Physical Curve("top") = {23};
