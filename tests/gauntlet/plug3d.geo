// A quarter of a tapered ring (inside a, outside b at z = 0, taper k) pressed in a tapered bore.
DefineConstant[ a = 0.25, b = 0.5, c = 0.9, h = 0.5, k = 0.2, n = 3, m = 4, q = 5, p = 4 ];
Point(1) = {a, 0, 0}; Point(2) = {b, 0, 0}; Point(3) = {b + k*h, 0, h}; Point(4) = {a, 0, h}; Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1};
Point(11) = {b - 0.3*k, 0, -0.3}; Point(12) = {c, 0, -0.3}; Point(13) = {c, 0, 0.4}; Point(14) = {b + 0.4*k, 0, 0.4}; Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11, 13} = n + 1; Transfinite Curve {12, 14} = m + 2; Transfinite Surface {2}; Recombine Surface {1, 2};
u[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi/2} { Surface{1}; Layers{q}; Recombine; };
v[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi/2} { Surface{2}; Layers{p}; Recombine; };
Physical Volume("plug") = {u[1]}; Physical Volume("hub") = {v[1]}; Physical Surface("flank") = {u[3]}; Physical Surface("bore") = {v[5]}; Physical Surface("top") = {u[4]}; Physical Surface("foot") = {v[2]};
Physical Surface("y0") = {1, 2}; Physical Surface("x0") = {u[0], v[0]};
