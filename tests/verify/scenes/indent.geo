// A block, 2 x 1, from its middle on, and a rigid punch of half width 0.5 with an edge rounded by 0.1, the upright side of which is over a node of the block.
Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 9; Transfinite Curve {2, 4} = 5; Transfinite Surface {1}; Recombine Surface {1};
Point(5) = {0.4, 1.1, 0}; Point(6) = {0, 1, 0}; Point(7) = {0.4, 1, 0}; Point(8) = {0.5, 1.1, 0}; Point(9) = {0.5, 1.5, 0}; Point(10) = {0, 1.5, 0};
Line(5) = {6, 7}; Circle(6) = {7, 5, 8}; Line(7) = {8, 9}; Line(8) = {9, 10}; Line(9) = {10, 6};
Curve Loop(2) = {5:9}; Plane Surface(2) = {2}; Recombine Surface {2};
MeshSize {:} = 0.1;
Physical Surface("block") = {1}; Physical Curve("bottom") = {1}; Physical Curve("top") = {3}; Physical Curve("middle") = {4};
Physical Surface("punch") = {2}; Physical Curve("skin") = {5:7};
