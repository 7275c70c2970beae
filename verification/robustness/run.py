#!/usr/bin/env python3
"""Measures from how many bad starts the program finds the right equilibrium.

usage: run.py TAUTLINE WORK [--samples N] [--seed S] [--position M] [--tension T] [--only NAME ...] [--jobs N]
    TAUTLINE: the program; WORK: a directory for decks and results; NAME: structures of inputs/, chains, nets

Disturbed starts: structures of inputs/ up to their first equilibrium. Every coordinate of every free node is displaced at random by up to M (20 mm), every
cable's initial strain changed by up to T (0.5) of itself; asked is the equilibrium of the undisturbed start.
Slack starts: chains and nets of cables drawn straight, each cable up to 1.3 times as long as it is drawn, under random loads, in random orientation; asked is the
least potential energy, which scipy looks for by itself. The energy is convex, so that there is no other equilibrium. README.md says what came out.
"""
import argparse
import collections
import concurrent.futures
import csv
import json
import math
import pathlib
import random
import re
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
INPUTS = HERE.parent.parent / "inputs"
SAME = 1e-6  # m, a tenth of what Newton's stopping rule leaves open on a structure of 10 m
STRUCTURES = {
    "perimeter truss": ("perimeter_truss_12m", {"reflector.gap": (0, 0.05)}),
    "umbrella": ("umbrella_12m", {}),
    "tent": ("tent_high_point", {}),
    "saddle": ("tent_saddle", {}),
    "cable roof": ("cable_roof_equal_mesh", {}),
    "spoke wheel": ("spoke_wheel_roof", {}),
    "guyed mast": ("guyed_mast", {}),
    "canopy": ("canopy_on_masts", {}),
    "cable net": ("cable_net", {}),
}
SLACK = ("chains", "nets")  # of slack_starts.py, where a miss is over the size


def run(program, deck, out, values):
    """Runs the deck; returns its results, or the last lines that it said where it left none."""
    command = [program, "run", str(deck), "-o", str(out), "--quiet", "--no-pictures"]
    for key, value in values.items():
        command += ["--set", f"{key}={value}"]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode in (0, 4):
        return json.loads((out / "results.json").read_text())
    return {"status": "failed", "reason": done.stderr.strip()[-300:], "steps": []}


def places(out):
    with open(out / "nodes.csv", newline="") as file:
        return [tuple(float(row[c]) for c in "xyz") for row in csv.DictReader(file)]


def farthest(a, b):
    return max(math.dist(x, y) for x, y in zip(a, b, strict=True))


Sample = collections.namedtuple("Sample", "name reached miss iterations descent attempts reason")


def sample_of(name, results, miss):
    stages = results["steps"][-1].get("stages", []) if results["steps"] else []
    return Sample(name, results["status"] == "done", miss, sum(s["newton_iterations"] for s in stages),
                  sum(s["descent_steps"] for s in stages), sum(s["failed_attempts"] for s in stages), results.get("reason", ""))


def first_equilibrium(name, directory):
    """The deck of inputs/ up to its first equilibrium, in one stage under all that acts at its end. @return file, index of the step"""
    text, separator, steps = (INPUTS / f"{name}.yaml").read_text().partition("\nsteps:\n")
    if not separator:
        sys.exit(f"{name}: no steps")
    entries = re.split(r"(?m)^(?=  - kind:)", steps.split("\noutput:")[0])
    entries = [e for e in entries if e.strip()]
    index = next(i for i, e in enumerate(entries) if "kind: equilibrium" in e)
    deck = directory / f"{name}.yaml"
    loads = re.search(r"loads: .*", entries[index])
    last = "  - kind: equilibrium\n    name: found\n    scatter: {position: 0, tension: 0, seed: 1}\n"
    if loads:
        last += f"    {loads.group()}\n"
    text = text.replace("../meshes/", f"{INPUTS.parent / 'meshes'}/")
    deck.write_text(text + "\nsteps:\n" + "".join(entries[:index]) + last)
    return deck, index


def disturbed(arguments, title):
    """One calm run for each set of parameters, beside it the disturbed ones."""
    name, parameters = STRUCTURES[title]
    work = arguments.work / name
    work.mkdir(exist_ok=True)
    deck, step = first_equilibrium(name, work)
    draw = random.Random(arguments.seed)

    def measure(index, values, seed):
        calm = work / ("calm" if not parameters else f"calm_{index}")
        if not (calm / "nodes.csv").exists() or parameters:
            first = run(arguments.tautline, deck, calm, values)
            if first["status"] != "done":
                sys.exit(f"{title}: the undisturbed start fails: {first['reason']}")
        wild = work / f"wild_{index}"
        scatter = f"steps.{step}.scatter."
        results = run(arguments.tautline, deck, wild, {
            **values, scatter + "position": arguments.position, scatter + "tension": arguments.tension, scatter + "seed": seed})
        miss = farthest(places(calm), places(wild)) if results["status"] == "done" else math.inf
        return sample_of(f"seed {seed} {values or ''}", results, miss)

    starts = [(i, {k: draw.uniform(*v) for k, v in parameters.items()}, draw.randrange(2**31)) for i in range(arguments.samples)]
    head = [measure(*starts[0])]  # makes the calm run that the others share
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        return head + list(pool.map(lambda start: measure(*start), starts[1:]))


def slack(arguments, kind):
    import slack_starts  # wants numpy and scipy

    work = arguments.work / kind
    work.mkdir(exist_ok=True)
    draw = random.Random(f"{arguments.seed} {kind}")

    def measure(index, seed):
        start = slack_starts.make(kind, random.Random(seed))
        deck = work / f"{index}.yaml"
        deck.write_text(slack_starts.deck(start))
        results = run(arguments.tautline, deck, work / str(index), {})
        miss = slack_starts.miss(start, places(work / str(index))) if results["status"] == "done" else math.inf
        return sample_of(f"{start.what} (seed {seed})", results, miss)

    starts = [(i, draw.randrange(2**31)) for i in range(arguments.samples)]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        return list(pool.map(lambda start: measure(*start), starts))


def spread(values):
    return f"{min(values):.4g} / {statistics.median(values):.4g} / {max(values):.4g}"


def report(title, samples, same):
    good = [s for s in samples if s.reached and s.miss <= same]
    columns = [f"{title:<16}", f"**{len(good)} of {len(samples)}**"]
    if good:
        columns += [f"{max(s.miss for s in good):.0e}", spread([s.iterations for s in good]), spread([s.descent for s in good])]
    print("| " + " | ".join(columns) + " |", flush=True)
    for s in samples:
        if s not in good:
            print(f"    {s.name}: " + (f"elsewhere, {s.miss:.3g} m" if s.reached else s.reason), flush=True)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0])
    parser.add_argument("tautline")
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--samples", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--position", type=float, default=0.02)
    parser.add_argument("--tension", type=float, default=0.5)
    parser.add_argument("--only", nargs="*", default=[*STRUCTURES, *SLACK])
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    print("| start | right equilibrium | farthest node [m] | Newton iterations, least / median / most | steps downhill, least / median / most |")
    print("|---|---|---|---|---|")
    for title in arguments.only:
        if title in STRUCTURES:
            report(title, disturbed(arguments, title), SAME)
        else:
            report(title, slack(arguments, title), 1e-4)


if __name__ == "__main__":
    main()
