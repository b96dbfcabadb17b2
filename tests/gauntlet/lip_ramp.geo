// A rubber ring whose round lip overlaps a shaft of steel; r-z plane
DefineConstant[ s = 0.25 ];
Point(1) = {10.2, -0.7, 0, s*0.7}; Point(2)={10.2,0,0}; Point(3)={10.2,0.7,0,s*0.7}; Point(9)={9.5,0,0,s*0.7};
Point(4) = {12, 1, 0, s*1.5}; Point(5)={12,-1,0,s*1.5};
Circle(1)={3,2,9}; Circle(2)={9,2,1};
Line(3)={1,5}; Line(4)={5,4}; Line(5)={4,3};
Curve Loop(1)={1,2,3,4,5}; Plane Surface(1)={1}; Recombine Surface{1};
Point(11)={8,-1.5,0,s*2}; Point(12)={10,-1.5,0,s*2}; Point(13)={10,1.5,0,s*2}; Point(14)={8,1.5,0,s*2};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11};
Curve Loop(2)={11:14}; Plane Surface(2)={2}; Recombine Surface{2};
Physical Surface("lip")={1}; Physical Curve("inner")={1,2}; Physical Curve("seat")={4};
Physical Surface("shaft")={2}; Physical Curve("land")={12}; Physical Curve("core")={14};
