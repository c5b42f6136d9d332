"""Cases for a diagnosis: a ship drawn at random with one effect, two, none, or one no registry holds."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from .plant import NAMES, TUNING, WHITE, Noise, sail
from .suzaku import HULL_TERMS, PROFILE, TARGETS
from .unknown import UNKNOWN

if TYPE_CHECKING:
    from mmgtune.trial import Trial

Draw = Callable[[int, np.random.Generator], dict[str, float]]
"""Parameters of an effect at a level 0 to 4; signs and directions are drawn."""

SPREAD = 0.22
"""Largest share by which a tuning target of a drawn ship differs from the profile's value."""

SPINNING = 4.0
"""r' beyond which a ship turns on the spot: the model's reference speed is another there (r' of 5)."""

TYPICAL = 3
"""The level any engineer would call visible."""

Sizes = tuple[float, float, float, float, float]


FOUR = ("turn_p35", "turn_m35", "zigzag_10", "zigzag_20")
"""Trials of a small programme: two turns and two zigzags."""


@dataclass(frozen=True)
class Programme:
    """Which trials are sailed, which of them causes are looked for on, and what of their log is kept.

    every  of the samples of once a second, one in so many is logged
    told   whether the log states the noise of its sensors
    """

    trials: tuple[str, ...] = NAMES
    tuning: tuple[str, ...] = TUNING
    every: int = 1
    told: bool = True

    def kept(self, trials: Sequence[Trial]) -> list[Trial]:
        """What is there of ten trials."""
        columns = ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta")
        return [
            replace(
                one,
                **{name: getattr(one, name)[:: self.every] for name in columns},
                noise=one.noise if self.told else {},
            )
            for one in trials
            if one.id in self.trials
        ]


@dataclass(frozen=True)
class Case:
    """One ship, what is hidden in her, and how she is measured: the arguments of ``plant.simulate`` with a name."""

    name: str
    ship: dict[str, float]
    effects: dict[str, dict[str, float]]
    seed: int
    noise: Noise
    of_trial: dict[str, dict[str, dict[str, float]]] = field(default_factory=dict)
    programme: Programme = Programme()

    @property
    def hidden(self) -> dict[str, dict[str, float]]:
        """What there is to be found: effects of all trials, and of single ones without their numbers."""
        return {**self.effects, **{tag: {} for own in self.of_trial.values() for tag in own}}


def _motion(typical: float) -> Sizes:
    """Levels of what changes the motion: about a tenth of the noise, twice, fifteen times it, typical, twice that.

    Root mean square over the motion channels of turns; refitted targets take up a good part of it.
    """
    return (0.002 * typical, 0.04 * typical, 0.3 * typical, typical, 2.0 * typical)


def _sensor(typical: float) -> Sizes:
    """Levels of what only shows in the log: from well below the noise on."""
    return (0.02 * typical, 0.1 * typical, 0.4 * typical, typical, 2.0 * typical)


def _sign(rng: np.random.Generator) -> float:
    return float(rng.choice((-1.0, 1.0)))


def _turn(rng: np.random.Generator) -> float:
    """A direction [rad]."""
    return float(rng.uniform(0.0, 2.0 * np.pi))


def _plain(name: str, sizes: Sizes) -> Draw:
    return lambda k, rng: {name: sizes[k]}


def _signed(name: str, sizes: Sizes) -> Draw:
    return lambda k, rng: {name: _sign(rng) * sizes[k]}


def _factor(name: str, shares: Sizes) -> Draw:
    """1 - share, or 1 + share."""
    return lambda k, rng: {name: 1.0 + _sign(rng) * shares[k]}


def _vector(names: tuple[str, str], sizes: Sizes) -> Draw:
    """Two components of a vector of that size in any direction."""

    def draw(k: int, rng: np.random.Generator) -> dict[str, float]:
        towards = _turn(rng)
        return dict(zip(names, (sizes[k] * float(np.cos(towards)), sizes[k] * float(np.sin(towards))), strict=True))

    return draw


def _from(name: str, sizes: Sizes) -> Draw:
    """A size and the direction it comes from."""
    return lambda k, rng: {name: sizes[k], "direction": _turn(rng)}


def _one_of(*draws: Draw) -> Draw:
    return lambda k, rng: draws[int(rng.integers(len(draws)))](k, rng)


def _degrees(draw: Draw) -> Draw:
    """The same with sizes in degrees."""
    return lambda k, rng: {name: float(np.radians(size)) for name, size in draw(k, rng).items()}


