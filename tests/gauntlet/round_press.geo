// A block, and a punch whose lower edges are rounded with a radius less than the size of a cell: a quarter turn each.
DefineConstant[ size = 0.12, r = 0.08, k = 0 ]; // k: facets along each rounded edge, 0: as gmsh likes
Point(1) = {-1.9, -0.47, 0, size}; Point(2) = {1.9, -0.47, 0, size}; Point(3) = {1.9, 0, 0, size}; Point(4) = {-1.9, 0, 0, size};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {0.53, 0, 0, size}; Point(12) = {0.53 + r, r, 0, size}; Point(13) = {0.53 + r, 0.55, 0, size}; Point(14) = {-0.91 - r, 0.55, 0, size};
Point(15) = {-0.91 - r, r, 0, size}; Point(16) = {-0.91, 0, 0, size}; Point(17) = {0.53, r, 0}; Point(18) = {-0.91, r, 0};
Circle(11) = {11, 17, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Circle(15) = {15, 18, 16}; Line(16) = {16, 11};
Curve Loop(2) = {11:16}; Plane Surface(2) = {2}; Recombine Surface {1, 2};
If (k > 0) Transfinite Curve {11, 15} = k + 1; EndIf
Physical Surface("block") = {1}; Physical Surface("punch") = {2};
Physical Curve("foot") = {1}; Physical Curve("top") = {3}; Physical Curve("head") = {13}; Physical Curve("skin") = {11, 12, 14, 15, 16};
