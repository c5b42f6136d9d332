"""What a network beside a model of forces finds: ships with a known piece of physics that the model lacks.

Each plant is a ship of the program with one more piece, sailed through turns, zigzags and random orders and measured as
noisy sensors would; the model of forces is tuned to the runs without the piece, a network is trained on what is left,
and runs that neither has seen are scored.  What the network says is then read (``mmgtune.learning.reading``).

    python tools/network_plants.py OUT.json [PLANT ...] [--keep FOLDER] [--read FOLDER]
"""

from __future__ import annotations

import argparse
import json
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.arrays import FloatArray
from mmgtune.backends import Integrator, pad
from mmgtune.files import write_text
from mmgtune.fitting import FitOptions, fit
from mmgtune.learning.choosing import pieces_of
from mmgtune.learning.hybrid_run import LearnedHybrid, learn_hybrid
from mmgtune.learning.reading import read_network
from mmgtune.learning.run import Hooks
from mmgtune.model import Model
from mmgtune.networks import Hybrid, HybridPredictor, load_network, save_network
from mmgtune.options.learning import HybridOptions
from mmgtune.orders import TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.predictor import as_predictor
from mmgtune.profile import ShipProfile, load_profile, tuned, with_effects
from mmgtune.scores import L_MSE, score
from mmgtune.trial import Trial, TrialSet

SOURCE = "plant of a study"

TABLE_7 = {
    "hull.R_0": 0.0207,
    "propeller.t_P": 0.0400,
    "wake.w_P0": 0.6330,
    "wake.C_w": -3.0,
    "rudder.t_R": -0.0290,
    "rudder.a_H": 0.2370,
    "rudder.x_H_": -0.9075,
    "rudder.eps": 1.1872,
    "rudder.kappa": 0.4014,
    "rudder.l_R_": -1.3320,
    "rudder.gamma_Rp": 0.3655,
    "rudder.gamma_Rn": 0.2580,
}
"""SUZAKU as found by Suyama et al. 2023, Table 7, row a_r = 0.5."""

ESSO_TARGETS = (
    "hull.X_0F",
    "hull.Y_v",
    "hull.Y_r",
    "hull.N_v",
    "hull.N_r",
    "wake.w_P0",
    "propeller.t_P",
    "rudder.t_R",
    "rudder.a_H",
    "rudder.x_H_",
    "rudder.l_R_",
    "rudder.gamma_Rp",
    "rudder.gamma_Rn",
)


@dataclass(frozen=True)
class Fleet:
    """How the runs of a ship are made.

    noise    standard deviations of the sensors: m, m, rad, m/s, m/s, rad/s
    scale    time [s] that lengths of runs are counted in: that of a ship length at the approach speed
    astern   lowest revolutions of random orders, as a share of those of the approach
    window   [s] of the windows that are trained on and scored
    """

    noise: tuple[float, ...]
    scale: float
    astern: float
    window: float


SUZAKU = Fleet((0.4, 0.4, math.radians(0.17), 0.02, 0.02, math.radians(0.03)), 27.0, 0.5, 100.0)
ESSO = Fleet((0.02, 0.02, math.radians(0.15), 0.005, 0.005, math.radians(0.05)), 7.5, -1.0, 60.0)


@dataclass(frozen=True)
class Plant:
    """A ship with a piece that the model given lacks.

    piece   in words
    ship    the ship that sails
    model   the profile before it is tuned, without the piece
    named   beginnings of names of terms that name the piece
    note    what is to be known of its result
    """

    piece: str
    fleet: Fleet
    ship: ShipProfile
    model: ShipProfile
    targets: tuple[str, ...]
    named: tuple[str, ...]
    note: str = ""


def _suzaku(piece: str, effects: dict[str, dict[str, float]], named: tuple[str, ...], note: str = "") -> Plant:
    before = load_profile("suzaku")
    ship = with_effects(tuned(before, TABLE_7, {}, {}), effects, SOURCE)
    return Plant(piece, SUZAKU, ship, before, tuple(TABLE_7), named, note)


def _esso(piece: str, lacks: dict[str, float], named: tuple[str, ...], note: str = "") -> Plant:
    whole = load_profile("esso_osaka_3m")
    sections = dict(whole.sections)
    for name, value in lacks.items():
        kind, symbol = name.split(".")
        of = sections[kind]
        one = replace(of.coefficients[symbol], value=value)
        sections[kind] = replace(of, coefficients={**of.coefficients, symbol: one})
    return Plant(piece, ESSO, whole, replace(whole, sections=sections), ESSO_TARGETS, named, note)


