// A hairpin (legs 0.2 thick, gap 0.2, length 1.2) between two plates; s: size of cells
DefineConstant[ s = 0.06 ];
Point(1) = {0, 0, 0};
Point(2) = {0, 0.3, 0, s}; Point(3) = {0, 0.1, 0, s}; Point(4) = {-0.3, 0, 0, s}; Point(5) = {-0.1, 0, 0, s}; Point(6) = {0, -0.3, 0, s}; Point(7) = {0, -0.1, 0, s};
Point(8) = {1.2, 0.3, 0, s}; Point(9) = {1.2, 0.1, 0, s}; Point(10) = {1.2, -0.3, 0, s}; Point(11) = {1.2, -0.1, 0, s};
Circle(1) = {2, 1, 4}; Circle(2) = {4, 1, 6}; Line(3) = {6, 10}; Line(4) = {10, 11}; Line(5) = {11, 7}; Circle(6) = {7, 1, 5}; Circle(7) = {5, 1, 3}; Line(8) = {3, 9}; Line(9) = {9, 8}; Line(10) = {8, 2};
Curve Loop(1) = {1:10}; Plane Surface(1) = {1};
Recombine Surface {1};
Physical Surface("pin") = {1}; Physical Curve("inside") = {5:8}; Physical Curve("top") = {10}; Physical Curve("foot") = {3};
