"""Measure the speed of the simulators and of whole commands; write ``docs/benchmarks.json`` and ``docs/benchmarks.md``.

    python -m tools.bench [FOLDER]

Figures of one run belong together: compare their ratios, not their seconds, with another machine's.  Simulator times
are the least of several repeats; commands run as processes of their own, cold with an empty cache of compiled kernels
and warm with a filled one.  Nothing else should run meanwhile.
"""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
import tempfile
import time
import tracemalloc
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.backends import Integrator, get_backend, pad
from mmgtune.backends.twins import jax_module
from mmgtune.files import write_text
from mmgtune.fitting.cmaes import _strategy
from mmgtune.learning.aims import RecurrentAim
from mmgtune.learning.hybrid import HybridAim, ResidualLoss, first_residual, ranges_of
from mmgtune.learning.hybrid_run import times_of
from mmgtune.learning.samples import samples_of
from mmgtune.learning.starting import first_weights, scales_of
from mmgtune.learning.task import make_task
from mmgtune.learning.training import Plan, Trainer, batch
from mmgtune.model import Model
from mmgtune.motions import as_trial
from mmgtune.objective import spread
from mmgtune.options import HybridOptions, LearnOptions
from mmgtune.orders import TurningOrder, run_manoeuvre
from mmgtune.profile import load_profile
from mmgtune.scores import score
from mmgtune.threads import cores
from mmgtune.trial import load_trials, write_trial
from tools.generate_voyage import make_voyage

STEPS = 600
LANES = (1, 48, 512, 4096)
EULER, RK4 = Integrator("euler"), Integrator("rk4")
COMMANDS = {
    "fit --ar 0.5": ["fit", "--ar", "0.5", "--no-report"],
    "fit --ar 0.5, with report": ["fit", "--ar", "0.5"],
    "fit --ar 0.5 --method least-squares": ["fit", "--ar", "0.5", "--method", "least-squares", "--no-report"],
    "sweep, five values, --method least-squares": ["sweep", "--method", "least-squares", "--no-report"],
    "diagnose": ["diagnose", "--no-report"],
}


def lane_steps() -> list[dict[str, Any]]:
    """Nanoseconds per lane and step of SUZAKU in a 35 deg turn, costs only."""
    model = Model(load_profile("suzaku"))
    t = np.arange(STEPS + 1.0)
    controls = np.column_stack([np.full(len(t), 106.0 / 60.0), np.full(len(t), np.radians(35.0))])
    cases = pad([t], [controls], [np.array([0.0, 0.0, 0.0, 3.086, 0.0, 0.0])])
    cases.weight[:, 1:, :3] = 1.0
    rows = []
    for lanes in LANES:
        theta = model.matrix(["hull.R_0"], np.linspace(0.012, 0.02, lanes)[None])
        row: dict[str, Any] = {"lanes": lanes}
        for name, integrator, repeats in (("numpy", RK4, 1), ("compiled", RK4, 30), ("compiled", EULER, 30)):
            backend = get_backend(name)

            def run(b: Any = backend, c: Any = theta, i: Integrator = integrator) -> None:
                b.run(model, c, cases, integrator=i)

            run()
            best = min(timed(run) for _ in range(repeats))
            row[f"{name}_{integrator.name}_ns"] = round(best / (lanes * STEPS) * 1e9, 1)
        row["ratio"] = round(row["numpy_rk4_ns"] / row["compiled_rk4_ns"], 1)
        rows.append(row)
    return rows


JAX_LANES, JAX_STEPS = 48, 900
"""Of the roll-outs that are differentiated."""


