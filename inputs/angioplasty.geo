// Quarter of three rings that do not touch: balloon, sleeve, artery of two layers; radii in mm. Divisions around do not match.
DefineConstant[ n = 12 ]; // cells along the quarter of the balloon; the sleeve has 3 n / 2, the artery 5 n / 4
Point(1) = {0, 0, 0};
Macro Ring
  Point(p + 1) = {r, 0, 0};  Point(p + 2) = {s, 0, 0};  Point(p + 3) = {0, s, 0};  Point(p + 4) = {0, r, 0};
  Line(p + 1) = {p + 1, p + 2};  Circle(p + 2) = {p + 2, 1, p + 3};  Line(p + 3) = {p + 3, p + 4};  Circle(p + 4) = {p + 4, 1, p + 1};
  Curve Loop(p) = {(p + 1):(p + 4)};  Plane Surface(p) = {p};
  Transfinite Curve {p + 1, p + 3} = 3;
  Transfinite Curve {p + 2, p + 4} = k + 1;
  Transfinite Surface {p};
  Recombine Surface {p};
Return
p = 10;  r = 0.4;   s = 0.5;   k = n;          Call Ring;
p = 20;  r = 0.55;  s = 0.65;  k = 3 * n / 2;  Call Ring;
// two layers share the circle between them
Point(31) = {0.71, 0, 0};  Point(32) = {0.97, 0, 0};  Point(33) = {1.1, 0, 0};
Point(34) = {0, 1.1, 0};   Point(35) = {0, 0.97, 0};  Point(36) = {0, 0.71, 0};
Line(31) = {31, 32};  Line(32) = {32, 33};  Line(34) = {34, 35};  Line(35) = {35, 36};
Circle(33) = {33, 1, 34};  Circle(36) = {36, 1, 31};  Circle(37) = {32, 1, 35};
Curve Loop(30) = {31, 37, 35, 36};   Plane Surface(30) = {30};
Curve Loop(31) = {32, 33, 34, -37};  Plane Surface(31) = {31};
Transfinite Curve {31, 32, 34, 35} = 3;
Transfinite Curve {33, 36, 37} = 5 * n / 4 + 1;
Transfinite Surface {30, 31};
Recombine Surface {30, 31};
Physical Surface("balloon")    = {10};
Physical Surface("sleeve")     = {20};
Physical Surface("media")      = {30};
Physical Surface("adventitia") = {31};
Physical Curve("bore")         = {14};
Physical Curve("balloon_skin") = {12};
Physical Curve("sleeve_bore")  = {24};
Physical Curve("sleeve_skin")  = {22};
Physical Curve("artery_bore")  = {36};
Physical Curve("plane_y")      = {11, 21, 31, 32};
Physical Curve("plane_x")      = {13, 23, 34, 35};
