// a sharp tooth, half angle 53 degrees, on a soft bed; sh: x of its tip, n, m: cells of the bed
DefineConstant[n=8, sh=0, m=2];
Point(1)={-1,0,0}; Point(2)={1,0,0}; Point(3)={1,0.4,0}; Point(4)={-1,0.4,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1};
Transfinite Curve{1,3}=n+1; Transfinite Curve{2,4}=m+1; Transfinite Surface{1}; Recombine Surface{1};
Point(11)={sh-0.4,0.7,0}; Point(12)={sh,0.4,0}; Point(13)={sh+0.4,0.7,0};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,11}; Curve Loop(2)={11,12,13}; Plane Surface(2)={2};
Transfinite Curve{11,12,13}=2;
Physical Surface("gasket")={1}; Physical Surface("tooth")={2};
Physical Curve("gb")={1}; Physical Curve("gt")={3}; Physical Curve("ft")={11,12};
