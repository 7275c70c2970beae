#!/usr/bin/env python3
"""Makes the meshes of this case with gmsh: unstructured ones over a rectangle, their nodes then put on the surface's edge.

python3 make_meshes.py
"""
import math
import pathlib
import subprocess
import tempfile

C = 0.848337938094979  # waist of the catenoid


def flat(h, x, y, quadrilaterals):
    """Nodes and facets of a rectangle meshed freely, h the side, and which nodes lie on its edge."""
    text = f"""
Point(1) = {{{x[0]}, {y[0]}, 0, {h}}}; Point(2) = {{{x[1]}, {y[0]}, 0, {h}}};
Point(3) = {{{x[1]}, {y[1]}, 0, {h}}}; Point(4) = {{{x[0]}, {y[1]}, 0, {h}}};
Line(1) = {{1, 2}}; Line(2) = {{2, 3}}; Line(3) = {{3, 4}}; Line(4) = {{4, 1}};
Curve Loop(1) = {{1, 2, 3, 4}}; Plane Surface(1) = {{1}};
Mesh.Algorithm = 6; Mesh.RecombineAll = {1 if quadrilaterals else 0};
"""
    with tempfile.TemporaryDirectory() as folder:
        drawing, mesh = pathlib.Path(folder, "flat.geo"), pathlib.Path(folder, "flat.msh")
        drawing.write_text(text)
        subprocess.run(["gmsh", "-2", "-format", "msh22", "-v", "1", drawing, "-o", mesh], check=True)
        lines = iter(mesh.read_text().split("\n"))
    nodes, facets, edges = [], [], []
    for line in lines:
        if line == "$Nodes":
            nodes = [tuple(map(float, next(lines).split()[1:3])) for _ in range(int(next(lines)))]
        if line == "$Elements":
            for _ in range(int(next(lines))):
                entry = list(map(int, next(lines).split()))
                if entry[1] == 1:
                    edges.append(entry[5:])
                if entry[1] in (2, 3):
                    facets.append(entry[5:])
    return nodes, facets, edges


def write(name, place, edge_group, mesh):
    nodes, facets, edges = mesh
    out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '0 3 "corners"', f'1 1 "{edge_group}"',
           '2 2 "film"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    out += [f"{i + 1} " + " ".join(f"{c:.15g}" for c in place(*p)) for i, p in enumerate(nodes)]
    out += ["$EndNodes", "$Elements", str(len(facets) + len(edges) + 4)]
    out += [f"{i + 1} 15 2 3 3 {i + 1}" for i in range(4)]
    out += [f"{i + 5} 1 2 1 1 {e[0]} {e[1]}" for i, e in enumerate(edges)]
    out += [f"{len(edges) + i + 5} {2 if len(f) == 3 else 3} 2 2 2 " + " ".join(map(str, f)) for i, f in enumerate(facets)]
    out += ["$EndElements", ""]
    with open(name + ".msh", "w") as file:
        file.write("\n".join(out))


def catenoid(phi, s):
    """A quarter between the rings, its sides on the meridians; inside on the cone of the mean radius."""
    z = 0.5 * s
    radius = C * math.cosh(z / C) if phi in (0.0, 1.0) else 1 - 0.1 * (1 - s * s)
    return radius * math.cos(phi * math.pi / 2), radius * math.sin(phi * math.pi / 2), z


def scherk(x, y):
    inside = 0.05 * (1 - x * x) * (1 - y * y)
    return x, y, math.log(math.cos(y) / math.cos(x)) + inside


def helicoid(u, v):
    """A strip from radius 0.5 to 1.5, a third of a turn, 1 m of pitch for a radian; bulged inside."""
    bulge = 0.05 * (1 - v * v) * (u - 0.5) * (1.5 - u)
    return u * math.cos(v), u * math.sin(v), v + bulge


def shallow(x, y):
    return x, y, 0.01 * (x * x - 3 * y * y)


for size, h in (("coarse", 0.125), ("fine", 0.0625)):
    for kind, quadrilaterals in (("triangles", False), ("quadrilaterals", True)):
        square = flat(h, (-1, 1), (-1, 1), quadrilaterals)
        write(f"scherk_{kind}_{size}", scherk, "edge", square)
        write(f"helicoid_{kind}_{size}", helicoid, "edge", flat(h, (0.5, 1.5), (-1, 1), quadrilaterals))
        write(f"catenoid_{kind}_{size}", catenoid, "edge", flat(h, (0, 1), (-1, 1), quadrilaterals))
        square = flat(2 * h, (-1, 1), (-1, 1), quadrilaterals)
        write(f"ropes_{kind}_{size}", lambda x, y: (2 * x, 2 * y, 0), "ropes", square)
        if size == "fine":
            write(f"shallow_{kind}", shallow, "edge", square)
