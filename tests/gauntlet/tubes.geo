// A shaft (r from rb to ra, z from 0 to sl) in a hub (r from ra - o to rh, z from h0 to h1) in the r-z plane; o: interference. c: radius of the shaft's outer end edge, e: of the hub's bore.
DefineConstant[
  rb = 0, ra = 1, rh = 2, sl = 2, h0 = 0, h1 = 2, o = 0.02, c = 0, e = 0,
  ns = 4, ms = 8, nh = 4, mh = 6 // cells across and along the shaft and the hub
];
Point(1) = {rb, 0, 0}; Point(2) = {ra, 0, 0}; Point(4) = {rb, sl, 0}; Line(1) = {1, 2}; Line(4) = {4, 1};
If (c > 0)
  Point(3) = {ra, sl - c, 0}; Point(5) = {ra - c, sl - c, 0}; Point(6) = {ra - c, sl, 0};
  Line(2) = {2, 3}; Circle(5) = {3, 5, 6}; Line(3) = {6, 4}; Curve Loop(1) = {1, 2, 5, 3, 4}; Plane Surface(1) = {1};
  Transfinite Curve {1, 3} = ns + 1; Transfinite Curve {2, 4} = ms + 1; Transfinite Curve {5} = 4; shaft[] = {2, 5, 3};
Else
  Point(3) = {ra, sl, 0}; Line(2) = {2, 3}; Line(3) = {3, 4}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
  Transfinite Curve {1, 3} = ns + 1; Transfinite Curve {2, 4} = ms + 1; Transfinite Surface {1}; shaft[] = {2, 3};
EndIf
ri = ra - o;
Point(12) = {rh, h0, 0}; Point(13) = {rh, h1, 0}; Line(12) = {12, 13};
If (e > 0)
  Point(11) = {ri + e, h0, 0}; Point(14) = {ri + e, h1, 0}; Point(15) = {ri + e, h0 + e, 0}; Point(16) = {ri, h0 + e, 0}; Point(17) = {ri + e, h1 - e, 0}; Point(18) = {ri, h1 - e, 0};
  Line(11) = {11, 12}; Line(13) = {13, 14}; Circle(15) = {14, 17, 18}; Line(14) = {18, 16}; Circle(16) = {16, 15, 11};
  Curve Loop(2) = {11, 12, 13, 15, 14, 16}; Plane Surface(2) = {2};
  Transfinite Curve {11, 13} = nh + 1; Transfinite Curve {12, 14} = mh + 1; Transfinite Curve {15, 16} = 4; hub[] = {11, 13, 14, 15, 16};
Else
  Point(11) = {ri, h0, 0}; Point(14) = {ri, h1, 0};
  Line(11) = {11, 12}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
  Transfinite Curve {11, 13} = nh + 1; Transfinite Curve {12, 14} = mh + 1; Transfinite Surface {2}; hub[] = {11, 13, 14};
EndIf
Recombine Surface {1, 2};
Physical Surface("shaft") = {1}; Physical Surface("hub") = {2};
Physical Curve("seat") = {2}; Physical Curve("bore") = {14}; Physical Curve("shaft_skin") = {shaft[]}; Physical Curve("hub_skin") = {hub[]};
Physical Curve("rim") = {12}; Physical Curve("inside") = {4}; Physical Curve("foot") = {1}; Physical Curve("ends") = {1, 3, 11, 13}; Physical Curve("hub_top") = {13};
