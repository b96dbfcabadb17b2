// a block in a corner: floor and wall are two rigid or elastic bodies
DefineConstant[ n = 4 ];
Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,1,0}; Point(4)={0,1,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Transfinite Curve{1:4}=n+1; Transfinite Surface{1}; Recombine Surface{1};
Point(11)={-0.5,-0.5,0}; Point(12)={1.6,-0.5,0}; Point(13)={1.6,0,0}; Point(14)={-0.5,0,0};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(11)={11:14}; Plane Surface(11)={11};
Transfinite Curve{11,13}=9; Transfinite Curve{12,14}=3; Transfinite Surface{11}; Recombine Surface{11};
Point(21)={-0.5,0,0}; Point(22)={0,0,0}; Point(23)={0,1.4,0}; Point(24)={-0.5,1.4,0};
Line(21)={21,22}; Line(22)={22,23}; Line(23)={23,24}; Line(24)={24,21}; Curve Loop(21)={21:24}; Plane Surface(21)={21};
Transfinite Curve{22,24}=7; Transfinite Curve{21,23}=3; Transfinite Surface{21}; Recombine Surface{21};
Physical Surface("block")={1}; Physical Surface("floor")={11}; Physical Surface("wall")={21};
Physical Curve("under")={1}; Physical Curve("left")={4}; Physical Curve("top")={3}; Physical Curve("right")={2};
Physical Curve("floor_top")={13}; Physical Curve("floor_bottom")={11}; Physical Curve("wall_face")={22}; Physical Curve("wall_back")={24};
