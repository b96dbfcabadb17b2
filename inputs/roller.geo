// Quarter of the lower half of a roller (radius 1, axis along y at z = 1) on a block [0,w] x [0,l] x [-h,0]; they touch along the line x = z = 0.
// The right half of the section of hertz2d.geo, drawn along y. Hexahedra only.
DefineConstant[
  n = 4, // cells along the quarter of the arc (even)
  w = 1, // half width of the block
  h = 1, // its height
  l = 2, // half length
  k = 2  // cells along it
];
m = Ceil(n / 2); // cells along a side of a block of the O-grid
s = Sqrt(0.5);

// half disc: centre, arc, core
Point(1) = {0, 0, 1};
Point(4) = {0, 0, 0};
Point(5) = {s, 0, 1 - s};
Point(6) = {1, 0, 1};
Point(9) = {0, 0, 0.5};
Point(10) = {0.4, 0, 0.6};
Point(11) = {0.5, 0, 1};

Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 6};
Line(7)  = {9, 10};
Line(8)  = {10, 11};
Line(10) = {1, 11};
Line(11) = {1, 9};
Line(14) = {4, 9};
Line(15) = {5, 10};
Line(16) = {6, 11};

Curve Loop(3) = {3, 15, -7, -14};   Plane Surface(3) = {3};
Curve Loop(4) = {4, 16, -8, -15};   Plane Surface(4) = {4};
Curve Loop(6) = {11, 7, 8, -10};    Plane Surface(6) = {6};

Transfinite Curve {3, 4, 7, 8, 10, 11, 14, 15, 16} = m + 1;
Transfinite Surface {3, 4, 6};
Recombine Surface {3, 4, 6};

// of each: the far end, the volume, then the sides in the order of the curve loop
a[] = Extrude {0, l, 0} { Surface{3}; Layers{k}; Recombine; };
b[] = Extrude {0, l, 0} { Surface{4}; Layers{k}; Recombine; };
c[] = Extrude {0, l, 0} { Surface{6}; Layers{k}; Recombine; };

// block, drawn without Extrude and after it: that merges points that lie in one place, and the bodies would share the line of contact
Point(1001) = {0, 0, -h};
Point(1002) = {w, 0, -h};
Point(1003) = {w, l, -h};
Point(1004) = {0, l, -h};
Point(1005) = {0, 0, 0};
Point(1006) = {w, 0, 0};
Point(1007) = {w, l, 0};
Point(1008) = {0, l, 0};
Line(1001) = {1001, 1002};
Line(1002) = {1002, 1003};
Line(1003) = {1003, 1004};
Line(1004) = {1004, 1001};
Line(1005) = {1005, 1006};
Line(1006) = {1006, 1007};
Line(1007) = {1007, 1008};
Line(1008) = {1008, 1005};
Line(1009) = {1001, 1005};
Line(1010) = {1002, 1006};
Line(1011) = {1003, 1007};
Line(1012) = {1004, 1008};
Curve Loop(1001) = {1001, 1002, 1003, 1004};    Plane Surface(1001) = {1001}; // bottom
Curve Loop(1002) = {1005, 1006, 1007, 1008};    Plane Surface(1002) = {1002}; // top
Curve Loop(1003) = {1001, 1010, -1005, -1009};  Plane Surface(1003) = {1003}; // y = 0
Curve Loop(1004) = {1002, 1011, -1006, -1010};  Plane Surface(1004) = {1004}; // x = w
Curve Loop(1005) = {1003, 1012, -1007, -1011};  Plane Surface(1005) = {1005}; // y = l
Curve Loop(1006) = {1004, 1009, -1008, -1012};  Plane Surface(1006) = {1006}; // x = 0
Surface Loop(1001) = {1001:1006};               Volume(1001) = {1001};
Transfinite Curve {1001, 1003, 1005, 1007} = Ceil(0.75 * n * w) + 1;
Transfinite Curve {1002, 1004, 1006, 1008} = k + 1;
Transfinite Curve {1009:1012} = Ceil(0.75 * n * h) + 1;
Transfinite Surface {1001:1006};
Recombine Surface {1001:1006};
Transfinite Volume {1001};

Physical Volume("roller")          = {a[1], b[1], c[1]};
Physical Volume("block")           = {1001};
Physical Surface("roller_surface") = {a[2], b[2]};
Physical Surface("top")            = {b[3], c[5]};
Physical Surface("roller_x")       = {a[5], c[2]};
Physical Surface("roller_ends")    = {3, 4, 6, a[0], b[0], c[0]};
Physical Surface("block_top")      = {1002};
Physical Surface("bottom")         = {1001};
Physical Surface("block_x")        = {1006};
Physical Surface("block_ends")     = {1003, 1005};
