// A block on a slope, seen along it; s: size of cells
DefineConstant[ s = 0.1 ];
Point(1) = {-1, -0.4, 0, 2 * s}; Point(2) = {1.5, -0.4, 0, 2 * s}; Point(3) = {1.5, 0, 0, s}; Point(4) = {-1, 0, 0, s};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {-0.4, 0, 0, 0.8 * s}; Point(12) = {0.4, 0, 0, 0.8 * s}; Point(13) = {0.4, 0.4, 0, s}; Point(14) = {-0.4, 0.4, 0, s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Recombine Surface {1, 2};
Physical Surface("slope") = {1}; Physical Surface("block") = {2};
Physical Curve("way") = {3}; Physical Curve("bed") = {1}; Physical Curve("under") = {11}; Physical Curve("rope") = {12};