def _side_force(k: int, rng: np.random.Generator) -> dict[str, float]:
    """Force and moment grow together, as the propeller pushes where it is."""
    factor = (1.002, 1.03, 1.2, 1.6, 2.2)[k]
    return {"force": factor, "moment": factor}


def _thruster(k: int, rng: np.random.Generator) -> dict[str, float]:
    """A push to either side somewhere between the perpendiculars."""
    force = _sign(rng) * _motion(3000.0)[k]
    return {"side": force, "moment": force * float(rng.uniform(-0.5, 0.5)) * PROFILE["particulars.L_pp"]}


def _skew(k: int, rng: np.random.Generator) -> dict[str, float]:
    """A push like that one, which grows with the square of the speed."""
    force = _sign(rng) * _motion(0.002)[k]
    return {"Y_0": force, "N_0": force * float(rng.uniform(-0.5, 0.5))}


def _sides(k: int, rng: np.random.Generator) -> dict[str, float]:
    """A blade that moves more to one side than to the other: by as much less to the other, or right there."""
    share = _sign(rng) * _motion(0.15)[k]
    return {"starboard": 1.0 + share, "port": 1.0 - float(rng.integers(2)) * share}


TERM_SIZES: dict[str, float] = {
    "N_rabsr": 0.015,
    "Y_vabsv": 0.15,
    "Y_rabsr": 0.06,
    "N_vabsv": 0.05,
    "N_vvv": 0.10,
    "N_rrr": 0.005,
    "Y_vvv": 0.4,
    "Y_vvr": 0.3,
    "X_vv": 0.06,
    "X_rr": 0.015,
    "N_rrabsr": 0.003,
}
"""Typical coefficients [prime] of the terms the hull may lack; r' comes to 2 in the tightest turns."""


def hull_term(term: str) -> Draw:
    """The ladder of one term of the hull; the last level leaves the ship able to turn without spinning."""
    size = TERM_SIZES[term]
    return _signed(term, (0.002 * size, 0.04 * size, 0.3 * size, size, 1.5 * size))


LADDER: dict[str, Draw] = {
    "rudder-offset": _degrees(_signed("angle", _motion(1.5))),
    "dead-time": _plain("seconds", (0.05, 0.2, 1.0, 3.0, 6.0)),
    "backlash": _degrees(_plain("play", (0.05, 0.3, 1.0, 2.5, 5.0))),
    "rudder-gain": _one_of(_factor("factor", _motion(0.12)), _sides),
    "governor-lag": _plain("time_constant", (0.5, 3.0, 15.0, 40.0, 80.0)),
    "engine-droop": _plain("share", (0.005, 0.03, 0.12, 0.25, 0.4)),
    "steering-lag": _one_of(
        _plain("time_constant", (0.1, 0.3, 1.2, 4.0, 8.0)),
        _degrees(_plain("rate_limit", (100.0, 30.0, 8.0, 3.5, 2.0))),
    ),
    "rpm-scale": _factor("factor", _motion(0.05)),
    "thrust": _factor("factor", _motion(0.12)),
    "flap": _factor("factor", _motion(0.2)),
    "clock-offset": _signed("seconds", _motion(3.0)),
    "current": _vector(("north", "east"), _motion(0.15)),
    "resistance": _signed("slope", _motion(3.0)),
    "shallow-water": _plain("depth", (2000.0, 200.0, 20.0, 9.0, 6.5)),
    "loading": _one_of(
        _factor("draught", _motion(0.1)),
        _signed("trim", _motion(0.15)),
        _factor("displacement", _motion(0.1)),
    ),
    "wind": _from("speed", (0.2, 1.0, 4.0, 8.0, 12.0)),
    "wave-drift": _from("force", _motion(6000.0)),
    "steady-force": _thruster,
    "hull-asymmetry": _skew,
    "propeller-side-force": _side_force,
    "memory": _one_of(*(_plain(name, (0.1, 0.4, 2.0, 8.0, 16.0)) for name in ("time_constant", "sway", "yaw"))),
    "rudder-stall": _degrees(_plain("angle", (38.0, 35.0, 32.0, 28.0, 22.0))),
    "rudder-limit": _degrees(_plain("angle", (39.9, 39.0, 36.0, 30.0, 22.0))),
    "hull-term": _one_of(*(hull_term(term) for term in HULL_TERMS)),
    "antenna": _one_of(_vector(("x", "y"), _sensor(12.0)), _vector(("x_alone", "y_alone"), _sensor(12.0))),
    "heading-bias": _degrees(_one_of(_signed("angle", _sensor(1.5)), _signed("alone", _sensor(1.5)))),
    "compass-deviation": _degrees(
        _one_of(
            _vector(("sine", "cosine"), _sensor(3.0)),
            _vector(("sine_alone", "cosine_alone"), _sensor(3.0)),
        )
    ),
    "position-latency": _plain("seconds", _sensor(2.5)),
    "velocity-filter": _one_of(
        *(_plain(name, (0.1, 0.4, 1.5, 4.0, 8.0)) for name in ("over_ground", "along_axes", "yaw_rate"))
    ),
    "heading-filter": _one_of(*(_plain(name, (0.05, 0.2, 1.0, 3.0, 6.0)) for name in ("time_constant", "alone"))),
    "gyro-drift": _degrees(
        _one_of(
            *(_signed(name, _sensor(0.015)) for name in ("heading", "heading_alone")),
            _signed("yaw_rate", _sensor(2e-4)),
        )
    ),
    "gyro-scale": _factor("factor", _sensor(0.05)),
    "gyro-bias": _degrees(_signed("rate", _sensor(0.05))),
    "log-misalignment": _degrees(_signed("angle", _sensor(1.5))),
    "speed-scale": _one_of(_factor("factor", _sensor(0.04)), _signed("grows", _sensor(0.05))),
    "log-zero": _one_of(*(_signed(name, _sensor(0.1)) for name in ("ahead", "abeam"))),
    "water-log": _vector(("north", "east"), (0.02, 0.06, 0.15, 0.35, 0.5)),
}
"""By tag, the effect at five levels: below visible, hardly, small, typical, and well above."""

