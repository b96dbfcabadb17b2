// a strip of thickness h along a spiral of N turns, s cells a turn
DefineConstant[ N = 2.25, r0 = 0.6, p = 0.2, h = 0.12, s = 16 ];
M = 24;
For i In {0:M}
  t = 2*Pi*N*i/M; r = r0 + p*t/(2*Pi);
  Point(100+i) = {r*Cos(t), r*Sin(t), 0};
  Point(200+i) = {(r+h)*Cos(t), (r+h)*Sin(t), 0};
EndFor
Spline(1) = {100:100+M}; Spline(2) = {200:200+M}; Line(3) = {100,200}; Line(4) = {100+M,200+M};
Curve Loop(1) = {1,4,-2,-3}; Plane Surface(1) = {1};
Transfinite Curve{1,2} = s*N+1; Transfinite Curve{3,4}=2; Transfinite Surface{1} = {100,100+M,200+M,200}; Recombine Surface{1};
Physical Surface("strip")={1}; Physical Curve("hull")={1,2,3,4}; Physical Curve("flanks")={1,2}; Physical Curve("inner")={3}; Physical Curve("outer")={4};
