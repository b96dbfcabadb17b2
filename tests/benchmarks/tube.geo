// A quarter of a thin tube, midline of radius 1, thickness h, oval by a thousandth, and the rigid plane of symmetry that its wall meets. n: cells around.
DefineConstant[n = 32, h = 0.01, e = 0.001];
Point(1) = {0, 0, 0};
a = 1 + e; b = 1 - e;
Point(2) = {a - h/2, 0, 0}; Point(3) = {a + h/2, 0, 0}; Point(4) = {0, b + h/2, 0}; Point(5) = {0, b - h/2, 0};
Line(1) = {2, 3}; Ellipse(2) = {3, 1, 3, 4}; Line(3) = {4, 5}; Ellipse(4) = {5, 1, 2, 2};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {2, 4} = n + 1; Transfinite Curve {1, 3} = 2; Transfinite Surface {1};
Point(11) = {-0.2, -0.1, 0}; Point(12) = {0.9, -0.1, 0}; Point(13) = {0.9, 0, 0}; Point(14) = {-0.2, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11:14} = 2; Transfinite Surface {2};
Recombine Surface {1, 2};
Physical Surface("tube") = {1}; Physical Surface("plane") = {2};
Physical Curve("outside") = {2}; Physical Curve("bore") = {4}; Physical Curve("side") = {1}; Physical Curve("crown") = {3}; Physical Curve("ground") = {13};
