// A disc between two plates; s: size of cells
DefineConstant[ s = 0.08 ];
Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0, s}; Point(3) = {0, 0.5, 0, s}; Point(4) = {-0.5, 0, 0, s}; Point(5) = {0, -0.5, 0, s};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {-1, 0.5, 0, s}; Point(12) = {1, 0.5, 0, s}; Point(13) = {1, 0.9, 0, 2 * s}; Point(14) = {-1, 0.9, 0, 2 * s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Point(21) = {-1, -0.5, 0, s}; Point(22) = {1, -0.5, 0, s}; Point(23) = {1, -0.9, 0, 2 * s}; Point(24) = {-1, -0.9, 0, 2 * s};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Recombine Surface {1:3};
Physical Surface("roller") = {1}; Physical Surface("upper") = {2}; Physical Surface("lower") = {3};
Physical Curve("rim") = {1:4}; Physical Curve("over") = {11}; Physical Curve("under") = {21}; Physical Curve("top") = {13}; Physical Curve("foot") = {23};
