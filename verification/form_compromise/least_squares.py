#!/usr/bin/env python3
"""Prints the references of this case; needs numpy and scipy."""
import numpy as np
from scipy.optimize import least_squares

index, nodes, fixed = {}, [], []
for i in range(4):
    for j in range(4):
        if i in (0, 3) and j in (0, 3):
            continue
        x, y = i - 1.5, j - 1.5
        index[i, j] = len(nodes)
        nodes.append((x, y, 0.3 * x * x - 0.25 * y * y + 0.1 * i))
        fixed.append(i in (0, 3) or j in (0, 3))
nodes, fixed = np.array(nodes), np.array(fixed)
branches = [(a, index[i + d, j + e]) for (i, j), a in index.items() for d, e in ((1, 0), (0, 1))
            if (i + d, j + e) in index and not (fixed[a] and fixed[index[i + d, j + e]])]
C = np.zeros((len(branches), len(nodes)))
for b, (i, j) in enumerate(branches):
    C[b, i], C[b, j] = -1, 1


def lengths(q):
    x = nodes.copy()
    free = C[:, ~fixed]
    x[~fixed] = -np.linalg.solve(free.T @ (q[:, None] * free), free.T @ (q[:, None] * (C[:, fixed] @ nodes[fixed])))
    return np.linalg.norm(C @ x, axis=1)


def show(name, deviations, **bounds):
    tight = dict(xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=9000)
    s = least_squares(deviations, np.full(12, 87.0), **bounds, **tight)
    print(name, "squares %.16g" % (2 * s.cost), "tensions", s.x * lengths(s.x), "lengths", lengths(s.x))


show("free", lambda q: np.r_[q * lengths(q) / 100 - 1, 2 * (lengths(q) / 0.8 - 1)])
show("bounded", lambda q: np.r_[q * lengths(q) / 100 - 1, 2 * (lengths(q) / 0.8 - 1)],
     bounds=(np.full(12, 84.0), np.full(12, 90.0)))
show("soft", lambda q: np.r_[q * lengths(q) / 100 - 1, 3 * np.maximum(0, lengths(q) - 1.05) / 1.05])
