// L-shaped steel bracket: foot [0,40] x [0,8], upright [0,8] x [0,40], a fillet of cells between them.
DefineConstant[ n = 2 ]; // cells through the thickness
Point(1) = {0, 0, 0};  Point(2) = {8, 0, 0};  Point(3) = {40, 0, 0};  Point(4) = {40, 8, 0};
Point(5) = {8, 8, 0};  Point(6) = {8, 40, 0}; Point(7) = {0, 40, 0};  Point(8) = {0, 8, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 1};
Line(9) = {2, 5};  Line(10) = {5, 8};
Curve Loop(1) = {1, 9, 10, 8};     Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -9};     Plane Surface(2) = {2};
Curve Loop(3) = {5, 6, 7, -10};    Plane Surface(3) = {3};
Transfinite Curve {1, 3, 6, 8, 9, 10} = n + 1;
Transfinite Curve {2, 4, 5, 7} = 4 * n + 1;
Transfinite Surface {1:3};
Recombine Surface {1:3};
Physical Surface("bracket") = {1:3};
Physical Curve("wall") = {6};
Physical Curve("tip")  = {3};
