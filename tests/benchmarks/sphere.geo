// A sphere of radius R and what is behind it, as far as s 2^k away: a core around the point of contact, the origin, then k shells of boxes, each twice as wide as
// the one before. All of it, or its half y >= 0. Below its mirror image, or a rigid plane.
DefineConstant[
  R = 200,   // the radius
  s = 1.6,   // half width of the core
  m = 2,     // cells along it
  k = 7,     // shells
  whole = 0, // 1: all of it
  pair = 1   // 1: two spheres; 0: a rigid plane below
];
h = R - Sqrt(R * R - s * s);          // height of the sphere at the middle of a side of the core
H = R - Sqrt(R * R - 2 * s * s);      // and at its corners
y0 = whole ? -1 : 0;
For b In {0:pair}
  B = 10000 * b;
  v = 1 - 2 * b;
  Point(B + 1) = {0, 0, v * R};
  // layer j = 0 .. k: corners (-,-), (+,-), (+,+), (-,+) at the surface, then behind
  For j In {0:k}
    w = s * 2^j;
    p = B + 100 * (j + 1);
    Point(p + 1) = {-w, y0 * w, v * ((j == 0 && !whole) ? h : H)};
    Point(p + 2) = {w, y0 * w, v * ((j == 0 && !whole) ? h : H)};
    Point(p + 3) = {w, w, v * H};
    Point(p + 4) = {-w, w, v * H};
    Point(p + 5) = {-w, y0 * w, v * w};
    Point(p + 6) = {w, y0 * w, v * w};
    Point(p + 7) = {w, w, v * w};
    Point(p + 8) = {-w, w, v * w};
    For i In {1:4}
      n = i == 4 ? 1 : i + 1;
      If (j == 0)
        Circle(p + i) = {p + i, B + 1, p + n};
      Else
        Line(p + i) = {p + i, p + n};
      EndIf
      Line(p + 4 + i) = {p + 4 + i, p + 4 + n};
      Line(p + 8 + i) = {p + i, p + 4 + i};
    EndFor
    For i In {1:4}
      n = i == 4 ? 1 : i + 1;
      Curve Loop(p + i) = {p + i, p + 8 + n, -(p + 4 + i), -(p + 8 + i)};
      Plane Surface(p + i) = {p + i};
    EndFor
    Curve Loop(p + 5) = {p + 5, p + 6, p + 7, p + 8};
    Plane Surface(p + 5) = {p + 5};
    Transfinite Curve {p + 1, p + 3, p + 5, p + 7} = 2 * m + 1;
    Transfinite Curve {p + 2, p + 4, p + 6, p + 8} = (whole ? 2 : 1) * m + 1;
    Transfinite Curve {p + 9:p + 12} = m + 1;
    Transfinite Surface {p + 1:p + 5};
    Recombine Surface {p + 1:p + 5};
  EndFor
  Curve Loop(B + 106) = {B + 101, B + 102, B + 103, B + 104};
  Surface(B + 106) = {B + 106} In Sphere {B + 1};
  Transfinite Surface {B + 106};
  Recombine Surface {B + 106};
  Surface Loop(B + 1) = {B + 101:B + 106};
  Volume(B + 1) = {B + 1};
  Transfinite Volume {B + 1};
  volumes[] = {B + 1};
  planes[] = {B + 101};
  For j In {1:k}
    p = B + 100 * (j + 1);
    o = p - 100;
    For i In {1:8}
      Line(p + 20 + i) = {o + i, p + i};
    EndFor
    Transfinite Curve {p + 21:p + 28} = 2;
    For i In {1:4}
      n = i == 4 ? 1 : i + 1;
      Curve Loop(p + 20 + i) = {o + i, p + 20 + n, -(p + i), -(p + 20 + i)};
      Surface(p + 20 + i) = {p + 20 + i};
      Curve Loop(p + 24 + i) = {o + 4 + i, p + 24 + n, -(p + 4 + i), -(p + 24 + i)};
      Surface(p + 24 + i) = {p + 24 + i};
      Curve Loop(p + 28 + i) = {o + 8 + i, p + 24 + i, -(p + 8 + i), -(p + 20 + i)};
      Surface(p + 28 + i) = {p + 28 + i};
    EndFor
    Transfinite Surface {p + 21:p + 32};
    Recombine Surface {p + 21:p + 32};
    For i In {1:4}
      n = i == 4 ? 1 : i + 1;
      If (i > 1 || whole)
        Surface Loop(p + i) = {o + i, p + i, p + 20 + i, p + 24 + i, p + 28 + i, p + 28 + n};
        Volume(p + i) = {p + i};
        Transfinite Volume {p + i};
        volumes[] += {p + i};
      EndIf
    EndFor
    Surface Loop(p + 5) = {o + 5, p + 5, p + 25, p + 26, p + 27, p + 28};
    Volume(p + 5) = {p + 5};
    Transfinite Volume {p + 5};
    volumes[] += {p + 5};
    planes[] += {p + 25, p + 29, p + 30};
  EndFor
  p = B + 100 * (k + 1);
  far[] = {p + 2:p + 5};
  If (whole)
    far[] += {p + 1};
  EndIf
  If (b == 0)
    Physical Volume("sphere") = {volumes[]};
    Physical Surface("cap") = {106};
    Physical Surface("far") = {far[]};
    middle[] = {planes[]};
  Else
    Physical Volume("other") = {volumes[]};
    Physical Surface("other_cap") = {B + 106};
    Physical Surface("other_far") = {far[]};
    middle[] += {planes[]};
  EndIf
EndFor
If (!whole)
  Physical Surface("middle") = {middle[]};
EndIf

// the plane
If (!pair)
  d = 4 * s;
  Point(11) = {-d, -d, -1}; Point(12) = {d, -d, -1}; Point(13) = {d, d, -1}; Point(14) = {-d, d, -1};
  Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
  Curve Loop(11) = {11:14};
  Plane Surface(11) = {11};
  Transfinite Curve {11:14} = 2;
  Transfinite Surface {11};
  Recombine Surface {11};
  out[] = Extrude {0, 0, 1} { Surface{11}; Layers{1}; Recombine; };
  Physical Volume("plane") = {out[1]};
  Physical Surface("ground") = {out[0]};
EndIf
