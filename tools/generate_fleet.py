"""Make a fleet of sister ships over months: generated, not measured, with what happened to each ship beside it.

    python -m tools.generate_fleet FOLDER [--ships 20] [--months 24] [--seed 1]

Sisters differ from SUZAKU by some percent in every coefficient; the profile of each is her own, as after her delivery.
Every month each sails two short trials, a turn and a timed zigzag, in a weak current that nobody measures, with the
noise of sensors.  Hidden in them: fouling that raises the resistance of every ship, dockings that clean it off, a gyro
compass that was replaced by one set up wrongly, and a rudder bent at its stock.  What was done to whom is written to
truth.json, and a table of jobs that follows the state of each ship to fleet.toml.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.arrays import FloatArray
from mmgtune.backends import Integrator
from mmgtune.files import write_text
from mmgtune.motions import as_trial, simulate_trials
from mmgtune.profile import ShipProfile, load_profile, tuned, with_effects
from mmgtune.trial import Trial, write_trial
from mmgtune.units import DEG

SPREAD = 0.06
"""Standard deviation of each coefficient among sisters, as a share of it."""

FOULING = (0.03, 0.18)
"""Growth of resistance a year, from and to."""

COMPASS = (1.0, 2.5)
RUDDER = (1.0, 2.5)
"""Sizes of the steps of a replaced compass and a bent rudder [deg], from and to."""

CURRENT = 0.03
"""Standard deviation of each component of the current [m/s]."""

NOISE = {"x": 0.4, "y": 0.4, "psi": 0.17 * DEG, "u": 0.02, "v": 0.02, "r": 0.03 * DEG}
"""Of white sensor noise, as in the bundled trials [m, m, rad, m/s, m/s, rad/s]."""

SECONDS = 240.0
RATE = 2.3 * DEG
"""Length of a trial [s], and rate of the steering gear [rad/s]."""

MONTHLY = ("turn_p25", "zigzag_p15")
"""What each ship sails every month."""

TABLE = """# The state of each ship, month by month: what differs from her profile now.
schema = 1

[[jobs]]
name = "state"
command = "fit"
profile = "ships/{ship}.toml"
trials = "logs/{ship}/{date}"

