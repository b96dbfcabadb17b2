// The L-shape of lshape.geo in two parts: two squares, and one of its own mesh that ends at the line from the re-entrant corner.
DefineConstant[
  n = 2, // cells along a side of the two squares
  m = 3  // along a side of the other
];
Point(1) = {0, 0, 0};
Point(2) = {-1, -1, 0};
Point(3) = {0, -2, 0};
Point(4) = {1, -1, 0};
Point(5) = {2, 0, 0};
Point(6) = {1, 1, 0};
Point(11) = {0, 0, 0};
Point(16) = {1, 1, 0};
Point(17) = {0, 2, 0};
Point(18) = {-1, 1, 0};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(9) = {1, 4};
Line(10) = {1, 6};
Line(16) = {16, 17};
Line(17) = {17, 18};
Line(18) = {18, 11};
Line(20) = {11, 16};

Curve Loop(1) = {1, 2, 3, -9};       Plane Surface(1) = {1};
Curve Loop(2) = {9, 4, 5, -10};      Plane Surface(2) = {2};
Curve Loop(3) = {20, 16, 17, 18};    Plane Surface(3) = {3};
Transfinite Curve {1:5, 9, 10} = n + 1;
Transfinite Curve {16, 17, 18, 20} = m + 1;
Transfinite Surface {1:3};
Recombine Surface {1:3};

Physical Surface("plate") = {1, 2};
Physical Surface("arm")   = {3};
Physical Curve("outer")   = {2:5, 16, 17};
Physical Curve("plate_side") = {10};
Physical Curve("arm_side")   = {20};
