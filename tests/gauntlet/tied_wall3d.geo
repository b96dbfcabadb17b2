// Two blocks, one on the other, and a wall beside them; n, k: cells along their edges
SetFactory("OpenCASCADE");
DefineConstant[ n = 3, k = 2 ];
Box(1) = {0, 0, 0, 1, 0.6, 0.5}; Box(2) = {0, 0, 0.5, 1, 0.6, 0.5}; Box(3) = {1, -0.1, -0.1, 0.2, 0.8, 1.3};
Transfinite Curve {1:12} = n + 1; Transfinite Curve {13:24} = k + 1; Transfinite Curve {25:36} = 2;
Transfinite Surface {:}; Recombine Surface {:}; Transfinite Volume {:};
Physical Volume("lower") = {1}; Physical Volume("upper") = {2}; Physical Volume("wall") = {3};
Physical Surface("lower_back") = {1}; Physical Surface("lower_side") = {2}; Physical Surface("bottom") = {5}; Physical Surface("joint_lower") = {6};
Physical Surface("upper_back") = {7}; Physical Surface("upper_side") = {8}; Physical Surface("joint_upper") = {11}; Physical Surface("top") = {12};
Physical Surface("flanks") = {3, 4, 9, 10}; Physical Surface("wall_face") = {13};
