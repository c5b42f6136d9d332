"""Measure the training of an ensemble against eager PyTorch; write ``docs/ensemble-speed.json``.

    python -m tools.ensemble_speed PYTHON [FILE]

PYTHON is an interpreter that has PyTorch and NumPy, see ``tools.torch_speed``.  Both get the same windows of made
trials and the same weights, and must find the same loss and norm of the gradient.  The program trains 15 members side
by side, a core to each; PyTorch trains them one after the other, as the loop of a paper would, with all cores for each
product.  The time of the processor is that of one update of one member on one core; the clock is that of one update of
each of the 15 members on all cores, for which nothing else may run.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

MEMBERS, BATCH, HORIZON, INITIAL = 15, 32, 100, 30
SIZES = ((3, 256), (2, 64))
ROUNDS, UPDATES = 3, 4
RATE, CLIP = 1e-4, 1.0
ORDER = ("W_in", "b_in", "W_hidden", "b_hidden", "W_out", "b_out")


def measure_own(folder: Path, cores: int) -> list[dict[str, Any]]:
    """This program's training; writes the windows and weights of each size, and what it finds of them."""
    from mmgtune.backends.twins import jax_module
    from mmgtune.generating import make_trials
    from mmgtune.learning.choosing import from_origin
    from mmgtune.learning.ensemble import EnsembleAim, first_member
    from mmgtune.learning.task import ensemble_task
    from mmgtune.learning.training import Plan, Trainer, batch
    from mmgtune.options import EnsembleOptions, MakeOptions
    from mmgtune.profile import load_profile
    from mmgtune.trial import load_trials

    jax, rows = jax_module(), []
    made = folder / "vectwin"
    if not made.is_dir():
        make_trials("vectwin", made, MakeOptions(sets=("train-b",)))
    data = load_trials(made / "train-b")
    for layers, width in SIZES:
        options = EnsembleOptions(layers=layers, width=width, horizon=HORIZON, initial=INITIAL)
        task = ensemble_task(load_profile("vectwin_3m"), data, options)
        weights, standards = first_member(task, 1)
        weights = jax.tree.map(np.float32, weights)
        aim = EnsembleAim(task).of(standards)
        starts = batch(aim.starts, BATCH, 1, 0)
        loss, gradient = jax.jit(jax.value_and_grad(aim.loss))(weights, starts, aim.data)
        span = starts[None, :] + np.arange(HORIZON + 1)[:, None]
        known = {f"{part}_{k}": v for part in ("motion", "start") for k, v in getattr(weights, part)._asdict().items()}
        known |= {f"{p}_{k}": v for p in ("motion", "start") for k, v in getattr(standards, p)._asdict().items()}
        np.savez(
            folder / f"{layers}-{width}.npz",
            **known,
            states=np.asarray(from_origin(jax.numpy.asarray(task.samples.states[span]))),
            controls=task.samples.controls[span[:-1]],
            wind=task.samples.wind[span[:-1]],
            sigma=task.noise,
            h=task.samples.step,
            loss=loss,
            norm=np.sqrt(sum(float((one**2).sum()) for one in jax.tree.leaves(gradient))),
        )
        trainer = Trainer(aim, Plan(1000, BATCH, RATE, 1000), alone=True)
        held = [trainer.begin(weights) for _ in range(MEMBERS)]

        def update(k: int, held: list[Any] = held, trainer: Any = trainer, starts: Any = starts) -> None:
            now = held[k]
            given = now.parameters, now.state, now.mean, starts, np.float32(1.0), np.float32(0.9)
            now.parameters, now.state, now.mean, *rest = trainer.update(*given, trainer.aim.data)
            jax.block_until_ready((now.parameters, rest))

        def every(update: Any = update) -> None:
            with ThreadPoolExecutor(cores) as pool:
                list(pool.map(update, range(MEMBERS)))

        rows.append({"layers": layers, "width": width, **timed(update, every)})
    return rows


def measure_torch(folder: Path, cores: int) -> list[dict[str, Any]]:
    """The same in eager PyTorch."""
    import torch

    torch.set_num_threads(cores)
    rows = []
    for layers, width in SIZES:
        with np.load(folder / f"{layers}-{width}.npz") as file:
            given = {name: torch.tensor(np.float32(file[name])) for name in file.files}
            h, known = float(file["h"]), (float(file["loss"]), float(file["norm"]))
        names = [f"{part}_{name}" for part in ("motion", "start") for name in ORDER]
        members = [{name: torch.nn.Parameter(given[name].clone()) for name in names} for _ in range(MEMBERS)]
        optimisers = [torch.optim.AdamW(w.values(), lr=RATE, weight_decay=0.0) for w in members]
        loss = torch_loss(torch, members[0], given, h)
        loss.backward()
        norm = float(torch.sqrt(sum((one.grad**2).sum() for one in members[0].values())))
        if not np.allclose((float(loss.detach()), norm), known, rtol=1e-2):
            raise SystemExit(f"{layers} x {width}: loss and norm {float(loss)}, {norm}, not {known}")

        def update(k: int, members: Any = members, of: Any = optimisers, given: Any = given, h: float = h) -> None:
            of[k].zero_grad()
            torch_loss(torch, members[k], given, h).backward()
            torch.nn.utils.clip_grad_norm_(members[k].values(), CLIP)
            of[k].step()

        def every(update: Any = update) -> None:
            for k in range(MEMBERS):
                update(k)

        rows.append({"layers": layers, "width": width, **timed(update, every)})
    return rows


