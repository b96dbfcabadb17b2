// Half of a half-cylinder (radius 50, axis at x = 0, flat top at y = 50) on half of a block [0,100] x [-200,0]. Quadrilaterals only.
DefineConstant[
  n = 6, // cells along an eighth of the circle
  m = 8  // cells along the block's half width
];
r = 50;
s = r * Sqrt(0.5);
Point(1) = {0, r, 0};
Point(2) = {0, 0, 0};
Point(3) = {s, r - s, 0};
Point(4) = {r, r, 0};
Point(5) = {0, 0.5 * r, 0};
Point(6) = {0.4 * r, 0.6 * r, 0};
Point(7) = {0.5 * r, r, 0};
Circle(1) = {2, 1, 3};  Circle(2) = {3, 1, 4};
Line(3) = {5, 6};  Line(4) = {6, 7};  Line(5) = {2, 5};  Line(6) = {3, 6};  Line(7) = {4, 7};
Line(8) = {5, 1};  Line(9) = {1, 7};
Curve Loop(1) = {1, 6, -3, -5};  Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -4, -6};  Plane Surface(2) = {2};
Curve Loop(3) = {3, 4, -9, -8};  Plane Surface(3) = {3};
Point(21) = {0, -200, 0};  Point(22) = {100, -200, 0};  Point(23) = {100, 0, 0};  Point(24) = {0, 0, 0};
Line(21) = {21, 22};  Line(22) = {22, 23};  Line(23) = {23, 24};  Line(24) = {24, 21};
Curve Loop(4) = {21, 22, 23, 24};  Plane Surface(4) = {4};
Transfinite Curve {1:9} = n + 1;
Transfinite Curve {21, 23} = m + 1;
Transfinite Curve {22, 24} = 2 * m + 1;
Transfinite Surface {1:4};
Recombine Surface {1:4};
Physical Surface("cylinder") = {1:3};
Physical Surface("block")    = {4};
Physical Curve("arc")       = {1, 2};
Physical Curve("flat")      = {7, 9};
Physical Curve("block_top") = {23};
Physical Curve("bottom")    = {21};
Physical Curve("axis")      = {5, 8, 24};
