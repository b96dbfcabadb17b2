// A block on a plate; n: cells along an edge of the block
DefineConstant[ n = 3 ];
Point(1) = {-0.3, -0.3, 0}; Point(2) = {0.3, -0.3, 0}; Point(3) = {0.3, 0.3, 0}; Point(4) = {-0.3, 0.3, 0};
Point(11) = {-0.6, -0.6, -0.3}; Point(12) = {1, -0.6, -0.3}; Point(13) = {1, 0.9, -0.3}; Point(14) = {-0.6, 0.9, -0.3};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(11) = {11:14}; Plane Surface(11) = {11};
Transfinite Curve {1:4} = n + 1; Transfinite Curve {11:14} = 4; Transfinite Surface {1}; Transfinite Surface {11}; Recombine Surface {1, 11};
v[] = Extrude {0, 0, 0.25} { Surface{1}; Layers{2}; Recombine; };
u[] = Extrude {0, 0, 0.3} { Surface{11}; Layers{1}; Recombine; };
Physical Volume("block") = {v[1]}; Physical Volume("plate") = {u[1]};
Physical Surface("under") = {1}; Physical Surface("top") = {v[0]}; Physical Surface("face") = {u[0]}; Physical Surface("bottom") = {11};
