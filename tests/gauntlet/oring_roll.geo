// A ring of rubber between a shaft and a bore, its axis x = 0; s: size of cells
DefineConstant[ s = 0.06 ];
Point(1) = {2, 0, 0}; Point(2) = {2.25, 0, 0, s}; Point(3) = {2, 0.25, 0, s}; Point(4) = {1.75, 0, 0, s}; Point(5) = {2, -0.25, 0, s};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {1.35, -1, 0, 3 * s}; Point(12) = {1.75, -1, 0, 3 * s}; Point(13) = {1.75, 1, 0, 3 * s}; Point(14) = {1.35, 1, 0, 3 * s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Point(21) = {2.25, -1, 0, 3 * s}; Point(22) = {2.65, -1, 0, 3 * s}; Point(23) = {2.65, 1, 0, 3 * s}; Point(24) = {2.25, 1, 0, 3 * s};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Recombine Surface {1:3};
Physical Surface("ring") = {1}; Physical Surface("shaft") = {2}; Physical Surface("bore") = {3};
Physical Curve("skin") = {1:4}; Physical Curve("hub") = {12}; Physical Curve("wall") = {24};
