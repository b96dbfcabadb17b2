// Two blocks, one on the other, between two walls and a lid; n: cells across the lower one
DefineConstant[ n = 5, k = 4 ];
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return
x0 = 0; x1 = 1; y0 = 0; y1 = 0.6; nx = n; ny = 3; Call Slab;
a = l; sa = s;
x0 = 0; x1 = 1; y0 = 0.6; y1 = 1.1; nx = k; ny = 2; Call Slab;
b = l; sb = s;
x0 = -0.3; x1 = 0; y0 = -0.2; y1 = 1.2; nx = 1; ny = 2; Call Slab;
c = l; sc = s;
x0 = 1; x1 = 1.3; y0 = -0.2; y1 = 1.2; nx = 1; ny = 2; Call Slab;
d = l; sd = s;

Physical Surface("lower") = {sa}; Physical Surface("upper") = {sb}; Physical Surface("walls") = {sc, sd};
Physical Curve("bottom") = {a}; Physical Curve("top") = {b + 2}; Physical Curve("joint_lower") = {a + 2}; Physical Curve("joint_upper") = {b};
Physical Curve("lower_sides") = {a + 1, a + 3}; Physical Curve("upper_sides") = {b + 1, b + 3}; Physical Curve("wall_faces") = {c + 1, d + 3};
