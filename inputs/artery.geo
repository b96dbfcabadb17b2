// Quarter of a tube of two layers around the z axis, with symmetry planes x = 0 and y = 0; radii of a carotid artery in mm.
DefineConstant[
  n = 6,  // cells along the quarter
  m = 2,  // cells through each layer
  l = 1   // cells along the axis
];
r0 = 0.71;
r1 = 0.97;
r2 = 1.1;
length = 0.4;
Point(1) = {0, 0, 0};
Point(2) = {r0, 0, 0};  Point(3) = {r1, 0, 0};  Point(4) = {r2, 0, 0};
Point(5) = {0, r0, 0};  Point(6) = {0, r1, 0};  Point(7) = {0, r2, 0};
Line(1) = {2, 3};  Line(2) = {3, 4};  Line(3) = {5, 6};  Line(4) = {6, 7};
Circle(5) = {2, 1, 5};  Circle(6) = {3, 1, 6};  Circle(7) = {4, 1, 7};
Curve Loop(1) = {1, 6, -3, -5};  Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -4, -6};  Plane Surface(2) = {2};
Transfinite Curve {1, 2, 3, 4} = m + 1;
Transfinite Curve {5, 6, 7} = n + 1;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
a[] = Extrude {0, 0, length} { Surface{1, 2}; Layers{l}; Recombine; };
Physical Volume("media")       = {a[1]};
Physical Volume("adventitia")  = {a[7]};
Physical Surface("near_end")   = {1, 2};
Physical Surface("far_end")    = {a[0], a[6]};
Physical Surface("plane_y")    = {a[2], a[8]};
Physical Surface("plane_x")    = {a[4], a[10]};
Physical Surface("bore")       = {a[5]};
Physical Surface("outside")    = {a[9]};
