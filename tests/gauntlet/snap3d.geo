// A cantilever with a tooth and a log across
DefineConstant[ n = 1 ];
Point(1) = {0, 0, -0.2}; Point(2) = {1.5, 0, -0.2}; Point(3) = {1.6, -0.15, -0.2}; Point(4) = {1.66, -0.15, -0.2}; Point(5) = {1.8, 0, -0.2}; Point(6) = {1.8, 0.12, -0.2}; Point(7) = {1.5, 0.12, -0.2}; Point(8) = {0, 0.12, -0.2};
Line(1) = {1, 2}; Line(2) = {2, 7}; Line(3) = {7, 8}; Line(4) = {8, 1}; Line(5) = {2, 3}; Line(6) = {3, 4}; Line(7) = {4, 5}; Line(8) = {5, 2}; Line(9) = {5, 6}; Line(10) = {6, 7};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Curve Loop(2) = {5:8}; Plane Surface(2) = {2}; Curve Loop(3) = {-8, 9, 10, -2}; Plane Surface(3) = {3};
Transfinite Curve {1, 3} = 10*n + 1; Transfinite Curve {2, 4, 9, 5, 7} = n + 1; Transfinite Curve {6, 8, 10} = 2*n + 1; Transfinite Surface {1:3}; Recombine Surface {1:3};
e[] = Extrude {0, 0, 0.4} { Surface{1:3}; Layers{3*n}; Recombine; };
Point(501) = {2.0, -0.3, -0.5}; Point(502) = {2.2, -0.3, -0.5}; Point(503) = {2.0, -0.1, -0.5}; Point(504) = {1.8, -0.3, -0.5}; Point(505) = {2.0, -0.5, -0.5};
Circle(501) = {502, 501, 503}; Circle(502) = {503, 501, 504}; Circle(503) = {504, 501, 505}; Circle(504) = {505, 501, 502}; Curve Loop(501) = {501:504}; Plane Surface(501) = {501}; Transfinite Curve {501:504} = 5; Transfinite Surface {501}; Recombine Surface {501};
Rotate {{0, 1, 0}, {2, 0, 0}, Pi / 12} { Surface{501}; }
w[] = Extrude {Sin(Pi/12), 0, Cos(Pi/12)} { Surface{501}; Layers{4}; Recombine; };
Physical Volume("beam") = {e[1], e[7], e[13]};
Physical Surface("tooth") = {e[2], e[8], e[9], e[10]};
Physical Surface("root") = {e[5]};
Physical Volume("log") = {w[1]};
Physical Surface("round") = {w[2], w[3], w[4], w[5]};