[jobs.options]
method = "least-squares"
objective = "standardised"
channels = ["x", "y", "psi", "u", "v", "r"]
initial = "estimated"
starts = 1
with_effects = ["resistance", "rudder-offset", "heading-bias"]
targets = ["effects.resistance.factor", "effects.rudder-offset.angle", "effects.heading-bias.angle"]
fixed = ["effects.resistance.slope", "effects.heading-bias.alone"]
"""


def sister(base: ShipProfile, k: int, rng: np.random.Generator, spread: float = SPREAD) -> ShipProfile:
    """A ship of the class: the coefficients that are tuned by default, each off by some percent."""
    values = {name: base.value(name) * (1.0 + spread * rng.standard_normal()) for name in base.targets}
    name = f"s{k + 1:02d}"
    ship = replace(tuned(base, values, {}, {}), provenance={})
    return replace(ship, id=name, name=f"Sister {k + 1}", template="")


def orders(name: str, t: FloatArray) -> FloatArray:
    """Rudder angles (n,) [rad] at times (n,) of a trial by name: turn_p25 goes over to 25 deg to starboard and stays,
    zigzag_m15 begins to port and goes over to the other side every 40 s."""
    kind, _, angle = name.partition("_")
    size = (1.0 if angle[0] == "p" else -1.0) * float(angle[1:]) * DEG
    side = 1.0 if kind == "turn" else np.where(((t - 10.0) // 40.0) % 2 == 0, 1.0, -1.0)
    wanted = np.where(t >= 10.0, size * side, 0.0)
    angle_now, moved = 0.0, np.zeros(len(t))
    for i in range(1, len(t)):
        step = RATE * (t[i] - t[i - 1])
        angle_now += float(np.clip(wanted[i] - angle_now, -step, step))
        moved[i] = angle_now
    return moved


def sailed(
    ship: ShipProfile,
    names: Sequence[str],
    state: dict[str, dict[str, float]],
    rng: np.random.Generator,
    *,
    calm: bool = False,
) -> list[Trial]:
    """Trials by name, see ``orders``, of a ship with effects {tag: {parameter: value}}, as her sensors show them.

    calm  without current and noise: what is true
    """
    t = np.arange(0.0, SECONDS + 0.5, 1.0)
    quiet = 0.0 if calm else 1.0
    trials = []
    for name in names:
        current = {way: quiet * CURRENT * rng.standard_normal() for way in ("north", "east")}
        real = with_effects(ship, {**state, "current": current}, "hidden")
        heading, n = rng.uniform(-np.pi, np.pi), rng.uniform(100.0, 106.0) / 60.0
        zero = np.zeros_like(t)
        known = {"psi": zero + heading, "u": zero + 3.0, "n": zero + n, "delta": orders(name, t)}
        manoeuvre = "turning" if name.startswith("turn") else "zigzag"
        still = {"x": zero, "y": zero, "v_m": zero, "r": zero}
        asked = Trial(id=name, ship=ship.id, manoeuvre=manoeuvre, source="generated", t=t, **still, **known)
        (motion,) = simulate_trials(real, [asked], integrator=Integrator("rk4"))
        noise = quiet * np.array(list(NOISE.values())) * rng.standard_normal(motion.states.shape)
        shown = as_trial(ship, replace(motion, states=motion.states + noise))
        note = "Generated, not measured: a made-up sister of SUZAKU" + ("." if calm else ", with sensor noise.")
        trials.append(replace(shown, manoeuvre=manoeuvre, noise={} if calm else dict(NOISE), note=note))
    return trials


def lots(n_ships: int, n_months: int, rng: np.random.Generator) -> list[dict[str, Any]]:
    """What happens to each ship: fouling of all, dockings of most, a compass and a bent rudder of some."""
    ships: list[dict[str, Any]] = [
        {
            "fouling": rng.uniform(*FOULING),
            "fouled": rng.uniform(0.0, 1.0),
            "docked": [],
            "compass": None,
            "rudder": None,
        }
        for _ in range(n_ships)
    ]
    drawn = rng.permutation(n_ships)
    for k in drawn[: round(0.6 * n_ships)]:
        ships[k]["docked"] = [int(rng.integers(3, n_months - 3))]
    for key, first, sizes in (("compass", 0.45, COMPASS), ("rudder", 0.7, RUDDER)):
        for k in drawn[round(first * n_ships) : round(first * n_ships) + max(1, round(0.15 * n_ships))]:
            size = rng.uniform(*sizes) * rng.choice([-1.0, 1.0])
            ships[k][key] = {"month": int(rng.integers(3, n_months - 3)), "deg": float(size)}
    return ships


def state_of(lot: dict[str, Any], month: int) -> dict[str, dict[str, float]]:
    """The effects on a ship in a month, from 0."""
    cleaned = [at for at in lot["docked"] if at <= month]
    years = (month - cleaned[-1]) / 12.0 if cleaned else lot["fouled"] + month / 12.0
    state = {"resistance": {"factor": 1.0 + lot["fouling"] * years}}
    for key, tag in (("compass", "heading-bias"), ("rudder", "rudder-offset")):
        if lot[key] and lot[key]["month"] <= month:
            state[tag] = {"angle": lot[key]["deg"] * DEG}
    return state


def date_of(month: int) -> str:
    """Months from January 2024 on."""
    return f"{2024 + month // 12}-{month % 12 + 1:02d}"


def make(folder: Path, n_ships: int = 20, n_months: int = 24, seed: int = 1) -> dict[str, Any]:
    """Write profiles, trials, table and truth to a folder; returns the truth."""
    rng = np.random.default_rng(seed)
    base = load_profile("suzaku")
    told = {}
    for k, lot in enumerate(lots(n_ships, n_months, rng)):
        ship = sister(base, k, rng)
        write_text(folder / "ships" / f"{ship.id}.toml", ship.text)
        own = np.random.default_rng([seed, k])
        for month in range(n_months):
            place = folder / "logs" / ship.id / date_of(month)
            for trial in sailed(ship, MONTHLY, state_of(lot, month), own):
                write_trial(trial, place / f"{trial.id}.parquet", overwrite=True)
        told[ship.id] = {
            "fouling_a_year": lot["fouling"],
            "docked": [date_of(month) for month in lot["docked"]],
            **{
                key: lot[key] and {"month": date_of(lot[key]["month"]), "deg": lot[key]["deg"]}
                for key in ("compass", "rudder")
            },
        }
    truth = {"schema": 1, "kind": "fleet-truth", "seed": seed, "months": n_months, "ships": told}
    write_text(folder / "truth.json", json.dumps(truth, indent=1) + "\n")
    write_text(folder / "fleet.toml", TABLE)
    return truth


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Make a fleet of sister ships: generated, not measured.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--ships", type=int, default=20)
    parser.add_argument("--months", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    make(asked.folder, asked.ships, asked.months, asked.seed)
