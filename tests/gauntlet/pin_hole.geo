// s: size of cells, 1: that of the scene
DefineConstant[ s = 1, r = 0.4, R = 0.42 ];
Point(1) = {0,0,0,0.1*s}; y = R - r;
Point(2) = {0,-y,0,0.12*s}; Point(3) = {0,-R,0,0.1*s}; Point(4) = {r,-y,0,0.1*s}; Point(5) = {0,r-y,0,0.1*s};
Line(1) = {2,3}; Circle(2) = {3,2,4}; Circle(3) = {4,2,5}; Line(4) = {5,2}; Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
Point(11) = {0,-1,0,0.3*s}; Point(12) = {1,-1,0,0.3*s}; Point(13) = {1,1,0,0.3*s}; Point(14) = {0,1,0,0.3*s}; Point(15) = {0,R,0,0.12*s}; Point(16) = {R,0,0,0.1*s};
Point(17) = {0,-R,0,0.1*s};
Line(11) = {17,11}; Line(12) = {11,12}; Line(13) = {12,13}; Line(14) = {13,14}; Line(15) = {14,15}; Circle(16) = {15,1,16}; Circle(17) = {16,1,17};
Curve Loop(2) = {11:17}; Plane Surface(2) = {2}; Recombine Surface {1,2};
Physical Surface("pin") = {1}; Physical Surface("plate") = {2}; Physical Curve("pin_face") = {2,3}; Physical Curve("hole") = {16,17}; Physical Curve("pin_axis") = {1,4}; Physical Curve("plate_axis") = {11,15}; Physical Curve("base") = {12};
