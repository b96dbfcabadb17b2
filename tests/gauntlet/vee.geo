// A square block turned by 45 degrees, its lower corner in a V. Its upper faces are supports.
DefineConstant[ n = 4, size = 0.4 ];
q = Sqrt(0.5);
Point(1) = {0, 0, 0}; Point(2) = {q, q, 0}; Point(3) = {0, 2 * q, 0}; Point(4) = {-q, q, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = n + 1; Transfinite Surface {1};
Point(11) = {0, -0.4, 0}; Point(12) = {1.2, -0.4, 0}; Point(13) = {1.2, 1.2, 0}; Point(14) = {0, 0, 0}; Point(15) = {-1.2, 1.2, 0}; Point(16) = {-1.2, -0.4, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11}; Curve Loop(2) = {11:16}; Plane Surface(2) = {2};
MeshSize {11:16} = size;
Recombine Surface {1, 2};
Physical Surface("block") = {1}; Physical Surface("vee") = {2};
Physical Curve("under") = {1, 4}; Physical Curve("right") = {2}; Physical Curve("left") = {3}; Physical Curve("groove") = {13, 14};
