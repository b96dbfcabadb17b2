// Axisymmetric: a tube, and around it, with a gap, a ring.
Point(1) = {1, 0, 0}; Point(2) = {1.1, 0, 0}; Point(3) = {1.1, 0.3, 0}; Point(4) = {1, 0.3, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(5) = {1.11, 0, 0}; Point(6) = {1.6, 0, 0}; Point(7) = {1.6, 0.3, 0}; Point(8) = {1.11, 0.3, 0};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Transfinite Curve {1, 3} = 4; Transfinite Curve {2, 4} = 3; Transfinite Curve {5, 7} = 5; Transfinite Curve {6, 8} = 4;
Transfinite Surface {1} = {1, 2, 3, 4}; Transfinite Surface {2} = {5, 6, 7, 8}; Recombine Surface {1, 2};
Physical Surface("tube") = {1}; Physical Surface("ring") = {2};
Physical Curve("y0") = {1, 5}; Physical Curve("y1") = {3, 7}; Physical Curve("inside") = {4}; Physical Curve("outside") = {2}; Physical Curve("hole") = {8};
