#!/usr/bin/env python3
"""Compares the families of form-finding on two nets and prints the tables of docs/form_finding.md.

usage: compare.py TAUTLINE WORK    TAUTLINE: the program; WORK: a directory for decks and results

The front net of the published 12 m reflector (870 cords) is taken from a run of this repository's deck, with what its ties carry as
loads; the saddle net (760 cables in a square frame) is made here. In both every cable is to carry the same tension. The elastic methods
get cut lengths that belong to the shape found by force densities. Every method starts from the same flat net.
"""
import csv
import json
import math
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent


def run(program, deck, out):
    """Runs a deck; returns its results, also of a run that did not converge."""
    command = [program, "run", str(deck), "-o", str(out), "--quiet", "--no-pictures"]
    code = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if code.returncode not in (0, 4):
        sys.exit(f"{' '.join(command)}\n{code.stderr}")
    return json.loads((out / "results.json").read_text())["steps"]


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def places(out):
    return [[float(row[c]) for c in "xyz"] for row in table(out / "form_finding_nodes.csv")]


class Net:
    """Nodes, which of them are fixed, cables as pairs, a force on every node, the tension wanted, and EA."""

    def __init__(self, nodes, fixed, cables, load, tension, stiffness):
        self.nodes, self.fixed, self.cables = nodes, fixed, cables
        self.load, self.tension, self.stiffness = load, tension, stiffness

    def flatten(self):
        """Every free node in the middle of its neighbours: the start of all methods."""
        neighbours = [[] for _ in self.nodes]
        for a, b in self.cables:
            neighbours[a].append(b)
            neighbours[b].append(a)
        for _ in range(500):
            for i, near in enumerate(neighbours):
                if not self.fixed[i]:
                    self.nodes[i] = [sum(self.nodes[k][c] for k in near) / len(near) for c in range(3)]

    def deck(self, step, lengths=None):
        """A deck with the step; with cut lengths every cable is a group of its own."""
        names = [f"c{k}" for k in range(len(self.cables))] if lengths else ["net"]
        at = [f"n{i}" for i in range(len(self.nodes))]
        lines = ["title: comparison", "units: SI", "model:", "  nodes:"]
        lines += [f"    {at[i]}: [{x!r}, {y!r}, {z!r}]" for i, (x, y, z) in enumerate(self.nodes)]
        lines += ["  elements:"]
        pairs = [f"[{at[a]}, {at[b]}]" for a, b in self.cables]
        lines += [f"    {n}: [{p}]" for n, p in zip(names, pairs)] if lengths else [f"    net: [{', '.join(pairs)}]"]
        lines += ["sections:", f"  cord: {{kind: cable, axial_stiffness: {self.stiffness}, mass_per_length: 0}}", "groups:"]
        for k, name in enumerate(names):
            state = f"unstressed_length: {lengths[k]!r}" if lengths else f"tension: {self.tension}"
            lines.append(f"  {name}: {{section: cord, {state}}}")
        lines.append(f"  rim: {{nodes: [{', '.join(a for a, f in zip(at, self.fixed) if f)}]}}")
        loaded = [i for i, f in enumerate(self.load) if f != 0 and not self.fixed[i]]
        lines += [f"  at_{at[i]}: {{nodes: [{at[i]}]}}" for i in loaded]
        lines += ["supports:", "  - {name: rim, on: [rim], fix: pinned}"]
        if loaded:
            lines.append("loads:")
            lines += [f"  - {{name: load_{i}, on: [at_{at[i]}], force: [0, 0, {self.load[i]!r}]}}" for i in loaded]
        lines += ["steps:", "  - kind: form_finding", f"    loads: [{', '.join(f'load_{i}' for i in loaded)}]"]
        lines += [f"    {key}: {value}" for key, value in step.items()]
        return "\n".join(lines + ["  - kind: equilibrium"]) + "\n"