WEAK = (
    "The tuned model's error is 18 % above noise.  A network gains less than 2 % on the runs kept back, whatever the "
    "penalty (3 and 15 tried), and is not kept."
)

PLANTS: dict[str, Callable[[], Plant]] = {
    "hull term N_r|r|": lambda: _suzaku(
        "hull term N_r|r| of -0.02", {"hull-term": {"N_rabsr": -0.02}}, ("hull-term.N_rabsr",)
    ),
    "drag of sideways flow Y_v|v|": lambda: _suzaku(
        "hull term Y_v|v| of -0.8", {"hull-term": {"Y_vabsv": -0.8}}, ("hull-term.Y_vabsv",)
    ),
    "memory of the flow": lambda: _suzaku(
        "hull forces that follow the motion in 8 s", {"memory": {"time_constant": 8.0}}, ("memory.",)
    ),
    "rudder stall": lambda: _suzaku(
        "rudder that stalls at 14 deg", {"rudder-stall": {"angle": math.radians(14.0)}}, ("rudder-stall.",)
    ),
    "rudder stall, hardly above noise": lambda: _suzaku(
        "rudder that stalls at 22 deg", {"rudder-stall": {"angle": math.radians(22.0)}}, ("rudder-stall.",), WEAK
    ),
    "propeller astern": lambda: _esso(
        "side force and yaw moment of the propeller turning astern",
        {f"propeller.{letter}_{k}": 0.0 for letter in "AB" for k in range(1, 6)},
        tuple(f"propeller.{letter}_{k}" for letter in "AB" for k in range(1, 6)),
        "The network is as strong to port as to starboard: it cannot add this force, which pushes to one side, and "
        "makes up for it by what follows from it.",
    ),
    "cross flow of a unified hull": lambda: _esso(
        "cross-flow drag of the hull, C_D of 0.97",
        {"hull.C_D": 0.0},
        ("hull.C_D", "hull-term.Y_vabsv", "hull-term.Y_rabsr", "hull-term.N_rabsr", "hull-term.N_rabsv"),
    ),
}
"""By name."""


def runs_of(plant: Plant) -> TrialSet:
    """Turns, zigzags and random orders of the ship with sensor noise; every fourth of a kind tests."""
    made = [*_steered(plant), *_ordered(plant)]
    trials = {one.id: one for one in made}
    test = []
    for kind in sorted({one.manoeuvre for one in made}):
        test += [one.id for one in made if one.manoeuvre == kind][1::4]
    return TrialSet(trials, tuple(id for id in trials if id not in test), tuple(test), ship=plant.ship.id)


def _steered(plant: Plant) -> Iterator[Trial]:
    """Turns and zigzags under a helmsman, who needs the motion."""
    model, fleet = Model(plant.ship), plant.fleet
    approach = plant.ship.approach
    assert approach is not None  # both ships have one
    helmsmen: list[tuple[str, Any, float]] = []
    for angle in (8, 15, 25, 35):
        for side in (1, -1):
            helmsmen.append(("turning", TurningOrder(math.radians(side * angle), 0.5 * fleet.scale, 9.0), 18.0))
    for angle in (10, 15, 20):
        for side in (1, -1):
            order = math.radians(side * angle)
            helmsmen.append(("zigzag", ZigzagOrder(order, abs(order), 0.5 * fleet.scale), 25.0))
    for seed, (kind, helmsman, longest) in enumerate(helmsmen, 1):
        rng = np.random.default_rng(seed)
        motion = run_manoeuvre(
            model,
            helmsman,
            speed=approach.speed * rng.uniform(0.8, 1.0),
            n=approach.n * rng.uniform(0.85, 1.0),
            heading=rng.uniform(-np.pi, np.pi),
            longest=longest * fleet.scale,
            sample=sample_of(fleet),
            engine=lambda share: 1.0 - 0.08 * (1.0 - share),
        )
        yield measured(plant, f"{kind}_{seed:02d}", kind, motion.t, motion.states, motion.controls, rng)


