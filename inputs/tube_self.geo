// Cross section of a tube, slightly oval; or the upper right quarter of it above a rigid plate in its plane of symmetry.
DefineConstant[
  r = 1,      // radius of the middle
  t = 0.01,   // thickness
  o = 0.001,  // ovality: half axes r (1 + o) and r (1 - o)
  n = 16,     // cells along a quarter
  m = 1,      // across the wall
  whole = 1   // 0: the quarter
];
a = r * (1 + o); b = r * (1 - o); h = t / 2;
Point(1) = {0, 0, 0};
Point(2) = {a - h, 0, 0}; Point(3) = {a + h, 0, 0}; Point(4) = {0, b - h, 0}; Point(5) = {0, b + h, 0};
Ellipse(1) = {2, 1, 2, 4}; Ellipse(2) = {3, 1, 3, 5}; Line(11) = {2, 3}; Line(12) = {4, 5};
Curve Loop(1) = {11, 2, -12, -1}; Plane Surface(1) = {1};
Transfinite Curve {1, 2} = n + 1; Transfinite Curve {11, 12} = m + 1; Transfinite Surface {1}; Recombine Surface {1};
If (whole)
  Point(6) = {-a + h, 0, 0}; Point(7) = {-a - h, 0, 0}; Point(8) = {0, -b + h, 0}; Point(9) = {0, -b - h, 0};
  Ellipse(3) = {4, 1, 6, 6}; Ellipse(4) = {5, 1, 7, 7}; Ellipse(5) = {6, 1, 6, 8}; Ellipse(6) = {7, 1, 7, 9};
  Ellipse(7) = {8, 1, 2, 2}; Ellipse(8) = {9, 1, 3, 3}; Line(13) = {6, 7}; Line(14) = {8, 9};
  Curve Loop(2) = {12, 4, -13, -3}; Plane Surface(2) = {2}; Curve Loop(3) = {13, 6, -14, -5}; Plane Surface(3) = {3}; Curve Loop(4) = {14, 8, -11, -7}; Plane Surface(4) = {4};
  Transfinite Curve {3:8} = n + 1; Transfinite Curve {13, 14} = m + 1; Transfinite Surface {2:4}; Recombine Surface {2:4};
  Physical Surface("tube") = {1:4}; Physical Curve("bore") = {1, 3, 5, 7}; Physical Curve("outside") = {2, 4, 6, 8};
  Physical Curve("upright") = {12, 14}; Physical Curve("level") = {11, 13};
Else
  Point(21) = {-0.8 * r, 0, 0}; Point(22) = {0.8 * r, 0, 0}; Point(23) = {0.8 * r, -r / 5, 0}; Point(24) = {-0.8 * r, -r / 5, 0};
  Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21};
  Curve Loop(5) = {21:24}; Plane Surface(5) = {5}; Transfinite Curve {21:24} = 2; Transfinite Surface {5}; Recombine Surface {5};
  Physical Surface("tube") = {1}; Physical Curve("bore") = {1}; Physical Curve("outside") = {2}; Physical Curve("upright") = {12}; Physical Curve("level") = {11};
  Physical Surface("plate") = {5}; Physical Curve("plate_face") = {21};
EndIf
