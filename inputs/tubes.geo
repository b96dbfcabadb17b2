// Two tubes that cross at a right angle and touch at the origin: the upper along x, the lower along z; a quarter of each (x > 0, z > 0).
// Radii ro (outside) and ri, half length l. A third of the length, next to the crossing, has half of the cells.
DefineConstant[
  n = 8,  // cells along a quarter of the circumference
  m = 2,  // across the wall
  k = 12, // along the half length
  l = 4   // half length
];
ro = 1;
ri = 0.8;
// upper tube: section in the plane x = 0, axis at (y, z) = (ro, 0); half circle z > 0, lowest point at the origin
Point(1) = {0, ro, 0};
Point(2) = {0, 0, 0};
Point(3) = {0, ro, ro};
Point(4) = {0, 2 * ro, 0};
Point(5) = {0, ro - ri, 0};
Point(6) = {0, ro, ri};
Point(7) = {0, ro + ri, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {5, 1, 6};
Circle(4) = {6, 1, 7};
Line(5) = {2, 5};
Line(6) = {3, 6};
Line(7) = {4, 7};
Curve Loop(1) = {1, 6, -3, -5}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -4, -6}; Plane Surface(2) = {2};
// lower tube: section in the plane z = 0, axis at (x, y) = (0, -ro); a hair below, so that gmsh joins no points
e = 1e-6;
Point(11) = {0, -ro - e, 0};
Point(12) = {0, -e, 0};
Point(13) = {ro, -ro - e, 0};
Point(14) = {0, -2 * ro - e, 0};
Point(15) = {0, -ro + ri - e, 0};
Point(16) = {ri, -ro - e, 0};
Point(17) = {0, -ro - ri - e, 0};
Circle(11) = {12, 11, 13};
Circle(12) = {13, 11, 14};
Circle(13) = {15, 11, 16};
Circle(14) = {16, 11, 17};
Line(15) = {12, 15};
Line(16) = {13, 16};
Line(17) = {14, 17};
Curve Loop(11) = {11, 16, -13, -15}; Plane Surface(11) = {11};
Curve Loop(12) = {12, 17, -14, -16}; Plane Surface(12) = {12};
Transfinite Curve {1, 3, 11, 13} = n + 1;
Transfinite Curve {2, 4, 12, 14} = n / 2 + 1;
Transfinite Curve {5:7, 15:17} = m + 1;
Transfinite Surface {1, 2, 11, 12};
Recombine Surface {1, 2, 11, 12};
a[] = Extrude {l / 3, 0, 0} { Surface{1, 2}; Layers{k / 2}; Recombine; };
b[] = Extrude {2 * l / 3, 0, 0} { Surface{a[0], a[6]}; Layers{k / 2}; Recombine; };
c[] = Extrude {0, 0, l / 3} { Surface{11, 12}; Layers{k / 2}; Recombine; };
d[] = Extrude {0, 0, 2 * l / 3} { Surface{c[0], c[6]}; Layers{k / 2}; Recombine; };
Physical Volume("upper")         = {a[1], a[7], b[1], b[7]};
Physical Volume("lower")         = {c[1], c[7], d[1], d[7]};
Physical Surface("upper_skin")   = {a[2]};       // the half of it that faces the other tube
Physical Surface("lower_skin")   = {c[2]};
Physical Surface("upper_end")    = {b[0], b[6]};
Physical Surface("lower_end")    = {d[0], d[6]};
Physical Surface("upper_x")      = {1, 2};                       // planes of symmetry
Physical Surface("upper_z")      = {a[5], a[9], b[5], b[9]};
Physical Surface("lower_z")      = {11, 12};
Physical Surface("lower_x")      = {c[5], c[9], d[5], d[9]};
