// a ring of outer radius 1 with a gap of 16 degrees, from end c_s to end c_e
DefineConstant[n = 6];
angle() = {8, 80, 100, 180, 260, 280, 352};
share() = {0.8, 2/9, 8/9, 8/9, 2/9, 0.8};
Point(100) = {0, 0, 0};
For k In {0:6}
  c = Cos(angle(k) * Pi / 180); s = Sin(angle(k) * Pi / 180);
  Point(2*k + 1) = {0.75*c, 0.75*s, 0}; Point(2*k + 2) = {c, s, 0};
  Line(k + 1) = {2*k + 1, 2*k + 2}; Transfinite Curve {k + 1} = Max(1, Round(0.4*n)) + 1;
EndFor
For k In {0:5}
  Circle(11 + k) = {2*k + 2, 100, 2*k + 4}; Circle(21 + k) = {2*k + 1, 100, 2*k + 3};
  Transfinite Curve {11 + k, 21 + k} = Max(1, Round(share(k)*n)) + 1;
  Curve Loop(31 + k) = {k + 1, 11 + k, -(k + 2), -(21 + k)};
  Plane Surface(41 + k) = {31 + k}; Transfinite Surface {41 + k}; Recombine Surface {41 + k};
EndFor
Physical Surface("c") = {41:46};
Physical Curve("c_s") = {1};
Physical Curve("c_e") = {7};
Physical Curve("inner") = {21:26};
Physical Curve("top") = {12};
Physical Curve("bot") = {15};
