// Quarter of a punch (radius 50, height 100, edge rounded by a radius of 10) on a foundation (radius 100, height 200), axis x = y = 0.
// Hexahedra: rings swept around the axis, three prisms of squares inside them. The foundation's top is at z = -gap: gmsh would
// join the bodies in the origin (it takes points closer than 1e-8 of the model's size for one).
DefineConstant[
  n = 1, // cells along the rounded edge, halved
  k = 2, // cells around, in each 45 degrees
  gap = 1e-5
];
s = 10 * Sqrt(0.5);
r = 20; // of the prisms

// Section of the punch outside the prisms, plane y = 0.
Point(1) = {r, 0, 0};    Point(2) = {40, 0, 0};    Point(3) = {40, 0, 10};  Point(4) = {40 + s, 0, 10 - s};
Point(5) = {50, 0, 10};  Point(6) = {50, 0, 100};  Point(7) = {32, 0, 100}; Point(8) = {r, 0, 100};
Point(9) = {r, 0, 25};   Point(10) = {32, 0, 25};
Line(1) = {1, 2};  Circle(2) = {2, 3, 4};  Circle(3) = {4, 3, 5};  Line(4) = {5, 6};  Line(5) = {6, 7};  Line(6) = {7, 8};
Line(7) = {8, 9};  Line(8) = {9, 1};       Line(9) = {9, 10};      Line(10) = {10, 4};  Line(11) = {10, 7};
Curve Loop(1) = {1, 2, -10, -9, 8};   Plane Surface(1) = {1};
Curve Loop(2) = {3, 4, 5, -11, 10};   Plane Surface(2) = {2};
Curve Loop(3) = {9, 11, 6, 7};        Plane Surface(3) = {3};
Transfinite Curve {1} = n + 1;
Transfinite Curve {2, 3} = n + 1;
Transfinite Curve {6, 9} = 2 * n + 1;
Transfinite Curve {4} = 2 * n + 1;
Transfinite Curve {7, 11} = 3 * n + 1;
Transfinite Curve {5, 8, 10} = n + 1;
Transfinite Surface {1} = {1, 4, 10, 9};
Transfinite Surface {2} = {4, 6, 7, 10};
Transfinite Surface {3};
Recombine Surface {1:3};
// Rings: two turns of 45 degrees. Lists of an extrusion: far face, volume, sides in the order of the section's curves, surface by surface.
a[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 4} { Surface{1:3}; Layers{k}; Recombine; };
b[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 4} { Surface{a[0], a[7], a[14]}; Layers{k}; Recombine; };

// Section of the prisms, plane z = 0: core and two blocks.
Macro Section // core of width w, radius R, at height Z; numbers from q on; N, M cells
  t = R * Sqrt(0.5);
  Point(q) = {0, 0, Z};         Point(q + 1) = {w, 0, Z};   Point(q + 2) = {0.85 * w, 0.85 * w, Z}; Point(q + 3) = {0, w, Z};
  Point(q + 4) = {R, 0, Z};     Point(q + 5) = {t, t, Z};   Point(q + 6) = {0, R, Z};
  Line(q) = {q, q + 1};         Line(q + 1) = {q + 1, q + 2};       Line(q + 2) = {q + 2, q + 3};   Line(q + 3) = {q + 3, q};
  Line(q + 4) = {q + 1, q + 4}; Line(q + 5) = {q + 2, q + 5};       Line(q + 6) = {q + 3, q + 6};
  Circle(q + 7) = {q + 4, q, q + 5};                                Circle(q + 8) = {q + 5, q, q + 6};
  Curve Loop(q) = {q, q + 1, q + 2, q + 3};                         Plane Surface(q) = {q};
  Curve Loop(q + 1) = {q + 4, q + 7, -(q + 5), -(q + 1)};           Plane Surface(q + 1) = {q + 1};
  Curve Loop(q + 2) = {q + 5, q + 8, -(q + 6), -(q + 2)};           Plane Surface(q + 2) = {q + 2};
  Transfinite Curve {q:(q + 3), q + 7, q + 8} = N + 1;
  Transfinite Curve {q + 4, q + 5, q + 6} = M + 1;
  Transfinite Surface {q:(q + 2)};
  Recombine Surface {q:(q + 2)};
Return

R = r; w = 0.5 * r; q = 1000; Z = 0; N = k; M = n;
Call Section;
c[] = Extrude {0, 0, 25} { Surface{1000:1002}; Layers{n}; Recombine; };
d[] = Extrude {0, 0, 75} { Surface{c[0], c[6], c[12]}; Layers{3 * n}; Recombine; };

// Foundation.
R = 100; w = 50; q = 2000; Z = -gap; N = k; M = 2 * n;
Call Section;
e[] = Extrude {0, 0, -200} { Surface{2000:2002}; Layers{4 * n}; Recombine; };

Physical Volume("punch")       = {a[1], a[8], a[15], b[1], b[8], b[15], c[1], c[7], c[13], d[1], d[7], d[13]};
Physical Volume("foundation")  = {e[1], e[7], e[13]};
Physical Surface("foot")       = {a[2], a[3], a[9], b[2], b[3], b[9], 1000:1002};
Physical Surface("head")       = {a[11], a[18], b[11], b[18], d[0], d[6], d[12]};
Physical Surface("top")        = {2000:2002};
Physical Surface("bottom")     = {e[0], e[6], e[12]};
Physical Surface("plane_x")    = {b[0], b[7], b[14], c[5], c[16], d[5], d[16], e[5], e[16]};
Physical Surface("plane_y")    = {1:3, c[2], c[8], d[2], d[8], e[2], e[8]};
