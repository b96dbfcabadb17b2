// half of a rigid punch with a sharp corner on a block: cells of both grow by q from the corner on
If(!Exists(n)) n = 10; EndIf
If(!Exists(q)) q = 1.6; EndIf
Point(1) = {0, 0, 0}; Point(2) = {0.3, 0, 0}; Point(3) = {1, 0, 0};
Point(4) = {1, 1, 0}; Point(5) = {0.3, 1, 0}; Point(6) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};
Transfinite Curve{1, -5} = n + 1 Using Progression 1/q;
Transfinite Curve{2, -4} = n + 1 Using Progression q;
Transfinite Curve{3, 7, -6} = n + 1 Using Progression 1/q;
Transfinite Surface{1, 2}; Recombine Surface{1, 2};
Point(11) = {0, 1, 0}; Point(12) = {0.3, 1, 0}; Point(13) = {0.3, 1.4, 0}; Point(14) = {0, 1.4, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};
Transfinite Curve{11 : 14} = 2; Transfinite Surface{3}; Recombine Surface{3};
Physical Surface("block") = {1, 2}; Physical Surface("punch") = {3};
Physical Curve("base") = {1, 2}; Physical Curve("left") = {6}; Physical Curve("top") = {4, 5}; Physical Curve("hull") = {11, 12};
