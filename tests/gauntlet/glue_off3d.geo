// two bars end to end along x, the second one raised by d; n, m cells across
DefineConstant[ n = 2, m = 3, d = 0.3, l = 2 ];
Point(1) = {0,0,0}; Point(2)={0,1,0}; Point(3)={0,1,1}; Point(4)={0,0,1};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Transfinite Curve{1:4}=n+1; Transfinite Surface{1}; Recombine Surface{1};
Point(11) = {1,d,0}; Point(12)={1,1+d,0}; Point(13)={1,1+d,1}; Point(14)={1,d,1};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(11)={11:14}; Plane Surface(11)={11};
Transfinite Curve{11:14}=m+1; Transfinite Surface{11}; Recombine Surface{11};
b[] = Extrude {1,0,0} { Surface{1}; Layers{l}; Recombine; };
c[] = Extrude {1,0,0} { Surface{11}; Layers{l}; Recombine; };
Physical Volume("left")={b[1]}; Physical Volume("right")={c[1]};
Physical Surface("wall")={1}; Physical Surface("left_face")={b[0]}; Physical Surface("right_face")={11}; Physical Surface("end")={c[0]};
