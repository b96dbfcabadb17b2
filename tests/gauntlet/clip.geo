// A cantilever (3 x 0.2) with a tooth below its end and a peg (radius q) that the tooth rides over; tooth and peg overlap by 0.18 in height.
DefineConstant[ q = 0.25, size = 0.1 ];
Point(1) = {0, 0, 0}; Point(2) = {2.6, 0, 0}; Point(3) = {2.75, -0.3, 0}; Point(4) = {2.85, -0.3, 0}; Point(5) = {3, 0, 0}; Point(6) = {3, 0.2, 0}; Point(7) = {2.6, 0.2, 0}; Point(8) = {0, 0.2, 0};
Line(1) = {1, 2}; Line(2) = {2, 7}; Line(3) = {7, 8}; Line(4) = {8, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 17; Transfinite Curve {2, 4} = 3; Transfinite Surface {1};
Line(5) = {2, 3}; Line(6) = {3, 4}; Line(7) = {4, 5}; Line(8) = {5, 6}; Line(9) = {6, 7}; Curve Loop(2) = {5:9, -2}; Plane Surface(2) = {2};
y = -0.12 - q;
Point(10) = {3.3, y, 0}; Point(11) = {3.3 + q, y, 0}; Point(12) = {3.3, y + q, 0}; Point(13) = {3.3 - q, y, 0}; Point(14) = {3.3 + q, y - 0.4, 0}; Point(15) = {3.3 - q, y - 0.4, 0};
Circle(11) = {11, 10, 12}; Circle(12) = {12, 10, 13}; Line(13) = {13, 15}; Line(14) = {15, 14}; Line(15) = {14, 11}; Curve Loop(3) = {11:15}; Plane Surface(3) = {3};
Mesh.MeshSizeMax = size; Recombine Surface {1, 2, 3};
Physical Surface("beam") = {1, 2}; Physical Surface("peg") = {3};
Physical Curve("root") = {4}; Physical Curve("tooth") = {1, 5, 6, 7}; Physical Curve("peg_face") = {11, 12, 13, 15}; Physical Curve("foot") = {14};
