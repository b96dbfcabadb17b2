// A plate of k cells over a block of n cells, both of length 1; the plate's mesh is finer.
DefineConstant[ n = 2, k = 7 ];
For i In {0:1}
  y = i;
  p = 10 * i;
  Point(p+1) = {0, y, 0}; Point(p+2) = {1, y, 0}; Point(p+3) = {1, y + 1, 0}; Point(p+4) = {0, y + 1, 0};
  Line(p+1) = {p+1, p+2}; Line(p+2) = {p+2, p+3}; Line(p+3) = {p+3, p+4}; Line(p+4) = {p+4, p+1};
  Curve Loop(p+1) = {p+1, p+2, p+3, p+4}; Plane Surface(p+1) = {p+1};
EndFor
Geometry.AutoCoherence = 0;
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = n + 1; Transfinite Curve {11, 13} = k + 1; Transfinite Curve {12, 14} = 2;
Transfinite Surface {1, 11}; Recombine Surface {1, 11};
Physical Surface("block") = {1}; Physical Surface("plate") = {11};
Physical Curve("bottom") = {1}; Physical Curve("sides") = {2, 4}; Physical Curve("top") = {3}; Physical Curve("under") = {11}; Physical Curve("walls") = {12, 14}; Physical Curve("head") = {13};
