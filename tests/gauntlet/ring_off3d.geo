// A quarter of a ring and of a shaft with a sharp end
DefineConstant[ n = 4 ];
Point(1) = {0.99, 0, 0}; Point(2) = {1.3, 0, 0}; Point(3) = {1.3, 0, 0.4}; Point(4) = {0.99, 0, 0.4}; Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {0.7, 0, -0.3}; Point(12) = {1.02, 0, -0.3}; Point(13) = {1.02, 0, 0.55}; Point(14) = {0.7, 0, 0.55}; Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {1, 3} = 3; Transfinite Curve {2, 4} = 4; Transfinite Curve {11, 13} = 3; Transfinite Curve {12, 14} = 7; Transfinite Surface {1, 2}; Recombine Surface {1, 2};
u[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi/2} { Surface{1}; Layers{n}; Recombine; };
v[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi/2} { Surface{2}; Layers{n + 1}; Recombine; };
Physical Volume("ring") = {u[1]};
Physical Volume("shaft") = {v[1]};
Physical Surface("bore") = {u[5]};
Physical Surface("pull") = {u[3]};
Physical Surface("hull") = {v[3], v[4]};
Physical Surface("foot") = {v[2]};
Physical Surface("core") = {v[5]};
Physical Surface("y0") = {1, 2};
Physical Surface("x0") = {u[0], v[0]};
