// One of 12 sectors of the friction ring under the rim of rotor.geo: gmsh -3 -format inp ring.geo. m.
SetFactory("OpenCASCADE");
angle = 2 * Pi / 12;
c = Cos(angle);
s = Sin(angle);
e = 1e-4;

// Bricks, one in the section and four along the circumference, of which all faces match.
Rectangle(1) = {0.086, -0.01, 0, 0.004, 0.004};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi / 2} { Surface{1}; }
Transfinite Curve {1 : 4} = 2;
Transfinite Surface {1};
Recombine Surface {1};
Extrude {{0, 0, 1}, {0, 0, 0}, angle} { Surface{1}; Layers{4}; Recombine; }

left() = Surface In BoundingBox {0.086 - e, -e, -1, 0.09 + e, e, 1};
right() = Surface In BoundingBox {0.086 * c - e, 0.086 * s - e, -1, 0.09 * c + e, 0.09 * s + e, 1};
groove() = Point In BoundingBox {0.09 - e, -e, -0.006 - e, 0.09 + e, e, -0.006 + e};

Physical Volume("RING") = {Volume{:}};
Physical Surface("LEFT") = {left()};
Physical Surface("RIGHT") = {right()};
Physical Point("GROOVE") = {groove()};
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;
Mesh.SaveGroupsOfNodes = 1;
