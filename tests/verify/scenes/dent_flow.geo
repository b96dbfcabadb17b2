// A rigid wedge with a round edge (radius 0.1, its face 27 degrees from the top) over the right half of a block of 10k by 6k cells
DefineConstant[ k = 1 ];
Point(1) = {0, -1, 0}; Point(2) = {2, -1, 0}; Point(3) = {2, 0, 0}; Point(4) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 10 * k + 1; Transfinite Curve {2, 4} = 6 * k + 1; Transfinite Surface {1};
a = Atan(0.5);
Point(10) = {0, 0, 0}; Point(11) = {0, 0.1, 0}; Point(12) = {0.1 * Sin(a), 0.1 - 0.1 * Cos(a), 0}; Point(13) = {0, 1, 0}; Point(14) = {0.1 * Sin(a), 1, 0};
Point(15) = {1.2, 0.1 - 0.1 * Cos(a) + 0.5 * (1.2 - 0.1 * Sin(a)), 0}; Point(16) = {1.2, 1, 0};
Circle(10) = {10, 11, 12}; Line(11) = {12, 14}; Line(12) = {14, 13}; Line(13) = {13, 10}; Line(14) = {12, 15}; Line(15) = {15, 16}; Line(16) = {16, 14};
Curve Loop(2) = {10:13}; Plane Surface(2) = {2}; Curve Loop(3) = {14, 15, 16, -11}; Plane Surface(3) = {3};
Transfinite Curve {10, 11, 12, 13, 15} = 2; Transfinite Curve {14, 16} = 5; Transfinite Surface {2, 3}; Recombine Surface {1:3};
Physical Surface("block") = {1}; Physical Surface("wedge") = {2, 3};
Physical Curve("base") = {1}; Physical Curve("top") = {3}; Physical Curve("cut") = {4}; Physical Curve("face") = {10, 14};
