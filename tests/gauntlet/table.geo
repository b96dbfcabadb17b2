// a block of n cells to its length on a table, whose edge is under it
If(!Exists(n)) n = 5; EndIf
Mesh.RecombineAll = 1; Mesh.SubdivisionAlgorithm = 1;
Point(1) = {-0.5, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {0.5, 0.5, 0}; Point(4) = {-0.5, 0.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n + 1; Transfinite Curve{2, 4} = Floor(n / 2) + 1; Transfinite Surface{1};
Point(11) = {-1, -0.5, 0, 0.3}; Point(12) = {0.2, -0.5, 0, 0.3}; Point(13) = {0.2, 0, 0, 0.3}; Point(14) = {-1, 0, 0, 0.3};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Physical Surface("block") = {1}; Physical Surface("table") = {2};
Physical Curve("top") = {3}; Physical Curve("face") = {1, 2, 4}; Physical Curve("board") = {12, 13};
