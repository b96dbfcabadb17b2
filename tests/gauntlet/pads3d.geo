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
nx = n; ny = n; nz = 2; z0 = 0; z1 = 0.2;
For i In {1 : 4}
  c = (i == 1 || i == 4) ? 0.4 : -0.4; d = i < 3 ? 0.4 : -0.4;
  x0 = c - 0.1; x1 = c + 0.1; y0 = d - 0.1; y1 = d + 0.1; Call Brick;
  Physical Volume(Sprintf("p%g", i)) = {v[1]}; Physical Surface(Sprintf("h%g", i)) = {v[0]}; Physical Surface(Sprintf("b%g", i)) = {s};
EndFor
x0 = -0.6; x1 = 0.6; y0 = -0.6; y1 = 0.6; z0 = 0.2; z1 = 0.3; nx = 5; ny = 5; nz = 1; Call Brick;
Physical Volume("plate") = {v[1]}; Physical Surface("under") = {s};
