// A spring bent to a U, legs along x; n: cells across it; h = 1: its upper half, with a rigid block below
DefineConstant[ n = 2, m = 14, h = 0 ];
t = 0.15; R = 0.3; L = 2;
Point(1) = {0, R, 0}; Point(2) = {0, R + t, 0}; Point(3) = {-L, R + t, 0}; Point(4) = {-L, R, 0}; Point(5) = {0, 0, 0}; Point(6) = {R, 0, 0}; Point(7) = {R + t, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Circle(5) = {1, 5, 6}; Line(6) = {6, 7}; Circle(7) = {7, 5, 2};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Curve Loop(2) = {5, 6, 7, -1}; Plane Surface(2) = {2};
Transfinite Curve {1, 3, 6} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Curve {5, 7} = 0.5 * m + 1;
If(h == 0)
  Point(11) = {0, -R, 0}; Point(12) = {0, -R - t, 0}; Point(13) = {-L, -R - t, 0}; Point(14) = {-L, -R, 0};
  Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Circle(15) = {11, 5, 6}; Circle(17) = {7, 5, 12};
  Curve Loop(11) = {11:14}; Plane Surface(11) = {11}; Curve Loop(12) = {15, 6, 17, -11}; Plane Surface(12) = {12};
  Transfinite Curve {11, 13} = n + 1; Transfinite Curve {12, 14} = m + 1; Transfinite Curve {15, 17} = 0.5 * m + 1;
  Transfinite Surface {1}; Transfinite Surface {2}; Transfinite Surface {11}; Transfinite Surface {12}; Recombine Surface {1, 2, 11, 12};
  Physical Surface("spring") = {1, 2, 11, 12}; Physical Curve("inner") = {4, 5, 15, 14}; Physical Curve("jaw_over") = {2}; Physical Curve("jaw_under") = {12}; 
  Physical Curve("tip_over") = {3}; Physical Curve("tip_under") = {13}; Physical Curve("middle") = {6};
  Physical Curve("leg_over") = {4}; Physical Curve("leg_under") = {14}; 
Else
  Point(21) = {-L - 1, -0.3, 0}; Point(22) = {0.1, -0.3, 0}; Point(23) = {0.1, 0, 0}; Point(24) = {-L - 1, 0, 0};
  Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(21) = {21:24}; Plane Surface(21) = {21};
  Transfinite Curve {21, 23} = 4; Transfinite Curve {22, 24} = 2;
  Transfinite Surface {1}; Transfinite Surface {2}; Transfinite Surface {21}; Recombine Surface {1, 2, 21};
  Physical Surface("spring") = {1, 2}; Physical Surface("floor") = {21}; Physical Curve("inner") = {4, 5}; Physical Curve("jaw_over") = {2}; Physical Curve("tip_over") = {3}; Physical Curve("middle") = {6}; Physical Curve("ground") = {23};
EndIf
