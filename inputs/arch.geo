// Half ring of two layers (radii 95, 90, 85 mm) on a block 250 x 50; the half x > 0; a slice of thickness d, or (d = 0) in the plane. Millimetres.
DefineConstant[
  n = 24, // cells along the quarter of the ring
  m = 1,  // across each layer
  k = 25, // along the half block
  d = 0,  // thickness; 0: in the plane
  nd = 1  // cells along it
];
ro = 95;
rm = 90;
ri = 85;
Point(1) = {0, ro, 0};    // centre; the block's top is y = 0
Point(2) = {0, 0, 0};
Point(3) = {ro, ro, 0};
Point(4) = {0, ro - rm, 0};
Point(5) = {rm, ro, 0};
Point(6) = {0, ro - ri, 0};
Point(7) = {ri, ro, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {4, 1, 5};
Circle(3) = {6, 1, 7};
Line(4) = {2, 4};
Line(5) = {4, 6};
Line(6) = {3, 5};
Line(7) = {5, 7};
Curve Loop(1) = {1, 6, -2, -4}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -3, -5}; Plane Surface(2) = {2};
// block: a hair below, so that gmsh joins no points
e = 1e-4;
Point(11) = {0, -50 - e, 0};
Point(12) = {125, -50 - e, 0};
Point(13) = {125, -e, 0};
Point(14) = {0, -e, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};
Transfinite Curve {1:3} = n + 1;
Transfinite Curve {4:7} = m + 1;
Transfinite Curve {11, 13} = k + 1;
Transfinite Curve {12, -14} = k / 3 + 1 Using Progression 0.85;
Transfinite Surface {1:3};
Recombine Surface {1:3};
If (d == 0)
  Physical Surface("outer")     = {1};
  Physical Surface("inner")     = {2};
  Physical Surface("block")     = {3};
  Physical Curve("ring_skin")   = {1};
  Physical Curve("ends")        = {6, 7};
  Physical Curve("ring_x")      = {4, 5};
  Physical Curve("block_x")     = {14};
  Physical Curve("block_top")   = {13};
  Physical Curve("bottom")      = {11};
Else
  a[] = Extrude {0, 0, d} { Surface{1}; Layers{nd}; Recombine; };
  b[] = Extrude {0, 0, d} { Surface{2}; Layers{nd}; Recombine; };
  c[] = Extrude {0, 0, d} { Surface{3}; Layers{nd}; Recombine; };
  Physical Volume("outer")      = {a[1]};
  Physical Volume("inner")      = {b[1]};
  Physical Volume("block")      = {c[1]};
  Physical Surface("ring_skin") = {a[2]};
  Physical Surface("ends")      = {a[3], b[3]};
  Physical Surface("ring_x")    = {a[5], b[5]};
  Physical Surface("block_x")   = {c[5]};
  Physical Surface("block_top") = {c[4]};
  Physical Surface("bottom")    = {c[2]};
  Physical Surface("back")      = {1, 2, 3};
  Physical Surface("front")     = {a[0], b[0], c[0]};
EndIf
