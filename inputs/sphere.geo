// Axisymmetric: rubber cylinder [0,5] x [-5,0] under a rigid sphere of radius 1 whose lowest point touches the origin.
DefineConstant[ n = 10 ]; // cells along the radius and the height of the rubber
Point(1) = {0, -5, 0};  Point(2) = {5, -5, 0};  Point(3) = {5, 0, 0};  Point(4) = {0, 0, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Point(11) = {0, 1, 0};  Point(12) = {0, 0, 0};  Point(13) = {1, 1, 0};  Point(14) = {0, 0.5, 0};  Point(15) = {0.5, 1, 0};
Circle(11) = {12, 11, 13};  Line(12) = {13, 15};  Circle(13) = {15, 11, 14};  Line(14) = {14, 12};
Curve Loop(2) = {11, 12, 13, 14};  Plane Surface(2) = {2};
Transfinite Curve {1, 2, 3, 4} = n + 1;
Transfinite Curve {11, 13} = 4 * n + 1;
Transfinite Curve {12, 14} = 2;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
Physical Surface("rubber") = {1};
Physical Surface("sphere") = {2};
Physical Curve("bottom") = {1};
Physical Curve("surface") = {3};
Physical Curve("axis") = {4};
Physical Curve("ball") = {11};
