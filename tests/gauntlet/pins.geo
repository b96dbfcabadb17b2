// A strip over two rigid pins, a third one comes down between them; s: size of cells
DefineConstant[ s = 0.06 ];
Point(1) = {-2.2, -0.06, 0, s}; Point(2) = {1.4, -0.06, 0, s}; Point(3) = {1.4, 0.06, 0, s}; Point(4) = {-2.2, 0.06, 0, s};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
For k In {0:2}
  x = -0.7 + 0.7 * k; y = k == 1 ? 0.26 : -0.26; p = 10 + 10 * k;
  Point(p) = {x, y, 0}; Point(p + 1) = {x + 0.2, y, 0, s}; Point(p + 2) = {x, y + 0.2, 0, s}; Point(p + 3) = {x - 0.2, y, 0, s}; Point(p + 4) = {x, y - 0.2, 0, s};
  For i In {0:3}
    Circle(p + i) = {p + 1 + i, p, p + 1 + (i + 1) % 4};
  EndFor
  Curve Loop(p) = {p:p + 3}; Plane Surface(p) = {p};
EndFor
Recombine Surface {1, 10, 20, 30};
Physical Surface("strip") = {1}; Physical Surface("left") = {10}; Physical Surface("middle") = {20}; Physical Surface("right") = {30};
Physical Curve("over") = {3}; Physical Curve("under") = {1}; Physical Curve("end") = {2};
Physical Curve("pins") = {10:13, 30:33}; Physical Curve("pin") = {20:23};
