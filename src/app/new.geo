// A punch with a round end above a block, for gmsh: "gmsh @NAME@.geo" shows it. The block is w wide and h high, its top at
// y = 0; the punch is 2a wide and b high, and its end, an arc of radius r, touches the block at the origin.
DefineConstant[
  n = 4,   // cells along half of the arc; from a scene: mesh: {parameter: {n: 8}}
  w = 2,
  h = 1,
  a = 0.5,
  b = 0.6,
  r = 0.8
];
c = r - Sqrt(r * r - a * a); // height of the ends of the arc

// block
Point(1) = {-w / 2, -h, 0};
Point(2) = {w / 2, -h, 0};
Point(3) = {w / 2, 0, 0};
Point(4) = {-w / 2, 0, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

// punch: 10 is the centre of the arc
Point(10) = {0, r, 0};
Point(11) = {-a, c, 0};
Point(12) = {0, 0, 0};
Point(13) = {a, c, 0};
Point(14) = {a, b, 0};
Point(15) = {0, b, 0};
Point(16) = {-a, b, 0};
Circle(11) = {11, 10, 12};
Circle(12) = {12, 10, 13};
Line(13) = {13, 14};
Line(14) = {14, 15};
Line(15) = {15, 16};
Line(16) = {16, 11};
Line(17) = {12, 15};
Curve Loop(2) = {11, 17, 15, 16};
Plane Surface(2) = {2};
Curve Loop(3) = {12, 13, 14, -17};
Plane Surface(3) = {3};

// quadrilaterals in rows: the program knows no triangles
Transfinite Curve {11, 12, 13, 14, 15, 16, 17} = n + 1;
Transfinite Curve {1, 3} = 4 * n + 1;
Transfinite Curve {2, 4} = 2 * n + 1;
Transfinite Surface {1:3};
Recombine Surface {1:3};

// groups: what the scene speaks of. Surfaces are bodies, curves are boundaries.
Physical Surface("block") = {1};
Physical Surface("punch") = {2, 3};
Physical Curve("bottom") = {1};
Physical Curve("block_top") = {3};
Physical Curve("punch_end") = {11, 12};
Physical Curve("punch_top") = {14, 15};
