"""What a prior of sister ships is worth: pooled against single calibration, on trials held out of ships held out.

    python -m tools.fleet_gains FOLDER [--ships 20] [--seed 1] [--out docs/fleet-gains.json]

Sisters are made (``tools.generate_fleet``): their coefficients lie about those that Suyama et al. (2023, Table 7) found
for SUZAKU, 6 % of each apart, and all are calibrated from her pre-determined values.  In five folds, sixteen sisters
with four trials each make the class; each of the others is calibrated to one, two and four of her own trials, alone and
with the class as a prior, and simulated on four further trials of hers.  Trials to tune to have the noise of sensors
and a weak current that nobody measures; held-out ones are without, so that what is counted is the model's error.
Intervals are of the mean over ships, by drawing ships anew.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.files import write_text
from mmgtune.fitting import FitOptions, Information, SisterClass, fit, information_of, pooled
from mmgtune.motions import simulate_trials
from mmgtune.profile import ShipProfile, load_profile, tuned
from mmgtune.trial import Trial, TrialSet
from tools.generate_fleet import sailed, sister
from tools.generate_suzaku_trials import SHIP

TUNE = ("zigzag_p15", "turn_p25", "turn_m15", "zigzag_m20")
"""Trials in the order in which a ship sails them."""

TEST = ("turn_m35", "turn_p10", "zigzag_m10", "zigzag_p25")

COUNTS = (1, 2, 4)
FOLDS = 5
OPTIONS = FitOptions(method="least-squares", a_r=0.8, starts=4, initial="estimated")
DRAWS = 5000


def trials_of(ship: ShipProfile, names: Sequence[str], rng: np.random.Generator, calm: bool) -> dict[str, Trial]:
    """Made trials of a sister, by id."""
    return {one.id: one for one in sailed(ship, names, {}, rng, calm=calm)}


def tuning_set(trials: dict[str, Trial], n: int, ship: str) -> TrialSet:
    """The first trials as a set that tunes."""
    some = {name: trials[name] for name in TUNE[:n]}
    return TrialSet(some, tuple(some), (), ship)


def off_track(ship: ShipProfile, trials: Sequence[Trial]) -> float:
    """Root mean square distance from the measured tracks [m], mean over trials."""
    found = []
    for trial, motion in zip(trials, simulate_trials(ship, list(trials)), strict=True):
        found.append(float(np.sqrt(np.mean(np.sum((motion.states[:, :2] - trial.motion[:, :2]) ** 2, axis=1)))))
    return float(np.mean(found))


def studied(folder: Path, n_ships: int, seed: int) -> list[dict[str, Any]]:
    """A row for each ship: metres off track on her held-out trials, before and by each calibration."""
    given = load_profile("suzaku")
    truth = tuned(given, SHIP, {}, {})
    rng = np.random.default_rng(seed)
    ships = [sister(truth, k, rng) for k in range(n_ships)]
    own = [trials_of(ship, TUNE, np.random.default_rng([seed, k, 0]), False) for k, ship in enumerate(ships)]
    tests = [trials_of(ship, TEST, np.random.default_rng([seed, k, 1]), True) for k, ship in enumerate(ships)]
    held = [list(one.values()) for one in tests]
    profiles = [replace(given, id=ship.id, name=ship.name) for ship in ships]
    told: dict[str, Information] = {}
    rows: list[dict[str, Any]] = []
    for profile, trials, unseen in zip(profiles, own, held, strict=True):
        row: dict[str, Any] = {"ship": profile.id, "before": off_track(profile, unseen), "single": {}, "pooled": {}}
        for n in COUNTS:
            data = tuning_set(trials, n, profile.id)
            result = fit(profile, data, OPTIONS)
            row["single"][n] = off_track(result.tuned_profile(), unseen)
            if n == max(COUNTS):
                found = information_of(result, data)
                assert found is not None  # there are trials
                told[profile.id] = found
        rows.append(row)
    for fold in range(FOLDS):
        out = [profile.id for k, profile in enumerate(profiles) if k % FOLDS == fold]
        members = SisterClass(f"fold-{fold}", {ship: one for ship, one in told.items() if ship not in out})
        path = write_text(folder / f"{members.name}.json", json.dumps(members.to_dict()) + "\n")
        class_mean = pooled(members)
        for row, profile, trials, unseen in zip(rows, profiles, own, held, strict=True):
            if profile.id not in out:
                continue
            mean = dict(zip(class_mean.names, class_mean.mean.tolist(), strict=True))
            row["class mean"] = off_track(tuned(profile, mean, {}, {}), unseen)
            for n in COUNTS:
                result = fit(profile, tuning_set(trials, n, profile.id), replace(OPTIONS, sisters=path))
                row["pooled"][n] = off_track(result.tuned_profile(), unseen)
    return rows


def summary(rows: Sequence[dict[str, Any]], seed: int) -> dict[str, Any]:
    """Means over ships and the share of the error that pooling removes, with 95 % intervals."""
    rng = np.random.default_rng(seed)
    draws = rng.integers(0, len(rows), size=(DRAWS, len(rows)))
    by_count = {}
    for n in COUNTS:
        single, both = (np.array([row[how][n] for row in rows]) for how in ("single", "pooled"))
        drawn = 1.0 - both[draws].sum(axis=1) / single[draws].sum(axis=1)
        by_count[n] = {
            "single": float(single.mean()),
            "pooled": float(both.mean()),
            "removed": float(1.0 - both.sum() / single.sum()),
            "interval": [float(end) for end in np.quantile(drawn, (0.025, 0.975))],
            "better": int(np.sum(both < single)),
        }
    means = {name: float(np.mean([row[name] for row in rows])) for name in ("before", "class mean")}
    return {"ships": len(rows), **means, "trials": by_count}


def table(found: dict[str, Any]) -> str:
    """The result as Markdown."""
    lines = ["| trials of her own | single [m] | pooled [m] | error removed | 95 % interval | better in |"]
    lines += ["|---:|---:|---:|---:|---|---:|", f"| 0 | {found['before']:.2f} | {found['class mean']:.2f} | | | |"]
    for n, row in found["trials"].items():
        low, high = (f"{100.0 * end:.0f}" for end in row["interval"])
        removed = f"{100.0 * row['removed']:.0f} %"
        numbers = f"{row['single']:.2f} | {row['pooled']:.2f} | {removed} | {low} to {high} %"
        lines.append(f"| {n} | {numbers} | {row['better']} of {found['ships']} |")
    return "\n".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="What a prior of sister ships is worth on trials held out.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--ships", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("docs/fleet-gains.json"))
    asked = parser.parse_args()
    made = studied(asked.folder, asked.ships, asked.seed)
    told = summary(made, asked.seed)
    command = f"python -m tools.fleet_gains FOLDER --ships {asked.ships} --seed {asked.seed}"
    write_text(asked.out, json.dumps({"schema": 1, "command": command, **told, "rows": made}, indent=1) + "\n")
    print(table(told))
