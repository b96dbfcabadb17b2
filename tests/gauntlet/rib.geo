// the hook of a beam on a rigid rib, whose corner is sharp (r = 0) or round
DefineConstant[r = 0, h = 0.12];
Geometry.AutoCoherence = 0;
Point(1) = {0, 0, 0, h}; Point(2) = {1.6, 0, 0, h}; Point(3) = {1.62, -0.2, 0, h / 2}; Point(4) = {1.7, -0.2, 0, h / 2}; Point(5) = {2, 0, 0, h / 2};
Point(6) = {2, 0.12, 0, h}; Point(7) = {0, 0.12, 0, h};
For i In {1:7}
  Line(i) = {i, i % 7 + 1};
EndFor
Curve Loop(1) = {1:7}; Plane Surface(1) = {1};
Point(11) = {2.05, -0.6, 0, h}; Point(12) = {2.35, -0.6, 0, h}; Point(13) = {2.35, -0.1, 0, h}; Point(14) = {2.05 + r, -0.1, 0, (r > 0) ? r / 3 : h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14};
If(r > 0)
  Point(15) = {2.05 + r, -0.1 - r, 0}; Point(16) = {2.05, -0.1 - r, 0, r / 3};
  Circle(14) = {14, 15, 16}; Line(15) = {16, 11};
  Curve Loop(2) = {11:15}; Physical Curve("rib_face") = {12:15};
Else
  Line(14) = {14, 11};
  Curve Loop(2) = {11:14}; Physical Curve("rib_face") = {12:14};
EndIf
Plane Surface(2) = {2};
Physical Surface("beam") = {1}; Physical Surface("rib") = {2};
Physical Curve("hook") = {1:5}; Physical Curve("root") = {7};
