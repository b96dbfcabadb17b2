// Right half (w = 0) or the whole (w = 1) of a wedge with a tip, on a rigid floor that goes on.
DefineConstant[ w = 0, a = 0.6, h = 0.4, g = 1, n = 8, m = 6 ];
Point(1) = {0, 0, 0}; Point(2) = {a, 0.25, 0}; Point(3) = {a, 0.25 + h, 0}; Point(4) = {0, h + 0.25, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1}; Recombine Surface {1};
If (w == 1)
  Point(5) = {-a, 0.25, 0}; Point(6) = {-a, 0.25 + h, 0}; Line(5) = {4, 6}; Line(6) = {6, 5}; Line(7) = {5, 1}; Curve Loop(2) = {5, 6, 7, -4}; Plane Surface(2) = {2};
  Transfinite Curve {5, 7} = n + 1; Transfinite Curve {6} = m + 1; Transfinite Surface {2}; Recombine Surface {2};
  Physical Surface("wedge") = {1, 2}; Physical Curve("face") = {1, 7}; Physical Curve("top") = {3, 5}; Physical Curve("cut") = {};
Else
  Physical Surface("wedge") = {1}; Physical Curve("face") = {1}; Physical Curve("top") = {3}; Physical Curve("cut") = {4};
EndIf
Point(11) = {-0.8, -0.2, 0}; Point(12) = {1, -0.2, 0}; Point(13) = {1, 0, 0}; Point(14) = {-0.8, 0, 0}; Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(3) = {11:14}; Plane Surface(3) = {3};
Transfinite Curve {11, 13} = 2*g + 1; Transfinite Curve {12, 14} = 2; Transfinite Surface {3}; Recombine Surface {3};
Physical Surface("floor") = {3}; Physical Curve("ground") = {13};
