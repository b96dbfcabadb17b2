// A wheel (ring) on a bar narrower than it
DefineConstant[ s = 0.14 ];
R = 0.5; For i In {0:1}
 r = i == 0 ? 0.5 : 0.3; b = 10 * i;
 Point(b + 5) = {0, -0.25, R + 0.001}; Point(b + 1) = {r, -0.25, R + 0.001}; Point(b + 2) = {0, -0.25, R + 0.001 + r}; Point(b + 3) = {-r, -0.25, R + 0.001}; Point(b + 4) = {0, -0.25, R + 0.001 - r};
 For j In {1:4}
  Circle(b + j) = {b + j, b + 5, b + j % 4 + 1};
 EndFor
EndFor
For j In {1:4}
 Line(20 + j) = {j, 10 + j};
EndFor
For j In {1:4}
 Curve Loop(30 + j) = {j, 20 + j % 4 + 1, -(10 + j), -(20 + j)}; Plane Surface(30 + j) = {30 + j};
EndFor
Transfinite Curve {1:4, 11:14} = 6; Transfinite Curve {21:24} = 3; Transfinite Surface {31:34}; Recombine Surface {31:34};
e[] = Extrude {0, 0.5, 0} { Surface{31:34}; Layers{4}; Recombine; };
Point(501) = {-0.8, -0.13, -0.4}; Point(502) = {0.5, -0.13, -0.4}; Point(503) = {0.5, 0.12, -0.4}; Point(504) = {-0.8, 0.12, -0.4};
Line(501) = {501, 502}; Line(502) = {502, 503}; Line(503) = {503, 504}; Line(504) = {504, 501}; Curve Loop(501) = {501:504}; Plane Surface(501) = {501};
Transfinite Curve {501, 503} = 9 + 1; Transfinite Curve {502, 504} = 2 + 1; Transfinite Surface {501}; Recombine Surface {501};
k500[] = Extrude {0, 0, 0.4} { Surface{501}; Layers{3}; Recombine; };
Physical Volume("wheel") = {e[1], e[7], e[13], e[19]};
Physical Surface("tread") = {e[2], e[8], e[14], e[20]};
Physical Surface("hub") = {e[4], e[10], e[16], e[22]};
Physical Volume("bar") = {k500[1]};
Physical Surface("foot") = {501};
Physical Surface("rail") = {k500[0], k500[2], k500[3], k500[4], k500[5]};