DRAWN = [tag for tag in LADDER if tag not in ("water-log", "steady-force", "hull-asymmetry", "thrust", "rudder-limit")]
"""Those that pairs and triples are drawn from: as when they were first drawn, so that results stay comparable."""


def draw_ship(rng: np.random.Generator) -> dict[str, float]:
    """A ship whose tuning targets differ from the profile's by up to SPREAD, each on its own."""
    return {name: PROFILE[name] * float(rng.uniform(1.0 - SPREAD, 1.0 + SPREAD)) for name in TARGETS}


def single(tag: str, level: int, seed: int, noise: Noise = WHITE) -> Case:
    """One effect; ship, signs and directions depend on tag and seed, not on the level (0 to 4)."""
    return Case(f"{tag}-{level}-{seed}", _ship(seed), {tag: LADDER[tag](level, _rng(tag, seed))}, seed, noise)


def null(seed: int, noise: Noise = WHITE) -> Case:
    """Nothing hidden: the drawn ship herself."""
    return Case(f"null-{seed}", _ship(seed), {}, seed, noise)


def pair(seed: int, noise: Noise = WHITE) -> Case:
    """Two different effects, each at the typical level."""
    rng = _rng("pair", seed)
    tags = [str(tag) for tag in rng.choice(DRAWN, size=2, replace=False)]
    hidden = {tag: LADDER[tag](TYPICAL, rng) for tag in tags}
    return Case(f"pair-{'-and-'.join(tags)}-{seed}", _ship(seed), hidden, seed, noise)


def triple(seed: int, noise: Noise = WHITE) -> Case:
    """Three different effects, each at the typical level."""
    rng = _rng("triple", seed)
    tags = [str(tag) for tag in rng.choice(DRAWN, size=3, replace=False)]
    hidden = {tag: LADDER[tag](TYPICAL, rng) for tag in tags}
    return Case(f"triple-{'-and-'.join(tags)}-{seed}", _ship(seed), hidden, seed, noise)


PROGRAMMES = (
    Programme(),
    Programme(tuning=NAMES),
    Programme(FOUR, FOUR),
)
"""Ten trials, half of them held out, or none; four with none held out."""


def otherwise(tag: str, seed: int) -> Case:
    """One effect at the typical level on a ship with noise of her own, measured by other people: fewer trials, samples
    every 1, 5 or 10 s, a third of the noise or three times as much, with a memory or without, told or not."""
    own = zlib.crc32(tag.encode()) % 100_000 * 100 + seed
    rng = _rng("otherwise", own)
    loudness = float(rng.choice((1.0 / 3.0, 1.0, 3.0)))
    scaled = {name: loudness * getattr(WHITE, name) for name in ("x", "y", "psi", "u", "v", "r", "n", "delta")}
    noise = Noise(**scaled, time_constant=float(rng.choice((0.0, 0.0, 30.0))))
    some = PROGRAMMES[int(rng.integers(len(PROGRAMMES)))]
    programme = replace(some, every=int(rng.choice((1, 5, 10))), told=bool(rng.integers(2)))
    hidden = {tag: LADDER[tag](TYPICAL, rng)}
    return Case(f"otherwise-{tag}-{seed}", _ship(own), hidden, own, noise, programme=programme)


