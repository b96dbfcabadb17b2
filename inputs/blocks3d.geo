// Two unit cubes on each other with divisions that do not match: lower [0,1]^3, upper [0,1]^2 x [1,2].
DefineConstant[
  n1 = 2, // cells along the sides of the lower block's top
  n2 = 3, // of the upper block's bottom
  m = 2   // over the height of each block
];
For b In {0:1} // numbers of block 1 are 100 larger; no extrusion: it would join the two faces
  t = 100 * b;
  For h In {0:1}
    Point(t + 1 + 4 * h) = {0, 0, b + h};  Point(t + 2 + 4 * h) = {1, 0, b + h};
    Point(t + 3 + 4 * h) = {1, 1, b + h};  Point(t + 4 + 4 * h) = {0, 1, b + h};
    For i In {1:4}
      Line(t + i + 4 * h) = {t + i + 4 * h, t + i % 4 + 1 + 4 * h};
    EndFor
    Curve Loop(t + 1 + h) = {t + 1 + 4 * h, t + 2 + 4 * h, t + 3 + 4 * h, t + 4 + 4 * h};
    Plane Surface(t + 1 + h) = {t + 1 + h};
  EndFor
  For i In {1:4}
    Line(t + 8 + i) = {t + i, t + 4 + i};
  EndFor
  For i In {1:4}
    Curve Loop(t + 2 + i) = {t + i, t + 9 + i % 4, -(t + 4 + i), -(t + 8 + i)};
    Plane Surface(t + 2 + i) = {t + 2 + i};
  EndFor
  Surface Loop(b + 1) = {t + 1, t + 2, t + 3, t + 4, t + 5, t + 6};
  Volume(b + 1) = {b + 1};
  Transfinite Curve {(t + 1):(t + 8)} = (b == 0 ? n1 : n2) + 1;
  Transfinite Curve {(t + 9):(t + 12)} = m + 1;
  Transfinite Surface {(t + 1):(t + 6)};
  Recombine Surface {(t + 1):(t + 6)};
  Transfinite Volume {b + 1};
EndFor
Physical Volume("lower") = {1};
Physical Volume("upper") = {2};
Physical Surface("bottom") = {1};
Physical Surface("lower_top") = {2};
Physical Surface("upper_bottom") = {101};
Physical Surface("top") = {102};
Physical Surface("y0") = {3, 103};
Physical Surface("x1") = {4, 104};
Physical Surface("y1") = {5, 105};
Physical Surface("x0") = {6, 106};
