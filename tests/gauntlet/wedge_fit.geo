// A plug (x from -p - 1.2 to -p, half height a, its corner rounded with radius r) before a channel whose wall comes down from y = a + 0.05 to y = a - c along x from 0 to l.
DefineConstant[ a = 0.5, p = 0.1, r = 0.1, l = 0.6, c = 0.05, w = 0.35, n = 10, m = 5 ];
Point(1) = {-p - 1.2, 0, 0}; Point(2) = {-p, 0, 0}; Point(3) = {-p, a - r, 0}; Point(4) = {-p - r, a - r, 0}; Point(5) = {-p - r, a, 0}; Point(6) = {-p - 1.2, a, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Circle(3) = {3, 4, 5}; Line(4) = {5, 6}; Line(5) = {6, 1}; Curve Loop(1) = {1:5}; Plane Surface(1) = {1};
Transfinite Curve {1, 4} = n + 1; Transfinite Curve {2, 5} = m + 1; Transfinite Curve {3} = 4;
Point(11) = {-1.4, a + 0.05, 0}; Point(12) = {0, a + 0.05, 0}; Point(13) = {l, a - c, 0}; Point(14) = {2.4, a - c, 0}; Point(15) = {2.4, a + w, 0}; Point(16) = {l, a + w, 0}; Point(17) = {0, a + w, 0}; Point(18) = {-1.4, a + w, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 17}; Line(17) = {17, 18}; Line(18) = {18, 11}; Line(19) = {12, 17}; Line(20) = {13, 16};
Curve Loop(11) = {11, 19, 17, 18}; Plane Surface(11) = {11}; Curve Loop(12) = {12, 20, 16, -19}; Plane Surface(12) = {12}; Curve Loop(13) = {13, 14, 15, -20}; Plane Surface(13) = {13};
Transfinite Curve {11, 17} = 8; Transfinite Curve {12, 16} = 5; Transfinite Curve {13, 15} = 12; Transfinite Curve {14, 18, 19, 20} = 4; Transfinite Surface {11:13}; Recombine Surface {1, 11:13};
Physical Surface("plug") = {1}; Physical Surface("channel") = {11:13};
Physical Curve("plane") = {1}; Physical Curve("pushed") = {5}; Physical Curve("plug_face") = {2, 3, 4}; Physical Curve("wall") = {11, 12, 13}; Physical Curve("outside") = {15, 16, 17};
