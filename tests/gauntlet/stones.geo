// Five stones of an arch, radii 1 and 1.3, 22 degrees each
DefineConstant[ n = 3, m = 4 ];
Point(1) = {0, 0, 0};
For i In {0 : 4}
  b = 100 * (i + 1); t0 = (35 + 22 * i) * Pi / 180; t1 = (35 + 22 * (i + 1)) * Pi / 180;
  Point(b + 1) = {Cos(t0), Sin(t0), 0}; Point(b + 2) = {1.3 * Cos(t0), 1.3 * Sin(t0), 0}; Point(b + 3) = {1.3 * Cos(t1), 1.3 * Sin(t1), 0}; Point(b + 4) = {Cos(t1), Sin(t1), 0};
  Line(b + 1) = {b + 1, b + 2}; Circle(b + 2) = {b + 2, 1, b + 3}; Line(b + 3) = {b + 3, b + 4}; Circle(b + 4) = {b + 4, 1, b + 1};
  Curve Loop(b) = {b + 1 : b + 4}; Plane Surface(b) = {b}; k = (i % 2) ? m : n;
  Transfinite Curve {b + 1, b + 3} = k + 1; Transfinite Curve {b + 2, b + 4} = 5; Transfinite Surface {b}; Recombine Surface {b};
EndFor
Physical Surface("stones") = {100, 200, 300, 400, 500};
Physical Curve("right") = {101}; Physical Curve("left") = {503};
Physical Curve("a1") = {103}; Physical Curve("a2") = {201}; Physical Curve("b1") = {203}; Physical Curve("b2") = {301};
Physical Curve("c1") = {303}; Physical Curve("c2") = {401}; Physical Curve("d1") = {403}; Physical Curve("d2") = {501};
