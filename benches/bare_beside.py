"""Bare condensed problems in dpana and Siconos, one thread each, one judge for both.

    apt-get install python3-siconos python3-numpy
    python3 benches/bare_beside.py [--quick] [FILE ...]

Without a file the shipped problems, tests/data/discrete. Both get the symmetric part of W and the same
tolerance: the natural map with the contacts' own stiffness, relative to the reaction, at most 1e-8, measured here
on what either returns. Siconos is asked for 1e-6, 1e-7, ... until its answer has it, by each of its solvers that
suits the dimension; the fastest counts. Seconds are processor time of a solve alone: the median of several.
"""

import argparse
import glob
import gzip
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

ALONE = dict(os.environ, OMP_NUM_THREADS="1", RAYON_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
if __name__ == "__main__" and os.environ.get("OPENBLAS_NUM_THREADS") != "1":
    os.execve(sys.executable, [sys.executable, *sys.argv], ALONE)

import numpy as np

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TOLERANCE = 1e-8
SPACE = ["NSGS", "NSN_AC", "NSN_FB", "NSN_NM", "ADMM", "PROX"]
PLANE = ["NSGS", "LEMKE", "CPG"]
LEAST = 0.002  # seconds below which neither is compared


class Problem:
    def __init__(self, file):
        with (gzip.open if file.endswith(".gz") else open)(file) as text:
            read = json.load(text)
        self.name, self.axes, self.mu = read["name"], read["dimension"], np.array(read["mu"])
        self.q = np.array(read["q"])
        w = np.zeros((len(self.q),) * 2)
        np.add.at(w, (read["w_rows"], read["w_cols"]), read["w_values"])
        self.w, self.read = 0.5 * (w + w.T), read
        diagonal = np.diag(self.w).reshape(-1, self.axes)
        own = np.column_stack([diagonal[:, 0]] + [diagonal[:, 1:].mean(axis=1)] * (self.axes - 1))
        least = own[own > 1e-15 * own.max()].min()
        self.step = 1 / np.where(own > 1e-15 * own.max(), own, least)

    def residual(self, reaction):
        """Natural map of a reaction (pressed where positive)."""
        reaction = np.asarray(reaction)
        r = reaction.reshape(-1, self.axes)
        trial = r - self.step * (self.w @ reaction + self.q).reshape(-1, self.axes)
        pressed = np.maximum(trial[:, 0], 0)
        size = np.linalg.norm(trial[:, 1:], axis=1)
        bound = self.mu * np.maximum(r[:, 0], 0) * (trial[:, 0] > 0)
        held = trial[:, 1:] * np.minimum(1, bound / np.where(size > 0, size, 1))[:, None]
        off = np.linalg.norm(r - np.column_stack([pressed, held]))
        force = -self.q @ self.q / max(self.q @ self.w @ self.q, 1e-300) * self.q
        return off / max(np.linalg.norm(r), 1e-3 * np.linalg.norm(force), 1e-300)


def by_siconos(problem, solver, tolerance):
    import siconos.numerics as sn

    posed = sn.FrictionContactProblem(problem.axes, problem.w, problem.q, problem.mu)
    driver = sn.fc3d_driver if problem.axes == 3 else sn.fc2d_driver
    options = sn.SolverOptions(getattr(sn, f"SICONOS_FRICTION_{problem.axes}D_{solver}"))
    options.iparam[0], options.dparam[0] = 100000 if "NSGS" in solver else 2000, tolerance
    reaction, velocity = np.zeros_like(problem.q), np.zeros_like(problem.q)
    start = time.process_time()
    driver(posed, reaction, velocity, options)
    return time.process_time() - start, problem.residual(reaction)


def fastest(problem, limit):
    """(seconds, residual, solver) of the fastest that reaches the tolerance; seconds None if none does."""
    best = (None, np.inf, "none")
    for solver in SPACE if problem.axes == 3 else PLANE:
        for digits in range(6, 16):
            seconds, residual = apart(lambda: by_siconos(problem, solver, 10.0**-digits), limit)
            if residual is None or (best[0] is not None and seconds > 3 * best[0]):
                break
            if residual <= TOLERANCE:
                again = [apart(lambda: by_siconos(problem, solver, 10.0**-digits), limit)[0] for _ in range(4)]
                seconds = float(np.median([seconds, *filter(None, again)]))
                if best[0] is None or seconds < best[0]:
                    best = (seconds, residual, solver)
                break
            if best[0] is None:
                best = (None, min(best[1], residual), "none")
    return best


def apart(run, limit):
    """What a run returns, in a process of its own that may crash, print or take too long."""
    with tempfile.TemporaryFile("w+") as answer:
        child = os.fork()
        if child == 0:
            quiet = os.open(os.devnull, os.O_WRONLY)
            os.dup2(quiet, 1), os.dup2(quiet, 2)
            signal.alarm(limit)
            run()  # what is loaded and written to for the first time does not count
            json.dump(run(), answer)
            answer.flush()
            os._exit(0)
        _, status = os.waitpid(child, 0)
        answer.seek(0)
        return tuple(json.load(answer)) if status == 0 else (None, None)


def by_dpana(problems, quick):
    """(seconds, residual, status) per name."""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for problem in problems:
            files.append(f"{folder}/{problem.name}.json")
            with open(files[-1], "w") as text:
                json.dump(problem.read, text)
        bench = os.environ.get("DPANA_BARE")
        command = [bench, "--bench"] if bench else ["cargo", "bench", "--quiet", "--bench", "bare", "--"]
        command += ["--reactions", folder] + ["--quick"] * quick + files
        rows = subprocess.run(command, cwd=HERE, env=ALONE, check=True, text=True, stdout=subprocess.PIPE).stdout
        found = {}
        for problem in problems:
            cells = re.search(rf"^\| {re.escape(problem.name)} \|(.*)\|$", rows, re.M)[1].split("|")
            with open(f"{folder}/{problem.name}") as text:
                reaction = np.array(json.load(text)).reshape(-1, problem.axes)
            reaction[:, 0] *= -1
            found[problem.name] = float(cells[1]), problem.residual(reaction.ravel()), cells[3].strip()
        return found


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    words.add_argument("files", nargs="*", help="problems in JSON, .gz too")
    words.add_argument("--quick", action="store_true", help="each once, four of the shipped")
    words.add_argument("--limit", type=int, default=20, help="seconds that one run of Siconos may take")
    given = words.parse_args()
    shipped = sorted(set(glob.glob(f"{HERE}/tests/data/discrete/*.json")) - set(glob.glob(f"{HERE}/tests/data/discrete/*_loads.json")))
    files = given.files or (shipped[:4] if given.quick else shipped)
    problems = [Problem(file) for file in files]
    mine, ratios = by_dpana(problems, given.quick), []
    print("| problem | contacts | axes | dpana ms | residual | status | Siconos ms | residual | solver | ratio |")
    print("|---|---:|---:|---:|---:|---|---:|---:|---|---:|")
    for problem in problems:
        seconds, residual, status = mine[problem.name]
        other, left, solver = fastest(problem, given.limit)
        compared = other is not None and max(seconds, other) > LEAST
        ratios += [seconds / other] if compared else []
        print(f"| {problem.name} | {len(problem.mu)} | {problem.axes} | {1e3 * seconds:.3f} | {residual:.1e} | {status} | "
              + (f"{1e3 * other:.3f}" if other is not None else "–")
              + f" | {left:.1e} | {solver} | {'' if other is None else f'{seconds / other:.2f}'} |", flush=True)
    if ratios:
        print(f"\nwhere either takes over {1e3 * LEAST:.0f} ms: {len(ratios)} problems, "
              f"median {np.median(ratios):.2f}, worst {max(ratios):.2f}")


if __name__ == "__main__":
    main()
