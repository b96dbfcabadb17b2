DefineConstant[ R = 20 ];
Macro Tube
  Point(b+1) = {r, 0, 0}; Point(b+2) = {s, 0, 0}; Point(b+3) = {s, h, 0}; Point(b+4) = {r, h, 0};
  For i In {1:4}
    Line(b+i) = {b+i, b+i%4+1};
  EndFor
  Transfinite Curve{b+1, b+3} = n+1; Transfinite Curve{b+2, b+4} = m+1;
  Curve Loop(b) = {b+1:b+4}; Plane Surface(b) = {b}; Transfinite Surface{b}; Recombine Surface{b};
Return
b = 10; r = R/2; s = R; h = 4; n = 1; m = 3; Call Tube;
b = 20; r = 20; s = 40; n = 6; m = 2; Call Tube;
Physical Surface("shaft") = {10}; Physical Surface("hub") = {20};
Physical Curve("skin") = {12}; Physical Curve("bore") = {24}; Physical Curve("ends") = {21, 23};
