// A snap hook: a beam with a nose below its end, and the catch that it is pushed over; plane strain.
//
//   clamp +---------------------------+
//         |            beam           |
//         +--------------------.      |            .------.
//                               \   .'             | catch |
//                                \.'  nose         |       |
DefineConstant[
  r = 0,     // radius of the nose, 0: sharp
  c = 0.3,   // radius of the catch's edges
  back = 60, // slope of the nose's back, degrees
  size = 1   // cells; half as large along contact
];
t = 2;  d = 2;  length = 20;  foot = 16;  top = -0.8;  near = 21;  far = 24;
b = back * Pi / 180;  e = Pi / 6;
cx = foot + d / Tan(b);  fy = -d + (length - cx) * Tan(e);
Point(1) = {0, 0, 0};  Point(2) = {foot, 0, 0};  Point(5) = {length, fy, 0};  Point(6) = {length, t, 0};  Point(7) = {0, t, 0};
If (r > 0)
  a = r * Tan((b + e) / 2); // from the corner to the arc's ends
  Point(3) = {cx - a * Cos(b), -d + a * Sin(b), 0};  Point(4) = {cx + a * Cos(e), -d + a * Sin(e), 0};
  Point(8) = {cx - a * Cos(b) + r * Sin(b), -d + a * Sin(b) + r * Cos(b), 0};
  Circle(3) = {3, 8, 4};
Else
  Point(3) = {cx, -d, 0};
EndIf
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 1};
If (r > 0)
  Line(4) = {4, 5};  Curve Loop(1) = {1:7};
Else
  Line(4) = {3, 5};  Curve Loop(1) = {1, 2, 4, 5, 6, 7};
EndIf
Plane Surface(1) = {1};
Point(11) = {near, -4, 0};  Point(12) = {far, -4, 0};  Point(13) = {far, top - c, 0};  Point(14) = {far - c, top, 0};  Point(15) = {near + c, top, 0};  Point(16) = {near, top - c, 0};
Point(17) = {far - c, top - c, 0};  Point(18) = {near + c, top - c, 0};
Line(11) = {11, 12};  Line(12) = {12, 13};  Circle(13) = {13, 17, 14};  Line(14) = {14, 15};  Circle(15) = {15, 18, 16};  Line(16) = {16, 11};
Curve Loop(2) = {11:16};  Plane Surface(2) = {2};
MeshSize {:} = size;  MeshSize {2, 3, 5, 13:16} = size / 2;
If (r > 0)
  MeshSize {4} = size / 2;
EndIf
Physical Surface("hook") = {1};
Physical Surface("catch") = {2};
Physical Curve("clamp") = {7};
If (r > 0)
  Physical Curve("nose") = {1, 2, 3, 4};
Else
  Physical Curve("nose") = {1, 2, 4};
EndIf
Physical Curve("edge") = {12:16};
Physical Curve("foot") = {11};