def derivatives() -> list[dict[str, Any]]:
    """Nanoseconds per lane and step of SUZAKU in a 35 deg turn on JAX, states kept: the run, and its gradient.

    The gradient is that of the sum of all squared positions by every coefficient of every lane; its seconds of
    compilation are those of a first call.
    """
    from mmgtune.backends.differentiable import log_of_cases, rollout
    from mmgtune.backends.twins import jax_module

    jax = jax_module()
    model = Model(load_profile("suzaku"))
    t = np.arange(JAX_STEPS + 1.0)
    controls = np.column_stack([np.full(len(t), 106.0 / 60.0), np.full(len(t), np.radians(35.0))])
    cases = pad([t], [controls], [np.array([0.0, 0.0, 0.0, 3.086, 0.0, 0.0])])
    theta = model.matrix(["hull.R_0"], np.linspace(0.012, 0.02, JAX_LANES)[None])
    log = log_of_cases(cases, np.zeros(JAX_LANES, dtype=int))
    start = np.repeat(cases.initial, JAX_LANES, axis=0)
    rows = []
    for integrator in (EULER, RK4):

        def squared(c: Any, i: Integrator = integrator) -> Any:
            return jax.numpy.sum(rollout(model, c, start, log, integrator=i)[..., :2] ** 2)

        def run(name: str, i: Integrator = integrator) -> None:
            get_backend(name).run(model, theta, cases, integrator=i, keep_states=True)

        with jax.enable_x64(True):
            gradient = jax.jit(jax.grad(squared))
            kinds = {
                "compiled": lambda r=run: r("compiled"),
                "jax": lambda r=run: r("jax"),
                "gradient": lambda g=gradient: jax.block_until_ready(g(theta)),
            }
            row: dict[str, Any] = {"integrator": integrator.name}
            for kind, work in kinds.items():
                row[f"{kind}_first_s"] = round(timed(work), 1)
                row[f"{kind}_ns"] = round(min(timed(work) for _ in range(20)) / (JAX_LANES * JAX_STEPS) * 1e9)
        row["ratio"] = round(row["jax_ns"] / row["compiled_ns"], 1)
        rows.append(row)
    return rows


def windows() -> dict[str, Any]:
    """Scores of one model on a thousand windows of 120 s at 10 Hz: seconds, and memory besides the windows [MB]."""
    model = Model(load_profile("suzaku"))
    trial = as_trial(model.profile, run_manoeuvre(model, TurningOrder(0.3), longest=120.0, sample=0.1))
    many = [replace(trial, id=str(k)) for k in range(1000)]
    sigma = spread([trial])
    seconds = min(timed(lambda: score(model, many, sigma)) for _ in range(3))
    tracemalloc.start()
    score(model, many, sigma)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return {"windows": len(many), "samples": trial.n_samples, "seconds": round(seconds, 3), "mb": round(peak / 1e6)}


def search_overhead() -> list[dict[str, Any]]:
    """Microseconds per candidate that CMA-ES itself takes, 12 targets."""
    rows = []
    for population in (12, 48, 128):
        strategy = _strategy(np.full(12, 0.5), population, np.random.RandomState(1), 1.0)
        generations = 60

        def loop(s: Any = strategy, n: int = generations) -> None:
            for _ in range(n):
                asked = s.ask()
                s.tell(asked, [float(np.sum((x - 0.3) ** 2)) for x in asked])

        rows.append({"lambda": population, "us_per_candidate": round(timed(loop) / generations / population * 1e6, 1)})
    return rows


def commands() -> list[dict[str, Any]]:
    """Whole processes: seconds cold and warm, and peak memory."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for title, arguments in COMMANDS.items():
            cache = Path(folder) / title.replace(" ", "_").replace(",", "")
            environment = {**os.environ, "MMGTUNE_CACHE": str(cache)}
            line = [sys.executable, "-m", "mmgtune", *arguments, "--quiet", "--force", "--out", str(cache / "run")]
            row: dict[str, Any] = {"command": f"mmgtune {' '.join(arguments)}", "title": title}
            for kind in ("cold", "warm"):
                row[f"{kind}_s"], row["peak_memory_mb"] = run(line, environment)
            rows.append(row)
        rows.append(a_check(Path(folder)))
    return rows


def a_check(folder: Path) -> dict[str, Any]:
    """A check of a hundred trials, the bundled ones ten times over."""
    copies = folder / "hundred"
    for trial in load_trials("suzaku").trials.values():
        for k in range(10):
            write_trial(replace(trial, id=f"{trial.id}_{k}"), copies / f"{trial.id}_{k}.parquet")
    arguments = ["check", "suzaku", str(copies), "--baseline", str(folder / "check.json")]
    environment = {**os.environ, "MMGTUNE_CACHE": str(folder / "cache")}
    line = [sys.executable, "-m", "mmgtune", *arguments]
    row: dict[str, Any] = {"command": "mmgtune check suzaku TRIALS --baseline FILE", "title": "check, 100 trials"}
    row["cold_s"], _ = run([*line, "--update-baseline"], environment)
    row["warm_s"], row["peak_memory_mb"] = run(line, environment)
    return row


def training() -> list[dict[str, Any]]:
    """Seconds of a gradient and an update of networks on SUZAKU's trials, and updates a second."""
    jax, rows = jax_module(), []
    for title, trainer, begin in (recurrent_training(), hybrid_training()):
        now = trainer.begin(begin)
        held = [now.parameters, now.state, now.mean]
        starts = batch(trainer.aim.starts, trainer.plan.batch, 1, 0)

        def update(held: list[Any] = held, trainer: Trainer = trainer, starts: Any = starts) -> None:
            found = trainer.update(*held, starts, np.float32(1.0), np.float32(0.9), trainer.aim.data)
            held[:] = found[:3]
            jax.block_until_ready(found)

        update()
        seconds = min(timed(update) for _ in range(10))
        rows.append(
            {
                "training": title,
                "batch": trainer.plan.batch,
                "seconds": round(seconds, 4),
                "updates_per_s": round(1.0 / seconds, 2),
            }
        )
    return rows


