// A key in its slot, play on three sides: pushed aside it tilts, onto the lip of the slot and a corner of its own.
DefineConstant[size = 0.3];
Point(1) = {-0.2, 0.3, 0, size}; Point(2) = {-0.2, -0.25, 0, size}; Point(3) = {0.2, -0.25, 0, size}; Point(4) = {0.2, 0.3, 0, size};
Point(5) = {-0.212, 0, 0, size}; Point(6) = {-1, 0, 0, size}; Point(7) = {-1, -0.9, 0, size}; Point(8) = {1, -0.9, 0, size};
Point(9) = {1, 0, 0, size}; Point(10) = {0.212, 0, 0, size}; Point(11) = {0.212, -0.262, 0, size}; Point(12) = {-0.212, -0.262, 0, size};
For i In {1:4}
  Line(i) = {i, i % 4 + 1};
EndFor
For i In {5:11}
  Line(i) = {i, i + 1};
EndFor
Line(12) = {12, 5};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Curve Loop(2) = {5:12}; Plane Surface(2) = {2};
Physical Surface("key") = {1}; Physical Surface("hub") = {2};
Physical Curve("skin") = {1:3}; Physical Curve("top") = {4}; Physical Curve("slot") = {10:12}; Physical Curve("base") = {7};
