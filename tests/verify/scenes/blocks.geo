// Two blocks on each other, the lower one [0,wl] x [0,hl], the upper one [xu,xu+wu] x [hl,hl+hu], the whole turned by `angle` degrees about the origin.
DefineConstant[
  nl = 4, // cells along the lower side of the interface
  nu = 4, // along the upper one
  ml = 2, // over the height, lower and upper
  mu = 2,
  wl = 1, wu = 1, xu = 0,
  hl = 1, hu = 1,
  split = 0, // 1: cells of the lower block end where the upper one does
  nc = 2, // then: cells of the lower block under the upper one; nl on either side
  angle = 0
];
c = Cos(angle * Pi / 180);
s = Sin(angle * Pi / 180);
Macro Place
  Point(p) = {c * x - s * y, s * x + c * y, 0};
Return
p = 1; x = 0;       y = 0;       Call Place;
p = 2; x = wl;      y = 0;       Call Place;
p = 3; x = wl;      y = hl;      Call Place;
p = 4; x = 0;       y = hl;      Call Place;
p = 5; x = xu;      y = hl;      Call Place;
p = 6; x = xu + wu; y = hl;      Call Place;
p = 7; x = xu + wu; y = hl + hu; Call Place;
p = 8; x = xu;      y = hl + hu; Call Place;
If (split)
  p = 11; x = xu;      y = 0;    Call Place;
  p = 12; x = xu + wu; y = 0;    Call Place;
  p = 13; x = xu + wu; y = hl;   Call Place;
  p = 14; x = xu;      y = hl;   Call Place;
  Line(11) = {1, 11};  Line(12) = {11, 12}; Line(13) = {12, 2};
  Line(2) = {2, 3};    Line(14) = {3, 13};  Line(15) = {13, 14}; Line(16) = {14, 4};  Line(4) = {4, 1};
  Line(17) = {11, 14}; Line(18) = {12, 13};
  Curve Loop(1) = {11, 17, 16, 4};   Plane Surface(1) = {1};
  Curve Loop(2) = {12, 18, 15, -17}; Plane Surface(2) = {2};
  Curve Loop(3) = {13, 2, 14, -18};  Plane Surface(3) = {3};
  Transfinite Curve {11, 16, 13, 14} = nl + 1;
  Transfinite Curve {12, 15} = nc + 1;
  Transfinite Curve {2, 4, 17, 18} = ml + 1;
  Transfinite Surface {1:3};
  Recombine Surface {1:3};
  Physical Surface("lower") = {1:3};
  Physical Curve("bottom") = {11, 12, 13};
  Physical Curve("lower_top") = {14, 15, 16};
  Physical Curve("uncovered") = {14, 16};
Else
  Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
  Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
  Transfinite Curve {1, 3} = nl + 1;
  Transfinite Curve {2, 4} = ml + 1;
  Transfinite Surface {1};
  Recombine Surface {1};
  Physical Surface("lower") = {1};
  Physical Curve("bottom") = {1};
  Physical Curve("lower_top") = {3};
EndIf
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Curve Loop(5) = {5, 6, 7, 8};  Plane Surface(5) = {5};
Transfinite Curve {5, 7} = nu + 1;
Transfinite Curve {6, 8} = mu + 1;
Transfinite Surface {5};
Recombine Surface {5};
Physical Surface("upper") = {5};
Physical Curve("upper_bottom") = {5};
Physical Curve("top") = {7};
Physical Curve("left_lower") = {4};
Physical Curve("left_upper") = {8};
Physical Curve("right_lower") = {2};
Physical Curve("right_upper") = {6};
