// A block in the corner of a tray whose floor and wall are one boundary; n: cells along its edges
DefineConstant[ n = 4 ];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 0.6, 0}; Point(4) = {0, 0.6, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 2 * n + 1; Transfinite Curve {2, 4} = n + 1; Transfinite Surface {1};
Point(11) = {-0.3, -0.3, 0}; Point(12) = {1.3, -0.3, 0}; Point(13) = {1.3, 0, 0}; Point(14) = {0, 0, 0};Point(23) = {0, 1, 0}; Point(24) = {-0.3, 1, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 23}; Line(15) = {23, 24}; Line(16) = {24, 11};
Line(17) = {11, 14};
Curve Loop(11) = {11:13, -17}; Plane Surface(11) = {11};
Curve Loop(12) = {17, 14:16}; Plane Surface(12) = {12};
Transfinite Curve {11, 13} = 4; Transfinite Curve {12, 17, 15} = 2; Transfinite Surface {11}; Transfinite Curve {14, 16} = 3; Transfinite Surface {12};
Recombine Surface {1, 11, 12};
Physical Surface("block") = {1}; Physical Surface("tray") = {11, 12};
Physical Curve("skin") = {1, 4}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("walls") = {13, 14}; Physical Curve("base") = {11};
