"""Measure training against eager PyTorch: seconds of a gradient and an update; write ``docs/networks-speed.json``.

    python -m tools.torch_speed PYTHON [FILE]

PYTHON is an interpreter that has PyTorch and NumPy; PyTorch is no dependency of the program, so install it into an
environment of its own: ``python -m venv FOLDER && FOLDER/bin/pip install numpy torch``.

The network is that of Wakita et al. 2022, written here once more in PyTorch as one would, without its compiler: what
does not change in a batch is computed once, and what was seen is projected once.  Both get the same windows of the
bundled trials and the same weights, and must find the same loss and norm of the gradient.  They are timed in turn, as
processes of their own, with the threads that each takes by itself.  Nothing else should run meanwhile.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

WIDTH, HORIZON, BATCHES, TYPES = 200, 60, (256, 512), ("1", "2")
ROUNDS, UPDATES = 4, 5
RATE, CLIP = 1e-4, 1.0


def measure_own(folder: Path) -> list[dict[str, Any]]:
    """This program's training; writes the windows and weights of each case, and what it finds of them."""
    from mmgtune.backends.twins import jax_module
    from mmgtune.learning.aims import RecurrentAim, from_origin
    from mmgtune.learning.starting import first_weights, scales_of
    from mmgtune.learning.task import make_task
    from mmgtune.learning.training import Plan, Trainer, batch
    from mmgtune.options import LearnOptions
    from mmgtune.profile import load_profile
    from mmgtune.trial import load_trials

    jax, rows = jax_module(), []
    for type in TYPES:
        options = LearnOptions(type=type, width=WIDTH, horizon=HORIZON)
        task = make_task(load_profile("suzaku"), load_trials("suzaku"), options)
        scales = scales_of(task.samples)
        aim = RecurrentAim(task, scales)
        weights = in_single(first_weights(len(task.inputs), WIDTH, 1))
        for n in BATCHES:
            starts = batch(aim.starts, n, 1, 0)
            loss, gradient = jax.jit(jax.value_and_grad(aim.loss))(weights, starts)
            span = starts[None, :] + np.arange(HORIZON + 1)[:, None]
            np.savez(
                folder / f"{type}-{n}.npz",
                **weights._asdict(),
                features=scales.features,
                accelerations=scales.accelerations,
                states=np.asarray(from_origin(jax.numpy.asarray(task.samples.states[span]))),
                controls=task.samples.controls[span[:-1]],
                wind=task.samples.wind[span[:-1]],
                sigma=list(task.sigma.values()),
                h=task.samples.step,
                memory=task.memory or 0,
                loss=loss,
                norm=np.sqrt(sum(float((one**2).sum()) for one in gradient)),
            )
            trainer = Trainer(aim, Plan(1000, n, RATE, 1000))
            now = trainer.begin(weights)
            held = [now.parameters, now.state, now.mean]

            def update(held: list[Any] = held, trainer: Any = trainer, starts: Any = starts) -> None:
                found = trainer.update(*held, starts, np.float32(1.0), np.float32(0.9), trainer.aim.data)
                held[:] = found[:3]
                jax.block_until_ready(found)

            rows.append({"type": type, "batch": n, "seconds": timed(update)})
    return rows


def in_single(weights: Any) -> Any:
    """The same weights in single precision."""
    return weights._make(np.float32(one) for one in weights)


def measure_torch(folder: Path) -> list[dict[str, Any]]:
    """The same in eager PyTorch."""
    import torch

    names = ("W_x", "W_r", "b_0", "W_1", "b_1", "W_2", "b_2", "W_3")
    rows = []
    for type in TYPES:
        for n in BATCHES:
            with np.load(folder / f"{type}-{n}.npz") as file:
                given = {name: torch.tensor(np.float32(file[name])) for name in file.files}
                memory, h, known = int(file["memory"]), float(file["h"]), (float(file["loss"]), float(file["norm"]))
            w = {name: torch.nn.Parameter(given[name]) for name in names}

            def loss_of(g: dict[str, Any] = given, w: dict[str, Any] = w, m: int = memory, h: float = h) -> Any:
                return torch_loss(torch, w, g, m, h)

            loss = loss_of()
            loss.backward()
            norm = float(torch.sqrt(sum((one.grad**2).sum() for one in w.values())))
            if not np.allclose((float(loss.detach()), norm), known, rtol=1e-3):
                raise SystemExit(f"type {type}: loss and norm {float(loss)}, {norm}, not {known}")
            optimiser = torch.optim.AdamW(w.values(), lr=RATE, weight_decay=0.0)

            def update(optimiser: Any = optimiser, w: dict[str, Any] = w, loss_of: Any = loss_of) -> None:
                optimiser.zero_grad()
                loss_of().backward()
                torch.nn.utils.clip_grad_norm_(w.values(), CLIP)
                optimiser.step()

            rows.append({"type": type, "batch": n, "seconds": timed(update)})
    return rows


