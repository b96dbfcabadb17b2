// A disc of radius 1 and a plate on it; n: cells along the radius
DefineConstant[ n = 8 ];
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return
x0 = 0; x1 = 1; y0 = 0; y1 = 0.5; nx = n; ny = n / 2; Call Slab;
a = l; sa = s;
x0 = 0; x1 = 1.6; y0 = 0.5; y1 = 0.7; nx = 4; ny = 1; Call Slab;
c = l; sc = s;

Physical Surface("disc") = {sa}; Physical Surface("plate") = {sc};
Physical Curve("bottom") = {a}; Physical Curve("top") = {a + 2}; Physical Curve("side") = {a + 1}; Physical Curve("face") = {c}; Physical Curve("axis") = {a + 3};
