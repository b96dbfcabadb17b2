// A rigid rod with round ends leans at 60 degrees between a floor and a wall; s: size of cells
DefineConstant[ s = 0.1 ];
r = 0.1; c = 0.5; w = Sqrt(0.75); L = 2;
// ends' centres
ax = r + L * c; ay = r; bx = r; by = r + L * w;
// along the rod u = (-c, w), across it v = (w, c)
Point(1) = {ax, ay, 0}; Point(2) = {bx, by, 0};
Point(3) = {ax - r * w, ay - r * c, 0, 0.4 * s}; Point(4) = {ax + r * c, ay - r * w, 0, 0.4 * s}; Point(5) = {ax + r * w, ay + r * c, 0, 0.4 * s};
Point(6) = {bx + r * w, by + r * c, 0, 0.4 * s}; Point(7) = {bx - r * c, by + r * w, 0, 0.4 * s}; Point(8) = {bx - r * w, by - r * c, 0, 0.4 * s};
Circle(1) = {3, 1, 4}; Circle(2) = {4, 1, 5}; Line(3) = {5, 6}; Circle(4) = {6, 2, 7}; Circle(5) = {7, 2, 8}; Line(6) = {8, 3}; Curve Loop(1) = {1:6}; Plane Surface(1) = {1};
Point(11) = {0.2, -0.4, 0, 2 * s}; Point(12) = {2, -0.4, 0, 2 * s}; Point(13) = {2, 0, 0, s}; Point(14) = {0.2, 0, 0, s};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Point(21) = {-0.4, 1, 0, 2 * s}; Point(22) = {0, 1, 0, s}; Point(23) = {0, 2.5, 0, s}; Point(24) = {-0.4, 2.5, 0, 2 * s};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Recombine Surface {1:3};
Physical Surface("rod") = {1}; Physical Surface("floor") = {2}; Physical Surface("wall") = {3};
Physical Curve("skin") = {1, 2, 4, 5}; Physical Curve("ground") = {13}; Physical Curve("face") = {22}; Physical Curve("held") = {11, 24};
