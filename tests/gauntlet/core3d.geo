Macro Disc
  p = newp; Point(p) = {cx, cy, cz};
  For kk In {0 : 3}
    da = off + Pi / 4 + kk * Pi / 2; dc = Cos(da); ds = Sin(da);
    Point(p + 1 + kk) = {cx + R * (dc * ux + ds * wx), cy + R * (dc * uy + ds * wy), cz + R * (dc * uz + ds * wz)};
    Point(p + 5 + kk) = {cx + q * (dc * ux + ds * wx), cy + q * (dc * uy + ds * wy), cz + q * (dc * uz + ds * wz)};
  EndFor
  l = newl;
  For kk In {0 : 3}
    j = (kk + 1) % 4;
    Circle(l + kk) = {p + 1 + kk, p, p + 1 + j}; Line(l + 8 + kk) = {p + 5 + kk, p + 1 + kk};
    If (hole)
      Circle(l + 4 + kk) = {p + 5 + kk, p, p + 5 + j};
    Else
      Line(l + 4 + kk) = {p + 5 + kk, p + 5 + j};
    EndIf
    Transfinite Curve {l + kk, l + 4 + kk} = n + 1; Transfinite Curve {l + 8 + kk} = m + 1;
  EndFor
  s = news;
  For kk In {0 : 3}
    j = (kk + 1) % 4;
    Curve Loop(s + kk) = {l + 8 + kk, l + kk, -(l + 8 + j), -(l + 4 + kk)}; Plane Surface(s + kk) = {s + kk};
    Transfinite Surface {s + kk}; Recombine Surface {s + kk};
  EndFor
  If (!hole)
    Curve Loop(s + 4) = {l + 4 : l + 7}; Plane Surface(s + 4) = {s + 4}; Transfinite Surface {s + 4}; Recombine Surface {s + 4};
  EndIf
Return
ux = 1; uy = 0; uz = 0; wx = 0; wy = 1; wz = 0; cz = 0; off = 0;

DefineConstant[ e = 2, k = 3, g = 3 ];
cx = 0; cy = 0; R = 0.3; q = 0.14; hole = 0; n = e; m = 1; Call Disc;
a = s;
u[] = Extrude {0, 0, 1} { Surface{a : a + 4}; Layers{g}; Recombine; };
R = 0.5; q = 0.3; hole = 1; n = k; m = 1; off = Pi / 4; Call Disc;
b = s;
v[] = Extrude {0, 0, 1} { Surface{b : b + 3}; Layers{g + 1}; Recombine; };
Physical Volume("core") = {u[1], u[7], u[13], u[19], u[25]}; Physical Volume("tube") = {v[1], v[7], v[13], v[19]};
Physical Surface("core_skin") = {u[3], u[9], u[15], u[21]}; Physical Surface("bore") = {v[5], v[11], v[17], v[23]};
Physical Surface("foot") = {a : a + 4, b : b + 3}; Physical Surface("head") = {u[0], u[6], u[12], u[18], u[24], v[0], v[6], v[12], v[18]};
