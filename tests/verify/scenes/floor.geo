// Half of a half disc (radius 1) on a floor that goes on beyond the plane of symmetry, to x = -a.
DefineConstant[ n = 8, a = 0.5 ];
m = n/2; s = Sqrt(0.5);
Point(1)={0,1,0}; Point(4)={0,0,0}; Point(5)={s,1-s,0}; Point(6)={1,1,0}; Point(9)={0,0.5,0}; Point(10)={0.4,0.6,0}; Point(11)={0.5,1,0};
Circle(3)={4,1,5}; Circle(4)={5,1,6}; Line(7)={9,10}; Line(8)={10,11}; Line(10)={1,11}; Line(11)={1,9}; Line(14)={4,9}; Line(15)={5,10}; Line(16)={6,11};
Curve Loop(3)={3,15,-7,-14}; Plane Surface(3)={3};
Curve Loop(4)={4,16,-8,-15}; Plane Surface(4)={4};
Curve Loop(6)={11,7,8,-10}; Plane Surface(6)={6};
Transfinite Curve {3,4,7,8,10,11,14,15,16}=m+1;
Transfinite Surface {3,4,6}; Recombine Surface {3,4,6};
Point(21)={-a,-0.5,0}; Point(22)={2,-0.5,0}; Point(23)={2,0,0}; Point(24)={-a,0,0};
Line(21)={21,22}; Line(22)={22,23}; Line(23)={23,24}; Line(24)={24,21}; Curve Loop(7)={21,22,23,24}; Plane Surface(7)={7};
Transfinite Curve {21,23}=3; Transfinite Curve {22,24}=2; Transfinite Surface {7}; Recombine Surface {7};
Physical Surface("disc")={3,4,6}; Physical Surface("floor")={7};
Physical Curve("cup")={3,4}; Physical Curve("top")={10,16}; Physical Curve("sym")={14,11}; Physical Curve("floor_top")={23};
