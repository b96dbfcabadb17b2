// Two discs of radius 1 glued to each other, meshes do not match, and a plate; n: cells along the radius of the lower one
DefineConstant[ n = 4, k = 3 ];
Macro Slab
  p = newp; Point(p) = {x0, y0, 0}; Point(p + 1) = {x1, y0, 0}; Point(p + 2) = {x1, y1, 0}; Point(p + 3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news; Curve Loop(s) = {l : l + 3}; Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = nx + 1; Transfinite Curve {l + 1, l + 3} = ny + 1; Transfinite Surface {s}; Recombine Surface {s};
Return
x0 = 0; x1 = 1; y0 = 0; y1 = 0.5; nx = n; ny = 2; Call Slab;
a = l; sa = s;
x0 = 0; x1 = 1; y0 = 0.5; y1 = 1; nx = k; ny = 2; Call Slab;
b = l; sb = s;
x0 = 0; x1 = 1.2; y0 = 1; y1 = 1.2; nx = 2; ny = 1; Call Slab;
c = l; sc = s;

Physical Surface("lower") = {sa}; Physical Surface("upper") = {sb}; Physical Surface("plate") = {sc};
Physical Curve("bottom") = {a}; Physical Curve("joint_lower") = {a + 2}; Physical Curve("joint_upper") = {b}; Physical Curve("top") = {b + 2}; Physical Curve("face") = {c}; Physical Curve("axis") = {a + 3, b + 3};
