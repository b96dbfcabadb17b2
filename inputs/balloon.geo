// Half of a thick spherical shell, meridian in the plane r = x, z = y: a quarter ring.
DefineConstant[
  a = 1, // inner radius
  b = 2, // outer radius
  n = 8, // cells along the meridian
  m = 8  // through the wall
];
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0};
Point(3) = {b, 0, 0};
Point(4) = {0, b, 0};
Point(5) = {0, a, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = m + 1;
Transfinite Curve {2, 4} = n + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("wall") = {1};
Physical Curve("plane") = {1};
Physical Curve("outer") = {2};
Physical Curve("axis") = {3};
Physical Curve("inner") = {4};
