// A block on a longer one; n: cells to half of the unit
DefineConstant[ n = 4 ];
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return
x0 = -1; x1 = 1; y0 = -0.4; y1 = 0; nx = 4 * n + 1; ny = n; Call Slab;
a = l; sa = s;
x0 = -0.5; x1 = 0.5; y0 = 0; y1 = 0.4; nx = 2 * n; ny = n; Call Slab;
b = l; sb = s;

Physical Surface("floor") = {sa}; Physical Surface("block") = {sb};
Physical Curve("bottom") = {a}; Physical Curve("way") = {a + 2}; Physical Curve("under") = {b}; Physical Curve("top") = {b + 2};
