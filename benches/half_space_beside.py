"""The same rough contacts in dpana, Tamaas and ContactMechanics, one thread each, one judge for all.

    pip install numpy tamaas contactmechanics
    cargo build --release && python benches/half_space_beside.py [--quick]

A self-affine periodic surface (H = 0.8, roll-off 8 waves, cut-off n/8, slope 0.1) is pressed by 0.01 E*
and, with friction 0.3, sheared by 0.35 of what friction can carry; Poisson's ratio 0.3. Seconds are
processor time: of the solve alone for the Python packages, of the whole program for dpana. The residual
is the natural map of fresh products with the symbol of the half-space, relative to the tractions,
for the approach and shift that suit each state best.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

YOUNG, POISSON, SHEARED = 2.0, 0.3, 0.35
MODULUS = YOUNG / (1 - POISSON**2)
PRESSURE = 0.01 * MODULUS
MOST = 1000  # iterations of Tamaas, whose friction solver stands still long before
ALONE = dict(os.environ, OMP_NUM_THREADS="1", RAYON_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")


def surface(n, hurst=0.8, slope=0.1, seed=3):
    """Heights on n x n points of the unit square."""
    most, random = n // 8, np.random.default_rng(seed)
    count = np.arange(-most, most + 1)
    kx, ky = np.meshgrid(count, count, indexing="ij")
    k = np.hypot(kx, ky)
    inside = (k <= most) & (k > 0)
    phase = np.exp(2j * np.pi * random.uniform(size=k.shape))
    waves = np.zeros((n, n), complex)
    waves[kx % n, ky % n] = np.where(inside, np.maximum(k, 8.0) ** (-1 - hurst) * phase, 0)
    heights = np.fft.ifft2(waves).real
    transformed, turn = np.fft.fft2(heights), 2j * np.pi * np.fft.fftfreq(n, 1 / n)
    slopes = [np.fft.ifft2(t * transformed).real for t in (turn[:, None], turn[None, :])]
    return heights * slope / np.sqrt(sum(s**2 for s in slopes).mean())


def displacements(traction):
    """Normal, x, y (rows are y) by pressure, and shear along x and y on the surface of z < 0."""
    n = traction.shape[1]
    ky = 2 * np.pi * np.fft.fftfreq(n, 1 / n)[:, None]
    kx = 2 * np.pi * np.fft.rfftfreq(n, 1 / n)[None, :]
    k = np.hypot(kx, ky)
    inverse, shear = np.where(k > 0, 1 / np.where(k > 0, k, 1), 0), YOUNG / (2 + 2 * POISSON)
    odd_x, odd_y = kx * (np.abs(kx) < np.pi * n), ky * (np.abs(ky) < np.pi * n)
    normal, x, y = (np.fft.rfft2(part) for part in traction)
    along = (odd_x * x + odd_y * y) * inverse**2
    coupling = 1j * (1 - 2 * POISSON) / (2 * shear) * inverse**2
    return [
        np.fft.irfft2(part, (n, n))
        for part in (
            (1 - POISSON) / shear * inverse * normal + coupling * (odd_x * x + odd_y * y),
            (inverse * x - POISSON * kx * inverse * (kx * x) * inverse**2
             - POISSON * odd_x * inverse * (odd_y * y) * inverse**2) / shear - coupling * odd_x * normal,
            (inverse * y - POISSON * ky * inverse * (ky * y) * inverse**2
             - POISSON * odd_y * inverse * (odd_x * x) * inverse**2) / shear - coupling * odd_y * normal,
        )
    ]


def residual(heights, friction, traction):
    """Natural map of pressure and shear, relative to them."""
    unit = np.zeros_like(traction)
    unit[:, 0, 0] = 1
    own = [displacements(unit * (np.arange(3) == part)[:, None, None])[part][0, 0] for part in (0, 1)]
    pressure, shear = traction[0], traction[1:]
    lift, *moved = displacements(np.array([-pressure, *shear]))
    gap = -heights - lift
    pressed = pressure > 0
    gap = gap - gap[pressed].mean()
    off = [np.minimum(pressure, gap / own[0])]
    if friction > 0:
        bound = friction * np.maximum(pressure, 0)
        stick = pressed & (np.hypot(*shear) < 0.95 * bound)
        slip = [part - part[stick].mean() for part in moved]
        trial = [s - w / own[1] for s, w in zip(shear, slip)]
        length = np.hypot(*trial)
        factor = np.where(length > bound, bound / np.where(length > 0, length, 1), 1)
        off += [s - factor * t for s, t in zip(shear, trial)]
    return np.sqrt(sum((part**2).sum() for part in off) / (traction**2).sum())


def by_dpana(heights, friction, program, folder):
    n = len(heights)
    np.save(f"{folder}/heights.npy", heights)
    scene = {
        "half_space": {"material": {"young": YOUNG, "poisson": POISSON}, "cells": [n, n], "size": [1, 1],
                       "surroundings": "periodic"},
        "surface": [{"height_map": {"file": "heights.npy"}}],
        "load": PRESSURE,
    }
    if friction > 0:
        scene |= {"friction": friction, "force": [SHEARED * friction * PRESSURE, 0]}
    with open(f"{folder}/scene.json", "w") as file:
        json.dump(scene, file)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [program, "half-space", f"{folder}/scene.json", "--npy", f"{folder}/a.npy",
               "--report", f"{folder}/a.json"]
    subprocess.run(command, check=True, env=ALONE, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    with open(f"{folder}/a.json") as file:
        step = json.load(file)["steps"][-1]
    print(f"          dpana says {step['status']}, {step['residual']:.1e}, "
          f"{step['applications']:.0f} applications", flush=True)
    fields = [np.load(f"{folder}/a_{name}.npy") for name in ("pressure", "shear_x", "shear_y")]
    return seconds, np.array(fields)


def by_tamaas(heights, friction):
    import tamaas as tm

    n = len(heights)
    kind = tm.model_type.surface_2d if friction > 0 else tm.model_type.basic_2d
    model = tm.Model(kind, [1.0, 1.0], [n, n])
    model.E, model.nu = YOUNG, POISSON
    if friction > 0:
        solver = tm.PolonskyKeerTan(model, np.ascontiguousarray(heights.T), 1e-12, friction)
        solver.max_iter = MOST
        load = [SHEARED * friction * PRESSURE, 0.0, PRESSURE]
    else:
        # The first of 1e-10 and below that it ends with: asked for less, it stalls.
        solver, load = tm.PolonskyKeerRey(model, np.ascontiguousarray(heights.T), 3e-11), PRESSURE
        solver.max_iter = MOST
    start = time.process_time()
    solver.solve(load)
    seconds = time.process_time() - start
    traction = np.array(model.traction)
    if friction > 0:
        return seconds, np.array([traction[..., 2].T, traction[..., 0].T, traction[..., 1].T])
    return seconds, np.array([traction.reshape(n, n).T, np.zeros((n, n)), np.zeros((n, n))])


def by_contactmechanics(heights, _friction):
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import Topography

    n = len(heights)
    topography = Topography(np.ascontiguousarray(heights.T), (1.0, 1.0), periodic=True)
    system = make_system(substrate="periodic", surface=topography, young=MODULUS)
    start = time.process_time()
    system.minimize_proxy(
        external_force=PRESSURE, pentol=1e-13 * np.ptp(heights), forcetol=1e-13 * PRESSURE / n**2, maxiter=3000
    )
    seconds = time.process_time() - start
    pressure = np.abs(np.asarray(system.substrate.force).reshape(n, n).T) * n * n
    return seconds, np.array([np.maximum(pressure, 0), np.zeros((n, n)), np.zeros((n, n))])


def child(name, folder, friction):
    heights = np.load(f"{folder}/heights.npy")
    seconds, traction = globals()[name](heights, friction)
    np.savez(f"{folder}/{name}.npz", seconds=seconds, traction=traction)


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    words.add_argument("--dpana", default="target/release/dpana", help="the program")
    words.add_argument("--quick", action="store_true", help="64 x 64 only")
    words.add_argument("--child", nargs=3, help=argparse.SUPPRESS)
    given = words.parse_args()
    if given.child:
        name, folder, friction = given.child
        return child(name, folder, float(friction))
    cases = [(64, 0.0), (64, 0.3)] if given.quick else [(256, 0.0), (512, 0.0), (128, 0.3), (256, 0.3)]
    print("cells  friction  program               seconds  residual")
    for n, friction in cases:
        heights = surface(n)
        with tempfile.TemporaryDirectory() as folder:
            found = {"dpana": by_dpana(heights, friction, given.dpana, folder)}
            for name in ["by_tamaas"] + ["by_contactmechanics"] * (friction == 0):
                command = [sys.executable, __file__, "--child", name, folder, str(friction)]
                if subprocess.run(command, env=ALONE).returncode == 0:
                    ended = np.load(f"{folder}/{name}.npz")
                    found[name[3:]] = float(ended["seconds"]), ended["traction"]
        for name, (seconds, traction) in found.items():
            off = residual(heights, friction, traction)
            print(f"{n:>4}²  {friction:>8}  {name:<20} {seconds:>8.2f}  {off:>8.1e}", flush=True)


if __name__ == "__main__":
    main()
