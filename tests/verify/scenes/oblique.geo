// A block cut at 30 degrees, one face of which is to be held. depth > 0: in space; beyond: what the upper part reaches beyond both sides of the lower one
SetFactory("OpenCASCADE");
DefineConstant[ depth = 0, beyond = 0 ];
a = 0.21132486540518713; b = 0.78867513459481287;
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, b, 0}; Point(4) = {0, a, 0};
Point(5) = {-beyond, a - beyond * (b - a), 0}; Point(6) = {1 + beyond, b + beyond * (b - a), 0}; Point(7) = {1 + beyond, 1.2, 0}; Point(8) = {-beyond, 1.2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Transfinite Curve {1:4} = 4; Transfinite Curve {5:8} = 5;
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Transfinite Surface {1, 2}; Recombine Surface {1, 2};
If (depth > 0)
  low[] = Extrude {0, 0, depth} { Surface{1}; Layers{2}; Recombine; };
  up[] = Extrude {0, 0, depth} { Surface{2}; Layers{3}; Recombine; };
  Physical Volume("low") = {low[1]}; Physical Volume("up") = {up[1]};
  Physical Surface("bottom") = {low[2]}; Physical Surface("top") = {up[4]}; Physical Surface("left") = {low[5], up[5]};
  Physical Surface("under") = {low[4]}; Physical Surface("over") = {up[2]}; Physical Surface("back") = {1, 2};
Else
  Physical Surface("low") = {1}; Physical Surface("up") = {2};
  Physical Curve("bottom") = {1}; Physical Curve("top") = {7}; Physical Curve("left") = {4, 8};
  Physical Curve("under") = {3}; Physical Curve("over") = {5};
EndIf
