#!/usr/bin/env python3
"""Runs the six variants of example 3.3 (Belov 2021) with 6, 8 and 12 spokes and prints the table of docs/theory/umbrella.md.

usage: compare.py PROGRAM FOLDER [-- further options of the program, e.g. --set parameters.subdivisions=4]
"""
import json
import math
import os
import subprocess
import sys
from pathlib import Path

DECK = Path(__file__).resolve().parents[2] / "inputs" / "umbrella_48m.yaml"


def wishes(front, rear, spokes):
    """Tensions aimed at [N]: those with which straight cords balance in plan, 40 N in the front net of triangles."""
    half = math.pi / spokes
    tensions = {
        "triangles": {"net": 40, "ring": 40 * math.cos(2 * half) / math.sin(half), "connector": 80 * math.cos(half),
                      "peripheral": 720},
        "coarse_triangles": {"net": 90, "ring": 90 * math.cos(2 * half) / math.sin(half), "connector": 144, "peripheral": 720},
        "belts": {"net": 160, "ring": 40, "peripheral": 200},
        "rectangles": {"net": 40, "ring": 29 / math.tan(half), "column": 29, "connector": 29, "peripheral": 720},
        "right_triangles": {"net": 12, "ring": 34 * math.tan(math.pi / 6) / math.tan(half), "column": 13, "connector": 26,
                            "peripheral": 720},
    }
    asked = {f"front_{part}_tension": value for part, value in tensions[front].items()}
    under_other = rear == "belts" and front != "belts"
    behind = {"net": 600, "ring": 120, "peripheral": 720} if under_other else tensions[rear]
    asked.update({f"rear_{part}_tension": value for part, value in behind.items() if part != "column"})
    return asked


VARIANTS = [
    (1, "triangles", "triangles", (6, 8, 12), (False, True)),
    (2, "belts", "belts", (6, 8, 12), (False, True)),
    (3, "triangles", "coarse_triangles", (6, 8, 12), (False, True)),
    (4, "triangles", "belts", (6, 8, 12), (True,)),
    (5, "rectangles", "belts", (6,), (False,)),
    (6, "right_triangles", "right_triangles", (6,), (False,)),
]


def run(program, folder, front, rear, spokes, paired, options):
    settings = {"front": front, "rear": rear, "spokes": spokes, "paired": str(paired).lower(), "tube": "square" if paired else "round",
                **wishes(front, rear, spokes)}
    name = f"{front}_{rear}_{spokes}{'_paired' if paired else ''}"
    command = [program, "run", str(DECK), "--output", str(folder / name), "--set", "steps.modal.modes=60"]
    for key, value in settings.items():
        command += ["--set", f"parameters.{key}={value}"]
    done = subprocess.run(command + options, capture_output=True, text=True,
                          env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}, check=False)
    if done.returncode != 0:
        return {"failed": (done.stderr or done.stdout).strip().splitlines()[-1]}
    return json.loads((folder / name / "results.json").read_text())


def row(results):
    if "failed" in results:
        return results["failed"]
    steps = {step["name"]: step for step in results["steps"]}
    tuned, modes = steps["tuning"], steps["modal"]
    links = [tuned["groups"][name] for name in ("root_links", "intermediate_links", "front_links", "rear_links")]
    masses = [sum(mode[:3]) for mode in modes["effective_mass"]]
    best = max(range(len(masses)), key=masses.__getitem__)
    net = tuned["groups"]["front_net"]
    slack = sum(group.get("slack", 0) for group in tuned["groups"].values())
    return (f"{1e3 * tuned['surface']['rms']:.2f} | {1e3 * tuned['surface']['rms_area_weighted']:.2f} | "
            f"{min(link['axial_min'] for link in links):.0f} | {max(link['moment_max'] for link in links):.0f} | "
            f"{modes['frequencies'][best]:.3f} ({masses[best]:.0f} kg) | {net['tension_min']:.1f} to {net['tension_max']:.1f} | "
            f"{slack}")


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    options = [option for option in sys.argv[3:] if option != "--"]
    print("| variant | front / rear | spokes | ties | RMS, mm | by area, mm | largest spoke compression, N | largest moment, N m | "
          "f, Hz (mass) | front net, N | slack |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for number, front, rear, spokes, pairings in VARIANTS:
        for n in spokes:
            for paired in pairings:
                result = row(run(program, folder, front, rear, n, paired, options))
                print(f"| {number} | {front} / {rear} | {n} | {'round' if paired else 'through'} | {result} |", flush=True)


if __name__ == "__main__":
    main()
