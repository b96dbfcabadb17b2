// Pin in a lug, a quarter: y >= 0 and z >= 0. The pin, radius a, touches the bore, radius b, at x = -b... lug is pulled to +x.
SetFactory("Built-in");
DefineConstant[ n = 3, c = 0.1, g = 1e-6 ];
a = 5; b = a + c + g; W = 10; L = 25; T = 4; P = 8;
// lug: bore centre at origin; pin centre shifted to touch the bore at x = -b: pin at x = -c
s = Sqrt(0.5);
Point(1) = {0, 0, 0};
Point(2) = {b, 0, 0}; Point(3) = {b * s, b * s, 0}; Point(4) = {-b * s, b * s, 0}; Point(5) = {-b, 0, 0};
Point(6) = {W, 0, 0}; Point(7) = {W, W, 0}; Point(8) = {-W * s, W * s, 0}; Point(9) = {-W, 0, 0}; Point(10) = {0, W, 0}; Point(13) = {0, b, 0};
Point(11) = {L, 0, 0}; Point(12) = {L, W, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 13}; Circle(3) = {13, 1, 4}; Circle(4) = {4, 1, 5};
Line(5) = {2, 6}; Line(6) = {3, 7}; Line(7) = {13, 10}; Line(8) = {4, 8}; Line(9) = {5, 9};
Line(10) = {6, 7}; Line(11) = {7, 10}; Circle(12) = {10, 1, 8}; Circle(13) = {8, 1, 9};
Line(14) = {6, 11}; Line(15) = {11, 12}; Line(16) = {12, 7};
Curve Loop(1) = {5, 10, -6, -1}; Plane Surface(1) = {1};
Curve Loop(2) = {6, 11, -7, -2}; Plane Surface(2) = {2};
Curve Loop(3) = {7, 12, -8, -3}; Plane Surface(3) = {3};
Curve Loop(4) = {8, 13, -9, -4}; Plane Surface(4) = {4};
Curve Loop(5) = {14, 15, 16, -10}; Plane Surface(5) = {5};
Transfinite Curve {1:4, 10:13, 15} = n + 1;
Transfinite Curve {5:9} = n + 1;
Transfinite Curve {14, 16} = n + 1;
Transfinite Surface {1:5};
Recombine Surface {1:5};
// pin
Point(101) = {-c, 0, 0}; Point(102) = {a - c, 0, 0}; Point(103) = {a * s - c, a * s, 0}; Point(104) = {-c, a, 0}; Point(105) = {-a * s - c, a * s, 0}; Point(106) = {-a - c, 0, 0};
Point(107) = {0.5 * a - c, 0, 0}; Point(108) = {0.42 * a - c, 0.42 * a, 0}; Point(109) = {-c, 0.5 * a, 0}; Point(110) = {-0.42 * a - c, 0.42 * a, 0}; Point(111) = {-0.5 * a - c, 0, 0};
Circle(101) = {102, 101, 103}; Circle(102) = {103, 101, 104}; Circle(103) = {104, 101, 105}; Circle(104) = {105, 101, 106};
Line(105) = {107, 108}; Line(106) = {108, 109}; Line(107) = {109, 110}; Line(108) = {110, 111};
Line(109) = {102, 107}; Line(110) = {103, 108}; Line(111) = {104, 109}; Line(112) = {105, 110}; Line(113) = {106, 111};
Line(114) = {101, 107}; Line(115) = {101, 109}; Line(116) = {101, 111};
Curve Loop(101) = {101, 110, -105, -109}; Plane Surface(101) = {101};
Curve Loop(102) = {102, 111, -106, -110}; Plane Surface(102) = {102};
Curve Loop(103) = {103, 112, -107, -111}; Plane Surface(103) = {103};
Curve Loop(104) = {104, 113, -108, -112}; Plane Surface(104) = {104};
Curve Loop(105) = {114, 105, 106, -115}; Plane Surface(105) = {105};
Curve Loop(106) = {115, 107, 108, -116}; Plane Surface(106) = {106};
Transfinite Curve {101:108, 114:116} = 2 + 1;
Transfinite Curve {109:113} = 1 + 1;
Transfinite Surface {101:106};
Recombine Surface {101:106};
lug[] = {};
For k In {1:5}
  e[] = Extrude {0, 0, T} { Surface{k}; Layers{2}; Recombine; };
  lug[] += e[1];
  If (k <= 4)
    bore[] += e[5];
  EndIf
  If (k == 5)
    tip = e[3];
  EndIf
  If (k == 1)
    sy[] += e[2];
  EndIf
  If (k == 4)
    sy[] += e[4];
  EndIf
  If (k == 5)
    sy[] += e[2];
  EndIf
EndFor
For k In {101:106}
  e[] = Extrude {0, 0, P} { Surface{k}; Layers{4}; Recombine; };
  pin[] += e[1];
  top[] += e[0];
  If (k <= 104)
    skin[] += e[2];
  EndIf
  If (k == 101)
    py[] += e[5];
  EndIf
  If (k == 104)
    py[] += e[3];
  EndIf
  If (k == 105)
    py[] += e[2];
  EndIf
  If (k == 106)
    py[] += e[5];
  EndIf
EndFor
Physical Volume("lug") = {lug[]};
Physical Volume("pin") = {pin[]};
Physical Surface("bore") = {bore[]};
Physical Surface("skin") = {skin[]};
Physical Surface("pulled") = {tip};
Physical Surface("pin_end") = {top[]};
Physical Surface("plane_y") = {sy[], py[]};
Physical Surface("plane_z") = {1:5, 101:106};
