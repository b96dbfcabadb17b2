// Halves of three discs one on the other between a floor and a plate.
DefineConstant[ s = 1 ];
Point(10) = {0, 0.3, 0}; Point(11) = {0, 0.0, 0, s*0.06}; Point(12) = {0.3, 0.3, 0, s*0.09}; Point(13) = {0, 0.6, 0, s*0.06};
Circle(11) = {11, 10, 12}; Circle(12) = {12, 10, 13}; Line(13) = {13, 11}; Curve Loop(10) = {11, 12, 13}; Plane Surface(10) = {10}; Recombine Surface {10};
Point(20) = {0, 0.8, 0}; Point(21) = {0, 0.6000000000000001, 0, s*0.05}; Point(22) = {0.2, 0.8, 0, s*0.07500000000000001}; Point(23) = {0, 1.0, 0, s*0.05};
Circle(21) = {21, 20, 22}; Circle(22) = {22, 20, 23}; Line(23) = {23, 21}; Curve Loop(20) = {21, 22, 23}; Plane Surface(20) = {20}; Recombine Surface {20};
Point(30) = {0, 1.3, 0}; Point(31) = {0, 1.0, 0, s*0.06}; Point(32) = {0.3, 1.3, 0, s*0.09}; Point(33) = {0, 1.6, 0, s*0.06};
Circle(31) = {31, 30, 32}; Circle(32) = {32, 30, 33}; Line(33) = {33, 31}; Curve Loop(30) = {31, 32, 33}; Plane Surface(30) = {30}; Recombine Surface {30};
Point(1) = {-0.2, -0.1, 0}; Point(2) = {0.8, -0.1, 0}; Point(3) = {0.8, 0, 0}; Point(4) = {-0.2, 0, 0}; Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(5) = {-0.2, 1.6, 0}; Point(6) = {0.8, 1.6, 0}; Point(7) = {0.8, 1.7, 0}; Point(8) = {-0.2, 1.7, 0}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5}; Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Transfinite Curve {1:8} = 2; Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Physical Surface("floor") = {1}; Physical Surface("plate") = {2}; Physical Surface("a") = {10}; Physical Surface("b") = {20}; Physical Surface("d") = {30};
Physical Curve("floor_face") = {3}; Physical Curve("plate_face") = {5}; Physical Curve("a_skin") = {11, 12}; Physical Curve("b_skin") = {21, 22}; Physical Curve("d_skin") = {31, 32}; Physical Curve("cut") = {13, 23, 33};
