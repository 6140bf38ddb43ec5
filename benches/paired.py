"""Two builds of dpana on the same scenes, run in turn: seconds of each stage, peak memory and Newton steps, and their ratios.

    git worktree add ../v0.4.0 v0.4.0 && (cd ../v0.4.0 && cargo build --release)
    cargo build --release
    python3 benches/paired.py ../v0.4.0/target/release/dpana target/release/dpana [--runs 5] [NAME ...]

A name is `cube N`, `square N` (cells a side), or a scene that both builds have in `examples/scenes`. Stages are those of the report;
`after` is all behind the factorisation, `before` all but the factorisation in front of it, `whole` wall time of the whole process. Of
every pair the ratio is taken, and of the ratios the median; least and largest beside it.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from statistics import median

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SCENES = os.path.join(HERE, "examples", "scenes")
NAMES = ["cube 16", "cube 24", "cube 32", "square 512"]
SHIPPED = ["hertz", "fretting", "pad", "punch", "sphere", "square", "ssnv128", "two_cubes", "cube"]
COLUMNS = ["whole", "assembly", "ordering", "factorisation", "before", "after", "MiB"]


def scene(name, folder):
    """The file of a scene, written where its mesh is generated."""
    kind, *cells = name.split()
    if not cells:
        return os.path.join(SCENES, f"{kind}.json")
    with open(os.path.join(SCENES, {"cube": "cube", "square": "ssnv128"}[kind] + ".json")) as text:
        read = json.load(text)
    cells, body = int(cells[0]), read["bodies"][0]
    if kind == "cube":
        body["mesh"]["box"]["cells"] = [cells] * 3
    else:
        body["mesh"] = {"rectangle": {"x": [0, 0.04], "y": [0, 0.04], "cells": [cells] * 2}}
        body["supports"][0]["group"], read["contacts"][0]["group"] = "right", "bottom"
    file = os.path.join(folder, name.replace(" ", "_") + ".json")
    with open(file, "w") as text:
        json.dump(read, text)
    return file


def run(program, file, folder):
    """What one run took, by column, and its Newton steps."""
    report = os.path.join(folder, "report.json")
    start = time.perf_counter()
    child = subprocess.Popen([program, "solve", file, "--report", report], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    whole = time.perf_counter() - start
    if status != 0:
        sys.exit(f"{program} {file}: {status}")
    with open(report) as text:
        read = json.load(text)
    seconds = read["work"]["seconds"]
    before = seconds["assembly"] + seconds["ordering"]
    after = seconds["total"] - before - seconds["factorisation"]
    memory = used.ru_maxrss / 1024
    found = dict(seconds, whole=whole, before=before, after=after, MiB=memory)
    return [found[column] for column in COLUMNS], read["work"]["newton_steps"]


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    words.add_argument("old"), words.add_argument("new")
    words.add_argument("names", nargs="*", help="scenes; without any, the cubes, the square and the shipped ones")
    words.add_argument("--runs", type=int, default=5)
    given = words.parse_intermixed_args()
    print("| scene | " + " | ".join(COLUMNS) + " | Newton steps |")
    print("|---|" + "---:|" * (len(COLUMNS) + 1))
    with tempfile.TemporaryDirectory() as folder:
        for name in given.names or NAMES + SHIPPED:
            file, pairs = scene(name, folder), []
            for _ in range(given.runs):
                pairs.append([run(program, file, folder) for program in (given.old, given.new)])
            cells = []
            for k in range(len(COLUMNS)):
                old, new = (median(pair[side][0][k] for pair in pairs) for side in (0, 1))
                ratios = [pair[1][0][k] / max(pair[0][0][k], 1e-9) for pair in pairs]
                shown = (f"{x:.0f}" if COLUMNS[k] == "MiB" else f"{x:.3f}" for x in (old, new))
                cells.append(" → ".join(shown) + f": {median(ratios):.2f} ({min(ratios):.2f}–{max(ratios):.2f})")
            print(f"| {name} | " + " | ".join(cells) + f" | {pairs[0][0][1]} → {pairs[0][1][1]} |", flush=True)


if __name__ == "__main__":
    main()
