// A rigid ring of eight cells, whose facets turn by 45 degrees each, a node at its lowest place; a block of n by n/2 cells below
DefineConstant[ n = 8 ];
Point(1) = {0, 0.5, 0};
For i In {0:3}
  Point(2 + i) = {0.5 * Sin(i * Pi / 2), 0.5 - 0.5 * Cos(i * Pi / 2), 0};
  Point(6 + i) = {0.2 * Sin(i * Pi / 2), 0.5 - 0.2 * Cos(i * Pi / 2), 0};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  Circle(1 + i) = {2 + i, 1, 2 + j};
  Circle(5 + i) = {6 + i, 1, 6 + j};
  Line(9 + i) = {2 + i, 6 + i};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  Curve Loop(1 + i) = {1 + i, 9 + j, -(5 + i), -(9 + i)};
  Plane Surface(1 + i) = {1 + i};
EndFor
Transfinite Curve {1:8} = 3; Transfinite Curve {9:12} = 2; Transfinite Surface {1:4};
Point(20) = {-1, -1, 0}; Point(21) = {1.1, -1, 0}; Point(22) = {1.1, -0.01, 0}; Point(23) = {-1, -0.01, 0};
Line(20) = {20, 21}; Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 20};
Curve Loop(20) = {20:23}; Plane Surface(20) = {20};
Transfinite Curve {20, 22} = n + 1; Transfinite Curve {21, 23} = n / 2 + 1; Transfinite Surface {20}; Recombine Surface {1:4, 20};
Physical Surface("tool") = {1:4}; Physical Surface("block") = {20};
Physical Curve("rim") = {1:4}; Physical Curve("top") = {22}; Physical Curve("base") = {20};
