// A bush, radii 8 to 10 + d, above a housing, radii 10 to 16, in the plane of radius x and axis y. The edges that meet are rounded (radius e).
// Triangles, which are turned into quadrilaterals: a cell cannot have a smooth boundary on both sides of a corner.
DefineConstant[
  d = 0.05,  // overlap
  e = 0.5,   // radius of the edges
  size = 1 // cells; half as large at the edges, three times outside
];
r = 10 + d;
Point(1) = {8, 0.1, 0};  Point(2) = {r - e, 0.1, 0};  Point(3) = {r, 0.1 + e, 0};  Point(4) = {r, 8, 0};  Point(5) = {8, 8, 0};
Point(6) = {r - e, 0.1 + e, 0};
Line(1) = {1, 2};  Circle(2) = {2, 6, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 1};
Curve Loop(1) = {1:5};  Plane Surface(1) = {1};
Point(11) = {10, -10, 0};  Point(12) = {16, -10, 0};  Point(13) = {16, 0, 0};  Point(14) = {10 + e, 0, 0};  Point(15) = {10, -e, 0};
Point(16) = {10 + e, -e, 0};
Line(11) = {11, 12};  Line(12) = {12, 13};  Line(13) = {13, 14};  Circle(14) = {14, 16, 15};  Line(15) = {15, 11};
Curve Loop(2) = {11:15};  Plane Surface(2) = {2};
MeshSize {:} = size;  MeshSize {2, 3, 14, 15} = size / 2;  MeshSize {12, 13} = 3 * size;
Physical Surface("bush") = {1};
Physical Surface("housing") = {2};
Physical Curve("pushed") = {4};
Physical Curve("outer") = {2, 3};
Physical Curve("bore") = {14, 15};
Physical Curve("base") = {11};
