// a block on a plate, both cut in two at y = 0
DefineConstant[ n = 4 ];
y0 = 0; Y0 = 0; k = 2;
Point(1)={-0.5,y0,0}; Point(2)={0.5,y0,0}; Point(3)={0.5,0.5,0}; Point(4)={-0.5,0.5,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Transfinite Curve{1,3}=n+1; Transfinite Curve{2,4}=n/k+1; Transfinite Surface{1}; Recombine Surface{1};
Point(11)={-1,Y0,-0.4}; Point(12)={1.5,Y0,-0.4}; Point(13)={1.5,1,-0.4}; Point(14)={-1,1,-0.4};
Line(31)={11,12}; Line(32)={12,13}; Line(33)={13,14}; Line(34)={14,11}; Curve Loop(31)={31:34}; Plane Surface(31)={31};
Transfinite Curve{31,33}=9; Transfinite Curve{32,34}=6/k+1; Transfinite Surface{31}; Recombine Surface{31};
b[]=Extrude{0,0,0.5}{Surface{1}; Layers{2}; Recombine;}; c[]=Extrude{0,0,0.4}{Surface{31}; Layers{2}; Recombine;};
Physical Volume("block")={b[1]}; Physical Volume("plate")={c[1]};
Physical Surface("under")={1}; Physical Surface("top")={b[0]}; Physical Surface("face")={c[0]}; Physical Surface("bottom")={31};
Physical Surface("sym")={b[2],c[2]};
