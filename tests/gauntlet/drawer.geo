// A drawer in two pairs of pads, with a buffer before it; n: cells across a pad
DefineConstant[ n = 4, g = 0 ];
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return
x0 = -1.5; x1 = 1.5; y0 = -0.2; y1 = 0.2; nx = 12; ny = 2; Call Slab;
d = l; sd = s;
nx = n; ny = n;
x0 = -1.1; x1 = -0.9; y0 = -0.4; y1 = -0.2; Call Slab;
a = l; sa = s;
x0 = 0.9; x1 = 1.1; Call Slab;
b = l; sb = s;
x0 = -1.1; x1 = -0.9; y0 = 0.2; y1 = 0.4; Call Slab;
e = l; se = s;
x0 = 0.9; x1 = 1.1; Call Slab;
f = l; sf = s;
x0 = 1.5; x1 = 2; y0 = -0.12; y1 = 0.12; nx = 5; ny = 3; Call Slab;
q = l; sq = s;
Physical Surface("drawer") = {sd}; Physical Surface("pads") = {sa, sb, se, sf}; Physical Surface("buffer") = {sq};
Physical Curve("sole") = {d}; Physical Curve("lid") = {d + 2}; Physical Curve("nose") = {d + 1};
Physical Curve("lower_pads") = {a + 2, b + 2}; Physical Curve("upper_pads") = {e, f}; Physical Curve("backs") = {a, b, e + 2, f + 2};
Physical Curve("front") = {q + 3}; Physical Curve("stop") = {q + 1};
