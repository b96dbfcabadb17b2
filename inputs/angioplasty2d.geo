// Balloon, sleeve and artery of two layers around the z axis: `sectors` quarters of the cross-section, from the x axis on.
DefineConstant[
  nb = 16, // cells of the balloon along a quarter
  ns = 24, // of the sleeve
  na = 20, // of the artery
  k = 1,   // cells through each of balloon and sleeve: 2k; through media and adventitia: 3k, 2k
  sectors = 1 // 4: the full ring
];
radius[] = {0.4, 0.5, 0.55, 0.65, 0.71, 0.97, 1.1};
Point(1) = {0, 0, 0};
last = sectors == 4 ? 3 : sectors; // rays but the first; those of a full ring close
For i In {0 : 6}
  For s In {0 : last}
    Point(10 * (i + 1) + s) = {radius[i] * Cos(s * Pi / 2), radius[i] * Sin(s * Pi / 2), 0};
  EndFor
  For s In {0 : sectors - 1}
    Circle(10 * (i + 1) + s) = {10 * (i + 1) + s, 1, 10 * (i + 1) + (s + 1) % 4};
  EndFor
EndFor
layer[] = {0, 2, 4, 5}; // inner circle of balloon, sleeve, media, adventitia
across[] = {2 * k, 2 * k, 3 * k, 2 * k};
around[] = {nb, ns, na, na};
For l In {0 : 3}
  i = layer[l];
  For s In {0 : last}
    Line(100 + 10 * i + s) = {10 * (i + 1) + s, 10 * (i + 2) + s};
    Transfinite Curve {100 + 10 * i + s} = across[l] + 1;
  EndFor
  For s In {0 : sectors - 1}
    e = (s + 1) % 4;
    Curve Loop(10 * i + s + 1) = {100 + 10 * i + s, 10 * (i + 2) + s, -(100 + 10 * i + e), -(10 * (i + 1) + s)};
    Plane Surface(10 * i + s + 1) = {10 * i + s + 1};
    Transfinite Curve {10 * (i + 1) + s, 10 * (i + 2) + s} = around[l] + 1;
    Transfinite Surface {10 * i + s + 1};
    Recombine Surface {10 * i + s + 1};
  EndFor
EndFor
end = sectors - 1;
Physical Surface("balloon")    = {1 : 1 + end};
Physical Surface("sleeve")     = {21 : 21 + end};
Physical Surface("media")      = {41 : 41 + end};
Physical Surface("adventitia") = {51 : 51 + end};
Physical Curve("bore")         = {10 : 10 + end};
Physical Curve("balloon_skin") = {20 : 20 + end};
Physical Curve("sleeve_bore")  = {30 : 30 + end};
Physical Curve("sleeve_skin")  = {40 : 40 + end};
Physical Curve("artery_bore")  = {50 : 50 + end};
Physical Curve("artery_skin")  = {70 : 70 + end};
// In a full ring there are no planes of symmetry. One ray keeps the bodies from turning and from moving along y; along x contact does (plane_x, which a scene
// may name, is of the balloon alone).
If (sectors == 4)
  Physical Curve("plane_y") = {100, 120, 140};
  Physical Curve("plane_x") = {101};
Else
  Physical Curve("plane_y") = {100, 120, 140, 150};
  Physical Curve("plane_x") = {101, 121, 141, 151};
EndIf