def recurrent_training() -> tuple[str, Trainer, Any]:
    """Networks of type 1 as ``learn rnn`` trains them."""
    options = LearnOptions()
    task = make_task(load_profile("suzaku"), load_trials("suzaku"), options)
    aim = RecurrentAim(task, scales_of(task.samples))
    begin = first_weights(len(task.inputs), options.width, 1)
    title = f"type 1, {options.horizon} samples, width {options.width}"
    single = begin._make(np.float32(one) for one in begin)
    return title, Trainer(aim, Plan(options.steps, options.batch, options.rate, options.validate_every)), single


def hybrid_training() -> tuple[str, Trainer, Any]:
    """A hybrid as ``learn hybrid`` trains it, with validation on what it learns from."""
    options, model, data = HybridOptions(), Model(load_profile("suzaku")), load_trials("suzaku")
    trials = [data.trials[id] for id in data.tune]
    step, lag = times_of(model.profile, trials, options)
    samples = samples_of(trials, model.inputs, step, model.draught)
    ranges = ranges_of(samples, lag, [one.role for one in model.arrangement.inputs])
    horizon = round((options.restart or 100.0) / step)
    loss = ResidualLoss(model, memory=lag, step=step, horizon=horizon)
    sigma = np.array(list(spread(trials).values()))
    aim = HybridAim(
        loss, model, samples, trials, ranges, sigma=sigma, penalty=options.penalty[0], restart=options.restart
    )
    begin = first_residual(len(ranges.deviation), options.width, 1)
    plan = Plan(options.steps, options.batch, options.rate, options.validate_every)
    return f"hybrid, {horizon} samples, width {options.width}", Trainer(aim, plan), begin


WATCH = """
import json, os, subprocess, sys, time
began = time.perf_counter()
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
print(json.dumps([status, round(time.perf_counter() - began, 2), usage.ru_maxrss // 1024]))
"""
"""A small process that starts and watches another: a child counts the memory of who forked it as its own."""


def run(line: list[str], environment: dict[str, str]) -> tuple[float, int]:
    """Seconds and peak memory [MB] of a process, which must succeed."""
    compiled = {name: value for name, value in environment.items() if name != "PYTHONDONTWRITEBYTECODE"}
    watched = subprocess.run([sys.executable, "-S", "-c", WATCH, *line], env=compiled, stdout=subprocess.PIPE)
    status, seconds, memory = json.loads(watched.stdout)
    if status:
        raise SystemExit(f"failed: {' '.join(line)}")
    return seconds, memory


def voyages() -> list[dict[str, Any]]:
    """Two models on voyages: 1,000 windows of 120 s, and thirty days at 1 Hz; seconds warm, and memory."""
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        environment = {**os.environ, "MMGTUNE_CACHE": str(folder / "cache")}
        model = Model(load_profile("suzaku"))
        for title, hours in (("1,000 windows", 1000.0 / 30.0), ("30 days", 720.0)):
            trial = make_voyage(model, hours)
            path = write_trial(trial, folder / f"{hours:.0f}.parquet")
            line = [sys.executable, "-m", "mmgtune", "validate", "suzaku", "kvlcc2", str(path), "--no-report"]
            line += ["--quiet", "--force", "--out", str(folder / "run")]
            if not rows:
                run(line, environment)  # compiles
            seconds, memory = run(line, environment)
            rows.append({"log": title, "rows": trial.n_samples, "warm_s": seconds, "peak_memory_mb": memory})
    return rows


