// Two tubes one in the other, quarter: radii 5 to 10 and 10 to 20, symmetry planes x = 0 and y = 0.
DefineConstant[
  n = 6,       // cells along the quarter of the inner tube
  ratio = 1.5, // of cells along the outer one to these
  m = 4        // cells through each wall
];
k = Ceil(ratio * n);
Point(1) = {0, 0, 0};
Point(2) = {5, 0, 0};    Point(3) = {10, 0, 0};  Point(4) = {0, 10, 0};  Point(5) = {0, 5, 0};
Point(12) = {10, 0, 0};  Point(13) = {20, 0, 0}; Point(14) = {0, 20, 0}; Point(15) = {0, 10, 0};
Line(1) = {2, 3};    Circle(2) = {3, 1, 4};    Line(3) = {4, 5};    Circle(4) = {5, 1, 2};
Line(11) = {12, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 15}; Circle(14) = {15, 1, 12};
Curve Loop(1) = {1, 2, 3, 4};      Plane Surface(1) = {1};
Curve Loop(2) = {11, 12, 13, 14};  Plane Surface(2) = {2};
Transfinite Curve {1, 3, 11, 13} = m + 1;
Transfinite Curve {2, 4} = n + 1;
Transfinite Curve {12, 14} = k + 1;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
Physical Surface("inner") = {1};
Physical Surface("outer") = {2};
Physical Curve("bore")        = {4};
Physical Curve("inner_shell") = {2};
Physical Curve("outer_bore")  = {14};
Physical Curve("shell")       = {12};
Physical Curve("plane_y")     = {1, 11};
Physical Curve("plane_x")     = {3, 13};
