// A fin of k*8 cells (width 0.15, height 1.5) below a rigid plate
DefineConstant[ k = 1 ];
Point(1) = {0, 0, 0}; Point(2) = {0.15, 0, 0}; Point(3) = {0.15, 1.5, 0}; Point(4) = {0, 1.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = Round(k) + 1; Transfinite Curve {2, 4} = Round(8 * k) + 1; Transfinite Surface {1};
Point(11) = {-1, 1.5, 0}; Point(12) = {2.2, 1.5, 0}; Point(13) = {2.2, 1.7, 0}; Point(14) = {-1, 1.7, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11:14} = 2; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("fin") = {1}; Physical Surface("plate") = {2};
Physical Curve("root") = {1}; Physical Curve("skin") = {2:4}; Physical Curve("face") = {11};
