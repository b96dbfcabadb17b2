// A belt over a quarter of a drum of radius 1 (centre at the origin), with straight ends that leave it at its top and at its right. Quadrilaterals only.
DefineConstant[
  t = 0.02, // thickness of the belt
  l = 0.3,  // length of its straight ends
  n = 16,   // cells along a quarter of the drum, of the belt; the drum has 1.25 times as many
  m = 1     // cells across the belt
];
r = 1; R = 1 + t; d = 0.9;
Point(1) = {0, 0, 0};
Point(2) = {-l, r, 0};  Point(3) = {0, r, 0};  Point(4) = {r, 0, 0};  Point(5) = {r, -l, 0};
Point(6) = {-l, R, 0};  Point(7) = {0, R, 0};  Point(8) = {R, 0, 0};  Point(9) = {R, -l, 0};
Line(1) = {2, 3};  Circle(2) = {3, 1, 4};  Line(3) = {4, 5};
Line(4) = {6, 7};  Circle(5) = {7, 1, 8};  Line(6) = {8, 9};
Line(7) = {2, 6};  Line(8) = {3, 7};  Line(9) = {4, 8};  Line(10) = {5, 9};
Curve Loop(1) = {1, 8, -4, -7};  Plane Surface(1) = {1};
Curve Loop(2) = {2, 9, -5, -8};  Plane Surface(2) = {2};
Curve Loop(3) = {3, 10, -6, -9};  Plane Surface(3) = {3};
// the drum goes on a little beyond both ends of the quarter
b = 0.2; s = Sin(b); c = Cos(b);
Point(11) = {-r * s, r * c, 0};  Point(12) = {r * c, -r * s, 0};
Point(13) = {-d * s, d * c, 0};  Point(14) = {d * c, -d * s, 0};
Point(15) = {0, r, 0};  Point(16) = {r, 0, 0};  Point(17) = {0, d, 0};  Point(18) = {d, 0, 0};
Circle(11) = {11, 1, 15};  Circle(12) = {15, 1, 16};  Circle(13) = {16, 1, 12};
Circle(14) = {13, 1, 17};  Circle(15) = {17, 1, 18};  Circle(16) = {18, 1, 14};
Line(17) = {11, 13};  Line(18) = {15, 17};  Line(19) = {16, 18};  Line(20) = {12, 14};
Curve Loop(11) = {11, 18, -14, -17};  Plane Surface(11) = {11};
Curve Loop(12) = {12, 19, -15, -18};  Plane Surface(12) = {12};
Curve Loop(13) = {13, 20, -16, -19};  Plane Surface(13) = {13};
k = Ceil(n * 2 * l / Pi);
Transfinite Curve {1, 3, 4, 6} = k + 1;
Transfinite Curve {2, 5} = n + 1;
Transfinite Curve {7:10} = m + 1;
Transfinite Curve {12, 15} = Ceil(1.25 * n) + 1;
Transfinite Curve {11, 13, 14, 16} = Ceil(n / 6) + 1;
Transfinite Curve {17:20} = 2;
Transfinite Surface {1:3, 11:13};
Recombine Surface {1:3, 11:13};
Physical Surface("belt") = {1:3};
Physical Surface("drum") = {11:13};
Physical Curve("inside") = {1:3};
Physical Curve("rim") = {11:13};
Physical Curve("slack") = {7};
Physical Curve("drawn") = {10};
