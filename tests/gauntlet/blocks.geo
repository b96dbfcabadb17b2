// A block on another in the plane: lower [l0, l1] x [-lh, 0], upper [u0, u1] x [-o, uh - o]; o: overlap, below 0 a gap. r: radius of the upper's lower corners (0: sharp).
DefineConstant[
  l0 = 0, l1 = 2, lh = 1, u0 = 0, u1 = 1, uh = 0.5, o = 0, r = 0,
  nl = 10, ml = 5, nu = 6, mu = 3 // cells along and across the lower and the upper
];
Point(1) = {l0, -lh, 0}; Point(2) = {l1, -lh, 0}; Point(3) = {l1, 0, 0}; Point(4) = {l0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = nl + 1; Transfinite Curve {2, 4} = ml + 1; Transfinite Surface {1};

Point(13) = {u1, uh - o, 0}; Point(14) = {u0, uh - o, 0};
If (r > 0)
  Point(11) = {u0 + r, -o, 0}; Point(12) = {u1 - r, -o, 0};
  Point(15) = {u1 - r, r - o, 0}; Point(16) = {u1, r - o, 0}; Point(17) = {u0 + r, r - o, 0}; Point(18) = {u0, r - o, 0};
  Circle(15) = {12, 15, 16}; Circle(16) = {18, 17, 11};
  Line(11) = {11, 12}; Line(12) = {16, 13}; Line(13) = {13, 14}; Line(14) = {14, 18};
  Curve Loop(2) = {11, 15, 12, 13, 14, 16}; Plane Surface(2) = {2};
  Transfinite Curve {11, 13} = nu + 1; Transfinite Curve {12, 14} = mu + 1; Transfinite Curve {15, 16} = 4;
  skin[] = {11, 12, 14, 15, 16};
Else
  Point(11) = {u0, -o, 0}; Point(12) = {u1, -o, 0};
  Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
  Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
  Transfinite Curve {11, 13} = nu + 1; Transfinite Curve {12, 14} = mu + 1; Transfinite Surface {2};
  skin[] = {11, 12, 14};
EndIf
Recombine Surface {1, 2};

Physical Surface("lower") = {1}; Physical Surface("upper") = {2};
Physical Curve("bottom") = {1}; Physical Curve("face") = {3}; Physical Curve("hull") = {2, 3, 4};
Physical Curve("top") = {13}; Physical Curve("under") = {11}; Physical Curve("skin") = {skin[]};
Physical Curve("left") = {4, 14}; Physical Curve("right") = {2, 12}; Physical Curve("upper_left") = {14}; Physical Curve("lower_left") = {4};
