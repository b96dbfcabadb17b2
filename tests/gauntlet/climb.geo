// A wheel on a slope of 20 degrees; s: size of cells
DefineConstant[ s = 0.08 ];
Point(10) = {0, 0.4, 0}; Point(11) = {0+0.4, 0.4, 0, s}; Point(12) = {0, 0.4+0.4, 0, s}; Point(13) = {0-0.4, 0.4, 0, s}; Point(14) = {0, 0.4-0.4, 0, s};
Circle(10) = {11, 10, 12}; Circle(11) = {12, 10, 13}; Circle(12) = {13, 10, 14}; Circle(13) = {14, 10, 11}; Curve Loop(10) = {10:13}; Plane Surface(10) = {10};
Point(20) = {-0.8, -0.4, 0, 2*s}; Point(21) = {1.6, -0.4, 0, 2*s}; Point(22) = {1.6, 0, 0, s}; Point(23) = {-0.8, 0, 0, s};
Line(20) = {20, 21}; Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 20}; Curve Loop(20) = {20:23}; Plane Surface(20) = {20};

Rotate {{0,0,1}, {0,0,0}, 20*Pi/180} { Surface{10, 20}; }
Recombine Surface {:}; Physical Surface("wheel")={10}; Physical Surface("bed")={20}; Physical Curve("rim")={10:13}; Physical Curve("road")={22}; Physical Curve("bottom")={20};
