// A slotted stent on a balloon in an artery of two layers: the sector 0 <= angle <= 180/slots degrees of one half, z >= 0, of the length.
// Slots of two kinds alternate around the stent: those around the middle (angle 0) reach to z = middle_slot, those of the ends (angle 180/slots)
// reach from z = end_slot to the end; they overlap, and what is between them bends when the stent expands.
DefineConstant[
  slots = 6,           // slots around the circumference, of each kind
  stent = 1.0,         // half length of the stent
  balloon = 1.15,      // of the balloon
  artery = 1.4,        // of the artery
  middle_slot = 0.75,  // where slots of the middle end
  end_slot = 0.25,     // where slots of the ends begin
  width = 0.25,        // of a slot, as a share of 180/slots degrees on each side of the slot's middle line
  n = 1                // divisions of everything
];
angle = Pi / slots;
cut = width * angle; // half a slot

// ---- the stent, radii 0.55 to 0.65: rectangles in the plane angle = cut, turned to both sides
z[] = {0, end_slot, middle_slot, stent};
For i In {0:3}
  Point(100 + i) = {0.55 * Cos(cut), 0.55 * Sin(cut), z[i]};
  Point(110 + i) = {0.65 * Cos(cut), 0.65 * Sin(cut), z[i]};
  Line(120 + i) = {100 + i, 110 + i};
EndFor
Transfinite Curve {120:123} = n + 1;
For i In {0:2}
  Line(130 + i) = {100 + i, 101 + i};
  Line(140 + i) = {110 + i, 111 + i};
  Curve Loop(150 + i) = {130 + i, 121 + i, -(140 + i), -(120 + i)};
  Plane Surface(150 + i) = {150 + i};
EndFor
Transfinite Curve {130, 140} = 2 * n + 1;
Transfinite Curve {131, 141} = 3 * n + 1;
Transfinite Curve {132, 142} = 2 * n + 1;
Transfinite Surface {150:152};  Recombine Surface {150:152};

// ---- balloon and artery: rectangles in the plane angle = 0 turned by the whole angle
r[] = {0.40, 0.50, 0.71, 0.97, 1.10};
For i In {0:4}
  l = i < 2 ? balloon : artery;
  Point(200 + i) = {r[i], 0, 0};
  Point(210 + i) = {r[i], 0, l};
  Line(220 + i) = {200 + i, 210 + i};
  Transfinite Curve {220 + i} = (i < 2 ? 8 : 9) * n + 1;
EndFor
For i In {0:3}
  If (i != 1)
    Line(230 + i) = {200 + i, 201 + i};
    Line(240 + i) = {210 + i, 211 + i};
    Curve Loop(250 + i) = {220 + i, 240 + i, -(221 + i), -(230 + i)};
    Plane Surface(250 + i) = {250 + i};
    Transfinite Curve {230 + i, 240 + i} = (i == 2 ? 2 : 1) * n + 1;
    Transfinite Surface {250 + i};  Recombine Surface {250 + i};
  EndIf
EndFor

// ---- turned. An extruded rectangle: [0] opposite side, [1] volume, [2] inside, [3] towards the end, [4] outside, [5] towards the middle
low[]  = Extrude { {0, 0, 1}, {0, 0, 0}, -cut } { Surface{152}; Layers{n}; Recombine; };
strut[] = Extrude { {0, 0, 1}, {0, 0, 0}, angle - 2 * cut } { Surface{150, 151, 152}; Layers{2 * n}; Recombine; };
high[] = Extrude { {0, 0, 1}, {0, 0, 0}, cut } { Surface{strut[0]}; Layers{n}; Recombine; };
Physical Volume("stent") = {low[1], strut[1], strut[7], strut[13], high[1]};
Physical Surface("stent_inner") = {low[2], strut[2], strut[8], strut[14], high[2]};
Physical Surface("stent_outer") = {low[4], strut[4], strut[10], strut[16], high[4]};
Physical Surface("stent_end") = {low[3], strut[15]};

tube[] = Extrude { {0, 0, 1}, {0, 0, 0}, angle } { Surface{250}; Layers{3 * n}; Recombine; };
wall[] = Extrude { {0, 0, 1}, {0, 0, 0}, angle } { Surface{252, 253}; Layers{3 * n}; Recombine; };
Physical Volume("balloon") = {tube[1]};
Physical Volume("media") = {wall[1]};
Physical Volume("adventitia") = {wall[7]};
Physical Surface("bore") = {tube[2]};
Physical Surface("balloon_outer") = {tube[4]};
Physical Surface("balloon_end") = {tube[3]};
Physical Surface("artery_inner") = {wall[2]};
Physical Surface("artery_end") = {wall[3], wall[9]};

// ---- planes of symmetry
Physical Surface("middle") = {strut[5], high[5], tube[5], wall[5], wall[11]};
Physical Surface("plane_0") = {low[0], 250, 252, 253};
Physical Surface("plane_angle") = {high[0], tube[0], wall[0], wall[6]};
