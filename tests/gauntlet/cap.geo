// a strip of length 4 and thickness h, and a cap on its end twice as thick, in cells of another size
DefineConstant[ h = 0.05, n = 16 ];
Point(1)={0,0,0}; Point(2)={4,0,0}; Point(3)={4,h,0}; Point(4)={0,h,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Transfinite Curve{1,3}=n+1; Transfinite Curve{2,4}=2; Transfinite Surface{1};
Point(11)={4,-h/2,0}; Point(12)={4.1,-h/2,0}; Point(13)={4.1,1.5*h,0}; Point(14)={4,1.5*h,0};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(11)={11:14}; Plane Surface(11)={11};
Transfinite Curve{11,13}=2; Transfinite Curve{12,14}=4; Transfinite Surface{11}; Recombine Surface{1,11};
Physical Surface("strip")={1}; Physical Surface("cap")={11};
Physical Curve("foot")={4}; Physical Curve("end")={2}; Physical Curve("face")={14};
