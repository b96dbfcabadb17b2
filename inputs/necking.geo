// Half of a round bar in the plane of radius x and axis y: the middle at y = 0, where it is a little thinner.
DefineConstant[ n = 6 ]; // cells along the radius; 2n along the half
DefineConstant[ grade = 1.2 ]; // each is so much longer than its neighbour towards the middle
R = 6.413;  L = 26.667;  taper = 0.982;
Point(1) = {0, 0, 0};  Point(2) = {taper * R, 0, 0};  Point(3) = {R, L, 0};  Point(4) = {0, L, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1:4};  Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {2} = 2 * n + 1 Using Progression grade;
Transfinite Curve {4} = 2 * n + 1 Using Progression 1 / grade;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("bar") = {1};
Physical Curve("middle") = {1};
Physical Curve("end") = {3};
Physical Curve("axis") = {4};
