// a disc (radius R, height h; n cells along each quarter) on a plate (m cells along its edges)
DefineConstant[ n = 2, m = 6, h = 0.3, R = 0.5, q = 0.25 ];
// disc: o-grid
Point(1)={q,q,0}; Point(2)={-q,q,0}; Point(3)={-q,-q,0}; Point(4)={q,-q,0}; Point(9)={0,0,0};
c=R*Sqrt(0.5);
Point(5)={c,c,0}; Point(6)={-c,c,0}; Point(7)={-c,-c,0}; Point(8)={c,-c,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};
Circle(5)={5,9,6}; Circle(6)={6,9,7}; Circle(7)={7,9,8}; Circle(8)={8,9,5};
Line(9)={1,5}; Line(10)={2,6}; Line(11)={3,7}; Line(12)={4,8};
Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1};
Curve Loop(2)={-1,9,5,-10}; Plane Surface(2)={2};
Curve Loop(3)={-2,10,6,-11}; Plane Surface(3)={3};
Curve Loop(4)={-3,11,7,-12}; Plane Surface(4)={4};
Curve Loop(5)={-4,12,8,-9}; Plane Surface(5)={5};
Transfinite Curve{1:8}=n+1; Transfinite Curve{9:12}=2; Transfinite Surface{1:5}; Recombine Surface{1:5};
For i In {1:5}
 b~{i}[] = Extrude {0,0,h} { Surface{i}; Layers{2}; Recombine; };
EndFor
Point(31)={-1,-1,-0.4}; Point(32)={1,-1,-0.4}; Point(33)={1,1,-0.4}; Point(34)={-1,1,-0.4};
Line(131)={31,32}; Line(132)={32,33}; Line(133)={33,34}; Line(134)={34,31}; Curve Loop(131)={131:134}; Plane Surface(131)={131};
Transfinite Curve{131:134}=m+1; Transfinite Surface{131}; Recombine Surface{131};
p[]=Extrude{0,0,0.4}{Surface{131}; Layers{2}; Recombine;};
Physical Volume("disc")={b~{1}[1],b~{2}[1],b~{3}[1],b~{4}[1],b~{5}[1]};
Physical Volume("plate")={p[1]};
Physical Surface("under")={1:5}; Physical Surface("top")={b~{1}[0],b~{2}[0],b~{3}[0],b~{4}[0],b~{5}[0]};
Physical Surface("bottom")={131}; Physical Surface("face")={p[0]};
