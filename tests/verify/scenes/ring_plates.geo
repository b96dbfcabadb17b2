// A whole ring, radii 0.95 and 1.05, between two plates; nothing but contact holds it.
Geometry.AutoCoherence = 0;
Point(1) = {0, 0, 0};
For i In {0 : 3}
  Point(10 + i) = {1.05*Cos(i*Pi/2), 1.05*Sin(i*Pi/2), 0};
  Point(20 + i) = {0.95*Cos(i*Pi/2), 0.95*Sin(i*Pi/2), 0};
  Line(30 + i) = {20 + i, 10 + i};
EndFor
For i In {0 : 3}
  j = (i + 1)%4;
  Circle(10 + i) = {10 + i, 1, 10 + j};
  Circle(20 + i) = {20 + i, 1, 20 + j};
  Curve Loop(i + 1) = {10 + i, -(30 + j), -(20 + i), 30 + i};
  Plane Surface(i + 1) = {i + 1};
EndFor
Transfinite Curve{10:13, 20:23} = 17;
Transfinite Curve{30:33} = 3;
For s In {0 : 1}
  y = 1.05*(2*s - 1);
  Point(40 + 4*s) = {-1.8, y - 0.1*(1 - s), 0};
  Point(41 + 4*s) = {1.8, y - 0.1*(1 - s), 0};
  Point(42 + 4*s) = {1.8, y + 0.1*s, 0};
  Point(43 + 4*s) = {-1.8, y + 0.1*s, 0};
  For k In {0 : 3}
    Line(40 + 4*s + k) = {40 + 4*s + k, 40 + 4*s + (k + 1)%4};
  EndFor
  Curve Loop(5 + s) = {40 + 4*s, 41 + 4*s, 42 + 4*s, 43 + 4*s};
  Plane Surface(5 + s) = {5 + s};
  Transfinite Curve{40 + 4*s, 42 + 4*s} = 10;
  Transfinite Curve{41 + 4*s, 43 + 4*s} = 2;
EndFor
Transfinite Surface{1:6};
Recombine Surface{1:6};
Physical Surface("ring") = {1:4};
Physical Surface("lower") = {5};
Physical Surface("upper") = {6};
Physical Curve("skin") = {10:13};
Physical Curve("floor") = {42};
Physical Curve("ceiling") = {44};
