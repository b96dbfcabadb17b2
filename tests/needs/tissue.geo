// A strip of tissue [0,20] x [0,5], cells of equal size; mesh.refine makes it finer than it has to be.
DefineConstant[ n = 4 ];
Point(1) = {0, 0, 0};  Point(2) = {20, 0, 0};  Point(3) = {20, 5, 0};  Point(4) = {0, 5, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 4 * n + 1;
Transfinite Curve {2, 4} = n + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("strip") = {1};
Physical Curve("left")   = {4};
Physical Curve("right")  = {2};
Physical Curve("bottom") = {1};
Physical Curve("top")    = {3};
