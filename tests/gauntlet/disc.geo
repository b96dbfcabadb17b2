// Lower half of a disc (radius 1, centre (0, 1)) cut off flat at y = 1, on a block [w0, w1] x [-h, 0] that it touches at the origin, o lower. half = 1: its right half alone,
// cut at x = 0; the block stays as it is.
DefineConstant[
  half = 1, w0 = -1, w1 = 1.5, h = 0.75, o = 0,
  n = 4, nb = 8, mb = 3 // cells along an eighth of the circle, along and across the block
];
s = Sqrt(0.5); c = 0.42;
Point(1) = {0, 1 - o, 0}; Point(2) = {0, -o, 0}; Point(3) = {s, 1 - s - o, 0}; Point(4) = {1, 1 - o, 0};
Point(5) = {0, 0.45 - o, 0}; Point(6) = {c, 1 - c - o, 0}; Point(7) = {0.55, 1 - o, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4};
Line(3) = {5, 6}; Line(4) = {6, 7}; Line(5) = {1, 7}; Line(6) = {1, 5}; Line(7) = {2, 5}; Line(8) = {3, 6}; Line(9) = {4, 7};
Curve Loop(1) = {1, 8, -3, -7}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 9, -4, -8}; Plane Surface(2) = {2};
Curve Loop(3) = {6, 3, 4, -5}; Plane Surface(3) = {3};
disc[] = {1, 2, 3}; arc[] = {1, 2}; top[] = {5, 9}; curves[] = {1:9};
If (half == 0)
  Point(13) = {-s, 1 - s - o, 0}; Point(14) = {-1, 1 - o, 0}; Point(16) = {-c, 1 - c - o, 0}; Point(17) = {-0.55, 1 - o, 0};
  Circle(11) = {2, 1, 13}; Circle(12) = {13, 1, 14};
  Line(13) = {5, 16}; Line(14) = {16, 17}; Line(15) = {1, 17}; Line(18) = {13, 16}; Line(19) = {14, 17};
  Curve Loop(11) = {7, 13, -18, -11}; Plane Surface(11) = {11};
  Curve Loop(12) = {18, 14, -19, -12}; Plane Surface(12) = {12};
  Curve Loop(13) = {15, -14, -13, -6}; Plane Surface(13) = {13};
  disc[] = {1, 2, 3, 11, 12, 13}; arc[] = {1, 2, 11, 12}; top[] = {5, 9, 15, 19}; curves[] = {1:9, 11:15, 18, 19};
Else
  Physical Curve("cut") = {6, 7};
EndIf
Point(21) = {w0, -h, 0}; Point(22) = {w1, -h, 0}; Point(23) = {w1, 0, 0}; Point(24) = {w0, 0, 0};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21}; Curve Loop(21) = {21:24}; Plane Surface(21) = {21};
Transfinite Curve {curves[]} = n + 1; Transfinite Curve {21, 23} = nb + 1; Transfinite Curve {22, 24} = mb + 1;
Transfinite Surface {disc[], 21}; Recombine Surface {disc[], 21};
Physical Surface("disc") = {disc[]}; Physical Surface("block") = {21};
Physical Curve("arc") = {arc[]}; Physical Curve("top") = {top[]};
Physical Curve("face") = {23}; Physical Curve("hull") = {22, 23, 24}; Physical Curve("bottom") = {21}; Physical Curve("block_left") = {24};
