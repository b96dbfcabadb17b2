// Indenter 1.2 x 1.2 with a crown of radius 0.75 above a block 12 x 4; gap 0.2. In the plane, or (d > 0) a slice of thickness d.
DefineConstant[
  n = 6,  // cells across the indenter (even); the block's are as long, its lower ones higher
  d = 0,  // thickness; 0: in the plane
  nd = 1  // cells along it
];
r = 0.75;
w = 1.2;                          // width of the indenter
h = 1.2;                          // height to its crown
y0 = 4.2;                         // its lowest point
x0 = 0.8;                         // its axis
s = r - Sqrt(r * r - w * w / 4);  // height of the crown

Point(1) = {x0, y0 + r, 0};
Point(2) = {x0 - w / 2, y0 + s, 0};
Point(3) = {x0, y0, 0};
Point(4) = {x0 + w / 2, y0 + s, 0};
Point(5) = {x0 - w / 2, y0 + h, 0};
Point(6) = {x0, y0 + h, 0};
Point(7) = {x0 + w / 2, y0 + h, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {5, 6};
Line(4) = {6, 7};
Line(5) = {2, 5};
Line(6) = {3, 6};
Line(7) = {4, 7};
Curve Loop(1) = {1, 6, -3, -5}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -4, -6}; Plane Surface(2) = {2};

Point(11) = {0, 0, 0};
Point(12) = {12, 0, 0};
Point(13) = {12, 4, 0};
Point(14) = {0, 4, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};

Transfinite Curve {1:4} = n / 2 + 1;
Transfinite Curve {5:7} = n + 1;
Transfinite Curve {11, 13} = 10 * n + 1;
Transfinite Curve {12, -14} = 1.5 * n + 1 Using Progression 1 / 1.15;
Transfinite Surface {1:3};
Recombine Surface {1:3};

If (d == 0)
  Physical Surface("indenter") = {1, 2};
  Physical Surface("block")    = {3};
  Physical Curve("crown")      = {1, 2};
  Physical Curve("top")        = {3, 4};
  Physical Curve("block_top")  = {13};
  Physical Curve("bottom")     = {11};
Else
  a[] = Extrude {0, 0, d} { Surface{1}; Layers{nd}; Recombine; };
  b[] = Extrude {0, 0, d} { Surface{2}; Layers{nd}; Recombine; };
  c[] = Extrude {0, 0, d} { Surface{3}; Layers{nd}; Recombine; };
  Physical Volume("indenter")   = {a[1], b[1]};
  Physical Volume("block")      = {c[1]};
  Physical Surface("crown")     = {a[2], b[2]};
  Physical Surface("top")       = {a[4], b[4]};
  Physical Surface("block_top") = {c[4]};
  Physical Surface("bottom")    = {c[2]};
  Physical Surface("back")      = {1, 2, 3};
  Physical Surface("front")     = {a[0], b[0], c[0]};
EndIf
