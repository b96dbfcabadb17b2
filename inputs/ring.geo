// Quarter of a ring (centre (0, 0), radii ri and ro) on a plate below it; a slice of thickness d.
DefineConstant[
  n = 16, // cells along the quarter
  m = 3,  // across the wall
  d = 1,  // thickness
  nd = 1, // cells along it
  k = 1   // cells along the plate
];
ro = 6.35;
ri = 4.15;
Point(1) = {0, 0, 0};
Point(2) = {0, -ro, 0};
Point(3) = {ro, 0, 0};
Point(4) = {0, -ri, 0};
Point(5) = {ri, 0, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {4, 1, 5};
Line(3) = {2, 4};
Line(4) = {3, 5};
Curve Loop(1) = {1, 4, -2, -3}; Plane Surface(1) = {1};
// plate
// wider than the ring everywhere: it expands, and gmsh would join points that coincide
Point(11) = {-1, -ro, -d / 2};
Point(12) = {2 * ro, -ro, -d / 2};
Point(13) = {2 * ro, -ro - 1, -d / 2};
Point(14) = {-1, -ro - 1, -d / 2};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve {1, 2} = n + 1;
Transfinite Curve {3, 4} = m + 1;
Transfinite Curve {11, 13} = k + 1;
Transfinite Curve {12, 14} = 2;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
a[] = Extrude {0, 0, d} { Surface{1}; Layers{nd}; Recombine; };
b[] = Extrude {0, 0, 2 * d} { Surface{2}; Layers{1}; Recombine; };
Physical Volume("ring")         = {a[1]};
Physical Volume("plate")        = {b[1]};
Physical Surface("outside")     = {a[2]};
Physical Surface("middle")      = {a[3]};
Physical Surface("foot")        = {a[5]};
Physical Surface("back")        = {1};
Physical Surface("front")       = {a[0]};
Physical Surface("plate_top")   = {b[2]};
