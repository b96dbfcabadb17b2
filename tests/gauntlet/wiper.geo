// a wiper blade on a window: the rounded end, of radius r, begins o below the surface
DefineConstant[o=0.8, r=0.1, h=0.12];
c=Cos(Pi/6); s=Sin(Pi/6); L=2; t=0.15;
x=0; y=r-o; // centre of the end
Point(1)={x-L*s-t*c,y+L*c-t*s,0,h};Point(2)={x-r*c,y-r*s,0,h/4};Point(3)={x,y,0,h/4};Point(4)={x+r*s,y-r*c,0,h/4};Point(5)={x+r*c,y+r*s,0,h/4};
Point(6)={x-L*s+t*c,y+L*c+t*s,0,h};
Line(1)={1,2};Circle(2)={2,3,4};Circle(3)={4,3,5};Line(4)={5,6};Line(5)={6,1};
Curve Loop(1)={1:5};Plane Surface(1)={1};
Point(11)={-1.5,-1,0};Point(12)={1.5,-1,0};Point(13)={1.5,0,0};Point(14)={-1.5,0,0};
Line(11)={11,12};Line(12)={12,13};Line(13)={13,14};Line(14)={14,11};
Curve Loop(2)={11:14};Plane Surface(2)={2};
Transfinite Curve{11,13}=13;Transfinite Curve{12,14}=5;Transfinite Surface{2};
Recombine Surface{:};
Physical Surface("blade")={1};Physical Surface("window")={2};
Physical Curve("edge")={1,2,3,4};Physical Curve("arm")={5};
Physical Curve("pane")={13};Physical Curve("frame")={11};
