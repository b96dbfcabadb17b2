// A bar on a hinge at 0 over two blocks with round heads, at -1 and at 2; s: size of cells
DefineConstant[ s = 0.08, R = 0.3 ];
Point(1) = {-1.3, 0.6, 0}; Point(2) = {2.3, 0.6, 0}; Point(3) = {2.3, 0.8, 0}; Point(4) = {-1.3, 0.8, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 13; Transfinite Curve {2, 4} = 2; Transfinite Surface {1}; Recombine Surface {1};
Macro Head
  p = newp; Point(p) = {x - 0.3, 0, 0, 2 * s}; Point(p + 1) = {x + 0.3, 0, 0, 2 * s}; Point(p + 2) = {x + 0.3, 0.6 - R, 0, 1.5 * s}; Point(p + 3) = {x, 0.6, 0, s / 2}; Point(p + 4) = {x - 0.3, 0.6 - R, 0, 1.5 * s}; Point(p + 5) = {x, 0.6 - R, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Circle(l + 2) = {p + 2, p + 5, p + 3}; Circle(l + 3) = {p + 3, p + 5, p + 4}; Line(l + 4) = {p + 4, p};
  c = news; Curve Loop(c) = {l : l + 4}; Plane Surface(c) = {c}; Recombine Surface {c};
Return
x = -1; Call Head;
a = l; sa = c;
x = 2; Call Head;
b = l; sb = c;
Physical Surface("bar") = {1}; Physical Surface("near") = {sa}; Physical Surface("far") = {sb};
Physical Curve("under") = {1}; Physical Curve("near_head") = {a + 2, a + 3}; Physical Curve("near_foot") = {a}; Physical Curve("far_head") = {b + 2, b + 3}; Physical Curve("far_foot") = {b};
