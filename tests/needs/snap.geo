// Half of an arch of the shape of a cosine, [0,l] wide, h high, t thick, and a punch that nearly touches its middle.
DefineConstant[ n = 32, m = 1, h = 5, l = 40, t = 1 ]; // cells along the arch and through it
For i In {0:16}
  x = l * i / 16;
  y = h / 2 * (1 + Cos(Pi * x / l));
  Point(100 + i) = {x, y, 0};
  Point(200 + i) = {x, y + t, 0};
EndFor
Spline(1) = {100:116};  Line(2) = {116, 216};  Spline(3) = {216:200:-1};  Line(4) = {200, 100};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
b = h + t + 1e-4;
Point(1) = {0, b, 0};  Point(2) = {2, b, 0};  Point(3) = {2, b + 2, 0};  Point(4) = {0, b + 2, 0};
Line(11) = {1, 2};  Line(12) = {2, 3};  Line(13) = {3, 4};  Line(14) = {4, 1};
Curve Loop(2) = {11, 12, 13, 14};  Plane Surface(2) = {2};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {2, 4} = m + 1;
Transfinite Curve {11, 13} = 3;
Transfinite Curve {12, 14} = 2;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
Physical Surface("arch")  = {1};
Physical Surface("punch") = {2};
Physical Curve("feet") = {2};
Physical Curve("back") = {3};
Physical Curve("mid")  = {4, 14};
Physical Curve("tip")  = {11};
Physical Curve("head") = {13};
