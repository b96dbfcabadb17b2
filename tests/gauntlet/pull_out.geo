// A shaft of radius 0.5 (d: larger by) in a hub of radii 0.5 and 1; n: cells to half of the unit
DefineConstant[ n = 4, d = 0 ];
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return
x0 = 0; x1 = 0.5 + d; y0 = -0.5; y1 = 1.5; nx = n; ny = 4 * n; Call Slab;
a = l; sa = s;
x0 = 0.5; x1 = 1; y0 = 0; y1 = 1; nx = n; ny = 2 * n + 1; Call Slab;
b = l; sb = s;
Physical Surface("shaft") = {sa}; Physical Surface("hub") = {sb};
Physical Curve("foot") = {a}; Physical Curve("skin") = {a + 1}; Physical Curve("head") = {a + 2}; Physical Curve("axis") = {a + 3};
Physical Curve("under") = {b}; Physical Curve("over") = {b + 2}; Physical Curve("bore") = {b + 3};
