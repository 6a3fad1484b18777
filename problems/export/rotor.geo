// One of 12 sectors of a bladed disk about the z axis: gmsh -3 -format inp rotor.geo. m.
SetFactory("OpenCASCADE");
angle = 2 * Pi / 12;
c = Cos(angle);
s = Sin(angle);
e = 1e-4;

// The disk from its hub to its rim, and a staggered blade that grows out of it.
Rectangle(1) = {0.03, -0.006, 0, 0.06, 0.012};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi / 2} { Surface{1}; }
Extrude {{0, 0, 1}, {0, 0, 0}, angle} { Surface{1}; }
Box(10) = {0.088, -0.002, -0.004, 0.042, 0.004, 0.008};
Rotate {{1, 0, 0}, {0.1, 0, 0}, Pi / 5} { Volume{10}; }
Rotate {{0, 0, 1}, {0, 0, 0}, angle / 2} { Volume{10}; }
BooleanUnion { Volume{1}; Delete; } { Volume{10}; Delete; }

left() = Surface In BoundingBox {0.03 - e, -e, -1, 0.09 + e, e, 1};
right() = Surface In BoundingBox {0.03 * c - e, 0.03 * s - e, -1, 0.09 * c + e, 0.09 * s + e, 1};
hub() = Surface In BoundingBox {0.03 * c - e, -e, -1, 0.03 + e, 0.03 * s + e, 1};
groove() = Point In BoundingBox {0.09 - e, -e, -0.006 - e, 0.09 + e, e, -0.006 + e};
tip() = Point In BoundingBox {0.1, 0, 0, 0.2, 0.2, 0.2};

// The nodes of the right face are those of the left one, turned.
Periodic Surface {right()} = {left()} Rotate {{0, 0, 1}, {0, 0, 0}, angle};

Physical Volume("ROTOR") = {Volume{:}};
Physical Surface("LEFT") = {left()};
Physical Surface("RIGHT") = {right()};
Physical Surface("HUB") = {hub()};
Physical Point("GROOVE") = {groove()};
Physical Point("TIP") = {tip()};
Mesh.ElementOrder = 2;
Mesh.SaveGroupsOfNodes = 1;
