// Half of a bar between jaws with soft pads; s: size of cells
DefineConstant[ s = 0.08 ];
Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0, s}; Point(3) = {0, 0.5, 0, s}; Point(5) = {0, -0.5, 0, s};
Circle(1) = {5, 1, 2}; Circle(2) = {2, 1, 3}; Line(3) = {3, 5}; Curve Loop(1) = {1:3}; Plane Surface(1) = {1};
Point(21) = {0.5, -0.6, 0, s}; Point(22) = {0.9, -0.6, 0, 1.5 * s}; Point(23) = {0.9, 0.6, 0, 1.5 * s}; Point(24) = {0.5, 0.6, 0, s};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Recombine Surface {1, 3};
Physical Surface("bar") = {1}; Physical Surface("pad") = {3};
Physical Curve("rim") = {1, 2}; Physical Curve("cut") = {3}; Physical Curve("face") = {24}; Physical Curve("jaw") = {22};
