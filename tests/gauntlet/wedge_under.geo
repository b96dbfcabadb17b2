// A floor, a wedge of length 3 on it whose upper side rises by a degrees, and a block of width 1.5 on that; s: size of cells.
DefineConstant[ s = 0.2, a = 10 ];
t = Tan(a * Pi / 180);
Point(1) = {-1, -0.5, 0, 2 * s}; Point(2) = {6, -0.5, 0, 2 * s}; Point(3) = {6, 0, 0, 2 * s}; Point(4) = {-1, 0, 0, 2 * s};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(5) = {0, 0, 0, s}; Point(6) = {3, 0, 0, s}; Point(7) = {3, 0.3 + 3 * t, 0, s}; Point(8) = {0, 0.3, 0, s};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5}; Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Point(9) = {0.8, 0.3 + 0.8 * t, 0, s}; Point(10) = {2.3, 0.3 + 2.3 * t, 0, s}; Point(11) = {2.3, 1.6, 0, 1.25 * s}; Point(12) = {0.8, 1.6, 0, 1.25 * s};
Line(9) = {9, 10}; Line(10) = {10, 11}; Line(11) = {11, 12}; Line(12) = {12, 9}; Curve Loop(3) = {9:12}; Plane Surface(3) = {3};
Recombine Surface {1:3};
Physical Surface("floor") = {1}; Physical Surface("wedge") = {2}; Physical Surface("block") = {3};
Physical Curve("ground") = {1}; Physical Curve("top") = {3}; Physical Curve("low") = {5}; Physical Curve("push") = {6}; Physical Curve("slope") = {7};
Physical Curve("under") = {9}; Physical Curve("side") = {10, 12}; Physical Curve("load") = {11};
