// Rubber bush between a steel core [0,2] and a steel sleeve, a strip of each: core x = 0..2, rubber x = 2..6, sleeve x = 6..7; height 6, cells shared.
DefineConstant[ n = 6 ];
Point(1) = {0, 0, 0};  Point(2) = {2, 0, 0};  Point(3) = {6, 0, 0};  Point(4) = {7, 0, 0};
Point(5) = {0, 6, 0};  Point(6) = {2, 6, 0};  Point(7) = {6, 6, 0};  Point(8) = {7, 6, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {5, 6};  Line(5) = {6, 7};  Line(6) = {7, 8};
Line(7) = {1, 5};  Line(8) = {2, 6};  Line(9) = {3, 7};  Line(10) = {4, 8};
Curve Loop(1) = {1, 8, -4, -7};   Plane Surface(1) = {1};
Curve Loop(2) = {2, 9, -5, -8};   Plane Surface(2) = {2};
Curve Loop(3) = {3, 10, -6, -9};  Plane Surface(3) = {3};
Transfinite Curve {1, 4} = n + 1;  Transfinite Curve {2, 5} = 2 * n + 1;  Transfinite Curve {3, 6} = n / 2 + 1;
Transfinite Curve {7:10} = 4 * n + 1;
Transfinite Surface {1:3};
Recombine Surface {1:3};
Physical Surface("core")   = {1};
Physical Surface("rubber") = {2};
Physical Surface("sleeve") = {3};
Physical Curve("inside")   = {7};
Physical Curve("outside")  = {10};
