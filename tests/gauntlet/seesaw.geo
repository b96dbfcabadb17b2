// a beam on the top of a half disc
DefineConstant[ s = 0.25 ];
Point(1)={0,0,0}; Point(2)={-1,0,0}; Point(3)={1,0,0}; Point(4)={0,1,0};
Line(1)={2,3}; Circle(2)={3,1,4}; Circle(3)={4,1,2}; Curve Loop(1)={1,2,3}; Plane Surface(1)={1};
Point(11)={-3,1,0}; Point(12)={3,1,0}; Point(13)={3,1.3,0}; Point(14)={-3,1.3,0};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(11)={11:14}; Plane Surface(11)={11};
Transfinite Curve{11,13}=13; Transfinite Curve{12,14}=2; Transfinite Surface{11}; Recombine Surface{11};
MeshSize{1,2,3,4}=s;
Physical Surface("disc")={1}; Physical Surface("beam")={11};
Physical Curve("foot")={1}; Physical Curve("round")={2,3}; Physical Curve("under")={11};
