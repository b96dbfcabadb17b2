// A block (2 w wide, h high) with a V-notch from above, half angle atan(b / d), and a rigid plate that does not reach it.
DefineConstant[ w = 1, h = 1, b = 0.15, d = 0.5, n = 5, m = 4 ];
Point(1) = {-w, 0, 0}; Point(2) = {0, 0, 0}; Point(3) = {w, 0, 0}; Point(4) = {w, h, 0}; Point(5) = {b, h, 0}; Point(6) = {0, h - d, 0}; Point(7) = {-b, h, 0}; Point(8) = {-w, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 6}; Line(3) = {6, 7}; Line(4) = {7, 8}; Line(5) = {8, 1}; Curve Loop(1) = {1, 2, 3, 4, 5};
Line(6) = {2, 3}; Line(7) = {3, 4}; Line(8) = {4, 5}; Line(9) = {5, 6}; Curve Loop(2) = {6, 7, 8, 9, -2};
Plane Surface(1) = {1}; Plane Surface(2) = {2};
Transfinite Curve {1, 4, 6, 8, 3, 9, 2} = n + 1; Transfinite Curve {5, 7} = 2 * m + 1; Recombine Surface {1, 2};
Physical Surface("block") = {1, 2}; Physical Curve("bottom") = {1, 6}; Physical Curve("left") = {5}; Physical Curve("right") = {7}; Physical Curve("flanks") = {3, 9};
