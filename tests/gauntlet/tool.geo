// a block of n cells to the unit of length, and a rigid tool above its top: shape 0: a flat punch, 1: a wedge
If(!Exists(n)) n = 5; EndIf
If(!Exists(shape)) shape = 0; EndIf
Mesh.RecombineAll = 1; Mesh.SubdivisionAlgorithm = 1;
Point(1) = {-1, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {-1, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 2 * n + 1; Transfinite Curve{2, 4} = n + 1; Transfinite Surface{1};
If(shape == 0)
  Point(11) = {-0.37, 1, 0, 0.3}; Point(12) = {0.37, 1, 0, 0.3}; Point(13) = {0.37, 1.4, 0, 0.3}; Point(14) = {-0.37, 1.4, 0, 0.3};
  Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
  Curve Loop(2) = {11:14};
  Physical Curve("tool") = {11, 12, 14};
Else
  Point(11) = {0.03, 1, 0, 0.3}; Point(12) = {0.6, 1.5, 0, 0.3}; Point(13) = {-0.54, 1.5, 0, 0.3};
  Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 11};
  Curve Loop(2) = {11:13};
  Physical Curve("tool") = {11, 13};
EndIf
Plane Surface(2) = {2};
Physical Surface("block") = {1}; Physical Surface("punch") = {2};
Physical Curve("base") = {1}; Physical Curve("top") = {3};
