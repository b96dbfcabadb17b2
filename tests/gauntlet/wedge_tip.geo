// A rigid wedge of 90 degrees, its tip rounded by r, on a block of n cells: facets of the wedge of h, on the block of 1/n.
DefineConstant[ r = 0.03, h = 0.015, off = 0.013, n = 28 ];
c = r*Sqrt(2)/2; w = 0.25;
Point(1) = {off - w, w - r*(Sqrt(2)-1), 0, h}; Point(2) = {off - c, r - c, 0, h}; Point(3) = {off, r, 0, h};
Point(4) = {off + c, r - c, 0, h}; Point(5) = {off + w, w - r*(Sqrt(2)-1), 0, h}; Point(6) = {off + w, 0.4, 0, h}; Point(7) = {off - w, 0.4, 0, h};
Line(1) = {1,2}; Circle(2) = {2,3,4}; Line(3) = {4,5}; Line(4) = {5,6}; Line(5) = {6,7}; Line(6) = {7,1};
Curve Loop(1) = {1:6}; Plane Surface(1) = {1}; Recombine Surface {1};
Point(11) = {-0.5, -0.5, 0}; Point(12) = {0.5, -0.5, 0}; Point(13) = {0.5, 0, 0}; Point(14) = {-0.5, 0, 0};
Line(11) = {11,12}; Line(12) = {12,13}; Line(13) = {13,14}; Line(14) = {14,11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {11,13} = n+1; Transfinite Curve {12,14} = n/2+1; Transfinite Surface {2}; Recombine Surface {2};
Physical Surface("tool") = {1}; Physical Surface("block") = {2};
Physical Curve("tip") = {1,2,3}; Physical Curve("face") = {13}; Physical Curve("bot") = {11};
