// Unit cube of n x n x n hexahedra.
DefineConstant[ n = 2 ];
Point(1) = {0, 0, 0};  Point(2) = {1, 0, 0};  Point(3) = {1, 1, 0};  Point(4) = {0, 1, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Transfinite Curve {1:4} = n + 1;
Transfinite Surface {1};
Recombine Surface {1};
top[] = Extrude {0, 0, 1} { Surface{1}; Layers{n}; Recombine; };
Physical Volume("cube") = {top[1]};
Physical Surface("y0") = {top[2]};
Physical Surface("x1") = {top[3]};
Physical Surface("y1") = {top[4]};
Physical Surface("x0") = {top[5]};
