// A unit square on a rigid obstacle of shape y = -0.05 (x - 0.5)^2, a parabola (Bezier of degree 2). n: cells of the square.
DefineConstant[n = 8];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = n + 1; Transfinite Surface {1};
Point(11) = {-0.5, -0.05, 0}; Point(12) = {0.5, 0.05, 0}; Point(13) = {1.5, -0.05, 0}; Point(14) = {1.5, -0.3, 0}; Point(15) = {-0.5, -0.3, 0};
Bezier(11) = {11, 12, 13}; Line(12) = {13, 14}; Line(13) = {14, 15}; Line(14) = {15, 11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11, 13} = 13; Transfinite Curve {12, 14} = 2; Transfinite Surface {2};
Recombine Surface {1, 2};
Physical Surface("square") = {1}; Physical Surface("obstacle") = {2};
Physical Curve("foot") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4}; Physical Curve("hill") = {11};
