// Meridian of two waves of a bellows between planes of symmetry in its crests: wall h thick, limbs w long from radius x, joined by turns whose middle
// lines have the radii ri (valleys) and ro (crests).
DefineConstant[ x = 1, w = 0.5, ri = 0.06, ro = 0.12, h = 0.04, n = 1, m = 6, k = 4 ];
c = h / 2; z = ri + ro;
For i In {0:3} // limbs at y[i], from x to x + w
  y = 2 * z * Floor((i + 1) / 2) + (i % 2 ? -ro : ro); p = 10 * i;
  Point(p + 1) = {x, y - c, 0}; Point(p + 2) = {x + w, y - c, 0}; Point(p + 3) = {x + w, y + c, 0}; Point(p + 4) = {x, y + c, 0};
  Line(p + 1) = {p + 1, p + 2}; Line(p + 2) = {p + 2, p + 3}; Line(p + 3) = {p + 3, p + 4}; Line(p + 4) = {p + 4, p + 1};
  Curve Loop(p + 1) = {p + 1, p + 2, p + 3, p + 4}; Plane Surface(p + 1) = {p + 1};
EndFor
For i In {0:4} // turns: crests 0 2 4, of which 0 and 4 are halves; valleys 1 3
  q = 50 + 10 * i; o = i % 2; s = o ? -1 : 1; r = o ? ri : ro; y = z * i; lo = 10 * (i - 1); up = 10 * i;
  Point(q) = {o ? x : x + w, y, 0}; Point(q + 1) = {(o ? x : x + w) + s * (r - c), y, 0}; Point(q + 2) = {(o ? x : x + w) + s * (r + c), y, 0};
  Line(q + 1) = {q + 1, q + 2};
  If(i > 0)
    Circle(q + 2) = {o ? lo + 4 : lo + 3, q, q + 1}; Circle(q + 3) = {o ? lo + 1 : lo + 2, q, q + 2};
    If(o)
      Curve Loop(q + 1) = {q + 3, -(q + 1), -(q + 2), lo + 4};
    Else
      Curve Loop(q + 1) = {q + 3, -(q + 1), -(q + 2), -(lo + 2)};
    EndIf
    Plane Surface(q + 1) = {q + 1};
    Transfinite Curve {q + 2, q + 3} = k + 1;
  EndIf
  If(i < 4)
    Circle(q + 4) = {q + 1, q, o ? up + 1 : up + 2}; Circle(q + 5) = {q + 2, q, o ? up + 4 : up + 3};
    If(o)
      Curve Loop(q + 2) = {q + 1, q + 5, up + 4, -(q + 4)};
    Else
      Curve Loop(q + 2) = {q + 1, q + 5, -(up + 2), -(q + 4)};
    EndIf
    Plane Surface(q + 2) = {q + 2};
    Transfinite Curve {q + 4, q + 5} = k + 1;
  EndIf
  Transfinite Curve {q + 1} = n + 1;
EndFor
Transfinite Curve {2, 4, 12, 14, 22, 24, 32, 34} = n + 1; Transfinite Curve {1, 3, 11, 13, 21, 23, 31, 33} = m + 1;
Transfinite Surface {:}; Recombine Surface {:};
Physical Surface("wall") = {1, 11, 21, 31, 52, 61, 62, 71, 72, 81, 82, 91};
Physical Curve("foot") = {51}; Physical Curve("head") = {91};
Physical Curve("skin") = {1, 3, 11, 13, 21, 23, 31, 33, 54, 55, 62:65, 72:75, 82:85, 92, 93};
