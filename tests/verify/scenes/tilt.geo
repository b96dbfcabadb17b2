// A block on a floor; n, m cells along either
DefineConstant[ n = 5, m = 8 ];
Point(1) = {-1, -0.4, 0}; Point(2) = {1, -0.4, 0}; Point(3) = {1, 0, 0}; Point(4) = {-1, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = m + 1; Transfinite Curve {2, 4} = 3; Transfinite Surface {1};
Point(11) = {-0.43, 0, 0}; Point(12) = {0.43, 0, 0}; Point(13) = {0.43, 0.3, 0}; Point(14) = {-0.43, 0.3, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {11, 13} = n + 1; Transfinite Curve {12, 14} = 3; Transfinite Surface {11}; Recombine Surface {1, 11};
Physical Surface("floor") = {1}; Physical Surface("block") = {11};
Physical Curve("bottom") = {1}; Physical Curve("top") = {3}; Physical Curve("under") = {11};
