// Quarter of the lower half of a ball (radius 1, centre (0,0,1), flat top at z = 1) on a block [0,w]^2 x [-h,0]; they touch at the origin.
// Hexahedra only: a core and three blocks around it, each with a third of the spherical surface.
DefineConstant[
  n = 2, // cells along a quarter of a great circle, halved
  w = 1, // half width of the block
  h = 1, // its height
  k = 3  // cells along the block's width
];
a = 0.5;
b = 0.42;
c = 0.36;
s = Sqrt(0.5);
t = Sqrt(1 / 3.0);

// ball: centre, poles, middles of the arcs, middle of the surface
Point(1) = {0, 0, 1};
Point(2) = {1, 0, 1};
Point(3) = {0, 1, 1};
Point(4) = {0, 0, 0};
Point(5) = {s, s, 1};
Point(6) = {s, 0, 1 - s};
Point(7) = {0, s, 1 - s};
Point(8) = {t, t, 1 - t};
// core
Point(12) = {a, 0, 1};
Point(13) = {0, a, 1};
Point(14) = {0, 0, 1 - a};
Point(15) = {b, b, 1};
Point(16) = {b, 0, 1 - b};
Point(17) = {0, b, 1 - b};
Point(18) = {c, c, 1 - c};

Circle(1) = {2, 1, 5};
Circle(2) = {5, 1, 3};
Circle(3) = {3, 1, 7};
Circle(4) = {7, 1, 4};
Circle(5) = {4, 1, 6};
Circle(6) = {6, 1, 2};
Circle(7) = {5, 1, 8};
Circle(8) = {7, 1, 8};
Circle(9) = {6, 1, 8};
Line(10) = {1, 12};
Line(11) = {1, 13};
Line(12) = {1, 14};
Line(13) = {12, 15};
Line(14) = {15, 13};
Line(15) = {13, 17};
Line(16) = {17, 14};
Line(17) = {14, 16};
Line(18) = {16, 12};
Line(19) = {15, 18};
Line(20) = {17, 18};
Line(21) = {16, 18};
Line(22) = {12, 2};
Line(23) = {13, 3};
Line(24) = {14, 4};
Line(25) = {15, 5};
Line(26) = {16, 6};
Line(27) = {17, 7};
Line(28) = {18, 8};

// spherical surface
Curve Loop(1) = {1, 7, -9, 6};      Surface(1) = {1} In Sphere {1};
Curve Loop(2) = {2, 3, 8, -7};      Surface(2) = {2} In Sphere {1};
Curve Loop(3) = {4, 5, 9, -8};      Surface(3) = {3} In Sphere {1};
// core
Curve Loop(4) = {10, 13, 14, -11};  Plane Surface(4) = {4};  // top
Curve Loop(5) = {11, 15, 16, -12};  Plane Surface(5) = {5};  // x = 0
Curve Loop(6) = {12, 17, 18, -10};  Plane Surface(6) = {6};  // y = 0
Curve Loop(7) = {13, 19, -21, 18};  Surface(7) = {7};
Curve Loop(8) = {14, 15, 20, -19};  Surface(8) = {8};
Curve Loop(9) = {16, 17, 21, -20};  Surface(9) = {9};
// between core and surface
Curve Loop(10) = {22, 1, -25, -13}; Plane Surface(10) = {10}; // top
Curve Loop(11) = {25, 2, -23, -14}; Plane Surface(11) = {11};
Curve Loop(12) = {23, 3, -27, -15}; Plane Surface(12) = {12}; // x = 0
Curve Loop(13) = {27, 4, -24, -16}; Plane Surface(13) = {13};
Curve Loop(14) = {24, 5, -26, -17}; Plane Surface(14) = {14}; // y = 0
Curve Loop(15) = {26, 6, -22, -18}; Plane Surface(15) = {15};
Curve Loop(16) = {25, 7, -28, -19}; Surface(16) = {16};
Curve Loop(17) = {27, 8, -28, -20}; Surface(17) = {17};
Curve Loop(18) = {26, 9, -28, -21}; Surface(18) = {18};
Surface Loop(1) = {4, 5, 6, 7, 8, 9};        Volume(1) = {1};
Surface Loop(2) = {1, 7, 10, 15, 16, 18};    Volume(2) = {2};
Surface Loop(3) = {2, 8, 11, 12, 16, 17};    Volume(3) = {3};
Surface Loop(4) = {3, 9, 13, 14, 17, 18};    Volume(4) = {4};
Transfinite Curve {1:28} = n + 1;
Transfinite Surface {1:18};
Recombine Surface {1:18};
Transfinite Volume {1:4};

// block
Point(31) = {0, 0, -h};
Point(32) = {w, 0, -h};
Point(33) = {w, w, -h};
Point(34) = {0, w, -h};
Point(35) = {0, 0, 0};
Point(36) = {w, 0, 0};
Point(37) = {w, w, 0};
Point(38) = {0, w, 0};
Line(31) = {31, 32};
Line(32) = {32, 33};
Line(33) = {33, 34};
Line(34) = {34, 31};
Line(35) = {35, 36};
Line(36) = {36, 37};
Line(37) = {37, 38};
Line(38) = {38, 35};
Line(39) = {31, 35};
Line(40) = {32, 36};
Line(41) = {33, 37};
Line(42) = {34, 38};
Curve Loop(31) = {31, 32, 33, 34};  Plane Surface(31) = {31}; // bottom
Curve Loop(32) = {35, 36, 37, 38};  Plane Surface(32) = {32}; // top
Curve Loop(33) = {31, 40, -35, -39}; Plane Surface(33) = {33}; // y = 0
Curve Loop(34) = {32, 41, -36, -40}; Plane Surface(34) = {34}; // x = w
Curve Loop(35) = {33, 42, -37, -41}; Plane Surface(35) = {35}; // y = w
Curve Loop(36) = {34, 39, -38, -42}; Plane Surface(36) = {36}; // x = 0
Surface Loop(5) = {31:36}; Volume(5) = {5};
Transfinite Curve {31:38} = k + 1;
Transfinite Curve {39:42} = Ceil(k * h / w) + 1;
Transfinite Surface {31:36};
Recombine Surface {31:36};
Transfinite Volume {5};

Physical Volume("ball")          = {1:4};
Physical Volume("block")         = {5};
Physical Surface("ball_surface") = {1:3};
Physical Surface("top")          = {4, 10, 11};
Physical Surface("ball_x")       = {5, 12, 13};
Physical Surface("ball_y")       = {6, 14, 15};
Physical Surface("block_top")    = {32};
Physical Surface("bottom")       = {31};
Physical Surface("block_x")      = {36};
Physical Surface("block_y")      = {33};
