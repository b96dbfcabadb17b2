// A pad (60 degrees, radius 1 to 1.3) with a steel back (to 1.4) over a rigid drum; s: size of cells
DefineConstant[ s = 0.08 ];
a = 30 * Pi / 180; S = Sin(a); C = Cos(a);
Point(1) = {0, 0, 0};
Point(2) = {-S, C, 0, s}; Point(3) = {S, C, 0, s}; Point(4) = {1.3 * S, 1.3 * C, 0, s}; Point(5) = {-1.3 * S, 1.3 * C, 0, s};
Point(6) = {1.4 * S, 1.4 * C, 0, s}; Point(7) = {-1.4 * S, 1.4 * C, 0, s};
Circle(1) = {2, 1, 3}; Line(2) = {3, 4}; Circle(3) = {4, 1, 5}; Line(4) = {5, 2}; Line(5) = {4, 6}; Circle(6) = {6, 1, 7}; Line(7) = {7, 5};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
Point(11) = {1, 0, 0, 1.5 * s}; Point(12) = {0, 1, 0, 1.5 * s}; Point(13) = {-1, 0, 0, 1.5 * s}; Point(14) = {0, -1, 0, 1.5 * s};
Point(15) = {0.8, 0, 0, 1.5 * s}; Point(16) = {0, 0.8, 0, 1.5 * s}; Point(17) = {-0.8, 0, 0, 1.5 * s}; Point(18) = {0, -0.8, 0, 1.5 * s};
For i In {0:3}
  Circle(11 + i) = {11 + i, 1, 11 + (i + 1) % 4}; Circle(21 + i) = {15 + i, 1, 15 + (i + 1) % 4};
EndFor
Curve Loop(3) = {11:14}; Curve Loop(4) = {21:24}; Plane Surface(3) = {3, 4};
Recombine Surface {1:3};
Physical Surface("pad") = {1}; Physical Surface("back") = {2}; Physical Surface("drum") = {3};
Physical Curve("lining") = {1}; Physical Curve("plate") = {6}; Physical Curve("rim") = {11:14};
