// A slotted stent on a balloon in an artery of two layers: the sector 0 <= angle <= 180/slots degrees of one half, z >= 0, of the length.
// Slots of two kinds alternate around the stent: those around the middle (angle 0) reach to z = middle_slot, those of the ends (angle 180/slots)
// reach from z = end_slot to the end; they overlap, and what is between them bends when the stent expands.
DefineConstant[
  slots = 5,           // slots around the circumference, of each kind
  stent = 1.0,         // half length of the stent
  balloon = 1.15,      // of the balloon
  artery = 1.4,        // of the artery
  middle_slot = 0.8,   // where slots of the middle end
  end_slot = 0.2,      // where slots of the ends begin
  width = 0.32,        // of a slot, as a share of 180/slots degrees on each side of the slot's middle line
  round = 1.3,         // length of a slot's round end over half the slot's width, halfway through the wall; 1: a half circle
  edge = 0.05,         // radius of the rounded edges of the wall; half its thickness: all round
  n = 1,               // divisions of balloon and artery
  fine = 2,            // of the stent: of an eighth of a slot's round end; strut and links in proportion, rounded edges are one cell wide
  layers = 1           // through the stent's wall
];
angle = Pi / slots;
cut = width * angle; // half a slot

// ---- the stent, radii 0.55 to 0.65, drawn on both cylinders over the angle and z. Block 0, at the end of the slot of the middle, is this; block 1 is the same at
// the end of the slot of the ends, turned by 180 degrees, without the uppermost row; the strut between them goes from 0-3-8-6 to 6-8-3-0. Edges are rounded
// where the wall ends: 0-1-2, 6-7-13-17 and 17-16-14-15; between these and the next points the wall grows thinner on an arc of 60 degrees.
//
//     z 15 ---- 14 ---- 16 - 17
//       11 ---- 10 ---- 12 - 13      0-1-2 and 3-4-5: quarter ellipses
//        |       |       |    |      6-7-13: side of the other slot
//        5 --    |       |    |      17-16-14-15: end of the stent (block 1, 13-12-10-11: its middle)
//        2 -- - -4 ----- 9 -- 7
//     slot  - 1    -     |    |
//               0 -- 3 - 8 -- 6
most = Pi / 3;
wide = edge * Sin(most);
tip = round * cut * 0.6;
For i In {0:35}
  k = i < 18 ? 0 : 1;
  j = i % 18;
  up = k == 0 ? stent - middle_slot + tip : end_slot + tip; // from the centre of the ellipses
  low = (tip + wide) * Sin(Pi / 4);
  slope_a[] += j < 3 || j == 6 || j == 7 || j == 13 || j == 17 ? most : 0;
  slope_z[] += j > 13 ? most : 0;
  offset = j < 3 ? 0 : wide;
  a = j < 6 ? (cut + offset / 0.6) * Cos(j % 3 * Pi / 4) : j == 11 || j == 15 ? 0 : j == 10 || j == 14 ? (cut + wide / 0.6) * Cos(Pi / 4)
      : angle - cut - (slope_a[i] > 0 ? 0 : wide / 0.6);
  h = j < 6 ? (tip + offset) * Sin(j % 3 * Pi / 4) : j == 6 || j == 8 ? 0 : j == 7 || j == 9 ? low : j > 13 || k == 1 ? up : up - wide;
  turn[] += Fabs(k * angle - a);
  height[] += k == 0 ? middle_slot - tip + h : end_slot + tip - h;
EndFor
quad[] = {0,1,4,3, 3,4,9,8, 8,9,7,6, 1,2,5,4, 4,5,11,10, 4,10,12,9, 9,12,13,7, 18,19,22,21, 21,22,27,26, 26,27,25,24, 19,20,23,22, 22,23,29,28, 22,28,30,27,
          27,30,31,25, 0,3,26,24, 3,8,21,26, 8,6,18,21, 10,11,15,14, 12,10,14,16, 13,12,16,17};
num = #quad[] / 4;
For i In {0:31}
  For j In {0:1}
    radius = 0.55 + 0.1 * j + (1 - 2 * j) * edge * (1 - Cos(slope_a[i]) * Cos(slope_z[i]));
    Point(100 * j + i + 1) = {radius * Cos(turn[i]), radius * Sin(turn[i]), height[i]};
  EndFor
  Line(5001 + i) = {i + 1, 101 + i};
  Transfinite Curve {5001 + i} = layers + 1;
EndFor
// Curves are known by their ends p < q: 64 p + q. Two of one ellipse or of two neighbouring ones are joined in polar coordinates.
made[] = {};
For i In {0:2047}
  made[i] = 0;