def _ordered(plant: Plant) -> Iterator[Trial]:
    """Random orders, which do not depend on the motion."""
    fleet, approach = plant.fleet, plant.ship.approach
    assert approach is not None
    for seed in range(101, 109):
        rng = np.random.default_rng(seed)
        t = np.arange(0.0, 18.0 * fleet.scale, sample_of(fleet))
        controls = np.column_stack(
            [
                _steps(rng, t, 3.0 * fleet.scale, fleet.astern * approach.n, approach.n, 0.3 * approach.n),
                _steps(rng, t, 1.5 * fleet.scale, math.radians(-35), math.radians(35), math.radians(30)),
            ]
        )
        start = np.array([0.0, 0.0, rng.uniform(-np.pi, np.pi), approach.speed * rng.uniform(0.5, 1.0), 0.0, 0.0])
        cases = pad([t], [controls], [start])
        states = as_predictor(plant.ship, integrator=Integrator("rk4", 4)).predict(cases).states[0, 0]
        yield measured(plant, f"random_{seed}", "random", t, states, controls, rng)


def sample_of(fleet: Fleet) -> float:
    """Time between samples [s]."""
    return 1.0 if fleet.scale > 20.0 else 0.2


def _steps(rng: np.random.Generator, t: FloatArray, hold: float, low: float, high: float, rate: float) -> FloatArray:
    """(n_samples,) orders drawn anew after about ``hold`` [s], followed at no more than ``rate`` over hold / 3."""
    ordered = np.empty(len(t))
    until = -1.0
    value = 0.0
    for k, now in enumerate(t):
        if now > until:
            value, until = rng.uniform(low, high), now + hold * rng.uniform(0.5, 1.5)
        ordered[k] = value
    followed = np.empty(len(t))
    most = rate / (hold / 3.0) * (t[1] - t[0])
    followed[0] = ordered[0]
    for k in range(1, len(t)):
        followed[k] = followed[k - 1] + np.clip(ordered[k] - followed[k - 1], -most, most)
    return followed


def measured(
    plant: Plant, id: str, kind: str, t: FloatArray, states: FloatArray, controls: FloatArray, rng: np.random.Generator
) -> Trial:
    """A run as noisy sensors would log it."""
    assert np.isfinite(states).all(), id
    shown = states + np.array(plant.fleet.noise) * rng.standard_normal(states.shape)
    return Trial(id, plant.ship.id, kind, "generated", t, *shown.T, *controls.T)


@dataclass(frozen=True, eq=False)
class Studied:
    """A plant, what was made of it, and its row."""

    plant: Plant
    learned: LearnedHybrid
    row: dict[str, Any]


def study(name: str, options: HybridOptions, say: Callable[[str], None] = print) -> Studied:
    """One plant: tuned, trained, scored and read."""
    began = time.perf_counter()
    plant = PLANTS[name]()
    data = runs_of(plant)
    options = replace(options, restart=plant.fleet.window)
    tuning = FitOptions(
        targets=plant.targets,
        a_r=0.5,
        method="least-squares",
        starts=1,
        objective="standardised",
        restart=plant.fleet.window,
        every=2.0,
    )
    without = replace(data, trials={id: data.trials[id] for id in data.tune}, test=())
    profile = tuned(plant.model, fit(plant.model, without, tuning).theta, {}, {"a_r": 0.5})
    say(f"{name}: tuned after {time.perf_counter() - began:.0f} s")
    hooks = Hooks(on_progress=lambda done, _, words: say(f"{name}: {words}") if done % 100 == 0 else None)
    learned = learn_hybrid(profile, data, options, hooks=hooks)
    say(f"{name}: trained after {time.perf_counter() - began:.0f} s")
    pieces = pieces_of(learned.test, options.restart)
    floor = L_MSE(score(as_predictor(plant.ship), pieces, learned.sigma))
    before, after = (L_MSE(learned.scores[which]) for which in ("before", "after"))
    row = {
        "plant": name,
        "piece": plant.piece,
        "runs": len(data.tune),
        "held_out_runs": len(data.test),
        "L_MSE_model": before,
        "L_MSE_hybrid": after,
        "L_MSE_plant": floor,
        "share_removed": (before - after) / (before - floor),
        "penalty": learned.penalty,
        "updates": learned.step,
        "wall_s": round(time.perf_counter() - began),
    }
    return Studied(plant, learned, {**row, **told(learned.hybrid, plant, data)})


