// The corner of a cube with edges of 0.6 points down at a block.
Point(1) = {-1, -1, -0.8};
a[] = Extrude {2, 0, 0} { Point{1}; Layers{3}; Recombine; };
b[] = Extrude {0, 2, 0} { Line{a[1]}; Layers{3}; Recombine; };
c[] = Extrude {0, 0, 0.8} { Surface{b[1]}; Layers{1}; Recombine; };
s = 0.6;
p = newp; Point(p) = {0, 0, 0};
d[] = Extrude {s / Sqrt(2), s / Sqrt(6), s / Sqrt(3)} { Point{p}; Layers{2}; Recombine; };
e[] = Extrude {-s / Sqrt(2), s / Sqrt(6), s / Sqrt(3)} { Line{d[1]}; Layers{2}; Recombine; };
f[] = Extrude {0, -2 * s / Sqrt(6), s / Sqrt(3)} { Surface{e[1]}; Layers{2}; Recombine; };
Physical Volume("base") = {c[1]};
Physical Volume("cube") = {f[1]};
Physical Surface("bottom") = {b[1]};
Physical Surface("top") = {c[0]};
Physical Surface("corner") = {e[1], f[2], f[5]};
Physical Surface("head") = {f[0], f[3], f[4]};