def reflector_net(program, work):
    """The published front net: found on its paraboloid, then with its ties as loads."""
    deck = work / "reflector.yaml"
    text = (REPOSITORY / "inputs/perimeter_truss_12m.yaml").read_text()
    deck.write_text(text[: text.index("steps:")] + "steps:\n  - kind: form_finding\n  - kind: equilibrium\n")
    run(program, deck, work / "reflector")
    tension = 10
    rows = [row for row in table(work / "reflector/cables.csv") if row["group"] == "front_net"]
    cables = [(int(row["node_1"]) - 1, int(row["node_2"]) - 1) for row in rows]
    nodes = places(work / "reflector")[: 1 + max(max(pair) for pair in cables)]  # of the front net
    pull = [0.0] * len(nodes)
    for a, b in cables:
        lift = tension * (nodes[b][2] - nodes[a][2]) / math.dist(nodes[a], nodes[b])
        pull[a] -= lift
        pull[b] += lift
    return Net(nodes, [math.hypot(x, y) > 5.99 for x, y, _ in nodes], cables, pull, tension, 30890)


def saddle_net():
    """20 x 20 meshes between the sides of a square of 20 m, which rise and fall as x^2 - y^2."""
    n = 20
    nodes, fixed, number = [], [], {}
    for i in range(n + 1):
        for j in range(n + 1):
            if i in (0, n) and j in (0, n):
                continue
            number[i, j] = len(nodes)
            x, y = i - n / 2, j - n / 2
            nodes.append([x, y, 0.03 * (x * x - y * y)])
            fixed.append(i in (0, n) or j in (0, n))
    cables = [(number[i, j], number[i + 1, j]) for i in range(n) for j in range(1, n)]
    cables += [(number[i, j], number[i, j + 1]) for i in range(1, n) for j in range(n)]
    return Net(nodes, fixed, cables, [0.0] * len(nodes), 8000, 1.2e7)


def report(label, entry, nodes, reference):
    if entry["status"] != "done":
        print(f"| {label} | {entry['iterations']}, not converged | {entry['wall_seconds'] * 1e3:.1f} | - |")
        return
    far = max(math.dist(a, b) for a, b in zip(nodes, reference)) if reference else 0.0
    print(f"| {label} | {entry['iterations']} | {entry['wall_seconds'] * 1e3:.1f} | {far:.0e} |")


def compare(program, work, name, net):
    """All methods on one net, each with the same start and to 1e-9 of the tension."""
    net.flatten()
    force_density = {"method": "tension", "tolerance": 1e-9, "max_iterations": 500}
    motion = {"method": "dynamic_relaxation", "tolerance": 1e-9}
    methods = [
        ("force density, steps of smallest norm", {**force_density, "solver": "smallest_norm"}, False),
        ("force density, Newton on positions", {**force_density, "solver": "position_newton"}, False),
        ("force density, fixed point", {**force_density, "solver": "fixed_point"}, False),
        ("dynamic relaxation, kinetic, constant tensions", {**motion, "constant_tension": "[net]"}, False),
        ("dynamic relaxation, viscous, constant tensions", {**motion, "constant_tension": "[net]", "damping": "viscous"}, False),
        ("dynamic relaxation, kinetic, cut lengths", motion, True),
        ("dynamic relaxation, viscous, cut lengths", {**motion, "damping": "viscous"}, True),
        ("stiffness matrix, cut lengths", {"method": "elastic", "tolerance": 1e-9, "max_iterations": 1000}, True)]
    print(f"\n{name}: {len(net.cables)} cables, {net.fixed.count(False)} free nodes\n")
    print("| method | iterations | time, ms | farthest node from the first, m |\n|---|---|---|---|")
    reference, lengths = None, None
    for k, (label, step, cut) in enumerate(methods):
        deck, out = work / f"{name}_{k}.yaml", work / f"{name}_{k}"
        deck.write_text(net.deck(step, lengths if cut else None))
        entry = run(program, deck, out)[0]
        found = places(out) if entry["status"] == "done" else None
        report(label, entry, found, reference)
        if reference is None:
            reference = found
            lengths = [float(row["unstressed_length"]) for row in table(out / "cables.csv")]


def main():
    program, work = sys.argv[1], pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    compare(program, work, "reflector_net", reflector_net(program, work))
    compare(program, work, "saddle_net", saddle_net())


if __name__ == "__main__":
    main()