def torch_loss(torch: Any, w: Any, given: Any, h: float) -> Any:
    """Mean over windows and samples of squared errors of velocities over the noise."""

    def network(part: str, x: Any) -> Any:
        x = (x - given[f"{part}_in_mean"]) / given[f"{part}_in_deviation"]
        x = torch.tanh(torch.addmm(w[f"{part}_b_in"], x, w[f"{part}_W_in"]))
        for W, b in zip(w[f"{part}_W_hidden"], w[f"{part}_b_hidden"], strict=True):
            x = torch.tanh(torch.addmm(b, x, W))
        raw = torch.addmm(w[f"{part}_b_out"], x, w[f"{part}_W_out"])
        raw = (raw - given[f"{part}_raw_mean"]) / given[f"{part}_raw_deviation"]
        return raw * given[f"{part}_out_deviation"] + given[f"{part}_out_mean"]

    measured = given["states"]
    seen = measured[:INITIAL, :, 3:]
    both = torch.cat([seen[:1], seen[1:] - seen[:1]])
    correction = network("start", both.permute(1, 0, 2).reshape(both.shape[1], -1))
    states = torch.cat([measured[0, :, :3], measured[0, :, 3:] + correction], -1)
    off = [(states - measured[0])[:, 3:] / given["sigma"]]
    for k in range(len(measured) - 1):
        psi, u, v, r = states[:, 2], states[:, 3], states[:, 4], states[:, 5]
        cos, sin = torch.cos(psi), torch.sin(psi)
        north, east = given["wind"][k].unbind(-1)
        blows = torch.stack([u - (north * cos + east * sin), v - (east * cos - north * sin)], -1)
        rates = network("motion", torch.cat([states[:, 3:], given["controls"][k], blows], -1))
        pose = torch.stack([u * cos - v * sin, u * sin + v * cos, r], -1)
        states = states + h * torch.cat([pose, rates], -1)
        off.append((states - measured[k + 1])[:, 3:] / given["sigma"])
    return torch.mean(torch.sum(torch.stack(off) ** 2, -1))


def timed(update: Any, every: Any) -> dict[str, list[float]]:
    """Seconds of the processor of an update of one member, and on the clock of one of each, after one not counted."""
    update(0)
    alone, together = [], []
    for _ in range(UPDATES):
        began = time.process_time()
        update(0)
        alone.append(time.process_time() - began)
    began = time.perf_counter()
    every()
    together.append(time.perf_counter() - began)
    return {"alone": alone, "together": together}


def main(python: str, target: Path) -> None:
    """Time both in turn, and write what was found."""
    from mmgtune.files import write_text
    from tools.bench import machine

    cores = sorted(os.sched_getaffinity(0))
    about: dict[str, Any] = {**machine(), "members": MEMBERS, "batch": BATCH, "horizon": HORIZON, "cores": len(cores)}
    about["load_before"] = round(os.getloadavg()[0], 1)
    times: dict[tuple[str, str, int, int], list[float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(ROUNDS):
            for taken in (cores[:1], cores):
                for side, interpreter in (("jax", sys.executable), ("torch", python)):
                    line = [interpreter, str(Path(__file__)), f"--{side}", folder, ",".join(map(str, taken))]
                    done = subprocess.run(line, check=True, stdout=subprocess.PIPE)
                    found = json.loads(done.stdout.splitlines()[-1])
                    about[side] = found["version"]
                    of = "alone" if taken == cores[:1] else "together"
                    for row in found["rows"]:
                        times.setdefault((of, side, row["layers"], row["width"]), []).extend(row[of])
    about["rows"] = [{"layers": layers, "width": width, **summary(times, layers, width)} for layers, width in SIZES]
    print(json.dumps(about, indent=1), flush=True)
    write_text(target, json.dumps(about, indent=1) + "\n")


def summary(times: Any, layers: int, width: int) -> dict[str, Any]:
    """Medians of both, and how many times as long PyTorch takes."""
    row: dict[str, Any] = {}
    for of, words in (("alone", "processor_s_an_update"), ("together", f"clock_s_{MEMBERS}_updates")):
        ours, theirs = (float(np.median(times[of, side, layers, width])) for side in ("jax", "torch"))
        row[words] = {"jax": round(ours, 4), "torch": round(theirs, 4), "ratio": round(theirs / ours, 2)}
    return row


if __name__ == "__main__":
    if sys.argv[1] in ("--jax", "--torch"):
        taken = [*map(int, sys.argv[3].split(","))]
        os.sched_setaffinity(0, taken)
        sys.path.insert(0, str(Path(__file__).parent.parent))
        rows = (measure_own if sys.argv[1] == "--jax" else measure_torch)(Path(sys.argv[2]), len(taken))
        print(json.dumps({"version": version(sys.argv[1].strip("-")), "rows": rows}))
    else:
        docs = Path(__file__).parent.parent / "docs"
        main(sys.argv[1], Path(sys.argv[2]) if len(sys.argv) > 2 else docs / "ensemble-speed.json")
