"""Time this checkout against another one, turn by turn in one run; write ``docs/benchmarks-against.json``.

    python tools/bench_against.py OTHER_CHECKOUT [FOLDER]

Each measurement runs in a process of its own, first of one checkout, then of the other, and so on; the least time of
each counts, and only their ratio says something.  Commands name the integrator, so that both do the same work.  Nothing
else should run meanwhile.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROUNDS = 3

LANES = """
import sys, time
import numpy as np
from mmgtune.backends import Integrator, get_backend, pad
from mmgtune.model import Model
from mmgtune.profile import load_profile

lanes, integrator = int(sys.argv[1]), Integrator(sys.argv[2])
model, steps = Model(load_profile("suzaku")), 600
t = np.arange(steps + 1.0)
controls = np.column_stack([np.full(len(t), 106.0 / 60.0), np.full(len(t), np.radians(35.0))])
weight = np.zeros((len(t), 6))
weight[1:, :3] = 1.0
start = np.array([0.0, 0.0, 0.0, 3.086, 0.0, 0.0])
cases = pad([t], [controls], [start], [np.zeros((len(t), 6))], [weight])
theta, backend = model.matrix(["hull.R_0"], np.linspace(0.012, 0.02, lanes)[None]), get_backend()
backend.run(model, theta, cases, integrator=integrator)
best = np.inf
for _ in range(max(5, 20000 // lanes)):
    began = time.perf_counter()
    backend.run(model, theta, cases, integrator=integrator)
    best = min(best, time.perf_counter() - began)
print(best)
"""

WINDOWS = """
import resource, time
import numpy as np
from mmgtune.backends import Integrator
from mmgtune.model import Model
from mmgtune.profile import load_profile
from mmgtune.trial import Trial
from mmgtune.scores import score

model = Model(load_profile("suzaku"))
t = np.arange(1201) * 0.1
steady = {name: np.zeros(len(t)) for name in ("x", "y", "psi", "v_m", "r")}
windows = [
    Trial(id=str(k), ship="", manoeuvre="", source="generated", t=t, u=np.full(len(t), 3.0), n=np.full(len(t), 1.7),
          delta=0.5 * np.sin(t / 20.0 + k), **steady)
    for k in range(1000)
]
sigma = dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), 1.0)
score(model, windows[:9], sigma, integrator=Integrator("rk4"))
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
began = time.perf_counter()
score(model, windows, sigma, integrator=Integrator("rk4"))
print(time.perf_counter() - began, (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) // 1024)
"""

FIT = ("--integrator", "euler", "--no-report", "--quiet", "--force", "--out", "{out}")
WORK: dict[str, list[str]] = {
    **{
        f"lane-step, {lanes} lanes, {integrator}": ["-c", LANES, str(lanes), integrator]
        for lanes in (48, 4096)
        for integrator in ("euler", "rk4")
    },
    "score of 1000 windows of 120 s at 10 Hz, rk4": ["-c", WINDOWS],
    "fit --ar 0.5, euler": ["-m", "mmgtune", "fit", "--ar", "0.5", *FIT],
    "sweep, least squares, euler": ["-m", "mmgtune", "sweep", "--method", "least-squares", *FIT],
    "diagnose suzaku suzaku": [
        *("-m", "mmgtune", "diagnose", "-p", "suzaku", "-t", "suzaku"),
        *("--no-report", "--quiet", "--force", "--out", "{out}"),
    ],
}


def seconds(checkout: Path, work: list[str], folder: Path) -> tuple[float, int | None]:
    """Seconds that a piece of work says it took, or that its process did; memory [MB] where it says."""
    environment = {**os.environ, "PYTHONPATH": str(checkout), "MMGTUNE_CACHE": str(folder / "cache")}
    line = [sys.executable, *(part.replace("{out}", str(folder / "run")) for part in work)]
    began = time.perf_counter()
    done = subprocess.run(line, cwd=checkout, env=environment, capture_output=True, text=True)
    took = time.perf_counter() - began
    if done.returncode:
        raise SystemExit(f"failed in {checkout}: {' '.join(work)[-80:]}\n{done.stderr}")
    if work[0] != "-c":
        return took, None
    said = done.stdout.split()
    return float(said[0]), int(said[1]) if len(said) > 1 else None


def compare(here: Path, other: Path) -> list[dict[str, Any]]:
    """The least of ROUNDS, other and this checkout in turn, and their ratio."""
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folders = {other: Path(name) / "other", here: Path(name) / "here"}
        for title, work in WORK.items():
            for checkout, folder in folders.items():
                folder.mkdir(exist_ok=True)
                seconds(checkout, work, folder)  # compiles
            times: dict[Path, list[tuple[float, int | None]]] = {checkout: [] for checkout in folders}
            for _ in range(ROUNDS):
                for checkout, folder in folders.items():
                    times[checkout].append(seconds(checkout, work, folder))
            before, now = (min(times[checkout]) for checkout in folders)
            row: dict[str, Any] = {
                "work": title,
                "other_s": round(before[0], 6),
                "here_s": round(now[0], 6),
                "ratio": round(now[0] / before[0], 3),
            }
            if now[1] is not None:
                row |= {"other_mb": before[1], "here_mb": now[1]}
            print(json.dumps(row), flush=True)
            rows.append(row)
    return rows


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    root = Path(__file__).resolve().parent.parent
    target = Path(sys.argv[2]) if len(sys.argv) > 2 else root / "docs"
    found = compare(root, Path(sys.argv[1]).resolve())
    (target / "benchmarks-against.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