def told(hybrid: Hybrid, plant: Plant, data: TrialSet) -> dict[str, Any]:
    """The part of a row that a trained network gives: what it says, and what it does outside the data."""
    reading = read_network(hybrid, list(data.trials.values()), restart=plant.fleet.window)
    first = [term.name for term in reading.terms[:2]]
    like = [one.name for term in reading.terms[:2] for one in term.rivals]
    return {
        "share_of_tuned": reading.tuned,
        "first_terms": [term.to_dict() for term in reading.terms[:2]],
        "named": any(term.startswith(plant.named) for term in first),
        "named_among_alike": any(term.startswith(plant.named) for term in [*first, *like]),
        "sentences": list(reading.sentences),
        "outside": outside(hybrid),
        "note": plant.note,
    }


def outside(hybrid: Hybrid) -> list[dict[str, Any]]:
    """What the hybrid does where it has no data, beside the model of forces alone, in the units its row says."""
    profile = hybrid.profile
    approach, L = profile.approach, profile.L_pp
    assert approach is not None  # both ships have one
    t = np.arange(0.0, 600.0, 0.5)
    orders = {
        "turn of 35 deg for ten minutes": (1.0, 1.0, math.radians(35.0)),
        "crash stop, revolutions reversed": (1.0, -1.0, 0.0),
        "turn of 20 deg at twice the approach speed": (2.0, 2.0, math.radians(20.0)),
    }
    found = []
    for words, (speed, n, rudder) in orders.items():
        controls = np.column_stack([np.full(len(t), n * approach.n), np.full(len(t), rudder)])
        start = np.array([0.0, 0.0, 0.0, speed * approach.speed, 0.0, 0.0])
        cases = pad([t], [controls], [start])
        both = [one.predict(cases) for one in (as_predictor(profile), HybridPredictor(hybrid))]
        model, with_network = (one.states[0, 0] for one in both)
        swept = float(np.sum(np.hypot(*np.diff(model[:, :2], axis=0).T)))
        found.append(
            {
                "run": words,
                "diverged": bool(both[1].diverged.any()),
                "largest_speed_over_approach": float(np.hypot(*with_network[:, 3:5].T).max() / approach.speed),
                "largest_yaw_rate_prime": float(np.abs(with_network[:, 5]).max() * L / approach.speed),
                "largest_yaw_rate_prime_model": float(np.abs(model[:, 5]).max() * L / approach.speed),
                "largest_distance_between_in_lengths": float(np.hypot(*(with_network - model)[:, :2].T).max() / L),
                "way_of_model_in_lengths": swept / L,
            }
        )
    return found


def table(rows: list[dict[str, Any]]) -> str:
    """The rows as Markdown."""
    heads = (
        "the model lacks",
        "error above noise removed",
        "read first (share of the force that tuning leaves)",
        "named",
    )
    lines = ["| " + " | ".join(heads) + " |", "|---|---:|---|---|"]
    for row in rows:
        terms = "; ".join(f"{one['title']} of {one['written']} ({one['share']:.0%})" for one in row["first_terms"])
        named = "yes" if row["named"] else "among those alike" if row["named_among_alike"] else "no"
        cells = (row["piece"], f"{row['share_removed']:.0%}", terms or "-", named)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Study the plants named, all where none is, and write the rows; those of other plants in the file stay."""
    given = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else "")
    given.add_argument("out", type=Path)
    given.add_argument("plants", nargs="*", help=", ".join(PLANTS))
    given.add_argument("--keep", type=Path, help="folder for the trained networks")
    given.add_argument("--read", type=Path, help="folder of trained networks to read anew; nothing is trained")
    asked = given.parse_args()
    found = {row["plant"]: row for row in json.loads(asked.out.read_text())["plants"]} if asked.out.is_file() else {}
    options = HybridOptions()
    for name in asked.plants or PLANTS:
        file = f"{''.join(c if c.isalnum() else '-' for c in name)}.safetensors"
        if asked.read:
            hybrid, plant = load_network(asked.read / file), PLANTS[name]()
            assert isinstance(hybrid, Hybrid), file
            found[name] |= told(hybrid, plant, runs_of(plant))
        else:
            done = study(name, options)
            found[name] = done.row
            if asked.keep:
                save_network(done.learned.hybrid, asked.keep / file, overwrite=True)
        rows = [found[name] for name in PLANTS if name in found]
        write_text(asked.out, json.dumps({"schema": 1, "plants": rows}, indent=1, ensure_ascii=False) + "\n")
        print(table(rows), flush=True)


if __name__ == "__main__":
    main()
