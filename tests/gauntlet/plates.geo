// Three plates on each other; n: cells to the unit of length, of the middle plate; the others by their own factors
DefineConstant[ n = 6 ];
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return
x0 = -1.5; x1 = 2; y0 = -0.4; y1 = 0; nx = 3 * n; ny = 2; Call Slab;
a = l; sa = s;
x0 = -1; x1 = 1; y0 = 0; y1 = 0.25; nx = 2 * n; ny = 2; Call Slab;
b = l; sb = s;
x0 = -0.8; x1 = 0.8; y0 = 0.25; y1 = 0.6; nx = 2 * n - 1; ny = 2; Call Slab;
c = l; sc = s;
Physical Surface("lower") = {sa}; Physical Surface("middle") = {sb}; Physical Surface("upper") = {sc};
Physical Curve("bottom") = {a}; Physical Curve("way") = {a + 2}; Physical Curve("under") = {b}; Physical Curve("over") = {b + 2};
Physical Curve("end") = {b + 1}; Physical Curve("foot") = {c}; Physical Curve("top") = {c + 2};
