// a quarter of a ball over a block, halves of sections through the axis
DefineConstant[ n = 8, R = 1 ];
Point(1)={0,-2,0}; Point(2)={2,-2,0}; Point(3)={2,0,0}; Point(4)={0,0,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Transfinite Curve{1,-3}=n+1 Using Progression 1.05; Transfinite Curve{2,4}=n+1; Transfinite Surface{1}; Recombine Surface{1};
Point(11)={0,0,0}; Point(12)={R,R,0}; Point(13)={0,R,0}; 
Circle(11)={11,13,12}; Line(12)={12,13}; Line(13)={13,11}; Curve Loop(11)={11:13}; Plane Surface(11)={11}; MeshSize{11:13}=0.25;
Physical Surface("soft")={1}; Physical Surface("ball")={11};
Physical Curve("foot")={1}; Physical Curve("axis")={4}; Physical Curve("top")={3}; Physical Curve("skin")={11};
