// A fibre of radius a, of which the length 1 is in the matrix and 0.3 stands out; n, m cells along either
DefineConstant[ a = 0.2, n = 8, m = 5 ];
Point(1) = {0, 0, 0}; Point(2) = {a, 0, 0}; Point(3) = {a, 1.3, 0}; Point(4) = {0, 1.3, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 2; Transfinite Curve {2, 4} = n + 1; Transfinite Surface {1};
Point(11) = {a, 0, 0}; Point(12) = {1, 0, 0}; Point(13) = {1, 1, 0}; Point(14) = {a, 1, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {11, -13} = 5 Using Progression 1.4; Transfinite Curve {12, 14} = m + 1; Transfinite Surface {11};
Recombine Surface {1, 11};
Physical Surface("fibre") = {1}; Physical Surface("matrix") = {11};
Physical Curve("axis") = {4}; Physical Curve("side") = {2}; Physical Curve("head") = {3}; Physical Curve("bore") = {14}; Physical Curve("rim") = {12};
