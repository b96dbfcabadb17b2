// Halves of a quarter ring, radii 1 and 1.4, height 0.3; n, m cells along either
DefineConstant[ n = 2, m = 3, u = 2, v = 3 ];
c = Sqrt(0.5);
Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1.4,0,0}; Point(4)={1.4*c,1.4*c,0}; Point(5)={c,c,0};
Line(1)={2,3}; Circle(2)={3,1,4}; Line(3)={4,5}; Circle(4)={5,1,2}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Transfinite Curve{1,3}=u+1; Transfinite Curve{2,4}=n+1; Transfinite Surface{1}; Recombine Surface{1};
a[]=Extrude{0,0,0.3}{Surface{1}; Layers{1}; Recombine;};
q = 0.007; Point(111)={-q,q,0}; Point(112)={c-q,c+q,0}; Point(113)={1.4*c-q,1.4*c+q,0}; Point(114)={-q,1.4+q,0}; Point(115)={-q,1+q,0};
Line(211)={112,113}; Circle(212)={113,111,114}; Line(213)={114,115}; Circle(214)={115,111,112}; Curve Loop(211)={211:214}; Plane Surface(211)={211};
Transfinite Curve{211,213}=v+1; Transfinite Curve{212,214}=m+1; Transfinite Surface{211}; Recombine Surface{211};
b[]=Extrude{0,0,0.3}{Surface{211}; Layers{2}; Recombine;};
Physical Volume("a")={a[1]}; Physical Volume("b")={b[1]};
Physical Surface("root")={a[2]}; Physical Surface("cut_a")={a[4]}; Physical Surface("cut_b")={b[2]}; Physical Surface("tip")={b[4]};
