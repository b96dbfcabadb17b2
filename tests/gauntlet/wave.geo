// Two bodies that meet in three arcs of radius 0.6; below and above: length of their cells.
DefineConstant[ below = 0.4, above = 0.05 ];
Point(101) = {0.5, 0.668337520964, 0}; Point(102) = {1.5, 1.33166247904, 0}; Point(103) = {2.5, 0.668337520964, 0};
For k In {0:1}
  h = k ? above : below;
  For i In {0:3}
    Point(10 * k + i + 1) = {i, 1, 0, h};
  EndFor
  Point(10 * k + 5) = {3, 2 * k, 0, h}; Point(10 * k + 6) = {0, 2 * k, 0, h};
  For i In {1:3}
    Circle(10 * k + i) = {10 * k + i, 100 + i, 10 * k + i + 1};
  EndFor
  Line(10 * k + 4) = {10 * k + 4, 10 * k + 5}; Line(10 * k + 5) = {10 * k + 5, 10 * k + 6}; Line(10 * k + 6) = {10 * k + 6, 10 * k + 1};
  Curve Loop(k + 1) = {10 * k + 1 : 10 * k + 6}; Plane Surface(k + 1) = {k + 1};
EndFor
Physical Surface("lower") = {1}; Physical Surface("upper") = {2};
Physical Curve("bottom") = {5}; Physical Curve("top") = {15}; Physical Curve("left") = {6, 16}; Physical Curve("right") = {4, 14};
Physical Curve("face") = {1 : 3}; Physical Curve("under") = {11 : 13};
