// A thin strip on a floor; n: cells along the strip
DefineConstant[ n = 40, m = 2 ];
Point(1) = {-4, 0, 0}; Point(2) = {0, 0, 0}; Point(3) = {0, 0.1, 0}; Point(4) = {-4, 0.1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1}; Recombine Surface {1};
Point(11) = {-4.5, -0.2, 0}; Point(12) = {0.5, -0.2, 0}; Point(13) = {0.5, 0, 0}; Point(14) = {-4.5, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {11, 13} = 6; Transfinite Curve {12, 14} = 2; Transfinite Surface {11}; Recombine Surface {11};
Physical Surface("strip") = {1}; Physical Surface("floor") = {11};
Physical Curve("under") = {1}; Physical Curve("end") = {2}; Physical Curve("top") = {3}; Physical Curve("way") = {13};
