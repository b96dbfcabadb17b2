// A bar of square section on its edge, which is cut off, in a groove of 90 degrees; n: cells across the bar
DefineConstant[ n = 2, m = 3, L = 1 ];
h = Sqrt(0.5); e = 0.1; b = 0.5; a = b * h;
// section in x and z: sides along (1, 1) and (-1, 1); the edge below is cut at e along both sides
Point(1) = {e * h, 0, e * h}; Point(2) = {a, 0, a}; Point(3) = {0, 0, 2 * a}; Point(4) = {-a, 0, a}; Point(5) = {-e * h, 0, e * h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Line(6) = {3, 5}; // two quadrilaterals
Point(6) = {0, 0, e * h}; 
Delete { Line{5, 6}; }
Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {6, 3};
Curve Loop(1) = {6, 1, 2, -7}; Plane Surface(1) = {1}; Curve Loop(2) = {5, 7, 3, 4}; Plane Surface(2) = {2};
Transfinite Curve {1, 7, 3} = n + 1; Transfinite Curve {4} = n + 1; Transfinite Curve {2} = n + 1; Transfinite Curve {5, 6} = n + 1; Transfinite Surface {1}; Transfinite Surface {2}; Recombine Surface {1, 2};
// the groove: two slabs beside each other
y = -0.3; 
Point(21) = {0.02, y, 0.02}; Point(22) = {0.5, y, 0.5}; Point(23) = {0.7, y, 0.3}; Point(24) = {0.22, y, -0.18};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(21) = {21:24}; Plane Surface(21) = {21};
Point(31) = {-0.02, y, 0.02}; Point(32) = {-0.5, y, 0.5}; Point(33) = {-0.7, y, 0.3}; Point(34) = {-0.22, y, -0.18};
Line(31) = {31, 32}; Line(32) = {32, 33}; Line(33) = {33, 34}; Line(34) = {34, 31}; Curve Loop(31) = {31:34}; Plane Surface(31) = {31};
Transfinite Curve {21, 23, 31, 33} = 5; Transfinite Curve {22, 24, 32, 34} = 2; Transfinite Surface {21}; Transfinite Surface {31}; Recombine Surface {21, 31};
v[] = Extrude {0, L, 0} { Surface{1}; Layers{m}; Recombine; };
u[] = Extrude {0, L, 0} { Surface{2}; Layers{m}; Recombine; };
p[] = Extrude {0, L + 0.6, 0} { Surface{21}; Layers{4}; Recombine; };
q[] = Extrude {0, L + 0.6, 0} { Surface{31}; Layers{4}; Recombine; };
Physical Volume("bar") = {v[1], u[1]}; Physical Volume("groove") = {p[1], q[1]};
Physical Surface("flanks") = {v[3], u[5]}; Physical Surface("end") = {v[0], u[0]};
Physical Surface("faces") = {p[2], q[2]}; Physical Surface("backs") = {p[4], q[4]};
