// Two squares on their corners, g apart; the small cell in the middle of each is held or moved by its boundary
DefineConstant[ g = 0.1, n = 3 ];
Macro Diamond
  Point(b+1)={0,y-r,0}; Point(b+2)={r,y,0}; Point(b+3)={0,y+r,0}; Point(b+4)={-r,y,0};
  Point(b+11)={0,y-r/3,0}; Point(b+12)={r/3,y,0}; Point(b+13)={0,y+r/3,0}; Point(b+14)={-r/3,y,0};
  For i In {1:4}
    j = i%4+1;
    Line(b+i)={b+i,b+j}; Line(b+10+i)={b+10+i,b+10+j}; Line(b+20+i)={b+10+i,b+i};
  EndFor
  For i In {1:4}
    j = i%4+1;
    Curve Loop(b+i)={b+i,-(b+20+j),-(b+10+i),b+20+i}; Plane Surface(b+i)={b+i};
  EndFor
  Transfinite Curve{b+1:b+4,b+11:b+14}=n+1; Transfinite Curve{b+21:b+24}=3; Transfinite Surface{b+1:b+4}; Recombine Surface{b+1:b+4};
Return
b=100; y=0.5; r=0.5; Call Diamond;
b=200; y=-0.5-g; r=0.5; Call Diamond;
Physical Surface("upper")={101:104}; Physical Surface("lower")={201:204};
Physical Curve("skin_u")={101:104}; Physical Curve("skin_l")={201:204}; Physical Curve("moved")={111:114}; Physical Curve("held")={211:214};
