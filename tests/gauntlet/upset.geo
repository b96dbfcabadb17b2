// Upper half of a billet (radius, or half width, b; half height h, its edge rounded with radius r) and the rigid die above it.
DefineConstant[ b = 1, h = 1, r = 0.15, size = 0.2 ];
Point(1) = {0, 0, 0, size}; Point(2) = {b, 0, 0, size}; Point(3) = {b, h - r, 0, size / 2}; Point(4) = {b - r, h - r, 0}; Point(5) = {b - r, h, 0, size / 2}; Point(6) = {0, h, 0, size};
Line(1) = {1, 2}; Line(2) = {2, 3}; Circle(3) = {3, 4, 5}; Line(4) = {5, 6}; Line(5) = {6, 1}; Curve Loop(1) = {1:5}; Plane Surface(1) = {1};
Point(11) = {0, h, 0}; Point(12) = {2.5 * b, h, 0}; Point(13) = {2.5 * b, h + 0.2, 0}; Point(14) = {0, h + 0.2, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11:14} = 2; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("billet") = {1}; Physical Surface("die") = {2};
Physical Curve("axis") = {5}; Physical Curve("middle") = {1}; Physical Curve("skin") = {2, 3, 4}; Physical Curve("die_face") = {11};
