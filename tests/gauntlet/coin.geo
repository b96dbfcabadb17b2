// block with a step in its upper side, and a hard block over it whose edge is just before the step
DefineConstant[ h = 0.08 ];
Point(1) = {-1.5, -0.64, 0, h}; Point(2) = {1.5, -0.64, 0, h}; Point(3) = {1.5, -0.12, 0, h};
Point(4) = {0.43, -0.12, 0, h}; Point(5) = {0.42, 0, 0, h}; Point(6) = {-1.5, 0, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(1) = {1:6}; Plane Surface(1) = {1}; Recombine Surface {1};
Point(11) = {-1.1, 0, 0, 2.5*h}; Point(12) = {0.38, 0, 0, 2.5*h}; Point(13) = {0.38, 0.76, 0, 2.5*h}; Point(14) = {-1.1, 0.76, 0, 2.5*h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2}; Recombine Surface {2};
Physical Surface("blank") = {1}; Physical Surface("die") = {2};
Physical Curve("foot") = {1}; Physical Curve("top") = {3, 4, 5};
Physical Curve("head") = {13}; Physical Curve("face") = {11, 12, 14};
