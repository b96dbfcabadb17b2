// A cylinder of radius R along y, longer than the block is wide
DefineConstant[ R = 0.5, n = 4, m = 5 ];
Point(1) = {0, -0.6, R}; Point(2) = {R, -0.6, R}; Point(3) = {0, -0.6, 2 * R}; Point(4) = {-R, -0.6, R}; Point(5) = {0, -0.6, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = n + 1; Transfinite Surface {1}; Recombine Surface {1};
e[] = Extrude {0, 1.2, 0} { Surface{1}; Layers{3}; Recombine; };
Point(31) = {-0.8, -0.4, -0.5}; Point(32) = {0.8, -0.4, -0.5}; Point(33) = {0.8, 0.4, -0.5}; Point(34) = {-0.8, 0.4, -0.5};
Line(131) = {31, 32}; Line(132) = {32, 33}; Line(133) = {33, 34}; Line(134) = {34, 31}; Curve Loop(131) = {131:134}; Plane Surface(131) = {131};
Transfinite Curve {131, 133} = 2 * m + 1; Transfinite Curve {132, 134} = 3; Transfinite Surface {131}; Recombine Surface {131};
p[] = Extrude {0, 0, 0.5} { Surface{131}; Layers{3}; Recombine; };
Physical Volume("log") = {e[1]}; Physical Volume("bed") = {p[1]};
Physical Surface("round") = {e[2], e[3], e[4], e[5]}; Physical Surface("top") = {p[0]}; Physical Surface("bottom") = {131};
