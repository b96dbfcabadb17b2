// A block [0, 2] x [-1, 0] of n cells along it and a plate whose end lies d beyond a node
DefineConstant[ n = 20, d = 0.0003 ];
Point(1) = {0, -1, 0}; Point(2) = {2, -1, 0}; Point(3) = {2, 0, 0}; Point(4) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = n / 2 + 1; Transfinite Surface {1};
Point(11) = {-0.2, 0.002, 0}; Point(12) = {1 + d, 0.002, 0}; Point(13) = {1 + d, 0.3, 0}; Point(14) = {-0.2, 0.3, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11, 13} = 4; Transfinite Curve {12, 14} = 2; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("block") = {1}; Physical Surface("plate") = {2};
Physical Curve("top") = {3}; Physical Curve("foot") = {1}; Physical Curve("left") = {4}; Physical Curve("under") = {11, 12};
