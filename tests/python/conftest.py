"""What the Python tests are held against: the command line of the same sources."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "examples" / "scenes"
DATA = ROOT / "tests" / "data"


@pytest.fixture(scope="session")
def program():
    """Runs the command line; DPANA_PROGRAM names it, or it is built."""
    path = os.environ.get("DPANA_PROGRAM")
    if path is None:
        build = ["cargo", "build", "--quiet", "--release", "--bin", "dpana"]
        subprocess.run(build, cwd=ROOT, check=True)
        target = os.environ.get("CARGO_TARGET_DIR", ROOT / "target")
        path = Path(target) / "release" / "dpana"

    def run(*arguments):
        command = [str(path), *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, timeout=600)

    return run


def without_seconds(report):
    """A report without what differs from run to run: times."""
    if isinstance(report, dict):
        kept = {name: of for name, of in report.items() if "seconds" not in name}
        return {name: without_seconds(of) for name, of in kept.items()}
    return [without_seconds(of) for of in report] if isinstance(report, list) else report


def read_report(path):
    return without_seconds(json.loads(Path(path).read_text()))


def block(support, *, cells=(4, 3), friction=0.3, **body):
    """A rectangle of 2 by 1 on a line, E = 1000, ν = 0.3, its top given a displacement."""
    return {
        "bodies": [
            {
                "name": "block",
                "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": list(cells)}},
                "model": "plane_strain",
                "materials": [{"young": 1000, "poisson": 0.3}],
                "supports": [{"group": "top", "displacement": support}],
                **body,
            }
        ],
        "contacts": [
            {
                "group": "bottom",
                "friction": friction,
                "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}},
            }
        ],
    }
