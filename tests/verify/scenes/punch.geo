// Axisymmetric: block [0,w] x [-w,0] under a rigid flat punch of radius 1.
DefineConstant[ n = 10, w = 20 ];
Point(1) = {0, -w, 0};  Point(2) = {w, -w, 0};  Point(3) = {w, 0, 0};  Point(4) = {0, 0, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Point(11) = {0, 0, 0};  Point(12) = {1, 0, 0};  Point(13) = {1, 1, 0};  Point(14) = {0, 1, 0};
Line(11) = {11, 12};  Line(12) = {12, 13};  Line(13) = {13, 14};  Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14};  Plane Surface(2) = {2};
Transfinite Curve {1:4} = n + 1;
Transfinite Curve {11:14} = 2;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
Physical Surface("block") = {1};
Physical Surface("punch") = {2};
Physical Curve("surface") = {3};
Physical Curve("far") = {1, 2};
Physical Curve("axis") = {4};
Physical Curve("foot") = {11};
