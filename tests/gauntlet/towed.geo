// A wheel of radius 0.5 on a layer; s: size of the layer's cells
DefineConstant[ s = 0.05, m = 8 ];
R = 0.5;
Point(1) = {0, R, 0}; Point(2) = {R, R, 0}; Point(3) = {0, 2 * R, 0}; Point(4) = {-R, R, 0}; Point(5) = {0, 0, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
MeshSize{1:5} = 0.15; Recombine Surface {1};
Point(11) = {-0.4, -0.2, 0}; Point(12) = {0.8, -0.2, 0}; Point(13) = {0.8, 0, 0}; Point(14) = {-0.4, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {11, 13} = 1.2 / s + 1; Transfinite Curve {12, 14} = 0.2 / s + 1; Transfinite Surface {11}; Recombine Surface {11};
Physical Surface("wheel") = {1}; Physical Surface("layer") = {11};
Physical Curve("rim") = {1:4}; Physical Curve("bottom") = {11}; Physical Curve("way") = {13};
