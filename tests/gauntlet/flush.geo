// Two squares one above the other, sides 1, a gap of g between them; n and m cells a side, below and above.
DefineConstant[ g = 0, n = 4, m = 4 ];
Macro Square
  Point(b+1) = {0, y, 0}; Point(b+2) = {1, y, 0}; Point(b+3) = {1, y + 1, 0}; Point(b+4) = {0, y + 1, 0};
  For i In {1:4}
    Line(b+i) = {b+i, b+i%4+1};
  EndFor
  Transfinite Curve{b+1:b+4} = k + 1;
  Curve Loop(b) = {b+1:b+4}; Plane Surface(b) = {b}; Transfinite Surface{b}; Recombine Surface{b};
Return
b = 10; y = 0; k = n; Call Square;
b = 20; y = 1 + g; k = m; Call Square;
Physical Surface("lower") = {10}; Physical Surface("upper") = {20};
Physical Curve("bottom") = {11}; Physical Curve("top") = {23}; Physical Curve("face") = {13}; Physical Curve("under") = {21}; Physical Curve("left") = {14, 24};
