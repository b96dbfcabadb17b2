// A slider [0,1] x [0,0.5] on a block [0,2] x [-1,0].
DefineConstant[ k = 1 ];
Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,.5,0}; Point(4)={0,.5,0}; Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};
Curve Loop(1)={1:4}; Plane Surface(1)={1}; Transfinite Curve{1,3}=7*k+1; Transfinite Curve{2,4}=4*k+1; Transfinite Surface{1}; Recombine Surface{1};
Point(11)={0,-1,0}; Point(12)={2,-1,0}; Point(13)={2,0,0}; Point(14)={0,0,0}; Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11};
Curve Loop(2)={11:14}; Plane Surface(2)={2}; Transfinite Curve{11,13}=11*k+1; Transfinite Curve{12,14}=6*k+1; Transfinite Surface{2}; Recombine Surface{2};
Physical Surface("slider")={1}; Physical Surface("block")={2}; Physical Curve("skin")={1,2,4}; Physical Curve("top")={3}; Physical Curve("hull")={12,13,14};
Physical Curve("bottom")={11};