RUNS: dict[str, Draw] = {
    "current": lambda k, rng: _vector(("north", "east"), (0.02, 0.06, 0.15, 0.35, 0.5))(k, rng),
    "rudder-offset": lambda k, rng: {"angle": float(np.radians((0.05, 0.2, 0.5, 1.0, 2.0)[k]) * rng.standard_normal())},
    "rudder-gain": lambda k, rng: {"factor": 1.0 + (0.005, 0.02, 0.05, 0.1, 0.2)[k] * float(rng.uniform(-1.0, 1.0))},
    "clock-offset": lambda k, rng: {"seconds": (0.1, 0.3, 0.8, 2.0, 4.0)[k] * float(rng.standard_normal())},
    "wind": lambda k, rng: _from("speed", (0.5, 2.0, 4.0, 8.0, 12.0))(k, rng),
    "loading": lambda k, rng: {"draught": 1.0 + (0.005, 0.02, 0.05, 0.1, 0.15)[k] * float(rng.uniform(-1.0, 1.0))},
}
"""What differs from trial to trial: an effect of one trial, at five levels."""


def gear_of_two_rates(level: int, seed: int, noise: Noise = WHITE) -> Case:
    """Orders are logged, and the rudder follows them more slowly to one side than to the other."""
    fast, slow = 3.0, (2.9, 2.5, 2.0, 1.5, 0.8)[level]
    rates = (slow, fast) if _sign(_rng("gear-of-two-rates", seed)) > 0.0 else (fast, slow)
    hidden = {"steering-lag": {"to_starboard": float(np.radians(rates[0])), "to_port": float(np.radians(rates[1]))}}
    return Case(f"gear-of-two-rates-{level}-{seed}", _ship(seed), hidden, seed, noise)


def of_runs(tag: str, level: int, seed: int, noise: Noise = WHITE) -> Case:
    """An effect with another value in each trial."""
    rng = _rng(f"runs-{tag}", seed)
    own = {name: {tag: RUNS[tag](level, rng)} for name in NAMES}
    return Case(f"runs-{tag}-{level}-{seed}", _ship(seed), {}, seed, noise, own)


def of_one_run(seed: int, noise: Noise = WHITE) -> Case:
    """A current in one trial of those that are looked at, and in none else."""
    rng = _rng("one-run", seed)
    own = {str(rng.choice(TUNING)): {"current": RUNS["current"](TYPICAL, rng)}}
    return Case(f"one-run-{seed}", _ship(seed), {}, seed, noise, own)


def tide(seed: int, noise: Noise = WHITE) -> Case:
    """A current that changes within runs as it does in time, another in each trial."""
    rng = _rng("tide", seed)
    own = {}
    for name in NAMES:
        first, gain = (_vector(("north", "east"), (0.2,) * 5)(0, rng) for _ in range(2))
        own[name] = {"current": {**first, **{f"{way}_rate": value / 400.0 for way, value in gain.items()}}}
    return Case(f"tide-{seed}", _ship(seed), {}, seed, noise, own)


def unknown(k: int, seed: int, noise: Noise = WHITE) -> Case:
    """The k-th effect no registry holds, with one of its magnitudes."""
    tag = list(UNKNOWN)[k]
    magnitude = float(_rng(tag, seed).choice(UNKNOWN[tag].magnitudes))
    return Case(f"{tag}-{seed}", _ship(seed), {tag: {"magnitude": magnitude}}, seed, noise)


def _ship(seed: int) -> dict[str, float]:
    return dict(_steerable(seed))


@cache
def _steerable(seed: int) -> dict[str, float]:
    """The first ship drawn that can be steered: some spin to a standstill, where the model is not valid."""
    rng = _rng("ship", seed)
    while True:
        ship = draw_ship(rng)
        if fastest_turn(ship, seed) < SPINNING:
            return ship


def fastest_turn(ship: dict[str, float], seed: int) -> float:
    """Largest r' in any trial of a ship with nothing hidden [-]."""
    largest = 0.0
    for rows in sail(ship, {}, seed).values():
        u, v, r = rows[:, 4], rows[:, 5], rows[:, 6]
        largest = max(largest, float(np.max(np.abs(r) * PROFILE["particulars.L_pp"] / np.hypot(u, v))))
    return largest


def _rng(what: str, seed: int) -> np.random.Generator:
    """Draws that depend on the seed and on what they are for."""
    return np.random.default_rng([seed, zlib.crc32(what.encode())])
