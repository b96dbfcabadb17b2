// A beam [0,l] x [0,t].
DefineConstant[ n = 40, m = 2, l = 40, t = 1 ]; // cells along it and through it
Point(1) = {0, 0, 0};  Point(2) = {l, 0, 0};  Point(3) = {l, t, 0};  Point(4) = {0, t, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {2, 4} = m + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("beam") = {1};
Physical Curve("left")   = {4};
Physical Curve("right")  = {2};
Physical Curve("bottom") = {1};
Physical Curve("top")    = {3};
