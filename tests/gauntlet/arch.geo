// Right half of a shallow arch (span 2 w, rise f, thickness d) and of a rigid round tool (radius q) that touches its crown from above.
DefineConstant[ w = 1, f = 0.14, d = 0.06, q = 0.3, n = 14, m = 2 ];
R = (w * w + f * f) / (2 * f); // radius of the arch's underside, centre (0, f - R)
k = (R + d) / R;
Point(1) = {0, f - R, 0}; Point(2) = {0, f, 0}; Point(3) = {w, 0, 0}; Point(4) = {w * k, (f - R) + (R - f) * k, 0}; Point(5) = {0, f + d, 0};
Circle(1) = {2, 1, 3}; Line(2) = {3, 4}; Circle(3) = {4, 1, 5}; Line(4) = {5, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1; Transfinite Surface {1};
Point(11) = {0, f + d, 0}; Point(12) = {0, f + d + q, 0}; Point(13) = {q, f + d + q, 0}; Point(14) = {q * Sin(Pi / 4), f + d + q - q * Cos(Pi / 4), 0};
Circle(11) = {11, 12, 14}; Circle(12) = {14, 12, 13}; Line(13) = {13, 12}; Line(14) = {12, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {11:14} = 5; Transfinite Surface {11}; Recombine Surface {1, 11};
Physical Surface("arch") = {1}; Physical Surface("tool") = {11};
Physical Curve("back") = {3}; Physical Curve("springing") = {2}; Physical Curve("crown") = {4}; Physical Curve("tip") = {11, 12};
