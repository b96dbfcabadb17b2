// a quarter of a ring in a ring; n, m cells along the quarter
DefineConstant[ n = 5, m = 7, a = 1, b = 1.5, c = 2 ];
Point(1) = {0,0,0};
Point(2) = {a,0,0}; Point(3) = {b,0,0}; Point(4) = {0,b,0}; Point(5) = {0,a,0};
Line(1) = {2,3}; Circle(2) = {3,1,4}; Line(3) = {4,5}; Circle(4) = {5,1,2};
Point(12) = {b,0,0}; Point(13) = {c,0,0}; Point(14) = {0,c,0}; Point(15) = {0,b,0};
Line(11) = {12,13}; Circle(12) = {13,1,14}; Line(13) = {14,15}; Circle(14) = {15,1,12};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {2,4} = n+1; Transfinite Curve {1,3} = 3; Transfinite Curve {12,14} = m+1; Transfinite Curve {11,13} = 3;
Transfinite Surface {1}; Transfinite Surface {2}; Recombine Surface {1,2};
Physical Surface("inner") = {1}; Physical Surface("outer") = {2};
Physical Curve("sx") = {3,13}; Physical Curve("sy") = {1,11};
Physical Curve("bore") = {4}; Physical Curve("inner_face") = {2}; Physical Curve("outer_face") = {14}; Physical Curve("rim") = {12};
