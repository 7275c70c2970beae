#!/usr/bin/env python3
"""Measures from how many disturbed starts the 12 m perimeter truss finds its equilibrium.

usage: run.py TAUTLINE WORK [--samples N] [--seed S] [--position M] [--tension T] [--subdivisions N] [--path NAME] [--jobs N]
    TAUTLINE: the program; WORK: a directory for decks and results; NAME: direct (default), staged, automatic or relaxation

Every sample has a gap of its own between 0 and 50 mm, a displacement of its own of up to M (20 mm) in each coordinate of every free node, and a change of
its own of up to T (0.5) of every cable's initial strain. Asked is the equilibrium of the undisturbed start with the same gap. README.md says what came out.
"""
import argparse
import collections
import concurrent.futures
import csv
import json
import pathlib
import random
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
DECK = HERE.parent.parent / "inputs" / "perimeter_truss_12m.yaml"
SAME = 1e-6  # m, a tenth of what Newton's stopping rule leaves open on a structure of this size
PATHS = {
    "direct": "",
    "staged": "\n    stages:\n      - {name: frame held, hold: [front_rim, rear_rim, struts]}\n      - {name: one strut held}",
    "automatic": "\n    release: automatic",
    "relaxation": "\n    fallback: dynamic_relaxation",
}
STEPS = """
steps:
  - kind: form_finding
  - kind: mesh
    subdivisions: SUBDIVISIONS
  - kind: equilibrium
    name: found
    scatter: {position: 0, tension: 0, seed: 1}"""


def write_deck(path, subdivisions, directory):
    """The deck of inputs/ with other steps."""
    structure, separator, _ = DECK.read_text().partition("\nsteps:")
    if not separator:
        sys.exit(f"{DECK}: no steps")
    deck = directory / "deck.yaml"
    deck.write_text(structure + STEPS.replace("SUBDIVISIONS", str(subdivisions)) + PATHS[path] + "\n")
    return deck


def run(program, deck, out, **values):
    """Runs the deck; returns its results, also of a run that did not converge."""
    command = [program, "run", str(deck), "-o", str(out), "--quiet", "--no-pictures"]
    for key, value in values.items():
        command += ["--set", f"{key.replace('__', '.')}={value}"]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if not (out / "results.json").exists():
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return json.loads((out / "results.json").read_text())


def places(out):
    with open(out / "nodes.csv", newline="") as file:
        return [tuple(float(row[c]) for c in "xyz") for row in csv.DictReader(file)]


def farthest(a, b):
    return max(sum((p - q) ** 2 for p, q in zip(x, y)) ** 0.5 for x, y in zip(a, b, strict=True))


Sample = collections.namedtuple("Sample", "index gap seed reached miss iterations descent attempts imbalance reason")


def measure(arguments, deck, index, gap, seed):
    """One disturbed start beside the undisturbed one."""
    common = {"reflector__gap": gap}
    calm, wild = arguments.work / f"{index}_calm", arguments.work / f"{index}_wild"
    first = run(arguments.tautline, deck, calm, **common)
    if first["status"] != "done":
        sys.exit(f"sample {index}: the undisturbed start fails: {first['reason']}")
    second = run(arguments.tautline, deck, wild, **common, **{
        "steps__found__scatter__position": arguments.position, "steps__found__scatter__tension": arguments.tension, "steps__found__scatter__seed": seed})
    stages = second["steps"][-1].get("stages", [])
    reached = second["status"] == "done"
    return Sample(index, gap, seed, reached, farthest(places(calm), places(wild)) if reached else float("inf"),
                  sum(s["newton_iterations"] for s in stages), sum(s["descent_steps"] for s in stages),
                  sum(s["failed_attempts"] for s in stages),
                  stages[0]["step0_out_of_balance"] if stages else float("nan"), second["reason"])


def spread(values):
    return f"{min(values):.4g} / {statistics.median(values):.4g} / {max(values):.4g}"


def report(samples):
    same = [s for s in samples if s.reached and s.miss <= SAME]
    print(f"same equilibrium: {len(same)} of {len(samples)} = {100 * len(same) / len(samples):.1f} %")
    if same:
        print(f"  farthest node from the undisturbed run, worst sample: {max(s.miss for s in same):.1e} m")
        print(f"  Newton iterations, least / median / most: {spread([s.iterations for s in same])}")
        print(f"  steps downhill, least / median / most: {spread([s.descent for s in same])}")
        print(f"  attempts that failed, least / median / most: {spread([s.attempts for s in same])}")
        print(f"  largest nodal force out of balance at the start, least / median / most: "
              f"{spread([s.imbalance for s in same])} N")
    for s in samples:
        if s not in same:
            told = f"another place, {s.miss:.3g} m away" if s.reached else s.reason
            print(f"  sample {s.index} (gap {s.gap:.5f} m, seed {s.seed}): {told}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0])
    parser.add_argument("tautline")
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--samples", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--position", type=float, default=0.02)
    parser.add_argument("--tension", type=float, default=0.5)
    parser.add_argument("--subdivisions", type=int, default=2)
    parser.add_argument("--path", choices=PATHS, default="direct")
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    deck = write_deck(arguments.path, arguments.subdivisions, arguments.work)
    draw = random.Random(arguments.seed)
    starts = [(i, draw.uniform(0, 0.05), draw.randrange(2**31)) for i in range(arguments.samples)]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        report(list(pool.map(lambda start: measure(arguments, deck, *start), starts)))


if __name__ == "__main__":
    main()
