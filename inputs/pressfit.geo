// A shaft in a hub as long as it, halves of sections through the axis x = 0. Quadrilaterals only.
DefineConstant[
  r = 20, // radius of the shaft
  R = 40, // outer radius of the hub
  h = 20, // length of both
  n = 8   // cells along the shaft; the hub has n + 2
];
Point(1) = {0, 0, 0}; Point(2) = {r, 0, 0}; Point(3) = {r, h, 0}; Point(4) = {0, h, 0};
Point(9) = {0.75 * r, h, 0}; // the hammer is thinner than the shaft
Point(5) = {r, 0, 0}; Point(6) = {R, 0, 0}; Point(7) = {R, h, 0}; Point(8) = {r, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 9}; Line(9) = {9, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(1) = {1, 2, 3, 9, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Transfinite Curve {1, 2, 4} = n + 1;
Transfinite Curve {3} = Ceil(n / 4) + 1;
Transfinite Curve {9} = n - Ceil(n / 4) + 1;
Transfinite Curve {5:8} = n + 3;
Transfinite Surface {1} = {1, 2, 3, 4};
Transfinite Surface {2};
Recombine Surface {1, 2};
Physical Surface("shaft") = {1};
Physical Surface("hub") = {2};
Physical Curve("axis") = {4};
Physical Curve("pushed") = {9};
Physical Curve("seat") = {2};
Physical Curve("bore") = {8};
Physical Curve("foot") = {5};
