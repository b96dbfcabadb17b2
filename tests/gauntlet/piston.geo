// A ring in a bore; s: size of cells
DefineConstant[ s = 0.06 ];
Point(10) = {0.7, 0, 0, s}; Point(11) = {1.0, 0, 0, s}; Point(12) = {1.0, 0.4, 0, s}; Point(13) = {0.7, 0.4, 0, s};
Line(10) = {10, 11}; Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 10}; Curve Loop(10) = {10:13}; Plane Surface(10) = {10};
Point(20) = {1.0, -0.3, 0, 0.2}; Point(21) = {1.3, -0.3, 0, 0.2}; Point(22) = {1.3, 1.1, 0, 0.2}; Point(23) = {1.0, 1.1, 0, 0.2};
Line(20) = {20, 21}; Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 20}; Curve Loop(20) = {20:23}; Plane Surface(20) = {20};

Recombine Surface {:}; Physical Surface("ring")={10}; Physical Surface("bore")={20}; Physical Curve("skin")={11}; Physical Curve("wall")={23}; Physical Curve("over")={12}; Physical Curve("under")={10};
