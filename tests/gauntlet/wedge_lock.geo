// A wedge between two blocks whose faces are as steep, a: half its angle in degrees
DefineConstant[ a = 8, n = 5, m = 6, g = 0 ];
k = Tan(a * Pi / 180); w = 0.2;
Point(1)={-w,0,0}; Point(2)={w,0,0}; Point(3)={w+1.2*k,1.2,0}; Point(4)={-w-1.2*k,1.2,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Transfinite Curve{1,3}=3; Transfinite Curve{2,4}=5; Transfinite Surface{1};
y0=0.2; y1=1;
Point(11)={w+y0*k+g,y0,0}; Point(12)={1,y0,0}; Point(13)={1,y1,0}; Point(14)={w+y1*k+g,y1,0};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(11)={11:14}; Plane Surface(11)={11};
Point(21)={-w-y0*k-g,y0,0}; Point(22)={-1,y0,0}; Point(23)={-1,y1,0}; Point(24)={-w-y1*k-g,y1,0};
Line(21)={22,21}; Line(22)={21,24}; Line(23)={24,23}; Line(24)={23,22}; Curve Loop(21)={21:24}; Plane Surface(21)={21};
Transfinite Curve{12,14}=n+1; Transfinite Curve{22,24}=m+1; Transfinite Curve{11,13,21,23}=4; Transfinite Surface{11}; Transfinite Surface{21};
Recombine Surface{1,11,21};
Physical Surface("wedge")={1}; Physical Surface("right")={11}; Physical Surface("left")={21};
Physical Curve("right_flank")={2}; Physical Curve("left_flank")={4}; Physical Curve("right_face")={14}; Physical Curve("left_face")={22}; Physical Curve("right_back")={12}; Physical Curve("left_back")={24};
