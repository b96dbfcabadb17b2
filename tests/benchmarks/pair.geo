// A square of side 1/2 on a unit square, n cells along and across each: a slice of two cubes.
DefineConstant[n = 1];
Point(1) = {-0.5, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {0.5, 1, 0}; Point(4) = {-0.5, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {-0.25, 1, 0}; Point(12) = {0.25, 1, 0}; Point(13) = {0.25, 1.5, 0}; Point(14) = {-0.25, 1.5, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {1:4, 11:14} = n + 1; Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Physical Surface("lower") = {1}; Physical Surface("upper") = {2};
Physical Curve("bottom") = {1}; Physical Curve("face") = {3};
Physical Curve("foot") = {11}; Physical Curve("top") = {13};
