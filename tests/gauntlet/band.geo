// A band round the upper half of a drum; n: its cells
DefineConstant[ n = 40 ];
Point(1)={0,0,0}; R=1; w=.05;
Point(2)={R,0,0};Point(3)={0,R,0};Point(4)={-R,0,0};Point(5)={R+w,0,0};Point(6)={0,R+w,0};Point(7)={-R-w,0,0}; Point(8)={R,-.5,0};Point(9)={R+w,-.5,0};Point(10)={-R,-.5,0};Point(11)={-R-w,-.5,0};
Circle(1)={2,1,3};Circle(2)={3,1,4};Circle(3)={5,1,6};Circle(4)={6,1,7};Line(5)={2,5};Line(6)={3,6};Line(7)={4,7};Line(8)={8,9};Line(9)={8,2};Line(10)={9,5};Line(11)={10,11};Line(12)={4,10};Line(13)={7,11};
Curve Loop(1)={1,6,-3,-5};Plane Surface(1)={1};Curve Loop(2)={2,7,-4,-6};Plane Surface(2)={2};Curve Loop(3)={9,5,-10,-8};Plane Surface(3)={3};Curve Loop(4)={12,11,-13,-7};Plane Surface(4)={4};
Transfinite Curve{1:4}=n/2+1;Transfinite Curve{5,6,7,8,11}=2;Transfinite Curve{9,10,12,13}=7;Transfinite Surface{1:4};
Point(20)={0,0,0}; Point(22)={R,0,0,.12};Point(23)={0,R,0,.12};Point(24)={-R,0,0,.12};Point(25)={0,-R,0,.12}; Circle(20)={22,20,23};Circle(21)={23,20,24};Circle(22)={24,20,25};Circle(23)={25,20,22};Curve Loop(20)={20:23};Plane Surface(20)={20};
Recombine Surface{:};Physical Surface("belt")={1:4};Physical Surface("drum")={20};Physical Curve("inner")={1,2,9,12};Physical Curve("rim")={20:23};Physical Curve("free")={8};Physical Curve("held")={11};
