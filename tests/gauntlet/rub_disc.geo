// a rigid disc is pressed into a block and slid along it, coarse facets on cells that adaptation makes fine
Point(1) = {-1.48, -0.83, 0, 0.12}; Point(2) = {1.48, -0.83, 0, 0.12}; Point(3) = {1.48, 0, 0, 0.12}; Point(4) = {-1.48, 0, 0, 0.12};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Recombine Surface {1};
Point(11) = {-0.19, 0.03, 0, 0.08}; Point(12) = {0.21, 0.43, 0, 0.08}; Point(13) = {-0.59, 0.43, 0, 0.08}; Point(14) = {-0.19, 0.43, 0};
Circle(11) = {11, 14, 12}; Line(12) = {12, 13}; Circle(13) = {13, 14, 11};
Curve Loop(2) = {11:13}; Plane Surface(2) = {2}; Recombine Surface {2};
Physical Surface("block") = {1}; Physical Surface("disc") = {2};
Physical Curve("foot") = {1}; Physical Curve("top") = {3}; Physical Curve("skin") = {11, 13};
