// A slider (0.8 x 0.6 x 0.5), turned by a degrees about the vertical, on a block (2 x 1 x 0.8).
DefineConstant[ a = 15 ];
Point(1) = {-1, -0.5, -0.8}; Point(2) = {1, -0.5, -0.8}; Point(3) = {1, 0.5, -0.8}; Point(4) = {-1, 0.5, -0.8};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1}; Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
Transfinite Curve {1,3} = 9; Transfinite Curve {2,4} = 5; Transfinite Surface {1}; Recombine Surface {1};
Point(11) = {-0.4, -0.3, 0}; Point(12) = {0.4, -0.3, 0}; Point(13) = {0.4, 0.3, 0}; Point(14) = {-0.4, 0.3, 0};
Line(11) = {11,12}; Line(12) = {12,13}; Line(13) = {13,14}; Line(14) = {14,11}; Curve Loop(11) = {11,12,13,14}; Plane Surface(11) = {11};
Rotate {{0,0,1}, {0,0,0}, a*Pi/180} { Surface{11}; }
Transfinite Curve {11,13} = 5; Transfinite Curve {12,14} = 4; Transfinite Surface {11}; Recombine Surface {11};
b[] = Extrude {0, 0, 0.8} { Surface{1}; Layers{3}; Recombine; };
c[] = Extrude {0, 0, 0.5} { Surface{11}; Layers{3}; Recombine; };
Physical Volume("block") = {b[1]}; Physical Volume("slider") = {c[1]};
Physical Surface("bottom") = {1}; Physical Surface("hull") = {b[0], b[2], b[3], b[4], b[5]};
Physical Surface("top") = {c[0]}; Physical Surface("skin") = {11, c[2], c[3], c[4], c[5]};
