"""The study of hidden effects: every case drawn, sailed, diagnosed from its files alone, and scored.

    python -m tests.hidden.study [--out docs/hidden.jsonl] [--jobs 2] [--only TEXT] [--minutes 200]

One line of JSON per case goes to the file as it is done; a run that was stopped goes on with what is missing.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import multiprocessing
import os
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import replace
from functools import cache
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path
from typing import Any

import mmgtune
from mmgtune.effects import find_effect

from .cases import (
    LADDER,
    RUNS,
    Case,
    gear_of_two_rates,
    null,
    of_one_run,
    of_runs,
    otherwise,
    pair,
    single,
    tide,
    triple,
    unknown,
)
from .plant import AUTOCORRELATED, simulate, write
from .unknown import JUMP, UNKNOWN

SEEDS = 4
NULLS, COLOURED_NULLS, PAIRS, TRIPLES = 80, 20, 48, 20

N_CASES = SEEDS * (6 * len(LADDER) + 2 * len(RUNS) + 4) + NULLS + COLOURED_NULLS + PAIRS + TRIPLES + len(UNKNOWN)

ASIDE = ("checking", "cli", "importing", "report")
"""Parts of the package whose source no diagnosis depends on."""


def cases() -> Iterator[tuple[str, Case]]:
    """Every case with the set it belongs to, those of a seed in an order of chance: a study that was stopped is a fair
    sample of the whole."""
    for seed in range(1, SEEDS + 1):
        yield from sorted(_of_seed(seed), key=lambda one: hashlib.sha256(one[1].name.encode()).digest())


def _of_seed(seed: int) -> Iterator[tuple[str, Case]]:
    for tag in LADDER:
        for level in range(5):
            yield f"{tag}:{level}", single(tag, level, seed)
        yield "otherwise", otherwise(tag, seed)
    for k in range(NULLS // SEEDS):
        yield "null", null(1000 + k * SEEDS + seed)
    for k in range(COLOURED_NULLS // SEEDS):
        case = null(2000 + k * SEEDS + seed, AUTOCORRELATED)
        yield "null-autocorrelated", replace(case, name=f"{case.name}-autocorrelated")
    for k in range(PAIRS // SEEDS):
        yield "pair", pair(3000 + k * SEEDS + seed)
    for k in range(TRIPLES // SEEDS):
        yield "triple", triple(4000 + k * SEEDS + seed)
    for tag in RUNS:
        for level in (2, 3):
            yield "of-runs", of_runs(tag, level, seed)
    for level in (2, 3):
        yield "gear-of-two-rates", gear_of_two_rates(level, seed)
    yield "of-runs", of_one_run(seed)
    yield "of-runs", tide(seed)
    if seed == 1:
        for k in range(len(UNKNOWN)):
            yield "unknown", unknown(k, seed)


def diagnosed(case: Case) -> dict[str, Any]:
    """What the program says of a case, from its files alone."""
    from mmgtune.diagnose import diagnose
    from mmgtune.profile import load_profile
    from mmgtune.trial import load_trials

    with tempfile.TemporaryDirectory() as folder:
        trials = simulate(case.ship, case.effects, case.seed, case.noise, case.of_trial)
        write(case.programme.kept(trials), Path(folder), case.programme.tuning)
        began = time.perf_counter()
        document = diagnose(load_profile("suzaku"), load_trials(folder)).to_dict()
    return {**document, "seconds": time.perf_counter() - began}


@cache
def code() -> str:
    """Fingerprint of the source that a diagnosis depends on: results of different ones are told apart."""
    package = Path(mmgtune.__file__).parent
    files = sorted(file for file in package.rglob("*.py") if file.relative_to(package).parts[0] not in ASIDE)
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:8]


def kept(hidden: dict[str, dict[str, float]], said: dict[str, Any]) -> dict[str, Any]:
    """What of a diagnosis is worth keeping: a line of a kilobyte."""
    return {
        "verdict": said["verdict"],
        "causes": [{key: cause[key] for key in ("effect", "parameters", "p_value")} for cause in said["causes"]],
        "groups": said["groups"],
        "traces": [trace["effect"] for trace in said["traces"]],
        "contributions": [
            (one["effect"], one["share_of_fall"], one["share_held_out"]) for one in said["contributions"]
        ],
        "jumped": bool(said["jumped"]),
        "unclear": said["unexplained"]["unclear"],
        "best": [
            {"effect": row["effect"], "parameters": row["parameters"], "gain": round(row["gain"] or 0.0, 1)}
            for row in said["candidates"][:3]
        ],
        "limits": [row for row in said["detectability"] if row["effect"] in hidden],
        "chi2_per_residual": said["chi2_per_residual"],
        "share_above_noise_removed": said["gain"]["share_above_noise_removed"],
        "seconds": round(said["seconds"], 1),
        "code": code(),
    }


def above_limit(hidden: dict[str, dict[str, float]], said: dict[str, Any]) -> bool | None:
    """Whether everything hidden is larger than the detection limit the program states; None where it states none."""
    found: list[bool] = []
    for tag, truth in hidden.items():
        for row in said["detectability"]:
            limits = {name: limit for name, limit in row["detection_limit"].items() if name in truth}
            if row["effect"] == tag and limits:
                found.append(_is_above(tag, truth, limits))
    return all(found) if found else None


def _is_above(tag: str, truth: dict[str, float], limits: dict[str, float | None]) -> bool:
    effect = find_effect(tag)
    assert effect is not None  # it is in the ladder
    sizes = []
    for name, limit in limits.items():
        parameter = effect.parameters[name]
        if limit is None:
            sizes.append(0.0)
        elif parameter.chart == "reciprocal":
            sizes.append(limit / truth[name])
        else:
            sizes.append(abs(truth[name] - parameter.null) / abs(limit - parameter.null))
    return math.hypot(*sizes) >= 1.0


def outcome(hidden: dict[str, dict[str, float]], said: dict[str, Any]) -> str:
    """right, grouped, partly (one of two), missed, unexplained or wrong; "clear" or "alarm" where nothing is hidden."""
    named = {cause["effect"] for cause in said["causes"]}
    groups = [set(group) for group in said["groups"]]
    if not hidden:
        return "clear" if said["verdict"] == "none" else "alarm"
    if any(tag.startswith("unknown") for tag in hidden):
        since = {UNKNOWN[tag].since for tag in hidden}
        named |= {JUMP} if said["jumped"] else set()
        fine = said["verdict"] == "unexplained" or (named and (named <= {"hull-term"} or named == since))
        return "right" if fine else "missed" if said["verdict"] == "none" else "wrong"
    if said["verdict"] == "unexplained":
        return "unexplained"
    if not named:
        return "missed"
    excused = {tag for group in groups if group & set(hidden) for tag in group}
    if named - set(hidden) - excused:
        return "wrong"
    told = {tag for tag in hidden if tag in named or any(tag in group for group in groups)}
    if told != set(hidden):
        return "partly"
    return "right" if not any(group & set(hidden) for group in groups) else "grouped"


def covered(hidden: dict[str, dict[str, float]], said: dict[str, Any]) -> list[bool]:
    """For each parameter that was hidden and estimated, whether its 95 % interval holds the truth."""
    found = []
    for cause in said["causes"]:
        truth = hidden.get(cause["effect"], {})
        for name, estimate in cause["parameters"].items():
            if name not in truth:
                continue
            low, high = (math.inf if end is None else end for end in estimate["ci95"])
            value = truth[name]
            if name == "direction":
                middle = 0.5 * (low + high)
                value = middle + math.remainder(value - middle, 2.0 * math.pi)
            found.append(low <= value <= high)
    return found


def covered_by_run(case: Case, said: dict[str, Any]) -> list[bool]:
    """The same for what differs between runs, run by run."""
    found = []
    for cause in said["causes"]:
        for row in (cause["by_run"] or {"values": []})["values"]:
            truth = case.of_trial.get(row["group"], {}).get(cause["effect"], {})
            for name, estimate in row["parameters"].items():
                low, high = (math.inf if end is None else end for end in estimate["ci95"])
                value = truth.get(name)
                if value is not None and name != "direction":
                    found.append(low <= value <= high)
    return found


def named_of_runs(case: Case, said: dict[str, Any]) -> bool:
    """Whether what differs between runs is said to."""
    return all(cause["by_run"] for cause in said["causes"] if cause["effect"] not in case.effects)


def work(kind: str, case: Case) -> dict[str, Any]:
    """One case done and scored."""
    said = diagnosed(case)
    of_runs_too = {"of_trial": case.of_trial, "of_runs": named_of_runs(case, said)} if case.of_trial else {}
    return {
        "set": kind,
        "case": case.name,
        "hidden": case.hidden,
        "outcome": outcome(case.hidden, said),
        "covered": covered(case.effects, said) + covered_by_run(case, said),
        "above_limit": above_limit(case.hidden, said),
        **of_runs_too,
        **kept(case.hidden, said),
    }


def on_one_core(count: Synchronized[int]) -> None:
    """Keep a worker on a core of its own: cases side by side are faster than threads within one."""
    if hasattr(os, "sched_getaffinity"):
        cores = sorted(os.sched_getaffinity(0))
        with count.get_lock():
            count.value += 1
            os.sched_setaffinity(0, {cores[count.value % len(cores)]})


def main() -> None:
    """Do what is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("docs/hidden.jsonl"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--only", default="", help="only cases whose name holds this")
    parser.add_argument("--minutes", type=float, default=math.inf, help="begin no case after this long")
    options = parser.parse_args()
    path: Path = options.out
    path.parent.mkdir(parents=True, exist_ok=True)
    done = {json.loads(line)["case"] for line in path.read_text().splitlines()} if path.exists() else set()
    left = [(kind, case) for kind, case in cases() if case.name not in done and options.only in case.name]
    print(f"{len(done)} done, {len(left)} to do", flush=True)
    ends = time.monotonic() + 60.0 * options.minutes
    pool = ProcessPoolExecutor(options.jobs, initializer=on_one_core, initargs=(multiprocessing.Value("i", 0),))
    with pool, path.open("a", encoding="utf-8") as file:
        waiting = iter(left)
        running = {pool.submit(work, *one) for _, one in zip(range(options.jobs), waiting, strict=False)}
        while running:
            finished = next(as_completed(running))
            running.remove(finished)
            row = finished.result()
            file.write(json.dumps(row) + "\n")
            file.flush()
            print(f"{row['case']}: {row['outcome']} ({row['seconds']:.0f} s)", flush=True)
            following = next(waiting, None) if time.monotonic() < ends else None
            if following is not None:
                running.add(pool.submit(work, *following))


if __name__ == "__main__":
    main()
