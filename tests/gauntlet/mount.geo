// A block of rubber, 2 b wide and h high, between two steel plates, 2 c wide and d thick, which it is glued to.
DefineConstant[ b = 20, h = 15, c = 22, d = 5, n = 3 ];
Point(1) = {-b, 0, 0}; Point(2) = {b, 0, 0}; Point(3) = {b, h, 0}; Point(4) = {-b, h, 0};
Point(11) = {-c, -d, 0}; Point(12) = {c, -d, 0}; Point(13) = {c, 0, 0}; Point(14) = {-c, 0, 0};
Point(21) = {-c, h, 0}; Point(22) = {c, h, 0}; Point(23) = {c, h + d, 0}; Point(24) = {-c, h + d, 0};
For k In {0:2}
  For i In {1:4}
    Line(10*k + i) = {10*k + i, 10*k + i%4 + 1};
  EndFor
  Curve Loop(k + 1) = {10*k + 1:10*k + 4}; Plane Surface(k + 1) = {k + 1};
EndFor
Transfinite Curve {1, 3} = 4*n + 1; Transfinite Curve {2, 4} = 2*n + 1;
Transfinite Curve {11, 13, 21, 23} = 3*n + 1; Transfinite Curve {12, 14, 22, 24} = n + 1;
Transfinite Surface {1:3}; Recombine Surface {1:3};
Physical Surface("rubber") = {1}; Physical Surface("low") = {2}; Physical Surface("up") = {3};
Physical Curve("foot") = {1}; Physical Curve("head") = {3};
Physical Curve("low_face") = {13}; Physical Curve("up_face") = {21}; Physical Curve("base") = {11}; Physical Curve("top") = {23};
