// A plate on two rollers; s: size of cells
DefineConstant[ s = 0.08 ];
Point(10) = {-0.5, 0, 0}; Point(11) = {-0.5+0.2, 0, 0, s}; Point(12) = {-0.5, 0+0.2, 0, s}; Point(13) = {-0.5-0.2, 0, 0, s}; Point(14) = {-0.5, 0-0.2, 0, s};
Circle(10) = {11, 10, 12}; Circle(11) = {12, 10, 13}; Circle(12) = {13, 10, 14}; Circle(13) = {14, 10, 11}; Curve Loop(10) = {10:13}; Plane Surface(10) = {10};
Point(20) = {0.5, 0, 0}; Point(21) = {0.5+0.2, 0, 0, s}; Point(22) = {0.5, 0+0.2, 0, s}; Point(23) = {0.5-0.2, 0, 0, s}; Point(24) = {0.5, 0-0.2, 0, s};
Circle(20) = {21, 20, 22}; Circle(21) = {22, 20, 23}; Circle(22) = {23, 20, 24}; Circle(23) = {24, 20, 21}; Curve Loop(20) = {20:23}; Plane Surface(20) = {20};
Point(30) = {-1, 0.2, 0, s}; Point(31) = {1, 0.2, 0, s}; Point(32) = {1, 0.4, 0, s}; Point(33) = {-1, 0.4, 0, s};
Line(30) = {30, 31}; Line(31) = {31, 32}; Line(32) = {32, 33}; Line(33) = {33, 30}; Curve Loop(30) = {30:33}; Plane Surface(30) = {30};
Point(40) = {-1.1, -0.4, 0, 2*s}; Point(41) = {1.4, -0.4, 0, 2*s}; Point(42) = {1.4, -0.2, 0, 2*s}; Point(43) = {-1.1, -0.2, 0, 2*s};
Line(40) = {40, 41}; Line(41) = {41, 42}; Line(42) = {42, 43}; Line(43) = {43, 40}; Curve Loop(40) = {40:43}; Plane Surface(40) = {40};

Recombine Surface {:}; Physical Surface("rollers")={10,20}; Physical Surface("plate")={30}; Physical Surface("floor")={40}; Physical Curve("skins")={10:13,20:23}; Physical Curve("under")={30}; Physical Curve("top")={32}; Physical Curve("ground")={42};
