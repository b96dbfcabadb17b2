// A round ridge (radius q) on a block and one hanging from another block, side by side; g: how far the two reach into each other.
DefineConstant[ q = 0.4, g = 0.12, w = 0.9, h = 0.4, s = 0.95, size = 0.13 ];
Point(1) = {-w, -h, 0}; Point(2) = {w, -h, 0}; Point(3) = {w, 0, 0}; Point(4) = {q, 0, 0}; Point(5) = {0, q, 0}; Point(6) = {-q, 0, 0}; Point(7) = {-w, 0, 0}; Point(8) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Circle(4) = {4, 8, 5}; Circle(5) = {5, 8, 6}; Line(6) = {6, 7}; Line(7) = {7, 1}; Curve Loop(1) = {1:7}; Plane Surface(1) = {1};
y = 2 * q - g;
Point(11) = {-s - w, y + h, 0}; Point(12) = {-s + w, y + h, 0}; Point(13) = {-s + w, y, 0}; Point(14) = {-s + q, y, 0}; Point(15) = {-s, y - q, 0}; Point(16) = {-s - q, y, 0}; Point(17) = {-s - w, y, 0}; Point(18) = {-s, y, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Circle(14) = {14, 18, 15}; Circle(15) = {15, 18, 16}; Line(16) = {16, 17}; Line(17) = {17, 11}; Curve Loop(2) = {11:17}; Plane Surface(2) = {2};
Mesh.MeshSizeMin = size; Mesh.MeshSizeMax = size; Recombine Surface {1, 2};
Physical Surface("lower") = {1}; Physical Surface("upper") = {2};
Physical Curve("bottom") = {1}; Physical Curve("top") = {11}; Physical Curve("hill") = {4, 5}; Physical Curve("knob") = {14, 15};
