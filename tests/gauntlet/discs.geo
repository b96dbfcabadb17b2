// A half disc that stands on a floor, a disc on it and a half disc above, a little apart, with the axis of symmetry x = 0.
DefineConstant[ r = 1, gap = 0.002, n = 6 ];
For k In {0:2}
  y = k * (2 * r + gap);
  c = newp; Point(c) = {0, y, 0};
  top = newp; Point(top) = {0, y + r, 0}; low = newp; Point(low) = {0, y - r, 0}; right = newp; Point(right) = {r, y, 0};
  If (k < 2)
    a = newl; Line(a) = {c, right}; b = newl; Circle(b) = {right, c, top}; d = newl; Line(d) = {top, c};
    l = newll; Curve Loop(l) = {a, b, d}; f = news; Plane Surface(f) = {l};
    Transfinite Curve {b} = 3 * n + 1; Transfinite Curve {a, d} = n + 1;
    disc~{k}[] += f; skin~{k}[] += b; axis[] += d; all[] += f;
    If (k == 0)
      floor = a;
    EndIf
  EndIf
  If (k > 0)
    If (k > 1)
      a = newl; Line(a) = {c, right}; Transfinite Curve {a} = n + 1; roof = a;
    EndIf
    b = newl; Circle(b) = {low, c, right}; d = newl; Line(d) = {c, low};
    l = newll; Curve Loop(l) = {d, b, -a}; f = news; Plane Surface(f) = {l};
    Transfinite Curve {b} = 3 * n + 1; Transfinite Curve {d} = n + 1;
    disc~{k}[] += f; skin~{k}[] += b; axis[] += d; all[] += f;
  EndIf
EndFor
Recombine Surface {all[]};
Physical Surface("lower") = {disc_0[]}; Physical Surface("middle") = {disc_1[]}; Physical Surface("upper") = {disc_2[]};
Physical Curve("lower_skin") = {skin_0[]}; Physical Curve("middle_skin") = {skin_1[]}; Physical Curve("upper_skin") = {skin_2[]};
Physical Curve("skins") = {skin_0[], skin_1[], skin_2[]};
Physical Curve("floor") = {floor}; Physical Curve("roof") = {roof}; Physical Curve("axis") = {axis[]};
