// A block on a plate; m: cells of the plate each way
DefineConstant[ m = 4 ];
Point(1)={-.7,-.7,-.3};Point(2)={.7,-.7,-.3};Point(3)={.7,.7,-.3};Point(4)={-.7,.7,-.3}; Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};Curve Loop(1)={1:4};Plane Surface(1)={1};
Transfinite Curve{1:4}=m+1;Transfinite Surface{1};Recombine Surface{1}; p[]=Extrude{0,0,.3}{Surface{1};Layers{2};Recombine;};
Point(1011)={-.25,-.25,0};Point(1012)={.25,-.25,0};Point(1013)={.25,.25,0};Point(1014)={-.25,.25,0}; Line(1111)={1011,1012};Line(1112)={1012,1013};Line(1113)={1013,1014};Line(1114)={1014,1011};Curve Loop(1111)={1111:1114};Plane Surface(1111)={1111};
Transfinite Curve{1111:1114}=4;Transfinite Surface{1111};Recombine Surface{1111}; q[]=Extrude{0,0,.25}{Surface{1111};Layers{1};Recombine;};
Physical Volume("bed")={p[1]};Physical Volume("block")={q[1]};Physical Surface("bottom")={1};Physical Surface("face")={p[0]};Physical Surface("under")={1111};Physical Surface("top")={q[0]};
