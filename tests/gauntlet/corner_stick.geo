// A block in the corner of a floor and a wall; n: cells along its edges
DefineConstant[ n = 4 ];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 0.6, 0}; Point(4) = {0, 0.6, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 2 * n + 1; Transfinite Curve {2, 4} = n + 1; Transfinite Surface {1};
Point(11) = {-0.3, -0.3, 0}; Point(12) = {1.3, -0.3, 0}; Point(13) = {1.3, 0, 0}; Point(14) = {-0.3, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Point(21) = {-0.3, 0, 0}; Point(22) = {0, 0, 0}; Point(23) = {0, 1, 0}; Point(24) = {-0.3, 1, 0};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(21) = {21:24}; Plane Surface(21) = {21};
Transfinite Curve {11, 13} = 4; Transfinite Curve {12, 14} = 2; Transfinite Surface {11}; Transfinite Curve {21, 23} = 2; Transfinite Curve {22, 24} = 3; Transfinite Surface {21};
Recombine Surface {1, 11, 21};
Physical Surface("block") = {1}; Physical Surface("floor") = {11}; Physical Surface("wall") = {21};
Physical Curve("under") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4}; Physical Curve("ground") = {13}; Physical Curve("face") = {22};
