// Rigid cam (ellipse a x b, long axis along x, centre at the origin) under a stiff follower with a flat foot of width 2 w.
DefineConstant[ a = 0.5, b = 0.3, w = 0.6, n = 12 ];
Point(1) = {0, 0, 0, 0.08}; Point(2) = {a, 0, 0, 0.05}; Point(3) = {0, b, 0, 0.08}; Point(4) = {-a, 0, 0, 0.05}; Point(5) = {0, -b, 0, 0.08};
Ellipse(1) = {2, 1, 2, 3}; Ellipse(2) = {3, 1, 4, 4}; Ellipse(3) = {4, 1, 4, 5}; Ellipse(4) = {5, 1, 2, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {-w, b, 0}; Point(12) = {w, b, 0}; Point(13) = {w, b + 0.4, 0}; Point(14) = {-w, b + 0.4, 0}; Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11, 13} = 2*n + 1; Transfinite Curve {12, 14} = 5; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("cam") = {1}; Physical Surface("follower") = {2}; Physical Curve("rim") = {1:4}; Physical Curve("foot") = {11}; Physical Curve("top") = {13}; Physical Curve("guide") = {12, 14};
