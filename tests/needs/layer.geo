// A strip [0,10] x [0,0.5].
DefineConstant[ n = 10 ];
Point(1) = {0, 0, 0}; Point(2) = {10, 0, 0}; Point(3) = {10, 0.5, 0}; Point(4) = {0, 0.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = 2; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("strip") = {1};
Physical Curve("left") = {4}; Physical Curve("right") = {2}; Physical Curve("below") = {1}; Physical Curve("above") = {3};
