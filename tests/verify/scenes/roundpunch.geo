// Axisymmetric: punch of radius 50 and height 100, edge rounded by a radius of 10, on a foundation of radius 100 and height 200.
DefineConstant[
  n = 2, // cells along the flat of the punch, in quarters
  m = 5  // cells along the foundation's radius
];
s = 10 * Sqrt(0.5);
Point(1) = {0, 0, 0};    Point(2) = {40, 0, 0};   Point(3) = {40, 10, 0};  Point(4) = {40 + s, 10 - s, 0};
Point(5) = {50, 10, 0};  Point(6) = {50, 100, 0}; Point(7) = {32, 100, 0}; Point(8) = {0, 100, 0};
Point(9) = {0, 25, 0};   Point(10) = {32, 25, 0};
Line(1) = {1, 2};  Circle(2) = {2, 3, 4};  Circle(3) = {4, 3, 5};  Line(4) = {5, 6};  Line(5) = {6, 7};  Line(6) = {7, 8};
Line(7) = {8, 9};  Line(8) = {9, 1};       Line(9) = {9, 10};      Line(10) = {10, 4};  Line(11) = {10, 7};
Curve Loop(1) = {1, 2, -10, -9, 8};   Plane Surface(1) = {1};
Curve Loop(2) = {3, 4, 5, -11, 10};   Plane Surface(2) = {2};
Curve Loop(3) = {9, 11, 6, 7};        Plane Surface(3) = {3};
Transfinite Curve {1} = 4 * n + 1;
Transfinite Curve {2, 3} = n + 1;
Transfinite Curve {6, 9} = 5 * n + 1;
Transfinite Curve {4, 7} = 6 * n + 1;
Transfinite Curve {11} = 7 * n + 1;
Transfinite Curve {7} = 7 * n + 1;
Transfinite Curve {5, 8, 10} = 2 * n + 1;
Transfinite Surface {1} = {1, 4, 10, 9};
Transfinite Surface {2} = {4, 6, 7, 10};
Transfinite Surface {3};
Point(21) = {0, -200, 0};  Point(22) = {100, -200, 0};  Point(23) = {100, 0, 0};  Point(24) = {0, 0, 0};
Line(21) = {21, 22};  Line(22) = {22, 23};  Line(23) = {23, 24};  Line(24) = {24, 21};
Curve Loop(4) = {21, 22, 23, 24};  Plane Surface(4) = {4};
Transfinite Curve {21, 23} = m + 1;
Transfinite Curve {22, 24} = 2 * m + 1;
Transfinite Surface {4};
Recombine Surface {1:4};
Physical Surface("punch") = {1:3};
Physical Surface("foundation") = {4};
Physical Curve("foot")   = {1:3};
Physical Curve("head")   = {5, 6};
Physical Curve("axis")   = {7, 8, 24};
Physical Curve("top")    = {23};
Physical Curve("bottom") = {21};
