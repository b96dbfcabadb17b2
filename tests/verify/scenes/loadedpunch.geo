// Axisymmetric: punch of radius 2.5 on a half-space cut off at radius 50. Quadrilaterals of order 2.

Point(1)={0,0,0}; Point(2)={2.5,0,0}; Point(3)={50,0,0}; Point(4)={0,-50,0}; Point(5)={0,-2.5,0}; Point(6)={2.0,-2.0,0}; Point(7)={35.35533905932738,-35.35533905932738,0};
Line(1)={1,2}; Line(2)={2,6}; Line(3)={6,5}; Line(4)={5,1}; Line(5)={2,3}; Circle(6)={3,1,7}; Circle(7)={7,1,4}; Line(8)={4,5}; Line(9)={6,7};
Curve Loop(1)={1,2,3,4}; Curve Loop(2)={5,6,-9,-2}; Curve Loop(3)={9,7,8,-3}; Plane Surface(1)={1}; Plane Surface(2)={2}; Plane Surface(3)={3};
Transfinite Curve{1,2,3,4,6,7}=9; Transfinite Curve{5,9}=10 Using Progression 1.4; Transfinite Curve{8}=10 Using Progression 1/1.4; Transfinite Surface{1:3}; Recombine Surface{1:3};
Physical Surface("ground")={1:3}; Physical Curve("surface")={1,5}; Physical Curve("far")={6,7};

Point(11)={0,0,0}; Point(12)={2.5,0,0}; Point(13)={2.5,1.5,0}; Point(14)={0,1.5,0}; Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11};
Curve Loop(11)={11,12,13,14}; Plane Surface(11)={11}; Transfinite Curve{11,13}=6; Transfinite Curve{12,14}=4; Transfinite Surface{11}; Recombine Surface{11};
Physical Surface("punch")={11}; Physical Curve("face")={11}; Physical Curve("top")={13}; Physical Curve("axis")={4,8,14};
