// Half of a billet of radius 1 and height 2, below a die
DefineConstant[ n = 4, m = 5 ];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = n + 1; Transfinite Surface {1};
Point(11) = {0, 1, 0}; Point(12) = {2, 1, 0}; Point(13) = {2, 1.2, 0}; Point(14) = {0, 1.2, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {11, 13} = m + 1; Transfinite Curve {12, 14} = 2; Transfinite Surface {11}; Recombine Surface {1, 11};
Physical Surface("billet") = {1}; Physical Surface("die") = {11};
Physical Curve("axis") = {4}; Physical Curve("middle") = {1}; Physical Curve("side") = {2}; Physical Curve("top") = {3}; Physical Curve("face") = {11};
