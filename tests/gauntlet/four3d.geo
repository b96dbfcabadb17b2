Macro Brick
  p = newp;
  For kk In {0 : 1}
    zz = kk ? z1 : z0; o = p + 4 * kk;
    Point(o) = {x0, y0, zz}; Point(o + 1) = {x1, y0, zz}; Point(o + 2) = {x1, y1, zz}; Point(o + 3) = {x0, y1, zz};
  EndFor
  l = newl;
  For kk In {0 : 3}
    j = (kk + 1) % 4;
    Line(l + kk) = {p + kk, p + j}; Line(l + 4 + kk) = {p + 4 + kk, p + 4 + j}; Line(l + 8 + kk) = {p + kk, p + 4 + kk};
  EndFor
  s = news; Curve Loop(s) = {l : l + 3}; Curve Loop(s + 1) = {l + 4 : l + 7};
  For kk In {0 : 3}
    j = (kk + 1) % 4;
    Curve Loop(s + 2 + kk) = {l + kk, l + 8 + j, -(l + 4 + kk), -(l + 8 + kk)};
  EndFor
  For kk In {0 : 5}
    Plane Surface(s + kk) = {s + kk};
  EndFor
  Transfinite Curve {l, l + 2, l + 4, l + 6} = nx + 1; Transfinite Curve {l + 1, l + 3, l + 5, l + 7} = ny + 1; Transfinite Curve {l + 8 : l + 11} = nz + 1;
  Transfinite Surface {s : s + 5}; Recombine Surface {s : s + 5};
  w = newv; Surface Loop(w) = {s : s + 5}; Volume(w) = {w}; Transfinite Volume {w};
  v[] = {s + 1, w, s + 2, s + 3, s + 4, s + 5};
Return

DefineConstant[ n = 2 ];
z0 = 0; z1 = 1;
x0 = 0; x1 = 0.5; y0 = 0; y1 = 0.5; nx = n; ny = n; nz = 3; Call Brick;
a[] = v[]; as = s;
x0 = -0.5; x1 = 0; nx = n + 1; ny = n + 1; nz = 2; Call Brick;
b[] = v[]; bs = s;
y0 = -0.5; y1 = 0; nx = n; ny = n; nz = 4; Call Brick;
c[] = v[]; cs = s;
x0 = 0; x1 = 0.5; nx = n + 1; ny = n + 1; nz = 3; Call Brick;
d[] = v[]; dbase = s;
Physical Volume("a") = {a[1]}; Physical Volume("b") = {b[1]}; Physical Volume("c") = {c[1]}; Physical Volume("d") = {d[1]};
Physical Surface("bottom") = {as, bs, cs, dbase}; Physical Surface("top") = {a[0], b[0], c[0], d[0]};
Physical Surface("a_left") = {a[5]}; Physical Surface("a_front") = {a[2]}; Physical Surface("b_right") = {b[3]}; Physical Surface("b_front") = {b[2]};
Physical Surface("c_back") = {c[4]}; Physical Surface("c_right") = {c[3]}; Physical Surface("d_left") = {d[5]}; Physical Surface("d_back") = {d[4]};
Physical Surface("left") = {b[5], c[5]}; Physical Surface("front") = {c[2], d[2]};
