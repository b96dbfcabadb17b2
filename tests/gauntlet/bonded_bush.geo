// A quarter turn of a rubber ring (radii ri, ro, height h) bonded inside and outside; no metal: the bonded faces move as told.
DefineConstant[ ri = 0.5, ro = 1, h = 0.5, n = 3, m = 4, k = 2 ];
For q In {0:2}
  Point(1 + 10 * q) = {ri * Cos(q * Pi / 2), ri * Sin(q * Pi / 2), 0}; Point(2 + 10 * q) = {ro * Cos(q * Pi / 2), ro * Sin(q * Pi / 2), 0};
  Line(1 + 10 * q) = {1 + 10 * q, 2 + 10 * q};
EndFor
Point(100) = {0, 0, 0};
For q In {0:1}
  Circle(2 + 10 * q) = {1 + 10 * q, 100, 11 + 10 * q}; Circle(3 + 10 * q) = {2 + 10 * q, 100, 12 + 10 * q};
  Curve Loop(1 + q) = {1 + 10 * q, 3 + 10 * q, -(11 + 10 * q), -(2 + 10 * q)}; Plane Surface(1 + q) = {1 + q};
EndFor
Transfinite Curve {1, 11, 21} = n + 1; Transfinite Curve {2, 3, 12, 13} = m + 1; Transfinite Surface {1, 2}; Recombine Surface {1, 2};
b[] = Extrude {0, 0, h} { Surface{1, 2}; Layers{k}; Recombine; };
Physical Volume("rubber") = {b[1], b[7]};
Physical Surface("mid") = {1, 2}; Physical Surface("free") = {b[0], b[6]}; Physical Surface("outer") = {b[3], b[9]}; Physical Surface("inner") = {b[5], b[11]}; Physical Surface("cut") = {b[2], b[10]};
