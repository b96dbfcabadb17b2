// A pin of taper 1 : 10 in a hub, r-z plane; s: size of cells
DefineConstant[ s = 0.08 ];
Point(1) = {0, -0.2, 0, s}; Point(2) = {0.9 , -0.2, 0, s}; Point(3) = {1.1, 1.8, 0, s}; Point(4) = {0, 1.8, 0, s};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {0.92, 0, 0, s}; Point(12) = {1.8, 0, 0, 2 * s}; Point(13) = {1.8, 1.2, 0, 2 * s}; Point(14) = {1.04, 1.2, 0, s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Recombine Surface {1, 2};
Physical Surface("pin") = {1}; Physical Surface("hub") = {2};
Physical Curve("flank") = {2}; Physical Curve("axis") = {4}; Physical Curve("head") = {3}; Physical Curve("bore") = {14}; Physical Curve("foot") = {11};
