// a rigid wedge over a block
Point(1) = {-1.5, -0.8, 0, 0.12}; Point(2) = {1.5, -0.8, 0, 0.12}; Point(3) = {1.5, 0, 0, 0.12}; Point(4) = {-1.5, 0, 0, 0.12};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Recombine Surface {1};
Point(11) = {0, 0.01, 0, 0.2}; Point(12) = {0.46, 0.38, 0, 0.2}; Point(13) = {0.46, 0.98, 0, 0.2};
Point(14) = {-0.46, 0.98, 0, 0.2}; Point(15) = {-0.46, 0.38, 0, 0.2};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 11};
Curve Loop(2) = {11:15}; Plane Surface(2) = {2}; Recombine Surface {2};
Physical Surface("block") = {1}; Physical Surface("wedge") = {2};
Physical Curve("foot") = {1}; Physical Curve("top") = {3}; Physical Curve("skin") = {11, 12, 14, 15};
