// A tool turned by 9 degrees whose lowest corner comes first, above a block of the facets' length f.
DefineConstant[ f = 0.2, n = 0.1 ]; // n: of the tool
Point(1) = {-2, -1, 0, f}; Point(2) = {2, -1, 0, f}; Point(3) = {2, 0, 0, f}; Point(4) = {-2, 0, 0, f};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {-0.5, 0.15, 0, n}; Point(12) = {0.45, 0, 0, n}; Point(13) = {0.6, 0.8, 0, n}; Point(14) = {-0.3, 0.9, 0, n};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2}; Recombine Surface {1, 2};
Physical Surface("block") = {1}; Physical Surface("tool") = {2};
Physical Curve("foot") = {1}; Physical Curve("top") = {3}; Physical Curve("head") = {13}; Physical Curve("edges") = {11, 12, 14};
