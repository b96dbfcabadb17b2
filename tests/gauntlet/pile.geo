// Three blocks on each other; s: size of cells
DefineConstant[ s = 0.12 ];
For k In {0:2}
  w = 0.9 - 0.15 * k; p = 1 + 10 * k; y = 0.4 * k;
  Point(p) = {-w, y, 0, s * (1 + 0.3 * k)}; Point(p + 1) = {w, y, 0, s * (1 + 0.3 * k)}; Point(p + 2) = {w, y + 0.4, 0, s * (1 + 0.3 * k)}; Point(p + 3) = {-w, y + 0.4, 0, s * (1 + 0.3 * k)};
  Line(p) = {p, p + 1}; Line(p + 1) = {p + 1, p + 2}; Line(p + 2) = {p + 2, p + 3}; Line(p + 3) = {p + 3, p}; Curve Loop(p) = {p:p + 3}; Plane Surface(p) = {p};
EndFor
Recombine Surface {1, 11, 21};
Physical Surface("a") = {1}; Physical Surface("b") = {11}; Physical Surface("c") = {21};
Physical Curve("floor") = {1}; Physical Curve("atop") = {3}; Physical Curve("bunder") = {11}; Physical Curve("btop") = {13}; Physical Curve("cunder") = {21}; Physical Curve("load") = {23};
