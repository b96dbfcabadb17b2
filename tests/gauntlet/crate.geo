// A crate 0.6 wide and 1.1 high on a layer
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return

x0 = -0.3; x1 = 0.3; y0 = 0; y1 = 1.1; nx = 4; ny = 6; Call Slab;
a = l; sa = s;
x0 = -0.8; x1 = 1; y0 = -0.2; y1 = 0; nx = 36; ny = 4; Call Slab;
b = l; sb = s;
Physical Surface("crate") = {sa}; Physical Surface("layer") = {sb};
Physical Curve("crate_faces") = {a, a + 1, a + 3}; Physical Curve("bottom") = {b}; Physical Curve("ground") = {b + 2};
