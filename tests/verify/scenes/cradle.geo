// A disc in a valley of 90 degrees, below a plate; half: its right half alone. The middle of the disc's underside is over the corner of the valley, a node.
DefineConstant[ half = 0 ];
c = Sqrt(0.5); r = 0.5; d = 0.28284; n = half ? 4 : 8;
Point(100) = {0, c, 0};
For k In {0:half ? n : n - 1}
  a = (k - 2) * Pi / 4; i = k % 2 ? d : r / 2;
  Point(1 + k) = {r * Cos(a), c + r * Sin(a), 0}; Point(11 + k) = {i * Cos(a), c + i * Sin(a), 0};
  Line(31 + k) = {11 + k, 1 + k};
  If (k % 2 == 0) Line(51 + k) = {100, 11 + k}; EndIf
EndFor
For k In {0:n - 1}
  l = half ? k + 1 : (k + 1) % n;
  Circle(1 + k) = {1 + k, 100, 1 + l}; Line(11 + k) = {11 + k, 11 + l};
  Curve Loop(1 + k) = {31 + k, 1 + k, -(31 + l), -(11 + k)}; Plane Surface(1 + k) = {1 + k};
EndFor
For k In {0:n - 2:2}
  l = half ? k + 2 : (k + 2) % n;
  Curve Loop(21 + k) = {51 + k, 11 + k, 12 + k, -(51 + l)}; Plane Surface(21 + k) = {21 + k};
EndFor
Transfinite Curve {1:n} = 4; Transfinite Curve {11:10 + n} = 4; Transfinite Curve {31:30 + n + half} = 4; Transfinite Curve {51:50 + n + half:2} = 4;
// the valley, two blocks below its faces, and the plate
Point(201) = {0, 0, 0}; Point(202) = {0.9, 0.9, 0}; Point(203) = {1.1, 0.7, 0}; Point(204) = {0, -0.4, 0}; Point(205) = {-1.1, 0.7, 0}; Point(206) = {-0.9, 0.9, 0};
Line(201) = {204, 203}; Line(202) = {203, 202}; Line(203) = {202, 201}; Line(204) = {201, 204};
Curve Loop(201) = {201, 202, 203, 204}; Plane Surface(201) = {201};
h = half ? 0 : -0.7; y = c + r;
Point(211) = {h, y, 0}; Point(212) = {0.7, y, 0}; Point(213) = {0.7, y + 0.2, 0}; Point(214) = {h, y + 0.2, 0};
Line(211) = {211, 212}; Line(212) = {212, 213}; Line(213) = {213, 214}; Line(214) = {214, 211};
Curve Loop(211) = {211:214}; Plane Surface(211) = {211};
Transfinite Curve {201, 203} = 7; Transfinite Curve {202, 204, 212, 214} = 2; Transfinite Curve {211, 213} = 6;
Physical Surface("disc") = {1:n, 21:20 + n:2}; Physical Curve("rim") = {1:n}; Physical Surface("plate") = {211}; Physical Curve("under") = {211};
If (half)
  Physical Surface("valley") = {201}; Physical Curve("faces") = {203}; Physical Curve("middle") = {31, 51, 51 + n, 31 + n};
Else
  Line(205) = {206, 205}; Line(206) = {205, 204}; Line(207) = {201, 206};
  Curve Loop(202) = {205, 206, -204, 207}; Plane Surface(202) = {202};
  Transfinite Curve {206, 207} = 7; Transfinite Curve {205} = 2;
  Physical Surface("valley") = {201, 202}; Physical Curve("faces") = {203, 207};
EndIf
Transfinite Surface "*"; Recombine Surface "*";
