// Half of a sheet under a rigid roll, y = 0 the plane of symmetry; s: size of cells
DefineConstant[ s = 0.06 ];
Point(1) = {0, 0.7, 0}; Point(2) = {0.5, 0.7, 0, s}; Point(3) = {0, 1.2, 0, 2 * s}; Point(4) = {-0.5, 0.7, 0, s}; Point(5) = {0, 0.2, 0, s};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(21) = {-1.5, 0, 0, s}; Point(22) = {1, 0, 0, s}; Point(23) = {1, 0.2, 0, s}; Point(24) = {-1.5, 0.2, 0, s};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Recombine Surface {1, 3};
Physical Surface("roll") = {1}; Physical Surface("sheet") = {3};
Physical Curve("rim") = {1:4}; Physical Curve("over") = {23}; Physical Curve("middle") = {21}; Physical Curve("back") = {24};
