// Bolt and nut with a metric thread (60 degrees, flat crests), as rings round the axis; x is the radius.
DefineConstant[
  teeth = 3,    // of the nut
  more = 2,     // of the bolt beyond it, at either end
  gap = 0.01,   // between flanks, normal to them; negative: they overlap
  size = 0.25   // cells along the thread
];
pitch = 1.5;  H = pitch * Sqrt(3) / 2;  rp = 5 - 3 * H / 8;  t30 = Tan(Pi / 6);
rc = 5;  rr = rp - H / 4;                              // bolt: crest, root
nc = rr + 0.1;  nr = rc + 0.1;  s = gap / Cos(Pi / 6); // nut: crest, root; its flanks are set back along the axis
L = teeth * pitch;  R = 8;  down = -more * pitch - 4;  up = L + more * pitch + 1;
// bolt: up along the thread and back along the axis
Point(1) = {0, down, 0};  Point(2) = {rr, down, 0};  p = 3;
w = pitch / 4 + (rp - rr) * t30;  v = pitch / 4 - (rc - rp) * t30;
For k In {-more:teeth + more - 1}
  y = (k + 0.5) * pitch;
  Point(p) = {rr, y - w, 0};  Point(p + 1) = {rc, y - v, 0};  Point(p + 2) = {rc, y + v, 0};  Point(p + 3) = {rr, y + w, 0};  p += 4;
EndFor
Point(p) = {rr, up, 0};  Point(p + 1) = {0, up, 0};  top = p;
For k In {1:p}
  Line(k) = {k, k + 1};
EndFor
Line(p + 1) = {p + 1, 1};
Curve Loop(1) = {1:p + 1};  Plane Surface(1) = {1};
// nut: up outside and down along the thread
q = p + 2;  p = q;
Point(p) = {nc, 0, 0};  Point(p + 1) = {R, 0, 0};  Point(p + 2) = {R, L, 0};  Point(p + 3) = {nc, L, 0};  p += 4;
w = pitch / 4 + (rp - nc) * t30 + s;  v = pitch / 4 - (nr - rp) * t30 + s;
For k In {teeth - 1:0:-1}
  y = (k + 0.5) * pitch;
  Point(p) = {nc, y + w, 0};  Point(p + 1) = {nr, y + v, 0};  Point(p + 2) = {nr, y - v, 0};  Point(p + 3) = {nc, y - w, 0};  p += 4;
EndFor
For k In {q:p - 2}
  Line(k) = {k, k + 1};
EndFor
Line(p - 1) = {p - 1, q};
Curve Loop(2) = {q:p - 1};  Plane Surface(2) = {2};
MeshSize {:} = size;  MeshSize {2, top, q + 1, q + 2} = 1;  MeshSize {1, top + 1} = 1.5;
Physical Surface("bolt") = {1};
Physical Surface("nut") = {2};
Physical Curve("axis") = {top + 1};
Physical Curve("shank") = {1};
Physical Curve("bearing") = {q};
Physical Curve("bolt_thread") = {3:top - 2};
Physical Curve("nut_thread") = {q + 3:p - 1};
