// Quarter of the rubber cylinder of sphere.geo (radius 5, height 5, top at z = 0) and of a rigid sphere of radius 1 whose lowest point touches the origin.
DefineConstant[
  n = 2, // cells along half the core of the cylinder and along the blocks around it; 2n over its height
  s = 20 // facets of the sphere along 60 degrees
];
R = 5; w = 2.5; t = R * Sqrt(0.5); b = 0.85 * w;
Point(1) = {0, 0, 0};  Point(2) = {w, 0, 0};  Point(3) = {b, b, 0};  Point(4) = {0, w, 0};
Point(5) = {R, 0, 0};  Point(6) = {t, t, 0};  Point(7) = {0, R, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Line(5) = {2, 5};  Line(6) = {3, 6};  Line(7) = {4, 7};  Circle(8) = {5, 1, 6};  Circle(9) = {6, 1, 7};
Curve Loop(1) = {1, 2, 3, 4};    Plane Surface(1) = {1};
Curve Loop(2) = {5, 8, -6, -2};  Plane Surface(2) = {2};
Curve Loop(3) = {6, 9, -7, -3};  Plane Surface(3) = {3};
Transfinite Curve {1:9} = n + 1;
Transfinite Surface {1:3};
Recombine Surface {1:3};
e[] = Extrude {0, 0, -R} { Surface{1:3}; Layers{2 * n}; Recombine; };

// Shell of the sphere up to 60 degrees and more from its lowest point, 0.1 thick.
c = Sin(Pi / 3); q = Sin(Pi / 2.7) * Sqrt(0.5);
For h In {0:1} // outside, inside
  g = 100 + 10 * h; r = 1 - 0.1 * h;
  Point(g) = {0, 0, 1};
  Point(g + 1) = {0, 0, 1 - r};          Point(g + 2) = {c * r, 0, 1 - 0.5 * r};
  Point(g + 3) = {q * r, q * r, 1 - Cos(Pi / 2.7) * r};  Point(g + 4) = {0, c * r, 1 - 0.5 * r};
  For i In {1:4}
    Circle(g + i) = {g + i, g, g + i % 4 + 1};
  EndFor
  Curve Loop(g) = {(g + 1):(g + 4)};
  Surface(g) = {g} In Sphere {g};
EndFor
For i In {1:4}
  Line(120 + i) = {100 + i, 110 + i};
EndFor
For i In {1:4}
  Curve Loop(120 + i) = {100 + i, 120 + i % 4 + 1, -(110 + i), -(120 + i)};
  Surface(120 + i) = {120 + i};
EndFor
Surface Loop(100) = {100, 110, 121:124};
Volume(100) = {100};
Transfinite Curve {101:104, 111:114} = s + 1;
Transfinite Curve {121:124} = 2;
Transfinite Surface {100, 110, 121:124};
Recombine Surface {100, 110, 121:124};
Transfinite Volume {100};

Physical Volume("rubber")   = {e[1], e[7], e[13]};
Physical Volume("sphere")   = {100};
Physical Surface("surface") = {1:3};
Physical Surface("ball")    = {100};
Physical Surface("bottom")  = {e[0], e[6], e[12]};
Physical Surface("plane_x") = {e[5], e[16]};
Physical Surface("plane_y") = {e[2], e[8]};
