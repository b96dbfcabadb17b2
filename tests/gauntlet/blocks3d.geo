// A block on another in space: lower [l0, l1] x [k0, k1] x [-lh, 0], upper [u0, u1] x [v0, v1] x [-o, uh - o], turned by a degrees about the vertical through the origin.
DefineConstant[
  l0 = 0, l1 = 1, k0 = 0, k1 = 1, lh = 0.5, u0 = 0, u1 = 1, v0 = 0, v1 = 1, uh = 0.5, o = 0, a = 0,
  nl = 4, kl = 4, ml = 2, nu = 3, ku = 3, mu = 2 // cells along x, y, z
];
Point(1) = {l0, k0, -lh}; Point(2) = {l1, k0, -lh}; Point(3) = {l1, k1, -lh}; Point(4) = {l0, k1, -lh};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = nl + 1; Transfinite Curve {2, 4} = kl + 1; Transfinite Surface {1};
Point(11) = {u0, v0, -o}; Point(12) = {u1, v0, -o}; Point(13) = {u1, v1, -o}; Point(14) = {u0, v1, -o};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Rotate {{0, 0, 1}, {0, 0, 0}, a * Pi / 180} { Surface{2}; }
Transfinite Curve {11, 13} = nu + 1; Transfinite Curve {12, 14} = ku + 1; Transfinite Surface {2};
Recombine Surface {1, 2};
b[] = Extrude {0, 0, lh} { Surface{1}; Layers{ml}; Recombine; };
c[] = Extrude {0, 0, uh} { Surface{2}; Layers{mu}; Recombine; };
Physical Volume("lower") = {b[1]}; Physical Volume("upper") = {c[1]};
Physical Surface("bottom") = {1}; Physical Surface("face") = {b[0]}; Physical Surface("hull") = {b[0], b[2], b[3], b[4], b[5]};
Physical Surface("top") = {c[0]}; Physical Surface("under") = {2}; Physical Surface("skin") = {2, c[2], c[3], c[4], c[5]};
Physical Surface("front") = {b[2], c[2]}; Physical Surface("left") = {b[5], c[5]}; Physical Surface("back") = {b[4], c[4]}; Physical Surface("right") = {b[3], c[3]};
Physical Surface("lower_left") = {b[5]}; Physical Surface("lower_front") = {b[2]}; Physical Surface("upper_front") = {c[2]}; Physical Surface("upper_left") = {c[5]};
