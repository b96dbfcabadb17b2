// two blocks side by side along the line x = 1; n, m cells along an edge, the right one raised by d
DefineConstant[ n = 2, m = 3, d = 0.3 ];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Point(5) = {1, d, 0}; Point(6) = {2, d, 0}; Point(7) = {2, 1 + d, 0}; Point(8) = {1, 1 + d, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5}; Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Transfinite Curve {1:4} = n + 1; Transfinite Curve {5:8} = m + 1;
Transfinite Surface {1}; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("left") = {1}; Physical Surface("right") = {2};
Physical Curve("wall") = {4}; Physical Curve("left_face") = {2}; Physical Curve("right_face") = {8}; Physical Curve("end") = {6};
