// A slender strut, h thick and l long, bowed by a half sine of height b; both ends on short flat heads.
DefineConstant[ l = 4, h = 0.2, b = 0.05, n = 2, m = 24 ];
For i In {0:m}
  y = l * i / m; x = b * Sin(Pi * i / m); tx = b * Pi / l * Cos(Pi * i / m); t = Sqrt(1 + tx * tx);
  Point(100 + i) = {x - h / 2 / t, y + h / 2 * tx / t, 0}; Point(200 + i) = {x + h / 2 / t, y - h / 2 * tx / t, 0};
EndFor
Spline(1) = {100:100 + m}; Spline(2) = {200:200 + m}; Line(3) = {100, 200}; Line(4) = {100 + m, 200 + m};
Curve Loop(1) = {3, 2, -4, -1}; Plane Surface(1) = {1};
Transfinite Curve {1, 2} = m + 1; Transfinite Curve {3, 4} = n + 1; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("column") = {1}; Physical Curve("foot") = {3}; Physical Curve("head") = {4}; Physical Curve("left") = {1}; Physical Curve("right") = {2};
Physical Curve("skin") = {1, 2};
