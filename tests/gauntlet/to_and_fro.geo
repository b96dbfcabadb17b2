// a block on a plate; n cells along the block, m along the plate
DefineConstant[ n = 5, m = 12 ];
Point(1)={-0.5,0,0}; Point(2)={0.5,0,0}; Point(3)={0.5,0.5,0}; Point(4)={-0.5,0.5,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Transfinite Curve{1,3}=n+1; Transfinite Curve{2,4}=n/2+1; Transfinite Surface{1}; Recombine Surface{1};
Point(11)={-1.5,-0.5,0}; Point(12)={1.5,-0.5,0}; Point(13)={1.5,0,0}; Point(14)={-1.5,0,0};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(11)={11:14}; Plane Surface(11)={11};
Transfinite Curve{11,13}=m+1; Transfinite Curve{12,14}=4; Transfinite Surface{11}; Recombine Surface{11};
Physical Surface("block")={1}; Physical Surface("plate")={11};
Physical Curve("under")={1}; Physical Curve("top")={3}; Physical Curve("bottom")={11}; Physical Curve("face")={13};
