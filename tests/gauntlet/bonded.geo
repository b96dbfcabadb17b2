// Right half of a rubber block (half width b, height h) bonded to plates below and above, and a rigid wall at x = b + g.
DefineConstant[ b = 1, h = 0.8, g = 0.09, n = 6, m = 6 ];
Point(1) = {0, 0, 0}; Point(2) = {b, 0, 0}; Point(3) = {b, h, 0}; Point(4) = {0, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1};
Point(11) = {b + g, -0.3, 0}; Point(12) = {b + g + 0.2, -0.3, 0}; Point(13) = {b + g + 0.2, h + 0.3, 0}; Point(14) = {b + g, h + 0.3, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11:14} = 2; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("rubber") = {1}; Physical Surface("wall") = {2};
Physical Curve("foot") = {1}; Physical Curve("side") = {2}; Physical Curve("head") = {3}; Physical Curve("cut") = {4}; Physical Curve("wall_face") = {14};
