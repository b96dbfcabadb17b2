// Lower half of a wheel of radius 1, axle along y at z = 1, a hair above a block [-1,1] x [0,l] x [-1,0].
DefineConstant[ n = 16, k = 1, l = 3 ]; // cells across the block and, half as many, around the wheel; along y; length
e = 1e-4;
s = Sqrt(0.5);
Point(1) = {0, 0, 1 + e};
Point(2) = {-1, 0, 1 + e};  Point(3) = {-s, 0, 1 + e - s};  Point(4) = {s, 0, 1 + e - s};  Point(5) = {1, 0, 1 + e};
Circle(1) = {2, 1, 3};  Circle(2) = {3, 1, 4};  Circle(3) = {4, 1, 5};  Line(4) = {5, 2};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Point(11) = {-1, 0, -1};  Point(12) = {1, 0, -1};  Point(13) = {1, 0, 0};  Point(14) = {-1, 0, 0};
Line(11) = {11, 12};  Line(12) = {12, 13};  Line(13) = {13, 14};  Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14};  Plane Surface(2) = {2};
Transfinite Curve {1, 3} = n / 4 + 1;
Transfinite Curve {2, 4} = n / 2 + 1;
Transfinite Curve {11, 13} = n + 1;
Transfinite Curve {12, 14} = n / 2 + 1;
Transfinite Surface {1} = {2, 3, 4, 5};
Transfinite Surface {2};
Recombine Surface {1, 2};
w[] = Extrude {0, l, 0} { Surface{1}; Layers{k}; Recombine; };
b[] = Extrude {0, l, 0} { Surface{2}; Layers{k}; Recombine; };
Physical Volume("wheel") = {w[1]};
Physical Volume("block") = {b[1]};
Physical Surface("tread")  = {w[2], w[3], w[4]};
Physical Surface("road")   = {b[4]};
Physical Surface("bottom") = {b[2]};
Physical Surface("ends")   = {2, b[0]};