def torch_loss(torch: Any, w: Any, given: Any, memory: int, h: float) -> Any:
    """Mean square of roll-outs less what was measured, over sigma."""
    states, measured = given["states"][0], given["states"][1:]
    zero_0, zero_1, zero_2 = (torch.tanh(w[name]) for name in ("b_0", "b_1", "b_2"))
    held = torch.zeros(states.shape[0], w["W_r"].shape[0])
    parts: list[Any] = []
    off = []
    for k in range(len(measured)):
        psi, u, v, r = states[:, 2], states[:, 3], states[:, 4], states[:, 5]
        cos, sin = torch.cos(psi), torch.sin(psi)
        north, east = given["wind"][k].unbind(-1)
        blows = torch.stack([u - (north * cos + east * sin), v - (east * cos - north * sin)], -1)
        seen = torch.cat([states[:, 3:], given["controls"][k], blows], -1) / given["features"]
        part = torch.addmm(w["b_0"], seen, w["W_x"])
        if memory:
            parts = [*parts[-memory + 1 :], part] if memory > 1 else [part]
            held = torch.tanh(parts[0]) - zero_0
            for one in parts[1:]:
                held = torch.tanh(torch.addmm(one, held, w["W_r"])) - zero_0
        else:
            held = torch.tanh(torch.addmm(part, held, w["W_r"])) - zero_0
        z = torch.tanh(torch.addmm(w["b_1"], held, w["W_1"])) - zero_1
        z = torch.tanh(torch.addmm(w["b_2"], z, w["W_2"])) - zero_2
        rates = (z @ w["W_3"]) * given["accelerations"]
        pose = torch.stack([u * cos - v * sin, u * sin + v * cos, r], -1)
        states = states + h * torch.cat([pose, rates], -1)
        off.append((states - measured[k]) / given["sigma"])
    return torch.mean(torch.stack(off) ** 2)


def timed(update: Any) -> list[float]:
    """Seconds of an update, several times, after one that does not count."""
    update()
    found = []
    for _ in range(UPDATES):
        began = time.perf_counter()
        update()
        found.append(time.perf_counter() - began)
    return found


def main(python: str, target: Path) -> None:
    """Time both in turn, and write what was found."""
    from mmgtune.files import write_text
    from tools.bench import machine

    times: dict[tuple[str, str, int], list[float]] = {}
    versions: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(ROUNDS):
            for side, interpreter in (("jax", sys.executable), ("torch", python)):
                line = [interpreter, str(Path(__file__)), f"--{side}", folder]
                done = subprocess.run(line, check=True, stdout=subprocess.PIPE)
                found = json.loads(done.stdout.splitlines()[-1])
                versions[side] = {"version": found["version"], "threads": found["threads"]}
                for row in found["rows"]:
                    times.setdefault((side, row["type"], row["batch"]), []).extend(row["seconds"])
    rows = []
    for type in TYPES:
        for n in BATCHES:
            own, other = (times[side, type, n] for side in ("jax", "torch"))
            row = {"type": type, "batch": n, "updates_timed": len(own)}
            for name, value in (("jax", own), ("torch", other)):
                row |= {f"{name}_s": round(float(np.median(value)), 4), f"{name}_least_s": round(min(value), 4)}
            row["ratio"] = round(row["torch_s"] / row["jax_s"], 2)
            row["ratio_of_least"] = round(row["torch_least_s"] / row["jax_least_s"], 2)
            rows.append(row)
            print(row)
    about = {**machine(), **versions, "width": WIDTH, "horizon": HORIZON, "rows": rows}
    write_text(target, json.dumps(about, indent=1) + "\n")


if __name__ == "__main__":
    if sys.argv[1] == "--jax":
        import os
        from importlib.metadata import version

        rows = measure_own(Path(sys.argv[2]))
        print(json.dumps({"version": version("jax"), "threads": len(os.sched_getaffinity(0)), "rows": rows}))
    elif sys.argv[1] == "--torch":
        import torch

        rows = measure_torch(Path(sys.argv[2]))
        print(json.dumps({"version": torch.__version__, "threads": torch.get_num_threads(), "rows": rows}))
    else:
        docs = Path(__file__).parent.parent / "docs"
        main(sys.argv[1], Path(sys.argv[2]) if len(sys.argv) > 2 else docs / "networks-speed.json")
