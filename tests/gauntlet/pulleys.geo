// A belt of thickness 0.02 round two pulleys of radius 0.4, 1.2 apart; n, k: cells to a quarter of the belt and of the pulleys, whose nodes match where they are equal
DefineConstant[ n = 10, k = 10 ];
R = 0.4; t = 0.02; L = 1.2;
Point(1) = {0, 0, 0}; Point(2) = {L, 0, 0};
Point(11) = {0, R, 0}; Point(12) = {-R, 0, 0}; Point(13) = {0, -R, 0}; Point(14) = {L, -R, 0}; Point(15) = {L + R, 0, 0}; Point(16) = {L, R, 0};
q = R + t;
Point(21) = {0, q, 0}; Point(22) = {-q, 0, 0}; Point(23) = {0, -q, 0}; Point(24) = {L, -q, 0}; Point(25) = {L + q, 0, 0}; Point(26) = {L, q, 0};
Circle(11) = {11, 1, 12}; Circle(12) = {12, 1, 13}; Line(13) = {13, 14}; Circle(14) = {14, 2, 15}; Circle(15) = {15, 2, 16}; Line(16) = {16, 11};
Circle(21) = {21, 1, 22}; Circle(22) = {22, 1, 23}; Line(23) = {23, 24}; Circle(24) = {24, 2, 25}; Circle(25) = {25, 2, 26}; Line(26) = {26, 21};
For i In {1 : 6}
  Line(30 + i) = {10 + i, 20 + i};
EndFor
For i In {1 : 6}
  j = i % 6 + 1;
  Curve Loop(i) = {10 + i, 30 + j, -(20 + i), -(30 + i)}; Plane Surface(i) = {i}; Transfinite Curve {30 + i} = 2;
EndFor
Transfinite Curve {11, 12, 14, 15, 21, 22, 24, 25} = n + 1; Transfinite Curve {13, 16, 23, 26} = 20; Transfinite Surface {1:6}; Recombine Surface {1:6};
Point(31) = {0, R, 0}; Point(32) = {-R, 0, 0}; Point(33) = {0, -R, 0}; Point(34) = {R, 0, 0};
Circle(41) = {31, 1, 32}; Circle(42) = {32, 1, 33}; Circle(43) = {33, 1, 34}; Circle(44) = {34, 1, 31}; Curve Loop(41) = {41:44}; Plane Surface(41) = {41};
Point(41) = {L, R, 0}; Point(42) = {L - R, 0, 0}; Point(43) = {L, -R, 0}; Point(44) = {L + R, 0, 0};
Circle(51) = {41, 2, 42}; Circle(52) = {42, 2, 43}; Circle(53) = {43, 2, 44}; Circle(54) = {44, 2, 41}; Curve Loop(51) = {51:54}; Plane Surface(51) = {51};
Transfinite Curve {41:44, 51:54} = k + 1; Recombine Surface {41, 51};
Physical Surface("belt") = {1:6}; Physical Surface("driver") = {41}; Physical Surface("driven") = {51};
Physical Curve("inner") = {11:16}; Physical Curve("rim_left") = {41:44}; Physical Curve("rim_right") = {51:54};
