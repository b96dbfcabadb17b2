// Whole square plate [-10,10]^2 with a round hole of radius 3: symmetric about both axes.
DefineConstant[ n = 6, r = 3, a = 10 ]; // cells along an eighth of the hole
s = r * Sqrt(0.5);
Point(1) = {0, 0, 0};
Point(2) = {s, s, 0};  Point(3) = {-s, s, 0};  Point(4) = {-s, -s, 0};  Point(5) = {s, -s, 0};
Point(6) = {a, a, 0};  Point(7) = {-a, a, 0};  Point(8) = {-a, -a, 0};  Point(9) = {a, -a, 0};
Circle(1) = {2, 1, 3};  Circle(2) = {3, 1, 4};  Circle(3) = {4, 1, 5};  Circle(4) = {5, 1, 2};
Line(5) = {6, 7};  Line(6) = {7, 8};  Line(7) = {8, 9};  Line(8) = {9, 6};
Line(9) = {2, 6};  Line(10) = {3, 7};  Line(11) = {4, 8};  Line(12) = {5, 9};
Curve Loop(1) = {1, 10, -5, -9};   Plane Surface(1) = {1};
Curve Loop(2) = {2, 11, -6, -10};  Plane Surface(2) = {2};
Curve Loop(3) = {3, 12, -7, -11};  Plane Surface(3) = {3};
Curve Loop(4) = {4, 9, -8, -12};   Plane Surface(4) = {4};
Transfinite Curve {1:12} = 2 * n + 1;
Transfinite Surface {1:4};
Recombine Surface {1:4};
Physical Surface("plate") = {1:4};
Physical Curve("hole")   = {1:4};
Physical Curve("top")    = {5};
Physical Curve("bottom") = {7};
Physical Curve("left")   = {6};
Physical Curve("right")  = {8};
