// A ring and a cone of 5 degrees that it is pushed up
DefineConstant[ n = 4 ];
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return

t = Tan(5 * Pi / 180);
Point(1) = {1, 0, 0}; Point(2) = {1.1, 0, 0}; Point(3) = {1.1, 0.2, 0}; Point(4) = {1 + 0.2 * t, 0.2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n / 2 + 1; Transfinite Curve {2, 4} = n + 1; Transfinite Surface {1}; Recombine Surface {1};
Point(11) = {0.7, -0.3, 0}; Point(12) = {1 - 0.3 * t, -0.3, 0}; Point(13) = {1 + 0.8 * t, 0.8, 0}; Point(14) = {0.7, 0.8, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {11, 13} = 3; Transfinite Curve {12, 14} = 6; Transfinite Surface {11}; Recombine Surface {11};
Physical Surface("ring") = {1}; Physical Surface("cone") = {11}; Physical Curve("bore") = {4}; Physical Curve("foot") = {1}; Physical Curve("flank") = {12};
