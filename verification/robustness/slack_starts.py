"""Chains and nets of cables drawn straight and longer than drawn, and where they hang: the least potential energy, looked for by scipy.

Internal energy of a cable of unstressed length L and stiffness EA at the length l: EA (l - L)^2 / (2 L) if l > L, else 0; loads are dead. This energy is convex in
the places of the nodes: whatever has no force out of balance has the least energy.
"""
import collections
import math

import numpy
import scipy.optimize

Start = collections.namedtuple("Start", "what nodes cables lengths stiffness forces held size")


def turned(points, draw):
    """The points in a random orientation."""
    q, r = numpy.linalg.qr(numpy.array([[draw.gauss(0, 1) for _ in range(3)] for _ in range(3)]))
    return points @ (q * numpy.sign(numpy.diag(r))).T


def make(kind, draw):
    """A start drawn at random: how many parts, how long, how stiff, how heavy, where the loads pull."""
    size = 10 ** draw.uniform(-1, 2)
    stretch = draw.uniform(1.005, 1.3)
    if kind == "chains":
        parts = draw.randrange(2, 41)
        nodes = numpy.linspace([0.0, 0, 0], [size, 0, 0], parts + 1)
        cables = [(i, i + 1) for i in range(parts)]
        held = [0, parts]
        what = f"chain of {parts} links, {stretch:.3f} of the chord"
    else:
        n, m = draw.randrange(3, 9), draw.randrange(3, 9)
        grid = [(i, j) for i in range(n + 1) for j in range(m + 1) if not (i in (0, n) and j in (0, m))]
        at = {place: k for k, place in enumerate(grid)}
        nodes = numpy.array([[size * i / n, size * j / n, 0.0] for i, j in grid])
        inside = [(i, j) for i, j in grid if 0 < i < n and 0 < j < m]
        cables = sorted({tuple(sorted((at[p], at[q]))) for p in inside for q in ((p[0] + 1, p[1]), (p[0] - 1, p[1]), (p[0], p[1] + 1), (p[0], p[1] - 1))})
        held = [at[p] for p in grid if p not in inside]
        what = f"net of {n} x {m} meshes, up to {stretch:.3f} of the chords"
    drawn = numpy.array([math.dist(nodes[a], nodes[b]) for a, b in cables])
    longer = numpy.full(len(cables), stretch) if kind == "chains" else numpy.array([draw.uniform(1, stretch) for _ in cables])
    weight = 10 ** draw.uniform(-1, 3)
    forces = numpy.zeros_like(nodes)
    for k in range(len(nodes)):
        if k not in held:
            forces[k] = [draw.uniform(-0.1, 0.1) * weight, draw.uniform(-0.1, 0.1) * weight, -draw.uniform(0.5, 1) * weight]
    stiffness = weight * len(nodes) * 10 ** draw.uniform(1, 5)
    both = turned(numpy.vstack([nodes, forces]), draw)
    return Start(what, both[:len(nodes)], numpy.array(cables), longer * drawn, stiffness, both[len(nodes):], held, size)


def deck(start):
    free = [k for k in range(len(start.nodes)) if k not in start.held]
    lines = [f"title: {start.what}", "model:", "  nodes:"]
    lines += [f"    n{k}: [{p[0]!r}, {p[1]!r}, {p[2]!r}]" for k, p in enumerate(start.nodes.tolist())]
    lines += ["  elements:"] + [f"    c{i}: [[n{a}, n{b}]]" for i, (a, b) in enumerate(start.cables)]
    lines += ["sections:", f"  rope: {{kind: cable, axial_stiffness: {start.stiffness!r}, mass_per_length: 0}}", "groups:"]
    lines += [f"  c{i}: {{section: rope, unstressed_length: {length!r}}}" for i, length in enumerate(start.lengths.tolist())]
    lines += [f"  held: {{nodes: [{', '.join(f'n{k}' for k in start.held)}]}}"] + [f"  n{k}: {{nodes: [n{k}]}}" for k in free]
    lines += ["supports: [{name: held, on: [held], fix: pinned}]", "loads:"]
    lines += [f"  - {{name: f{k}, on: [n{k}], force: {start.forces[k].tolist()}}}" for k in free]
    return "\n".join(lines + ["steps: [{kind: equilibrium}]", ""])


def potential(start, stiffness, x):
    """Energy, gradient and Hessian by the free coordinates x."""
    free = [k for k in range(len(start.nodes)) if k not in start.held]
    places = start.nodes.copy()
    places[free] = x.reshape(-1, 3)
    a, b = start.cables.T
    d = places[b] - places[a]
    length = numpy.linalg.norm(d, axis=1)
    pull = numpy.maximum(0, stiffness * (length / start.lengths - 1))
    n = d / length[:, None]
    energy = (pull**2 / (2 * stiffness) * start.lengths).sum() - (start.forces * (places - start.nodes)).sum()
    gradient = -start.forces.copy()
    numpy.add.at(gradient, a, -pull[:, None] * n)
    numpy.add.at(gradient, b, pull[:, None] * n)
    across = pull / length
    along = numpy.where(pull > 0, stiffness / start.lengths, 0)
    block = (along - across)[:, None, None] * n[:, :, None] * n[:, None, :] + across[:, None, None] * numpy.eye(3)
    hessian = numpy.zeros((len(places), 3, len(places), 3))
    for k, (p, q) in enumerate(start.cables):
        hessian[p, :, p] += block[k]
        hessian[q, :, q] += block[k]
        hessian[p, :, q] -= block[k]
        hessian[q, :, p] -= block[k]
    m = 3 * len(free)
    return energy, gradient[free].ravel(), hessian[free][:, :, free].reshape(m, m)


def least_energy(start):
    """Places of the free nodes, by scipy's trust-region method with ever stiffer cables."""
    free = [k for k in range(len(start.nodes)) if k not in start.held]
    force = numpy.linalg.norm(start.forces)
    x = start.nodes[free].ravel()
    stiffness = min(start.stiffness, 3 * force)
    while True:
        here = {}

        def at(x):
            key = x.tobytes()
            if key not in here:
                here.clear()
                here[key] = potential(start, stiffness, x)
            return here[key]

        def least(method):
            return scipy.optimize.minimize(lambda x: at(x)[0] / (force * start.size), x, jac=lambda x: at(x)[1] / (force * start.size),
                                           hess=lambda x: at(x)[2] / (force * start.size), method=method,
                                           options={"gtol": 1e-9 / start.size, "maxiter": 2000, "initial_trust_radius": 0.1 * start.size, "max_trust_radius": start.size}).x

        try:
            x = least("trust-exact")
        except ValueError:  # where its own factorisation meets a singular Hessian
            x = least("trust-krylov")
        if stiffness == start.stiffness:
            return x
        stiffness = min(start.stiffness, 10 * stiffness)


def miss(start, places):
    """Farthest of any node from where the energy is least, over the size; infinite if the energy at `places` is larger than there."""
    free = [k for k in range(len(start.nodes)) if k not in start.held]
    x = numpy.array(places)[free].ravel()
    least = least_energy(start)
    excess = potential(start, start.stiffness, x)[0] - potential(start, start.stiffness, least)[0]
    if excess > 1e-6 * numpy.linalg.norm(start.forces) * start.size:
        return math.inf
    return numpy.linalg.norm((x - least).reshape(-1, 3), axis=1).max() / start.size
