// O-ring, a circle of radius a about (R, a), in a groove of width w with rounded corners, under a flat lid; x is the radius.
DefineConstant[
  n = 3, // cells along an eighth of the circle
  m = 2  // through the metal
];
R = 10;  a = 1.5;  w = 3.7;  depth = 2;  f = 0.3;  t = 1;  c = 0.45;
// O-grid in the circle: centre 1, outer 2..9 counter-clockwise from the right, core 12..19
Point(1) = {R, a, 0};
For k In {0:7}
  Point(2 + k) = {R + a * Cos(k * Pi / 4), a + a * Sin(k * Pi / 4), 0};
  r = (k % 2 == 0) ? c * a : 1.25 * c * a;
  Point(12 + k) = {R + r * Cos(k * Pi / 4), a + r * Sin(k * Pi / 4), 0};
EndFor
For k In {0:7}
  l = (k + 1) % 8;
  Circle(1 + k) = {2 + k, 1, 2 + l};
  Line(11 + k) = {12 + k, 12 + l};
  Line(21 + k) = {2 + k, 12 + k};
EndFor
For k In {0:3}
  Line(31 + k) = {1, 12 + 2 * k};
EndFor
For k In {0:7}
  l = (k + 1) % 8;
  Curve Loop(1 + k) = {1 + k, 21 + l, -(11 + k), -(21 + k)};
  Plane Surface(1 + k) = {1 + k};
EndFor
For k In {0:3}
  l = (k + 1) % 4;
  Curve Loop(11 + k) = {31 + k, 11 + 2 * k, 12 + 2 * k, -(31 + l)};
  Plane Surface(11 + k) = {11 + k};
EndFor
Transfinite Curve {1:8, 11:18, 31:34} = n + 1;
Transfinite Curve {21:28} = n + 1;
Transfinite Surface {1:8, 11:14};

// groove: inner contour x = R - w/2 .. R + w/2, floor y = 0
x0 = R - w / 2; x1 = R + w / 2;
Point(101) = {x0 - t, depth, 0}; Point(102) = {x0, depth, 0}; Point(103) = {x0, f, 0}; Point(104) = {x0 + f, 0, 0};
Point(105) = {x1 - f, 0, 0}; Point(106) = {x1, f, 0}; Point(107) = {x1, depth, 0}; Point(108) = {x1 + t, depth, 0};
Point(109) = {x1 + t, f, 0}; Point(110) = {x1 + t, -t, 0}; Point(111) = {x1 - f, -t, 0}; Point(112) = {x0 + f, -t, 0}; Point(113) = {x0 - t, -t, 0}; Point(114) = {x0 - t, f, 0};
Point(115) = {x0 + f, f, 0}; Point(116) = {x1 - f, f, 0};
Line(101) = {101, 102}; Line(102) = {102, 103}; Circle(103) = {103, 115, 104}; Line(104) = {104, 105}; Circle(105) = {105, 116, 106}; Line(106) = {106, 107};
Line(107) = {107, 108}; Line(108) = {108, 109}; Line(109) = {109, 110}; Line(110) = {110, 111}; Line(111) = {111, 112}; Line(112) = {112, 113}; Line(113) = {113, 114}; Line(114) = {114, 101};
Line(115) = {114, 103}; Line(116) = {112, 104}; Line(117) = {111, 105}; Line(118) = {109, 106};
Curve Loop(101) = {101, 102, -115, 114}; Plane Surface(101) = {101};
Curve Loop(102) = {115, 103, -116, 112, 113}; Plane Surface(102) = {102};
Curve Loop(103) = {116, 104, -117, 111}; Plane Surface(103) = {103};
Curve Loop(104) = {117, 105, -118, 109, 110}; Plane Surface(104) = {104};
Curve Loop(105) = {118, 106, 107, 108}; Plane Surface(105) = {105};
Transfinite Curve {101, 107, 115, 118, 116, 117} = m + 1;
Transfinite Curve {114, 102, 106, 108} = 5;
Transfinite Curve {104, 111} = 7;
Transfinite Curve {112, 113, 109, 110} = m + 1;
Transfinite Curve {103, 105} = 2 * m + 1;
Transfinite Surface {101, 103, 105};
Transfinite Surface {102} = {114, 103, 104, 112};
Transfinite Surface {104} = {111, 105, 106, 109};
// lid
Point(201) = {x0 - t, 2 * a, 0}; Point(202) = {x1 + t, 2 * a, 0}; Point(203) = {x1 + t, 2 * a + t, 0}; Point(204) = {x0 - t, 2 * a + t, 0};
Line(201) = {201, 202}; Line(202) = {202, 203}; Line(203) = {203, 204}; Line(204) = {204, 201};
Curve Loop(201) = {201:204}; Plane Surface(201) = {201};
Transfinite Curve {201, 203} = 9; Transfinite Curve {202, 204} = m + 1;
Transfinite Surface {201};
Recombine Surface {:};
Physical Surface("ring") = {1:8, 11:14};
Physical Surface("housing") = {101:105};
Physical Surface("lid") = {201};
Physical Curve("skin") = {1:8};
Physical Curve("wall") = {102:106};
Physical Curve("floor") = {110:112};
Physical Curve("lid_face") = {201};
Physical Curve("lid_top") = {203};
