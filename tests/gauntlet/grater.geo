// A pad with rounded feet on a longer block; s: size of its cells
DefineConstant[ s = 0.06, r = 0.12, n = 6 ];
Point(1) = {-0.6 + r, 0, 0}; Point(2) = {0.6 - r, 0, 0}; Point(3) = {0.6, r, 0}; Point(4) = {0.6, 0.25, 0}; Point(5) = {-0.6, 0.25, 0}; Point(6) = {-0.6, r, 0}; Point(7) = {0.6 - r, r, 0}; Point(8) = {-0.6 + r, r, 0};
Line(1) = {1, 2}; Circle(2) = {2, 7, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Circle(6) = {6, 8, 1}; Curve Loop(1) = {1:6}; Plane Surface(1) = {1}; MeshSize{1:6} = s; Recombine Surface {1};
Point(11) = {-1, -0.4, 0}; Point(12) = {1.6, -0.4, 0}; Point(13) = {1.6, 0, 0}; Point(14) = {-1, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {11, 13} = 5 * n + 1; Transfinite Curve {12, 14} = n + 1; Transfinite Surface {11}; Recombine Surface {11};
Physical Surface("pad") = {1}; Physical Surface("floor") = {11}; Physical Curve("under") = {6, 1, 2}; Physical Curve("top") = {4}; Physical Curve("bottom") = {11}; Physical Curve("way") = {13};
