// A square plug (half width a) in a round hole (radius r < a sqrt 2) of a block (half width b); a quarter.
DefineConstant[ a = 0.36, r = 0.45, b = 1, s = 1 ];
Point(1) = {0, 0, 0, 0.12*s}; Point(2) = {a, 0, 0, 0.08*s}; Point(3) = {a, a, 0, 0.05*s}; Point(4) = {0, a, 0, 0.08*s};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {r, 0, 0, 0.1*s}; Point(12) = {b, 0, 0, 0.2*s}; Point(13) = {b, b, 0, 0.2*s}; Point(14) = {0, b, 0, 0.2*s}; Point(15) = {0, r, 0, 0.1*s}; Point(16) = {r/Sqrt(2), r/Sqrt(2), 0, 0.05*s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Circle(15) = {15, 1, 16}; Circle(16) = {16, 1, 11}; Curve Loop(2) = {11:16}; Plane Surface(2) = {2}; Recombine Surface {1, 2};
Physical Surface("plug") = {1}; Physical Surface("block") = {2}; Physical Curve("skin") = {2, 3}; Physical Curve("hole") = {15, 16}; Physical Curve("y0") = {1, 11}; Physical Curve("x0") = {4, 14};
