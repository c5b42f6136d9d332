"""Sets of trials, by name: which ship, what is hidden in her, how she was sailed and how that was logged."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from mmgtune.trial import Trial, write_trial

from .logbook import Instruments, write_up
from .plant import DEG, ESSO, SUZAKU, Helm, Hidden, Ship, sail

KN = 1852.0 / 3600.0
SHIPS = {"suzaku": SUZAKU, "esso_osaka": ESSO}
ROUGH = Instruments(
    every=1.0,
    jitter=0.05,
    position=0.8,
    position_lasts=20.0,
    position_step=0.5,
    velocity=0.04,
    velocity_step=0.05,
    heading=0.2 * DEG,
    heading_step=0.5 * DEG,
    yaw_rate=0.05 * DEG,
    yaw_rate_step=0.05 * DEG,
    rudder_step=0.5 * DEG,
    turns_step=1.0 / 60.0,
    held=2.0,
    gaps=2,
)
"""Poor instruments and gaps.  Positions that come every other second are a second late in the mean: that may be said.
"""

# kind, angle [deg], check or dwell
PLANS: dict[str, tuple[tuple[str, float, float], ...]] = {
    "mixed": (("turn", 35, 0), ("zigzag", -10, 10), ("turn", -20, 0), ("zigzag", 20, 20), ("keep", 15, 60)),
    "few": (("turn", -35, 0), ("turn", 15, 0), ("zigzag", 20, 20), ("zigzag", -10, 10)),
    "three": (("turn", 35, 0), ("zigzag", 20, 20), ("turn", -20, 0)),
    "turns": (("turn", 35, 0), ("turn", -35, 0), ("turn", 15, 0), ("turn", -20, 0), ("pull-out", 25, 0)),
    "zigzags": (("zigzag", 10, 10), ("zigzag", -10, 10), ("zigzag", 20, 20), ("zigzag", -20, 20), ("turn", 30, 0)),
    "spiral": (("spiral", 20, 45), ("turn", -35, 0), ("zigzag", 10, 10), ("turn", 20, 0)),
    "harbour": (("keep", 25, 70), ("zigzag", 15, 10), ("pull-out", -35, 0), ("turn", 35, 0), ("keep", -40, 90)),
    "many": (
        ("turn", 35, 0), ("turn", -35, 0), ("turn", 20, 0), ("turn", -15, 0),
        ("zigzag", 10, 10), ("zigzag", -10, 10), ("zigzag", 20, 20), ("zigzag", -20, 20),
    ),
}  # fmt: skip


@dataclass(frozen=True)
class Case:
    """A set of trials and the truth about it.

    causes     tag of each true cause and its size in words; akin: tags that would not be silly where none is named
    group      nothing, one, two, by-run, unknown
    hidden     fields of ``Hidden``; sensors: of ``Instruments``; by_run: either's, one a run, taken in turn
    off        coefficients differ by 3 % to so much
    absorbed   the targets that are tuned can take it: that nothing is named is right as well
    draw       another number draws other hulls, headings, helmsmen and noise, the causes being the same
    """

    name: str
    group: str
    causes: Mapping[str, str]
    plan: str = "mixed"
    ship: str = "suzaku"
    hidden: Mapping[str, float] = field(default_factory=dict)
    sensors: Mapping[str, float] = field(default_factory=dict)
    by_run: tuple[Mapping[str, float], ...] = ()
    off: float = 0.0
    rough: bool = False
    absorbed: bool = False
    akin: tuple[str, ...] = ()
    wind_logged: bool = False
    draw: int = 0


_LATE = ("dead-time", "clock-offset")
"""A lag of the second order is one of the first and a short delay."""
_HULL = {
    0.0: "R0 Xvr Xrr Xvvvr Xvvvv Yv Yr Yvvv Yvrr Nv Nr Nvvv Nvvr my kzz tP w0 Cw tR aH eps kappa lR gp gn fa cl1",
    1.0: "R0 XA Yv Yr Nv Nr CD CrY CrN my kzz tP w0 tau k0 tR aH eps kappa lR gp gn fa",
}


def ship_of(case: Case) -> Ship:
    """The ship as she is: some six in ten coefficients off by 3 % to ``case.off``, either way."""
    ship = SHIPS[case.ship]
    if case.off <= 0.0:
        return ship
    rng = _drawn(case, "hull")
    changed = {}
    for name in _HULL[ship.full].split():
        size, sign, chosen = rng.uniform(0.03, case.off), rng.choice((-1.0, 1.0)), rng.random() < 0.6
        if chosen:
            changed[name] = getattr(ship, name) * (1.0 + sign * size)
    return ship._replace(**changed)


def _drawn(case: Case, what: str) -> np.random.Generator:
    names = (case.name, what) if case.draw == 0 else (case.name, what, str(case.draw))
    return np.random.default_rng(zlib.crc32("/".join(names).encode()))


def _helm(ship: Ship, kind: str, angle: float, second: float, rng: np.random.Generator) -> tuple[Helm, ...]:
    """Orders of a run, the angles and how long each is held."""
    slow = ship.L / 83.0 * SUZAKU.speed / ship.speed  # how much longer everything takes than with the small ship
    by_hand = rng.random() < 0.5
    helm = Helm(
        heading=float(rng.uniform(0.0, 2.0 * np.pi)),
        n=ship.n * float(rng.choice((0.88, 0.95, 1.0, 1.0, 1.06))),
        lead=float(rng.uniform(12.0, 30.0)),
        lasts=0.0,
        course=0.0,
        check=0.0,
        kp=0.9 if by_hand else 1.3,
        kd=(25.0 if by_hand else 35.0) * slow,
        every=5.0 if by_hand else 2.0,
        rounding=(1.0 if by_hand else 0.5) * DEG,
        late=float(rng.uniform(0.5, 2.5)),
        band=(0.4 if by_hand else 0.2) * DEG,
        sag=0.03,
    )
    a = angle * DEG
    if kind in ("turn", "pull-out"):
        held = slow * (330.0 if abs(angle) >= 30 else 480.0)
        if kind == "pull-out":
            return helm._replace(lasts=helm.lead + 1.5 * held), np.array([a, 0.0]), np.array([held, 1e9])
        return helm._replace(lasts=helm.lead + held), np.array([a]), np.array([1e9])
    if kind == "zigzag":
        lasts = helm.lead + slow * (240.0 if abs(angle) >= 20 else 200.0)
        return helm._replace(lasts=lasts, check=second * DEG), np.array([a]), np.array([1e9])
    if kind == "spiral":
        steps = a * np.array([1.0, 0.5, 0.25, 0.0, -0.25, -0.5, -1.0])
        dwell = second * slow
        return helm._replace(lasts=helm.lead + 7.5 * dwell), steps, np.full(7, dwell)
    dwell = second * slow
    return helm._replace(lasts=helm.lead + 4 * dwell, course=1.0), a * np.array([1.0, 0.0, -1.0]), np.full(3, dwell)


def make(case: Case) -> dict[str, Trial]:
    """The trials of a set, by id, always the same."""
    ship = ship_of(case)
    trials = {}
    for i, (kind, angle, second) in enumerate(PLANS[case.plan]):
        name = f"{i + 1:02d}_{kind}_{'p' if angle > 0 else 'm'}{abs(angle):.0f}"
        rng = _drawn(case, name)
        helm, orders, hold = _helm(ship, kind, angle, second, rng)
        own = dict(case.by_run[i % len(case.by_run)]) if case.by_run else {}
        of_ship = {key: value for key, value in {**case.hidden, **own}.items() if key in Hidden._fields}
        of_log = {key: value for key, value in {**case.sensors, **own}.items() if key not in Hidden._fields}
        hidden = Hidden(gust_phase=float(rng.uniform(0.0, 6.0)))._replace(**of_ship)
        by = ROUGH if case.rough else Instruments(every=2.0 if ship.full else float(rng.choice((1.0, 1.0, 2.0, 0.5))))
        rows = sail(ship, hidden, helm, orders, hold, 240.0 if not ship.full else 500.0)
        manoeuvre = {"turn": "turning", "pull-out": "turning", "zigzag": "zigzag"}.get(kind, "")
        trial = write_up(rows, replace(by, **of_log), rng, id=name, ship=case.ship, manoeuvre=manoeuvre)
        if case.wind_logged:
            blown = {
                "wind_speed": np.abs(hidden.wind * (1.0 + 0.08 * rng.standard_normal(len(trial.t)))),
                "wind_dir": hidden.wind_from + 0.06 * rng.standard_normal(len(trial.t)),
            }
            trial = replace(trial, extra=blown)
        trials[name] = trial
    return trials


def write(case: Case, folder: Path) -> Path:
    """Trial files and their split: every other run tests, as long as three tune."""
    trials = make(case)
    for name, trial in trials.items():
        write_trial(trial, folder / f"{name}.parquet")
    names = list(trials)
    test = names[1::2] if len(names) > 4 else names[-1:]
    tune = [name for name in names if name not in test]
    lines = [f'ship = "{case.ship}"', f"tune = {tune}".replace("'", '"'), f"test = {test}".replace("'", '"')]
    (folder / "split.toml").write_text("\n".join(lines) + "\n")
    return folder


def _nothing(name: str, **of: object) -> Case:
    return Case(name, "nothing", {}, **of)  # type: ignore[arg-type]


def _one(name: str, tag: str, size: str, **of: object) -> Case:
    return Case(name, "one", {tag: size}, **of)  # type: ignore[arg-type]


def _unknown(name: str, **of: object) -> Case:
    return Case(name, "unknown", {}, **of)  # type: ignore[arg-type]


def _all() -> tuple[Case, ...]:
    off = {"off": 0.08}
    return (
        # nothing hidden
        _nothing("nothing-mixed"),
        _nothing("nothing-spiral", plan="spiral"),
        _nothing("nothing-rough", plan="many", rough=True, akin=("position-latency",)),
        _nothing("nothing-esso", ship="esso_osaka", plan="few"),
        _nothing("nothing-off-5", plan="many", off=0.05),
        _nothing("nothing-off-10", plan="mixed", off=0.10),
        _nothing("nothing-off-harbour", plan="harbour", off=0.08),
        _nothing("nothing-off-esso", ship="esso_osaka", plan="few", off=0.08),
        # one cause
        _one("current", "current", "0.45 m/s to 63 deg", hidden={"north": 0.20, "east": 0.40}),
        _one("current-off", "current", "0.25 m/s to 217 deg", plan="few", hidden={"north": -0.2, "east": -0.15}, **off),
        _one(
            "current-tide", "current", "0.3 m/s north, falling 0.05 m/s a minute", plan="turns",
            hidden={"north": 0.3, "north_rate": -0.05 / 60, "east_rate": 0.04 / 60},
        ),
        _one("wind", "wind", "9 m/s from 300 deg", plan="turns", hidden={"wind": 9.0, "wind_from": 300 * DEG}),
        # Of the two ships' forms, moments differ by far more than forces; here by less.
        _one("wind-near", "wind", "9 m/s from 300 deg", plan="turns",
             hidden={"wind": 9.0, "wind_from": 300 * DEG, "wind_arm": 0.4}),
        _one("wind-off", "wind", "8 m/s from 40 deg", hidden={"wind": 8.0, "wind_from": 40 * DEG}, **off),
        _one(
            "wind-logged", "wind", "8 m/s from 140 deg, logged", wind_logged=True,
            hidden={"wind": 8.0, "wind_from": 140 * DEG}, **off,
        ),
        _one("shallow", "shallow-water", "depth 1.6 draughts", plan="many", hidden={"depth": 1.6 * 3.8}),
        _one("shallow-esso", "shallow-water", "depth 1.5 draughts", ship="esso_osaka", plan="few",
             hidden={"depth": 1.5 * 21.79}, absorbed=True),
        _one("waves", "wave-drift", "12 kN abeam from 250 deg", plan="turns",
             hidden={"drift": 12e3, "drift_from": 250 * DEG}, **off),
        _one("rudder-zero", "rudder-offset", "1.5 deg", plan="three", hidden={"offset": 1.5 * DEG},
             rough=True, akin=("position-latency",)),
        _one("rudder-zero-off", "rudder-offset", "-1 deg", plan="harbour", hidden={"offset": -1.0 * DEG}, **off),
        _one("rudder-gain", "rudder-gain", "0.88", plan="many", hidden={"gain": 0.88}),
        _one("stall", "rudder-stall", "soft from 20 deg", plan="turns", hidden={"stall": 20 * DEG}),
        _one("flap", "flap", "0.6", plan="many", hidden={"flap": 0.6}, **off),
        _one("turns-shown", "rpm-scale", "1.06", plan="mixed", hidden={"turns": 1.06}),
        _one("side-force", "propeller-side-force", "Y and N 2.5 times", plan="many",
             hidden={"side_Y": 2.5, "side_N": 2.5}),
        _one("steering-lag", "steering-lag", "4 s", plan="zigzags", hidden={"lag": 4.0}, akin=_LATE, **off),
        _one("steering-rate", "steering-lag", "1.2 deg/s", plan="zigzags", hidden={"slow": 1.2 * DEG}),
        _one("dead-time", "dead-time", "3 s", plan="zigzags", hidden={"dead": 3.0}),
        _one("play", "backlash", "3 deg", plan="harbour", hidden={"play": 3.0 * DEG}),
        _one("clock", "clock-offset", "2.5 s", plan="mixed", sensors={"clock": 2.5}, **off),
        _one("heading-off", "heading-bias", "2 deg", plan="mixed", sensors={"heading_off": 2.0 * DEG}),
        _one("gyro-off", "gyro-bias", "0.08 deg/s", plan="few", sensors={"yaw_rate_off": 0.08 * DEG}, **off),
        _one("gyro-drift", "gyro-drift", "0.6 deg/min", plan="turns", sensors={"heading_drift": 0.01 * DEG}),
        _one("deviation", "compass-deviation", "B 2.5, C -1.5 deg", plan="turns",
             sensors={"deviation_B": 2.5 * DEG, "deviation_C": -1.5 * DEG}),
        _one("log-scale", "speed-scale", "1.05", plan="mixed", sensors={"log_scale": 1.05}, **off),
        _one("antenna", "antenna", "-28 m, 3 m", plan="few", sensors={"antenna_x": -28.0, "antenna_y": 3.0}, **off),
        _one("late-positions", "position-latency", "2 s", plan="mixed", sensors={"late": 2.0}),
        _one("smoothed", "velocity-filter", "mean over 12 s", plan="zigzags", sensors={"mean_over": 12.0}, **off),
        _one("fouled-30", "resistance", "1.3 times", plan="mixed", hidden={"fouled": 1.3}, absorbed=True, **off),
        _one("fouled-180", "resistance", "1.8 times", plan="mixed", hidden={"fouled": 1.8}, rough=True,
             akin=("position-latency",), **off),
        _one("fouled-240", "resistance", "2.4 times", plan="many", hidden={"fouled": 2.4}),
        _one("loaded", "loading", "draught 1.12, trim 0.15", plan="many", hidden={"draught": 1.12, "trim": 0.15}),
        _one("hull-N", "hull-term", "N r'|r'| -0.025", plan="many", hidden={"Nrar": -0.025}),
        _one("hull-Y-off", "hull-term", "Y v'|v'| -0.35", plan="turns", hidden={"Yvav": -0.35}, **off),
        _one("memory", "memory", "10 s", plan="zigzags", hidden={"memory": 10.0}),
        # two causes
        Case("current+zero", "two", {"current": "0.35 m/s to 315 deg", "rudder-offset": "1.5 deg"},
             hidden={"north": 0.25, "east": -0.25, "offset": 1.5 * DEG}, **off),
        Case("wind+antenna", "two", {"wind": "9 m/s from 200 deg", "antenna": "25 m"}, plan="turns",
             hidden={"wind": 9.0, "wind_from": 200 * DEG}, sensors={"antenna_x": 25.0}),
        Case("current+turns-shown", "two", {"current": "0.3 m/s to 90 deg", "rpm-scale": "0.94"}, plan="many",
             hidden={"east": 0.3, "turns": 0.94}),
        Case("shallow+heading", "two", {"shallow-water": "1.6 draughts", "heading-bias": "-1.5 deg"}, plan="many",
             hidden={"depth": 6.1}, sensors={"heading_off": -1.5 * DEG}),
        Case("fouled+zero", "two", {"resistance": "1.9 times", "rudder-offset": "-1.5 deg"},
             hidden={"fouled": 1.9, "offset": -1.5 * DEG}, **off),
        Case("lag+current", "two", {"steering-lag": "4 s", "current": "0.3 m/s to 180 deg"}, plan="zigzags",
             hidden={"lag": 4.0, "north": -0.3}, akin=_LATE, **off),
        Case("stall+current-esso", "two", {"rudder-stall": "18 deg", "current": "0.4 m/s to 53 deg"}, plan="few",
             ship="esso_osaka", hidden={"stall": 18 * DEG, "north": 0.24, "east": 0.32}),
        Case("gyro+wind", "two", {"gyro-bias": "-0.08 deg/s", "wind": "8 m/s from 80 deg"}, plan="turns",
             hidden={"wind": 8.0, "wind_from": 80 * DEG}, sensors={"yaw_rate_off": -0.08 * DEG}, **off),
        # another size in each run
        Case("currents", "by-run", {"current": "0.3 m/s to 0, 120, 240 deg"}, plan="mixed",
             by_run=({"north": 0.3}, {"north": -0.15, "east": 0.26}, {"north": -0.15, "east": -0.26})),
        Case("winds-off", "by-run", {"wind": "9, 4, 7 m/s from 30, 150, 260 deg"}, plan="turns", **off,
             by_run=tuple({"wind": w, "wind_from": d * DEG} for w, d in ((9, 30), (4, 150), (7, 260)))),
        Case("zeros", "by-run", {"rudder-offset": "1.8, -0.6, 0.8 deg"}, plan="mixed",
             by_run=tuple({"offset": a * DEG} for a in (1.8, -0.6, 0.8))),
        Case("clocks-off", "by-run", {"clock-offset": "3, 0, 1.5 s"}, plan="zigzags", **off,
             by_run=tuple({"clock": a} for a in (3.0, 0.0, 1.5))),
        Case("turns-shown-differ", "by-run", {"rpm-scale": "1.06, 0.97, 1.0"}, plan="mixed",
             by_run=tuple({"turns": a} for a in (1.06, 0.97, 1.0))),
        Case("loads-off", "by-run", {"loading": "draught 1.12, 1.0, 0.9"}, plan="many", **off,
             by_run=tuple({"draught": a} for a in (1.12, 1.0, 0.9))),
        # what no program could know
        _unknown("two-plays", plan="harbour", hidden={"play_1": 2.0 * DEG, "play_2": 6.0 * DEG}, akin=("backlash",)),
        _unknown("engine-derates", plan="turns", hidden={"derate": 0.15 / 400}, akin=("rpm-scale",), **off),
        _unknown("cargo-shifts", plan="turns", hidden={"shift_at": 120.0, "shift_N": 0.004, "shift_X": 0.004}),
        _unknown("ice", plan="mixed", hidden={"ice_X": 0.006, "ice_N": -0.003}, akin=("hull-term",), **off),
        _unknown("passing-ship", plan="mixed", off=0.08,
                 hidden={"pass_at": 130.0, "pass_for": 25.0, "pass_Y": 45e3, "pass_N": 9e5}),
        _unknown("eddy", plan="turns", akin=("current",),
                 hidden={"eddy": 0.35, "eddy_x": 60.0, "eddy_y": 60.0, "eddy_size": 110.0}),
        _unknown("fast-clock", plan="mixed", sensors={"fast": 1.04}, **off),
        _unknown("sticking-blade", plan="many", hidden={"stuck_at": 75.0, "stuck_for": 30.0}),
    )  # fmt: skip


CASES = {case.name: case for case in _all()}
