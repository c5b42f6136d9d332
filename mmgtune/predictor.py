"""Whatever turns cases into states: a physics model with one or many parameter vectors, a network, a formula.

A predictor has members (candidates, particles, networks) along one axis; each predicts every case.  Simulation, scores,
checks, repetitions and reports take a predictor, or a profile or model, which ``as_predictor`` makes one of.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

import numpy as np

from .arguments import Found, ship_of
from .arrays import BoolArray, FloatArray, IntArray
from .backends import STATES, Cases, Integrator, LaneModel, get_backend, pad
from .circumstances import notes_on
from .displayed import Brief
from .errors import OptionError, Problem, brief, kind_of
from .model import Model
from .physics.quantities import State, Surroundings
from .predictor_checks import RETURNED, lacking, require_described, require_predicted
from .profile import ShipProfile
from .trial import Trial, TrialSet, another_ship, surroundings

AT_ONCE = 100_000
"""Samples times members predicted at one time, but for those of a single case; bounds the memory (5 MB of states)."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """What a predictor makes of cases.

    states    (n_cases, n_members, T, 6) x, y [m], psi [rad], u, v_m [m/s], r [rad/s]; after the end of a case anything
    diverged  (n_cases, n_members) whether a run left the world of ships; its states then mean nothing
    """

    states: FloatArray
    diverged: BoolArray


@runtime_checkable
class Predictor(Protocol):
    """Turns cases into states: what a model of your own has to have to be scored, checked and simulated as others are.

    name       what to call it
    L_pp       length of the ship between perpendiculars [m]
    n_members  how many predictions it makes of each case
    inputs     what drives it, by names of ``inputs.INPUTS``: the columns of ``cases.controls``
    method     how it gets on in time, named beside every J: "rk4", "network at 1 s"
    """

    @property
    def name(self) -> str: ...

    @property
    def L_pp(self) -> float: ...

    @property
    def n_members(self) -> int: ...

    @property
    def inputs(self) -> Sequence[str]: ...

    @property
    def method(self) -> str: ...

    def predict(self, cases: Cases) -> Prediction:
        """All members on every case, each from ``cases.initial``; never raises for a run that diverges.

        -> ``Prediction(states, diverged)``: arrays (n_cases, n_members, T, 6) with a state for each sample of
        ``cases.t``, and (n_cases, n_members) of truth values.  There is an axis of members even where there is one.
        """
        ...


def predicted(predictor: Predictor, cases: Cases) -> Prediction:
    """What a predictor that anyone may have written makes of cases.

    Raises OptionError for states or marks of another shape than ``Prediction`` has, and for states that are not finite
    in a run that is not marked.
    """
    return Prediction(*require_predicted(predictor, cases, predictor.predict(cases)))


class Stepper(Protocol):
    """One member under way, steered while it moves."""

    def step(self, now: FloatArray, then: FloatArray, h: float) -> FloatArray:
        """The state (6,) after h [s] more with inputs going from ``now`` to ``then``, (n_inputs,) each."""
        ...


@runtime_checkable
class Steerable(Predictor, Protocol):
    """A predictor that remembers more than the state shows, such as a network with a memory: it steps by itself."""

    def stepper(self, member: int, state: FloatArray, controls: FloatArray) -> Stepper:
        """A member ready to go from a state (6,) with inputs (n_inputs,)."""
        ...


class Run(Protocol):
    """Members under way on many lanes at once, steered while they move.

    states  (n_members, n_lanes, 6)
    """

    @property
    def states(self) -> FloatArray: ...

    def step(self, controls: FloatArray, around: FloatArray, h: float) -> None:
        """March by h [s] with inputs (n_lanes, n_inputs) in surroundings (n_lanes, n_surroundings).

        Both may have an axis of members in front.
        """
        ...


@runtime_checkable
class Fleet(Predictor, Protocol):
    """A predictor whose members can be steered on many lanes at once, each with inputs of its own.

    own_step  [s] it marches in, None where it is told
    """

    @property
    def own_step(self) -> float | None: ...

    def under_way(self, states: FloatArray, controls: FloatArray) -> Run:
        """All members on lanes, from states (n_members, n_lanes, 6) with inputs (n_members, n_lanes, n_inputs)."""
        ...


@runtime_checkable
class Paired(Predictor, Protocol):
    """A predictor that can run one member on each case, as a helmsman to each member asks for."""

    def paired(self, cases: Cases, members: IntArray) -> FloatArray:
        """States (n_cases, T, 6) of case k by member ``members[k]``; not finite once a run diverges."""
        ...


Sampling = Literal["TS-infinity", "TS1"]
"""How particles keep to members of an ensemble: one for the whole path, or another at each step (Chua et al. 2018)."""


@runtime_checkable
class Uncertain(Predictor, Protocol):
    """A predictor that knows what it does not know, and says so by particles: as many as are asked for."""

    def drawn(self, n: int, seed: int, sampling: Sampling = "TS-infinity") -> Predictor:
        """n particles as the members of a predictor; the same seed draws the same ones.

        Raises OptionError for a way of sampling that makes no sense for it.
        """
        ...


def particles_of(predictor: Predictor, n: int, seed: int, sampling: Sampling = "TS-infinity") -> Predictor:
    """n particles of a predictor that is ``Uncertain``, or all that it ``holds`` where these are fewer; any other as it
    is, whose members are its particles.

    Raises OptionError for a way of sampling that makes no sense for it.
    """
    if isinstance(predictor, Uncertain):
        # Twice the same particle says no more than once, and makes bands look surer than they are.
        return predictor.drawn(min(n, getattr(predictor, "holds", n)), seed, sampling)
    if sampling != "TS-infinity":
        what = f"'{predictor.name}' cannot be sampled by {sampling}"
        why = "only an ensemble that draws particles can have another member at each step"
        raise OptionError(Problem(what, "sampling", why, 'leave it at "TS-infinity"'))
    return predictor


@dataclass(eq=False)
class Restarted:
    """Any predictor steered: begun anew at each step from the state it reached, as a case of two samples."""

    predictor: Predictor
    member: int
    state: FloatArray

    def step(self, now: FloatArray, then: FloatArray, h: float) -> FloatArray:
        """See ``Stepper``; NaN throughout once it diverged."""
        found = predicted(self.predictor, pad([np.array([0.0, h])], [np.array([now, then])], [self.state]))
        lost = bool(found.diverged[0, self.member])
        self.state = np.full(6, np.nan) if lost else np.array(found.states[0, self.member, 1])
        return self.state


def stepper_of(predictor: Predictor, member: int, state: FloatArray, controls: FloatArray) -> Stepper:
    """A member under way from a state (6,) with inputs (n_inputs,): its own stepper, or one begun anew each step."""
    if isinstance(predictor, Steerable):
        return predictor.stepper(member, state, controls)
    return Restarted(predictor, member, state)


class LaneFleet:
    """Members of a model of forces on lanes, on NumPy; see ``Run``.  Inputs change linearly within a step.

    ship  a model with the coefficients of every lane, the lanes of a member side by side
    """

    def __init__(self, ship: LaneModel, states: FloatArray, controls: FloatArray):
        self._shape = states.shape[:2]
        self._ship = ship
        self._run = ship.under_way(State(*_on_lanes(states)), ship.arrangement.control(*_on_lanes(controls)))

    @property
    def states(self) -> FloatArray:
        """See ``Run``."""
        return np.stack(self._run.shown, axis=-1).reshape(*self._shape, len(STATES))

    def step(self, controls: FloatArray, around: FloatArray, h: float) -> None:
        """See ``Run``."""
        inputs = np.broadcast_to(controls, (*self._shape, controls.shape[-1]))
        here = Surroundings(*_on_lanes(np.broadcast_to(around, (*self._shape, around.shape[-1]))))
        with np.errstate(all="ignore"):
            self._run.step(self._ship.arrangement.control(*_on_lanes(inputs)), here, h, Integrator("rk4"))


def _on_lanes(values: FloatArray) -> FloatArray:
    """(n, n_members * n_lanes) of (n_members, n_lanes, n)."""
    return np.ascontiguousarray(values.reshape(-1, values.shape[-1]).T)


@dataclass(frozen=True, eq=False, repr=False)
class PhysicsPredictor(Brief):
    """A model with one or many parameter vectors.

    theta  (n_rows, n_members) coefficients
    """

    model: Model
    theta: FloatArray
    integrator: Integrator = Integrator()
    backend: str = "compiled"

    @property
    def name(self) -> str:
        """Id of the profile."""
        return self.model.profile.id

    @property
    def L_pp(self) -> float:
        """Length between perpendiculars [m]."""
        return self.model.L_pp

    @property
    def n_members(self) -> int:
        """Number of parameter vectors."""
        return int(self.theta.shape[1])

    @property
    def inputs(self) -> tuple[str, ...]:
        """What drives the model."""
        return self.model.inputs

    @property
    def method(self) -> str:
        """The integrator."""
        return words_of(self.integrator)

    @property
    def doubted(self) -> tuple[str, ...]:
        """What a reader of anything that it predicts must know, in words."""
        return ()

    def predict(self, cases: Cases) -> Prediction:
        """See ``Predictor``."""
        result = get_backend(self.backend).run(
            self.model, self.theta, cases, integrator=self.integrator, keep_states=True
        )
        return Prediction(result.states, result.diverged)

    @property
    def own_step(self) -> None:
        """See ``Fleet``."""
        return None

    def under_way(self, states: FloatArray, controls: FloatArray) -> Run:
        """See ``Fleet``."""
        theta = np.repeat(self.theta, states.shape[1], axis=1)
        return LaneFleet(LaneModel(self.model, theta), states, controls)


def as_predictor(
    ship: Predictor | ShipProfile | Model | Found,
    *,
    theta: FloatArray | None = None,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
) -> Predictor:
    """A profile or model, or the profile of a result, as a predictor; a predictor as it is, which has its own ways.

    theta  (n_rows, n_members) coefficients of a profile or model, its own where None
    Raises OptionError for anything else, and for coefficients of something that has none of that kind.
    """
    if isinstance(ship, Found):
        ship = ship_of(ship)
    if isinstance(ship, ShipProfile):
        ship = Model(ship)
    if isinstance(ship, Model):
        own = ship.matrix()
        return PhysicsPredictor(ship, own if theta is None else _columns(theta, len(own)), integrator, backend)
    if isinstance(ship, type) or not isinstance(ship, Predictor):
        raise OptionError(_no_ship(ship))
    require_described(ship)
    if theta is not None:
        raise OptionError(Problem("coefficients are given for a predictor", ship.name, "only a profile has them"))
    return ship


def _columns(theta: object, n_rows: int) -> FloatArray:
    """Coefficients as they are.  Raises OptionError for what is no array of a column for each member."""
    shape = np.shape(theta) if isinstance(theta, np.ndarray) else ()
    if isinstance(theta, np.ndarray) and len(shape) == 2 and shape[0] == n_rows and shape[1]:
        return theta
    what = f"theta has shape {shape}" if isinstance(theta, np.ndarray) else f"theta is {kind_of(theta)}"
    why = f"it is an array of {n_rows} coefficients of the model, and of each a value for every member"
    fix = f"give one of shape ({n_rows}, n_members); Model(SHIP).matrix() is that of the ship herself"
    raise OptionError(Problem(what, "theta", why, fix))


def _no_ship(given: object) -> Problem:
    """The problem of what is neither a profile nor a predictor, though it may be meant as one."""
    if isinstance(given, type):
        what = f"the class {given.__name__} is no ship"
        return Problem(what, "", "a ship profile, a model or a predictor is needed", f"make one: {given.__name__}(...)")
    gone = lacking(given)
    if gone:
        why = f"a predictor has {', '.join(gone)} too; see help(mmgtune.Predictor)"
        fix = f"add {', '.join(gone)}" + (f"; predict(cases) returns {RETURNED}" if "predict" in gone else "")
        return Problem(f"{kind_of(given)} is not yet a predictor: it lacks {', '.join(gone)}", brief(given), why, fix)
    why = "a ship profile, a model or a predictor is needed"
    fix = "load a profile with load_profile(NAME)"
    if isinstance(given, (TrialSet, Trial)):
        fix = "give the ship first, then the trials"
    return Problem(f"{kind_of(given)} is no ship", brief(given), why, fix)


def profile_of(predictor: Predictor) -> ShipProfile | None:
    """The profile a predictor computes by, None where it is no physics model."""
    return predictor.model.profile if isinstance(predictor, PhysicsPredictor) else None


def draught_of(predictor: Predictor) -> float | None:
    """Draught of the ship [m] of a predictor that has a physics model, alone or with a network; else None."""
    model = getattr(predictor, "model", None)
    return model.draught if isinstance(model, Model) else None


def noted(predictor: Predictor, trials: Sequence[Trial], ship: str, called: str = "") -> list[str]:
    """What a reader of what a predictor makes of trials must know: that they are of another ship, and of a model what
    is doubtful in it and what was around the ship.

    ship    id of the ship they are of, "" where nothing says
    called  what to call the predictor, where it is not by its name
    """
    found = of_another_ship(predictor, ship, called)
    if isinstance(predictor, PhysicsPredictor):
        found += [*predictor.doubted, *notes_on(predictor.model, trials)]
    return found


def of_another_ship(predictor: Predictor, ship: str, called: str = "") -> list[str]:
    """Where trials are of another ship than a predictor, that they are; arguments as for ``noted``."""
    if profile := profile_of(predictor):
        return another_ship(ship, profile.id)
    own = getattr(predictor, "id", None)
    if not ship or not own or ship == own:
        return []
    return [f"the trials are of '{ship}', '{called or predictor.name}' was trained for '{own}'"]


def words_of(integrator: Integrator) -> str:
    """The integrator as it is named beside J: "rk4", "euler, 2 substeps"."""
    return integrator.name + (f", {integrator.substeps} substeps" if integrator.substeps > 1 else "")


def cases_from(
    trials: Sequence[Trial],
    inputs: Sequence[str],
    draught: float | None,
    *,
    parts: Sequence[slice] | None = None,
    initial: Sequence[FloatArray] | None = None,
    target: Sequence[FloatArray] | None = None,
    weight: Sequence[FloatArray] | None = None,
) -> Cases:
    """Trials as cases, driven by their measured inputs, in what was measured around them.

    inputs   what drives the predictor
    draught  of the ship [m], see ``surroundings``; None of a predictor that has none
    parts    samples of each that are meant, all where None
    initial  (6,) state each starts from, that of its first sample where None
    target, weight  (n_samples, 6) as in ``Cases``
    Raises TrialError for a trial without one of the inputs.
    """
    parts = [slice(0, trial.n_samples) for trial in trials] if parts is None else parts
    both = list(zip(trials, parts, strict=True))
    return pad(
        [trial.t[part] for trial, part in both],
        [trial.inputs(inputs)[part] for trial, part in both],
        [trial.motion[part.start] for trial, part in both] if initial is None else initial,
        target,
        weight,
        (surroundings(trial, draught)[part] for trial, part in both),
    )


def portions(lengths: Sequence[int], n_members: int) -> Iterator[slice]:
    """Cases of these lengths in portions that are predicted at one time; a case is padded to the longest of them."""
    first, longest = 0, 0
    for k, length in enumerate(lengths):
        longest = max(longest, length)
        if k > first and (k + 1 - first) * longest * n_members > AT_ONCE:
            yield slice(first, k)
            first, longest = k, length
    if lengths:
        yield slice(first, len(lengths))
