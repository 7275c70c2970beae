// A square membrane of 1 m x 1 m, 4 x 4 cells of two triangles, with its edge cables and corner points.
Point(1) = {0, 0, 0};
side[] = Extrude {1, 0, 0} { Point{1}; Layers{4}; };
swept[] = Extrude {0, 1, 0} { Curve{side[1]}; Layers{4}; };
Physical Surface("cloth") = {swept[1]};
Physical Curve("edge") = {side[1], swept[0], swept[2], swept[3]};
Physical Point("corners") = Point{:};
