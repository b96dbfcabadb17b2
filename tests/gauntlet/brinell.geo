// A ball of radius 1 over a cylinder; s: size of the cells under it
DefineConstant[ s = 0.04 ];
Point(1) = {0, 1, 0}; Point(2) = {0, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0.3, 1, 0};
Circle(1) = {2, 1, 3}; Line(2) = {3, 1}; Line(3) = {1, 2}; Curve Loop(1) = {1:3}; Plane Surface(1) = {1}; MeshSize{1, 3} = 0.2; MeshSize{2} = 0.06; Recombine Surface {1};
Point(11) = {0, -1.5, 0}; Point(12) = {1.5, -1.5, 0}; Point(13) = {1.5, 0, 0}; Point(14) = {0.4, 0, 0}; Point(15) = {0, 0, 0}; 
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 11}; Curve Loop(11) = {11:15}; Plane Surface(11) = {11}; MeshSize{11:13} = 0.3; MeshSize{14, 15} = s; Recombine Surface {11};
Physical Surface("ball") = {1}; Physical Surface("metal") = {11}; Physical Curve("skin") = {1}; Physical Curve("top") = {13, 14}; Physical Curve("bottom") = {11}; Physical Curve("axis") = {15};
