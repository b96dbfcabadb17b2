// L-shape turned by 45 degrees: three squares of side sqrt(2) around the re-entrant corner at the origin.
DefineConstant[
  n = 2 // cells along a side of a square
];
Point(1) = {0, 0, 0};
Point(2) = {-1, -1, 0};
Point(3) = {0, -2, 0};
Point(4) = {1, -1, 0};
Point(5) = {2, 0, 0};
Point(6) = {1, 1, 0};
Point(7) = {0, 2, 0};
Point(8) = {-1, 1, 0};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 1};
Line(9) = {1, 4};
Line(10) = {1, 6};

Curve Loop(1) = {1, 2, 3, -9};   Plane Surface(1) = {1};
Curve Loop(2) = {9, 4, 5, -10};  Plane Surface(2) = {2};
Curve Loop(3) = {10, 6, 7, 8};   Plane Surface(3) = {3};
Transfinite Curve {1:10} = n + 1;
Transfinite Surface {1:3};
Recombine Surface {1:3};

Physical Surface("plate") = {1:3};
Physical Curve("outer")   = {2:7};
