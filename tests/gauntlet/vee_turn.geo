// A rigid roller in a block with a groove of 90 degrees; s: size of cells
DefineConstant[ s = 0.05 ];
q = Sqrt(0.5);
Point(1) = {0, 0.5 * 2 * q, 0}; Point(2) = {0.5, q, 0, 0.6 * s}; Point(3) = {0, q + 0.5, 0, s}; Point(4) = {-0.5, q, 0, 0.6 * s}; Point(5) = {0, q - 0.5, 0, 0.6 * s};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0, s}; Point(12) = {1, 1, 0, s}; Point(13) = {1, -0.5, 0, 2 * s}; Point(14) = {-1, -0.5, 0, 2 * s}; Point(15) = {-1, 1, 0, s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 11}; Curve Loop(2) = {11:15}; Plane Surface(2) = {2};
Recombine Surface {1, 2};
Physical Surface("roller") = {1}; Physical Surface("block") = {2};
Physical Curve("rim") = {1:4}; Physical Curve("flanks") = {11, 15}; Physical Curve("foot") = {13};
