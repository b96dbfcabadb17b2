// A ball of radius 0.55 over a ring of radii 0.5 and 0.9; s: size of cells
DefineConstant[ s = 0.1 ];
R = 0.55; y = 0.75;
Point(1) = {0, y, 0}; Point(2) = {0, y - R, 0}; Point(3) = {R, y, 0}; Point(4) = {0, y + R, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 2}; Curve Loop(1) = {1:3}; Plane Surface(1) = {1};
MeshSize{1:4} = 0.15; Recombine Surface {1};
c = 0.1;
Point(11) = {0.5 + c, -0.4, 0}; Point(12) = {0.9, -0.4, 0}; Point(13) = {0.9, 0.4, 0}; Point(14) = {0.5 + c, 0.4, 0}; Point(15) = {0.5, 0.4 - c, 0}; Point(16) = {0.5, -0.4 + c, 0}; Point(17) = {0.5 + c, 0.4 - c, 0}; Point(18) = {0.5 + c, -0.4 + c, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Circle(14) = {14, 17, 15}; Line(15) = {15, 16}; Circle(16) = {16, 18, 11}; Curve Loop(11) = {11:16}; Plane Surface(11) = {11};
MeshSize{11, 12, 13, 14, 15, 16} = s; Recombine Surface {11};
Physical Surface("ball") = {1}; Physical Surface("ring") = {11}; Physical Curve("skin") = {1, 2}; Physical Curve("bore") = {14, 15, 16}; Physical Curve("foot") = {11};
