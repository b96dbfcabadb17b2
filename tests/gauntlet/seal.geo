// An O-ring (section of diameter 0.4) in the groove of a shaft, pushed through a bore with a lead-in, r-z plane; s: size of cells
DefineConstant[ s = 0.06 ];
Point(1) = {1.0, 0.21, 0}; Point(2) = {1.2, 0.21, 0, s}; Point(3) = {1.0, 0.41, 0, s}; Point(4) = {0.8, 0.21, 0, s}; Point(5) = {1.0, 0.01, 0, s};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {0.5, -0.2, 0, 2 * s}; Point(12) = {1.08, -0.2, 0, s}; Point(13) = {1.08, 0, 0, s}; Point(14) = {0.795, 0, 0, s}; Point(15) = {0.795, 0.5, 0, s}; Point(16) = {1.08, 0.5, 0, s}; Point(17) = {1.08, 0.7, 0, s}; Point(18) = {0.5, 0.7, 0, 2 * s};
For i In {0:7}
  Line(11 + i) = {11 + i, 11 + (i + 1) % 8};
EndFor
Curve Loop(2) = {11:18}; Plane Surface(2) = {2};
Point(31) = {1.25, 0.5, 0, s}; Point(32) = {1.5, 0.5, 0, 2 * s}; Point(33) = {1.5, 2.2, 0, 2 * s}; Point(34) = {1.12, 2.2, 0, s}; Point(35) = {1.12, 1.0, 0, s};
Line(31) = {31, 32}; Line(32) = {32, 33}; Line(33) = {33, 34}; Line(34) = {34, 35}; Line(35) = {35, 31}; Curve Loop(3) = {31:35}; Plane Surface(3) = {3};
Recombine Surface {1:3};
Physical Surface("ring") = {1}; Physical Surface("shaft") = {2}; Physical Surface("bore") = {3};
Physical Curve("skin") = {1:4}; Physical Curve("groove") = {12:16}; Physical Curve("wall") = {34, 35};
