// Two combs that interlock: fingers 1 wide, 4 long, gaps `gap`; the left comb goes on by three fingers at either end. Plane strain.
DefineConstant[ gap = 0.05, size = 0.5 ];
Macro Finger // from x = xa to xb and back, y = ya and yb
  Point(p) = {xa, ya, 0, size};  Point(p + 1) = {xb, ya, 0, size};  Point(p + 2) = {xb, yb, 0, size};  Point(p + 3) = {xa, yb, 0, size};  p += 4;
Return
p = 1;
Point(p) = {-1, -7, 0, size};  Point(p + 1) = {0, -7, 0, size};  p += 2;
xa = 0;  xb = 4;
For k In {-3:5}
  ya = 2 * k;  yb = 2 * k + 1;  Call Finger;
EndFor
Point(p) = {0, 12, 0, size};  Point(p + 1) = {-1, 12, 0, size};  p += 2;
n = p - 1;
For k In {1:n - 1}
  Line(k) = {k, k + 1};
EndFor
Line(n) = {n, 1};
Curve Loop(1) = {1:n};  Plane Surface(1) = {1};
q = p;
Point(p) = {5 + gap, 6.5, 0, size};  Point(p + 1) = {4 + gap, 6.5, 0, size};  p += 2;
xa = 4 + gap;  xb = gap;
For k In {2:-1:-1}
  ya = 2 * k + 2 - gap;  yb = 2 * k + 1 + gap;  Call Finger;
EndFor
Point(p) = {4 + gap, -1.5, 0, size};  Point(p + 1) = {5 + gap, -1.5, 0, size};  p += 2;
For k In {q:p - 2}
  Line(k) = {k, k + 1};
EndFor
Line(p - 1) = {p - 1, q};
Curve Loop(2) = {q:p - 1};  Plane Surface(2) = {2};
Physical Surface("left") = {1};
Physical Surface("right") = {2};
Physical Curve("left_teeth") = {3:n - 3};
Physical Curve("left_back") = {n};
Physical Curve("right_teeth") = {q + 2:p - 4};
Physical Curve("right_back") = {p - 1};
