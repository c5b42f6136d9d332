"""Standard manoeuvres or whole trials simulated, with their indices and criteria: what ``mmgtune simulate`` does."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import NoneType
from typing import Any, SupportsIndex, overload

from .arguments import ShipGiven, TrialsGiven, of_one_ship
from .backends import Integrator
from .circumstances import beyond_formulas
from .displayed import Plotted, inert
from .errors import OptionError, Problem, among, brief, must_be_a
from .evaluation import TrialRecord, evaluate
from .files import all_or_none, path_of, refuse_existing
from .inputs import INPUTS
from .manoeuvres.criteria import Criterion, check_stopping
from .manoeuvres.stopping import stopping_indices
from .manoeuvres.summary import criteria_of, indices_of
from .model import Model
from .motions import Motion, as_trial
from .networks import named_ship
from .options import SimulateOptions
from .options.choice import must_be
from .options.orders import ORDERS
from .orders import Sailing, Straight, TurningOrder, ZigzagOrder, possible_approach, run_manoeuvres, sample_of
from .predictor import PhysicsPredictor, Predictor, as_predictor, noted, profile_of
from .profile import ShipProfile
from .stated_indices import no_reverse
from .steering import APPROACH, STEP
from .trial import Coverage, write_trial
from .units import DEG, quantity

ORDERED = "rk4"
"""How manoeuvres given as orders are simulated, at steps of their own."""

STOP = "stop"
"""What a crash stop is called."""

RADIANS = 2.0
"""A plain number of degrees below this is likely meant as radians."""

PER_SECOND = 20.0
"""A plain number of revolutions a minute below this is likely meant as revolutions a second."""


class NoSuchRun(OptionError, IndexError):
    """A number of a run that there is not; sequences end where they meet the second."""


@dataclass(frozen=True, eq=False)
class Simulated(Plotted, Sequence[Motion]):
    """Simulated runs, a sequence of ``Motion``, with what they are judged by: trial by trial, of each all members.

    records  each beside the trial it is of; empty for manoeuvres given as orders
    notes    on what was around the ship
    bands    on indices of manoeuvres, as ``predicting.with_bands`` adds them: level [%], particles, and runs
    """

    written_by = "write_simulation"

    predictor: Predictor
    motions: tuple[Motion, ...]
    records: tuple[TrialRecord, ...]
    options: SimulateOptions
    notes: tuple[str, ...] = ()
    bands: Mapping[str, Any] | None = None

    def __len__(self) -> int:
        return len(self.motions)

    @overload
    def __getitem__(self, k: int | str) -> Motion: ...
    @overload
    def __getitem__(self, k: slice) -> Sequence[Motion]: ...
    def __getitem__(self, k: int | str | slice) -> Motion | Sequence[Motion]:
        """The run of that number, from 0, or of that id.

        Raises OptionError for one that there is not, and for an id of which there are several members.
        """
        if isinstance(k, slice):
            return self.motions[k]
        if isinstance(k, str):
            found = [motion for motion in self.motions if motion.id == k]
            if len(found) == 1:
                return found[0]
            if found:
                why = f"it is that of {len(found)} members"
                fix = f"write [run for run in RUNS if run.id == {k!r}]"
                raise OptionError(Problem(f"'{k}' is the id of several runs", "simulated", why, fix))
            known = list(dict.fromkeys(motion.id for motion in self.motions))
            raise OptionError(Problem(f"no run '{k}'", "simulated", **among(k, known)))
        if not isinstance(k, SupportsIndex):
            why = "a run is had by its number or its id"
            raise OptionError(Problem(f"no run {brief(k)}", "simulated", why, "write [0]"))
        if not -len(self.motions) <= k.__index__() < len(self.motions):
            there = f"there are {len(self.motions)}, from 0"
            raise NoSuchRun(Problem(f"no run {k}", "simulated", there, "write a number below that"))
        return self.motions[k]

    def __repr__(self) -> str:
        """In a line."""
        ids = [motion.id for motion in self.motions]
        more = f" and {len(ids) - 4} more" if len(ids) > 4 else ""
        return inert(f"Simulated({self.predictor.name}: {', '.join(ids[:4])}{more})")

    @property
    def ship(self) -> ShipProfile | None:
        """The profile, None of a predictor that has none."""
        return profile_of(self.predictor)

    def rows(self) -> list[dict[str, Any]]:
        """Status, indices, distance to what was measured, and criteria of every run; bands where there are some."""
        records = self.records or (None,) * len(self.motions)
        rows = [self._described(motion, record) for motion, record in zip(self.motions, records, strict=True)]
        if self.bands is None:
            return rows
        by_id = {run["id"]: {one["index"]: one for one in run["indices"]} for run in self.bands["runs"]}
        return [{**row, "bands": by_id[row["id"]]} for row in rows]

    def write(self, folder: Path | str, *, with_forces: bool = False, overwrite: bool = False) -> list[Path]:
        """Write every run as a trial file, with its number in the name where there are several members.

        One that diverged is no trial, and is left out.

        Raises OutputError where one is there already, OptionError for forces of a predictor that has none.
        """
        folder = path_of(folder)
        several = self.predictor.n_members > 1
        motions = [motion for motion in self.motions if not motion.diverged]
        ids = [f"{motion.id}_{motion.member}" if several else motion.id for motion in motions]
        paths = [folder / f"{id}.parquet" for id in ids]
        refuse_existing(paths, overwrite)
        with all_or_none():
            for id, motion, path in zip(ids, motions, paths, strict=True):
                trial = as_trial(self.predictor, replace(motion, id=id), with_forces=with_forces)
                write_trial(trial, path, overwrite=overwrite)
        return paths

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        ship = self.ship
        return {
            "schema": 1,
            "kind": "simulate",
            "profile": self.predictor.name,
            "sha256": ship.sha256 if ship else None,
            "runs": self.rows(),
            "notes": list(self.notes),
            "doubts": [one.to_dict() for one in ship.doubts()] if ship else [],
        }

    def _begins(self, motion: Motion) -> dict[str, float]:
        """Speed and revolutions that a run begins with, without revolutions of a ship that logs none."""
        found = {"speed_m_per_s": float(motion.states[0, 3])}
        if any(INPUTS[name].role == "propeller" for name in motion.inputs):
            found["rpm"] = 60.0 * float(motion.mean_of("propeller")[0])
        return found

    def _described(self, motion: Motion, record: TrialRecord | None) -> dict[str, Any]:
        ship, L_pp = self.ship, self.predictor.L_pp
        V = ship.approach.speed if ship and ship.approach else float(motion.states[0, 3])
        track = None if motion.diverged else motion.track()
        measured = record.measured.indices if record else None
        stop = (
            stopping_indices(track, L_pp, _ordered_at(L_pp, V)) if track and not record and motion.id == STOP else None
        )
        criteria: tuple[Criterion, ...] = ()
        if track:
            criteria = check_stopping(stop, L_pp, V) if stop else criteria_of(track, L_pp, V, measured)
        return {
            "id": motion.id,
            **({"member": motion.member} if self.predictor.n_members > 1 else {}),
            "status": "diverged" if motion.diverged else "ok",
            "duration_s": float(motion.t[-1]),
            "approach": self._begins(motion),
            "integrator": record.method if record else ORDERED,
            "indices": record.indices
            if record
            else stop.to_dict()
            if stop
            else indices_of(track, L_pp)
            if track
            else {},
            "measured": measured,
            **({"order": record.measured.order} if record else {}),
            "measures": record.measures if record and not motion.diverged else None,
            "unvisited": unvisited(ship, [motion]) if ship else [],
            "criteria": [criterion.to_dict() for criterion in criteria],
        }


def unvisited(ship: ShipProfile, motions: Sequence[Motion]) -> list[str]:
    """Where runs go that the trials a ship was tuned to did not, in words; nothing of a profile that does not say."""
    known = Coverage.from_dict(ship.provenance.get("coverage") or {})
    tracks = [motion.track() for motion in motions if not motion.diverged]
    return known.unvisited_by(Coverage.of(tracks, ship.L_pp)) if known and tracks else []


def _beyond(ship: ShipProfile | None, motions: Sequence[Motion]) -> list[str]:
    """The same of each run, as notes."""
    found: dict[str, list[str]] = {}
    for motion in motions if ship else ():
        assert ship is not None  # else there are none
        for words in unvisited(ship, [motion]):
            found.setdefault(words, []).append(motion.id)
    return [
        f"{', '.join(dict.fromkeys(ids))}: goes where the trials this ship was tuned to did not, {words}"
        for words, ids in found.items()
    ]


def _beyond_the_gear(ship: ShipProfile, options: SimulateOptions) -> list[str]:
    """Which manoeuvres order more than the steering gear of a ship does, as notes."""
    rudders = [one.name for one in ship.arrangement.inputs if one.role == "rudder"]
    gears = [gear for one in rudders if (gear := ship.actuator(one)) is not None]
    most = min((min(-gear.low, gear.high) for gear in gears), default=math.inf)
    beyond = [
        name
        for name, order in _orders(options)
        if abs(order.angle if isinstance(order, TurningOrder) else order.rudder) > most + 1e-9
    ]
    ends = f"the rudder stops at {most / DEG:.3g} deg, where the steering gear of the ship ends"
    return [f"{', '.join(beyond)}: {ends}"] if beyond else []


def simulate(
    ship: ShipGiven | Model | Predictor,
    trials: TrialsGiven | None = None,
    options: SimulateOptions = SimulateOptions(),
    *,
    integrator: Integrator | None = None,
    backend: str | None = None,
) -> Simulated:
    """Simulate trials with their own inputs, or where there are none the manoeuvres of the options.

    ship, trials  objects, paths or bundled names; ``ship`` may be any predictor, ``trials`` a list of trials
    integrator, backend  in place of those of the options; a predictor has its own ways
    Manoeuvres by orders are integrated finely whatever the options say.  A run that diverges is marked so.
    Raises OptionError for orders that make no sense or are given together with trials, and for a predictor without a
    profile that is given no trials.
    """
    must_be(options, SimulateOptions)
    must_be_a(integrator, (Integrator, NoneType), "integrator")
    must_be_a(backend, (str, NoneType), "backend")
    predictor = as_predictor(
        named_ship(ship, integrator or options.make_integrator()),
        integrator=integrator or options.make_integrator(),
        backend=backend or options.backend,
    )
    if trials is None:
        ordered = tuple(_on_orders(predictor, options))
        assert isinstance(predictor, PhysicsPredictor)  # or else it takes no orders
        own = (*_beyond_the_gear(predictor.model.profile, options), *beyond_formulas(predictor.model))
        return Simulated(predictor, ordered, (), options, (*own, *_beyond(profile_of(predictor), ordered)))
    if options.given(ORDERS):
        raise OptionError(
            Problem(
                "trials have their own inputs",
                "trials",
                "rudder and propeller follow what was measured, not orders",
                "leave out turn, zigzag, stop, speed and rpm",
            )
        )
    several, of_ship = of_one_ship(trials)
    records = evaluate(predictor, several)
    notes = noted(predictor, several, of_ship)
    simulated = tuple(record.motion for record in records)
    return Simulated(predictor, simulated, records, options, (*notes, *_beyond(profile_of(predictor), simulated)))


def _on_orders(predictor: Predictor, options: SimulateOptions) -> list[Motion]:
    if not isinstance(predictor, PhysicsPredictor) or predictor.n_members > 1:
        what = f"'{predictor.name}' is given no trials"
        why = "orders are for a profile: they need its approach condition and its steering gear"
        raise OptionError(Problem(what, "trials", why, "name trials, whose inputs drive it"))
    model, ship = predictor.model, predictor.model.profile
    speed = None if options.speed is None else approach_speed(options.speed)
    n = None if options.rpm is None else revolutions(options.rpm)
    possible_approach(speed, n, ship.L_pp, ship.approach)
    L, V = ship.L_pp, speed or (ship.approach.speed if ship.approach else 1.0)
    sample, at = sample_of(L, V), _ordered_at(L, V)
    longest = max(600.0, 150.0 * L / V)
    sailings = [
        Sailing(helmsman, name, speed, n, longest=longest, sample=sample) for name, helmsman in _orders(options, at)
    ]
    if options.stop:
        ahead = n if n is not None else ship.approach.n if ship.approach else 0.0
        back = astern_of(options, ahead, L, ship)
        telegraph = partial(_reversed, ahead, -back, at)
        sailings.append(
            Sailing(Straight(), STOP, speed, n, 0.0, longest, sample, telegraph=telegraph, until_stopped=True)
        )
    return run_manoeuvres(model, sailings, theta=predictor.theta.repeat(len(sailings), axis=1))


def _ordered_at(L_pp: float, V: float) -> float:
    """Time of the order [s]: after the approach of ``predict`` and stated indices, rounded up to a sample."""
    sample = sample_of(L_pp, V)
    return sample * math.ceil(APPROACH * STEP * L_pp / V / sample - 1e-9)


def _reversed(ahead: float, astern: float, at: float, t: float) -> float:
    """Revolutions ordered at a time."""
    return ahead if t < at - 1e-9 else astern


def astern_of(options: SimulateOptions, ahead: float, L_pp: float, ship: ShipProfile | None) -> float:
    """Revolutions of a crash stop [1/s], a number above 0: those of the options, as many as ahead where they say none.

    Raises OptionError where no ship turns so fast, and where the equations end at reversed propellers.
    """
    n = ahead
    if options.astern:
        n = revolutions(options.astern.lstrip("-"), "astern")
        possible_approach(None, n, L_pp, ship.approach if ship else None, option="astern")
    if ship is not None and (problem := no_reverse(ship, "stop", "leave the stop out")):
        raise OptionError(problem)
    return n


def _orders(options: SimulateOptions, at: float = 0.0) -> list[tuple[str, TurningOrder | ZigzagOrder]]:
    """The manoeuvres asked for by name, each once, ordered at time ``at`` [s]; both hard turns where none is.

    Raises OptionError for orders that make no sense.
    """
    orders: dict[str, TurningOrder | ZigzagOrder] = {}
    for text in turns_of(options):
        angle = rudder_angle(text)
        orders[turn_name(angle)] = TurningOrder(angle, at)
    for text in options.zigzag:
        rudder, heading = zigzag_angles(text)
        orders[zigzag_name(rudder, heading)] = ZigzagOrder(rudder * DEG, heading * DEG, at)
    return [*orders.items()]


def turns_of(options: SimulateOptions) -> tuple[str, ...]:
    """The turns asked for; both hard ones where nothing is."""
    return options.turn or (() if options.zigzag or options.stop else ("35", "-35"))


def turn_name(angle: float) -> str:
    """What a turn at this rudder angle [rad] is called: turn_p35."""
    return f"turn_{_signed(angle / DEG)}"


def zigzag_name(rudder: float, heading: float) -> str:
    """What a zigzag of these angles [deg] is called: zigzag_p10_10."""
    return f"zigzag_{_signed(rudder)}_{heading:g}"


def rudder_angle(text: str) -> float:
    """The rudder angle [rad] of "35", "35 deg" or "0.61 rad".  Raises OptionError."""
    written = _plain(text)
    if written is not None and 0.0 < abs(written) < RADIANS:
        fix = f'write {written / DEG:.3g} for degrees, "{text} rad", or "{text} deg" if that is meant'
        raise OptionError(Problem(f"a rudder angle of {text} looks like radians", "turn", "turn is in degrees", fix))
    angle = written * DEG if written is not None else quantity(text, "turn", "rad", '35 or "0.61 rad"', bare=True)
    if not 0.0 < abs(angle) <= 0.5 * math.pi:
        why = "no ship turns by that" if angle == 0.0 else "no rudder goes beyond 90 deg"
        fix = "give an angle between -90 and 90 deg, not 0"
        raise OptionError(Problem(f"rudder angle {angle / DEG:g} deg", "turn", why, fix))
    return angle


def approach_speed(text: str) -> float:
    """The speed [m/s] of "12 kn".  Raises OptionError."""
    speed = quantity(text, "speed", "m/s", '"12 kn"')
    if not speed > 0.0:
        raise OptionError(
            Problem(f"the approach speed is {text}", "speed", "manoeuvres begin ahead", "give a speed above 0")
        )
    return speed


def revolutions(text: str, option: str = "rpm") -> float:
    """Propeller revolutions [1/s] of "106", "106 rpm" or "1.77 1/s".  Raises OptionError, naming the option."""
    written = _plain(text)
    if written is not None and 0.0 < written < PER_SECOND:
        fix = f'write {60.0 * written:.4g} for 1/min, "{text} 1/s", or "{text} rpm" if that is meant'
        raise OptionError(Problem(f"{text} revolutions look like 1/s", option, f"{option} is in 1/min", fix))
    n = written / 60.0 if written is not None else quantity(text, option, "1/s", '106 or "1.77 1/s"', bare=True)
    if not (n > 0.0 and math.isfinite(n)):
        why = "manoeuvres begin ahead" if option == "rpm" else "the propeller is to turn astern"
        raise OptionError(Problem(f"the revolutions are {text}", option, why, "give a number above 0"))
    return n


def zigzag_angles(text: str) -> tuple[float, float]:
    """Rudder and heading [deg] of "20/20" or "-10/10".  Raises OptionError."""
    try:
        rudder, heading = (float(part) for part in text.split("/"))
        if not (0.0 < abs(rudder) <= 90.0 and 0.0 < heading <= 180.0):
            raise ValueError
    except ValueError:
        why = "it is not a rudder angle to 90 deg and a change of heading to 180 deg with a stroke between"
        fix = "write RUDDER/HEADING in degrees, such as 20/20"
        raise OptionError(Problem(f"'{text}' is not a zigzag", "zigzag", why, fix)) from None
    if abs(rudder) < RADIANS or heading < RADIANS:
        fix = "write RUDDER/HEADING in degrees, such as 20/20"
        raise OptionError(Problem(f"a zigzag {text} looks like radians", "zigzag", "zigzag is in degrees", fix))
    return rudder, heading


def _plain(text: str) -> float | None:
    """A number without a unit, None where there is one."""
    try:
        return float(text)
    except ValueError:
        return None


def _signed(angle: float) -> str:
    return f"{'p' if angle > 0 else 'm'}{abs(angle):g}"