EndFor
For m In {0:4 * num - 1}
  m1 = m % 4 == 3 ? m - 3 : m + 1;
  p = quad[m] < quad[m1] ? quad[m] : quad[m1];
  q = quad[m] < quad[m1] ? quad[m1] : quad[m];
  id = 64 * p + q;
  k = p < 18 ? 0 : 1;
  pj = p % 18;
  qj = q % 18;
  same = (p < 18) == (q < 18);
  rim = (pj < 3 && qj == pj + 3) || (pj == 6 && qj == 8) || (pj == 7 && qj == 9) || (pj == 12 && qj == 13) || (pj == 16 && qj == 17) || (pj < 14 && qj > 13);
  across = (pj > 2 && pj < 5 && qj == pj + 5) || (pj == 10 && qj == 12) || (pj == 14 && qj == 16);
  steps = !same ? 3 * fine : rim || across ? 1 : pj < 10 && qj > 9 ? 2 * fine : fine;
  If (made[id] == 0)
    made[id] = 1;
    For j In {0:1}
      way[] = {100 * j + p + 1};
      For i In {1:7}
        t = i / 8;
        sa = slope_a[p] + t * (slope_a[q] - slope_a[p]);
        sz = slope_z[p] + t * (slope_z[q] - slope_z[p]);
        If (same && pj < 6 && qj < 6)
          offset = wide - edge * Sin(sa);
          phi = (pj % 3 + t * (qj % 3 - pj % 3)) * Pi / 4;
          a = Fabs(k * angle - (cut + offset / 0.6) * Cos(phi));
          z = k == 0 ? middle_slot - tip + (tip + offset) * Sin(phi) : end_slot + tip - (tip + offset) * Sin(phi);
        Else
          ta = t;
          tz = t;
          If (slope_a[p] != slope_a[q])
            ta = (Sin(sa) - Sin(slope_a[p])) / (Sin(slope_a[q]) - Sin(slope_a[p]));
          EndIf
          If (slope_z[p] != slope_z[q])
            tz = (Sin(sz) - Sin(slope_z[p])) / (Sin(slope_z[q]) - Sin(slope_z[p]));
          EndIf
          a = turn[p] + ta * (turn[q] - turn[p]);
          z = height[p] + tz * (height[q] - height[p]);
        EndIf
        radius = 0.55 + 0.1 * j + (1 - 2 * j) * edge * (1 - Cos(sa) * Cos(sz));
        way[i] = 100000 * (j + 1) + 8 * id + i;
        Point(way[i]) = {radius * Cos(a), radius * Sin(a), z};
      EndFor
      way[8] = 100 * j + q + 1;
      Spline(10000 * (j + 1) + id) = way[];
      Transfinite Curve {10000 * (j + 1) + id} = steps + 1;
    EndFor
    Curve Loop(30000 + id) = {10000 + id, 5001 + q, -(20000 + id), -(5001 + p)};
    Surface(30000 + id) = {30000 + id};
    Transfinite Surface {30000 + id};  Recombine Surface {30000 + id};
  EndIf
  ring[m % 4] = (quad[m] < quad[m1] ? 1 : -1) * id;
  If (m % 4 == 3)
    f = (m - 3) / 4 + 1;
    For j In {0:1}
      For i In {0:3}
        loop[i] = ring[i] + (ring[i] > 0 ? 10000 : -10000) * (j + 1);
      EndFor
      Curve Loop(100 * j + f) = loop[];
      Surface(100 * j + f) = {100 * j + f};
    EndFor
    Surface Loop(f) = {f, 100 + f, 30000 + Fabs(ring[0]), 30000 + Fabs(ring[1]), 30000 + Fabs(ring[2]), 30000 + Fabs(ring[3])};
    Volume(f) = {f};
  EndIf
EndFor
Transfinite Surface {1:num, 101:100 + num};  Recombine Surface {1:num, 101:100 + num};
Transfinite Volume {1:num};
Physical Volume("stent") = {1:num};
Physical Surface("stent_inner") = {1:num};
Physical Surface("stent_outer") = {101:100 + num};
Physical Surface("stent_end") = {30000 + 64 * 14 + 15, 30000 + 64 * 14 + 16, 30000 + 64 * 16 + 17};

// ---- balloon and artery: rectangles in the plane angle = 0 turned by the whole angle
r[] = {0.40, 0.50, 0.71, 0.97, 1.10};
For i In {0:4}
  l = i < 2 ? balloon : artery;
  Point(300 + i) = {r[i], 0, 0};
  Point(310 + i) = {r[i], 0, l};
  Line(320 + i) = {300 + i, 310 + i};
  Transfinite Curve {320 + i} = (i < 2 ? 8 : 11) * n + 1;
EndFor
For i In {0:3}
  If (i != 1)
    Line(330 + i) = {300 + i, 301 + i};
    Line(340 + i) = {310 + i, 311 + i};
    Curve Loop(350 + i) = {320 + i, 340 + i, -(321 + i), -(330 + i)};
    Plane Surface(350 + i) = {350 + i};
    Transfinite Curve {330 + i, 340 + i} = (i == 2 ? 2 : 1) * n + 1;
    Transfinite Surface {350 + i};  Recombine Surface {350 + i};
  EndIf
EndFor

// ---- turned. An extruded rectangle: [0] opposite side, [1] volume, [2] inside, [3] towards the end, [4] outside, [5] towards the middle
tube[] = Extrude { {0, 0, 1}, {0, 0, 0}, angle } { Surface{350}; Layers{3 * n}; Recombine; };
wall[] = Extrude { {0, 0, 1}, {0, 0, 0}, angle } { Surface{352, 353}; Layers{3 * n}; Recombine; };
Physical Volume("balloon") = {tube[1]};
Physical Volume("media") = {wall[1]};
Physical Volume("adventitia") = {wall[7]};
Physical Surface("bore") = {tube[2]};
Physical Surface("balloon_outer") = {tube[4]};
Physical Surface("balloon_end") = {tube[3]};
Physical Surface("artery_inner") = {wall[2]};
Physical Surface("artery_end") = {wall[3], wall[9]};

// ---- planes of symmetry
Physical Surface("middle") = {30000 + 64 * 28 + 29, 30000 + 64 * 28 + 30, 30000 + 64 * 30 + 31, tube[5], wall[5], wall[11]};
Physical Surface("plane_0") = {30000 + 64 * 2 + 5, 30000 + 64 * 5 + 11, 30000 + 64 * 11 + 15, 350, 352, 353};
Physical Surface("plane_angle") = {30000 + 64 * 20 + 23, 30000 + 64 * 23 + 29, tube[0], wall[0], wall[6]};
