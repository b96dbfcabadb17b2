// A block (w wide, h high) that fills a box and lies under a lid as wide as itself. Sides and bottom of the box are one surface, its skin another.
DefineConstant[ w = 1.2, h = 1, n = 5, m = 4, nb = 4 ];
Point(1) = {0, 0, 0}; Point(2) = {w, 0, 0}; Point(3) = {w, h, 0}; Point(4) = {0, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1};
Point(11) = {-0.3, -0.3, 0}; Point(12) = {w + 0.3, -0.3, 0}; Point(13) = {w + 0.3, h + 0.3, 0}; Point(14) = {w, h + 0.3, 0}; Point(15) = {w, 0, 0}; Point(16) = {0, 0, 0}; Point(17) = {0, h + 0.3, 0}; Point(18) = {-0.3, h + 0.3, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 17}; Line(17) = {17, 18}; Line(18) = {18, 11}; Curve Loop(2) = {11:18}; Plane Surface(2) = {2};
Transfinite Curve {11, 12, 14, 15, 16, 18} = nb + 1; Transfinite Curve {13, 17} = 2;
Point(21) = {0, h, 0}; Point(22) = {w, h, 0}; Point(23) = {w, h + 0.2, 0}; Point(24) = {0, h + 0.2, 0};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Transfinite Curve {21, 23} = nb; Transfinite Curve {22, 24} = 2; Transfinite Surface {3};
Recombine Surface {1, 2, 3};
Physical Surface("block") = {1}; Physical Surface("box") = {2}; Physical Surface("lid") = {3};
Physical Curve("skin") = {1:4}; Physical Curve("inside") = {14, 15, 16}; Physical Curve("lid_face") = {21};
