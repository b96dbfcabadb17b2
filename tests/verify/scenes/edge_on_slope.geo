// an elastic wedge, its face at 45 degrees, over the sharp edge of a block
DefineConstant[f=1];
Point(1)={1,-1,0,0.25*f}; Point(2)={2,-1,0,0.25*f}; Point(3)={2,0,0,0.25*f}; Point(4)={1,0,0,0.25*f};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};
Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1};
Transfinite Curve{1,2,3,4}=4/f+1; Transfinite Surface{1}; Recombine Surface{1};
Point(11)={0.2,-0.8,0,0.25*f}; Point(12)={1.8,0.8,0,0.25*f}; Point(13)={1,1.6,0,0.25*f}; Point(14)={-0.6,0,0,0.25*f};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11};
Curve Loop(2)={11,12,13,14}; Plane Surface(2)={2};
Transfinite Curve{11,13}=Ceil(9/f)+1; Transfinite Curve{12,14}=Ceil(5/f)+1; Transfinite Surface{2}; Recombine Surface{2};
Physical Surface("block")={1}; Physical Surface("wedge")={2};
Physical Curve("base")={1}; Physical Curve("top")={3}; Physical Curve("inner")={4}; Physical Curve("face")={11}; Physical Curve("held")={13};