def timed(work: Any) -> float:
    """Seconds that a call takes."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def machine() -> dict[str, Any]:
    """What the figures were measured on."""
    cpu = platform.processor()
    if Path("/proc/cpuinfo").exists():
        names = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
        cpu = names[0].partition(":")[2].strip() if names else cpu
    import numba

    return {
        "cpu": cpu,
        "cores": cores(),
        "system": platform.system(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": numba.__version__,
        "date": f"{datetime.now(UTC):%Y-%m-%d}",
    }


def as_markdown(found: dict[str, Any]) -> str:
    """The page for people."""
    m, w = found["machine"], found["windows"]
    lines = [
        "# Benchmarks",
        "",
        "Measured by `make bench`, which writes this page and `benchmarks.json`. Ratios carry over between machines,",
        f"seconds do not. This run: {m['cpu']}, {m['cores']} cores, Python {m['python']},",
        f"NumPy {m['numpy']}, numba {m['numba']}, {m['date']}.",
        "",
        "## One step of one lane",
        "",
        f"SUZAKU, {STEPS} steps of a 35 deg turn, cost only; ns per lane and step, call overhead included.",
        "",
        "| lanes | NumPy, rk4 | compiled, rk4 | ratio | compiled, euler |",
        "|---:|---:|---:|---:|---:|",
        *(
            f"| {r['lanes']} | {r['numpy_rk4_ns']:,} | {r['compiled_rk4_ns']:,} | {r['ratio']} "
            f"| {r['compiled_euler_ns']:,} |"
            for r in found["lane_steps"]
        ),
        "",
        "## Derivatives",
        "",
        f"SUZAKU, {JAX_LANES} lanes of {JAX_STEPS} steps of a 35 deg turn, states kept; ns per lane and step.",
        "The gradient is that of one number by all coefficients of all lanes.",
        "",
        "| integrator | compiled | JAX | ratio | gradient | first gradient [s] |",
        "|---|---:|---:|---:|---:|---:|",
        *(
            f"| {r['integrator']} | {r['compiled_ns']:,} | {r['jax_ns']:,} | {r['ratio']} | {r['gradient_ns']:,} "
            f"| {r['gradient_first_s']} |"
            for r in found["derivatives"]
        ),
        "",
        "## Many windows",
        "",
        f"Scores of one model on {w['windows']} windows of {w['samples']} samples, rk4: {w['seconds']} s, {w['mb']} MB",
        "besides the windows themselves.",
        "",
        "## Voyages",
        "",
        "`mmgtune validate suzaku kvlcc2 LOG --no-report` on generated logs at 1 Hz, windows of 120 s; warm.",
        "",
        "| log | rows | warm [s] | peak memory [MB] |",
        "|---|---:|---:|---:|",
        *(f"| {r['log']} | {r['rows']:,} | {r['warm_s']} | {r['peak_memory_mb']} |" for r in found["voyages"]),
        "",
        "## Training",
        "",
        "A gradient and an update of networks on the bundled trials of SUZAKU, compiled; needs `mmgtune[learn]`.",
        "",
        "| network | windows in a batch | seconds | updates a second |",
        "|---|---:|---:|---:|",
        *(f"| {r['training']} | {r['batch']} | {r['seconds']} | {r['updates_per_s']} |" for r in found["training"]),
        "",
        "## CMA-ES itself",
        "",
        "Asking and telling, without any simulation, 12 targets.",
        "",
        "| lambda | microseconds per candidate |",
        "|---:|---:|",
        *(f"| {r['lambda']} | {r['us_per_candidate']} |" for r in found["search_overhead"]),
        "",
        "## Whole commands",
        "",
        "On the bundled, generated trials of SUZAKU, as processes; cold compiles the kernel first.",
        "",
        "| command | cold [s] | warm [s] | peak memory [MB] |",
        "|---|---:|---:|---:|",
        *(f"| `{r['command']}` | {r['cold_s']} | {r['warm_s']} | {r['peak_memory_mb']} |" for r in found["commands"]),
        "",
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent / "docs"
    results = {
        "machine": machine(),
        "lane_steps": lane_steps(),
        "derivatives": derivatives(),
        "windows": windows(),
        "voyages": voyages(),
        "training": training(),
        "search_overhead": search_overhead(),
        "commands": commands(),
    }
    write_text(target / "benchmarks.json", json.dumps(results, indent=1) + "\n")
    write_text(target / "benchmarks.md", as_markdown(results))
    print(as_markdown(results))
