// A pin with a bore in a lug, in mm: `gmsh -2 -order 2 lug.geo -o lug.msh`.
radii[] = {10.02, 10, 4}; // of the hole, of the pin in it, of the bore of the pin
sizes[] = {1.5, 1.5, 2.5};

Point(1) = {0, 0, 0, 1};
Point(2) = {-60, -25, 0, 8};
Point(3) = {-60, 25, 0, 8};
Point(4) = {0, 25, 0, 5};
Point(5) = {25, 0, 0, 5};
Point(6) = {0, -25, 0, 5};
Line(1) = {2, 6};
Circle(2) = {6, 1, 5};
Circle(3) = {5, 1, 4};
Line(4) = {4, 3};
Line(5) = {3, 2};
For side In {0:2}
  radius = radii[side];
  size = sizes[side];
  Point(11 + 10 * side) = {radius, 0, 0, size};
  Point(12 + 10 * side) = {0, radius, 0, size};
  Point(13 + 10 * side) = {-radius, 0, 0, size};
  Point(14 + 10 * side) = {0, -radius, 0, size};
  Circle(11 + 10 * side) = {11 + 10 * side, 1, 12 + 10 * side};
  Circle(12 + 10 * side) = {12 + 10 * side, 1, 13 + 10 * side};
  Circle(13 + 10 * side) = {13 + 10 * side, 1, 14 + 10 * side};
  Circle(14 + 10 * side) = {14 + 10 * side, 1, 11 + 10 * side};
EndFor
Curve Loop(1) = {1, 2, 3, 4, 5};
Curve Loop(2) = {11, 12, 13, 14};
Curve Loop(3) = {21, 22, 23, 24};
Curve Loop(4) = {31, 32, 33, 34};
Plane Surface(1) = {1, 2};
Plane Surface(2) = {3, 4};

Physical Surface("lug") = {1};
Physical Surface("pin") = {2};
Physical Curve("base") = {5};
Physical Curve("hole") = {11:14};
Physical Curve("shank") = {21:24};
Physical Curve("load") = {31:34};
