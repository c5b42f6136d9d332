"""What an effect is: a way in which ship, surroundings or sensors differ from the model, absent at known values."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal, NamedTuple, Protocol

import numpy as np

from ..components import AT_LEAST_0, Component, Field
from ..inputs import Role
from ..physics.quantities import KNOWN, Force, Lanes, State, Surroundings
from ..units import DEG
from .visited import Visited

MOVING, TRIED = State(x=1.0, y=2.0, psi=0.3, u=1.0, v_m=-0.2, r=0.1), 0.01
"""A ship that moves every way [m, rad, m/s, rad/s], and how far from its null a sensor's parameter is tried on her."""


FASTER = 2.5
"""Factor on a logged wind or current up to which it is looked for."""


class Scale(NamedTuple):
    """Size of a ship, for bounds and typical values that hold for models and tankers alike."""

    L: float  # length between perpendiculars [m]
    d: float  # draught [m]
    U: float  # approach speed, or a tenth of sqrt(g L) where the profile has none [m/s]
    force: float  # 0.5 rho L d U^2 [N]
    n: float  # revolutions of the propeller at the approach speed [1/s]; 0 where the profile has none


@dataclass(frozen=True)
class Parameter(Field):
    """One number of an effect.

    null      value at which the effect is absent
    bounds    lowest and highest value looked at when searching for the effect, by ship; ``bounds_source`` says why
    typical   a size worth finding, by ship: signatures are taken over this distance from the null
    far       values far from the null that a search begins at too, by ship, where much is wrong: from the null no slope
              leads there
    of_run    lowest and highest value that is believed of a single run, by ship, where that is less than ``bounds``:
              values of runs bend to much else
    chart     "linear"; "reciprocal" where the null is at infinity; "polar" for a size followed by its direction
    """

    null: float = 0.0
    bounds: Callable[[Scale], tuple[float, float]] = lambda _: (-1.0, 1.0)
    typical: Callable[[Scale], float] = lambda _: 0.1
    far: Callable[[Scale], tuple[float, ...]] = lambda _: ()
    of_run: Callable[[Scale], tuple[float, float]] | None = None
    chart: str = "linear"
    bounds_source: str = ""

    def __post_init__(self) -> None:
        if self.default is None:
            object.__setattr__(self, "default", self.null)

    def searched(self, value: float) -> float:
        """What a value is searched for by, and the value of that again: itself, or its reciprocal where the null is at
        infinity.  ``bounds`` and ``typical`` are of this."""
        return 1.0 / value if self.chart == "reciprocal" else value


def factor_about_one(what: str, off: float, typical: float, source: str) -> Parameter:
    """A factor that changes nothing at 1, on what a sensor shows, an actuator does or a ship carries.

    off, typical  how far from 1 it is looked for, and a size worth finding; source says why no further than that
    """
    return Parameter(
        what,
        low=0.0,
        high=3.0,
        null=1.0,
        bounds=lambda _: (1.0 - off, 1.0 + off),
        typical=lambda _: typical,
        bounds_source=source,
    )


def rudder_angle_from(what: str, typical: float) -> Parameter:
    """A rudder or inflow angle [rad] from which on something happens to either side, absent at infinity; in a search at
    half a turn, which none reaches.

    typical  a size worth finding [deg]
    """
    return Parameter(
        what,
        "rad",
        null=float("inf"),
        low=0.0,
        chart="reciprocal",
        bounds=lambda _: (1.0 / np.pi, 1.0 / (8.0 * DEG)),
        typical=lambda _: 1.0 / (typical * DEG) - 1.0 / np.pi,
        bounds_source="from 8 deg to an angle no rudder reaches",
    )


def angle_about_zero(what: str, most: float, off: float) -> Parameter:
    """An angle [rad] by which what is shown, or stands, is off, absent at 0.

    most  the largest that a profile may say [rad]; off: how far [deg] it is looked for
    """
    return Parameter(
        what,
        "rad",
        low=-most,
        high=most,
        bounds=lambda _: (-off * DEG, off * DEG),
        typical=lambda _: 1.0 * DEG,
        bounds_source=f"beyond {off:g} deg anyone would see it",
    )


def velocity_of_water(what: str) -> Parameter:
    """A component [m/s] of the velocity of water over ground, absent at 0."""
    return Parameter(
        what,
        "m/s",
        bounds=lambda ship: (-0.6 * ship.U, 0.6 * ship.U),
        typical=lambda ship: 0.05 * ship.U,
        bounds_source="six tenths of the approach speed",
    )


def factor_on_measured(what: str, most: float, typical: float, source: str) -> Parameter:
    """The factor on something that was measured around the ship: as measured unless told otherwise, absent at 0.

    most, typical  the largest that is looked for, and a size worth finding; source says why no more than that
    """
    return Parameter(
        f"factor on {what} measured in the trial",
        default=1.0,
        low=AT_LEAST_0,
        high=5.0,
        null=0.0,
        bounds=lambda _: (0.0, most),
        typical=lambda _: typical,
        bounds_source=source,
    )


def turned_on_measured(what: str, comes: str) -> Parameter:
    """How far the direction of something that was measured around the ship is off [rad], absent at 0.

    comes  where it is logged from, or to: "comes from"
    """
    return Parameter(
        f"how far the logged direction of {what} is clockwise of where it {comes}",
        "rad",
        low=-np.pi,
        high=np.pi,
        bounds=lambda _: (-np.pi / 2.0, np.pi / 2.0),
        typical=lambda _: 10.0 * DEG,
        bounds_source="a right angle",
    )


def factor_on_flow_measured(what: str, typical: float) -> Parameter:
    """As ``factor_on_measured``, on a wind or a current; below 0 where its direction was logged the other way round."""
    source = "more than m/s that were taken for knots, either way"
    plain = factor_on_measured(what, FASTER, typical, source)
    label = f"{plain.label}, below 0 where it goes the other way"
    return replace(plain, label=label, low=-5.0, bounds=lambda _: (-FASTER, FASTER))


@dataclass(frozen=True, kw_only=True, repr=False)
class Effect(Component):
    """An effect: a component of kind "effects.<tag>".  Each place of the data flow has a class of its own below.

    place      where in the data flow it acts
    borrowed   fields of ``params`` after the parameters, with the profile's coefficient each is filled from
    variants   sets of parameters that are searched for together; each set is one hypothesis
    sentence   the cause in words a captain understands, from {parameter: number with unit and interval, as text}
    told_as    pairs of parameters, north and east [SI], told as a size and a direction too: names of these two
    pivots     parameters about which others are meant, {parameter: its value by ship where the effect is put into a
               profile}; they are never searched for
    read_off   pivots that the log of the trials says, {parameter: its value by what they visit}; at their null in
               manoeuvres from orders, which are no log
    rough      whether its formula is right to no more than some per cent of itself, so that what it leaves says little
    rough_with parameters with which it is so, as a change that is never quite even
    akin       tags of effects that act much alike: where one fits best, the others are fitted too
    refines    parameters that show only where others of the effect are known: a search looks for them beside these
    besides    parameters that a search looks for, and a fit with the effect tunes only where they are named
    form       parameters that say how far the force is off its formula, {parameter: one standard deviation about its
               null}; a search lets them go wherever it fits the effect, a fit tunes them only where they are named
    absorbed   coefficients of the profile that do the same as a parameter, {parameter: section.symbol}: where that one
               is tuned, the parameter is not searched for
    needs      coefficients the effect changes; it does not apply to a profile without them
    of_parts   parts of the arrangement's breakdown it works on; it does not apply to a ship without them
    one_of_many  its variants are many of one kind, of which chance finds the best: a search charges for the choice
    of_measured  parameters that act on what was measured around the ship, {parameter: one of ``quantities.KNOWN``}
    varies     parameters that may differ from run to run: what surrounds the ship, and what a crew changes between
               runs; variants of these alone are searched for with a value of each run, or group of runs, too
    subject    what differs then, as the subject of a sentence; the title where empty
    stand_in   parameters that say what there is where that was not measured; none where they are at their null
    beyond     what to say where surroundings are beyond what the effect holds for, from {section.symbol: number} and
               the surroundings of samples (n_samples,) each, of voyages those with the least and the largest of
               everything; "" where they are not, None where it holds in any
    told_by    what to measure that tells it from all else, be it on board, alongside or in a log; "" where nothing does
    unvisited  what trials would have to visit for a diagnosis to believe in the effect, from {parameter: value fitted}
               and what they do visit; "" where they visit it, None where any trials will do
    """

    place: ClassVar[str]
    borrowed: Mapping[str, str] = field(default_factory=dict)
    variants: tuple[tuple[str, ...], ...] = ()
    sentence: Callable[[Mapping[str, str]], str] = lambda _: ""
    told_as: Mapping[tuple[str, str], tuple[str, str]] = field(default_factory=dict)
    pivots: Mapping[str, Callable[[Scale], float]] = field(default_factory=dict)
    read_off: Mapping[str, Callable[[Visited], float]] = field(default_factory=dict)
    rough: bool = False
    rough_with: tuple[str, ...] = ()
    akin: tuple[str, ...] = ()
    refines: tuple[str, ...] = ()
    besides: tuple[str, ...] = ()
    form: Mapping[str, float] = field(default_factory=dict)
    absorbed: Mapping[str, str] = field(default_factory=dict)
    needs: tuple[str, ...] = ()
    of_parts: tuple[str, ...] = ()
    one_of_many: bool = False
    of_measured: Mapping[str, str] = field(default_factory=dict)
    varies: tuple[str, ...] = ()
    subject: str = ""
    stand_in: tuple[str, ...] = ()
    told_by: str = ""
    beyond: Callable[[Mapping[str, float], Surroundings], str] | None = None
    unvisited: Callable[[Mapping[str, float], Visited], str] | None = None

    def __post_init__(self) -> None:
        if (*self.fields, *self.borrowed) != self.params._fields:
            raise TypeError(f"effect '{self.tag}': {(*self.fields, *self.borrowed)} are not {self.params._fields}")
        unknown = set(self.of_measured.values()) - {*KNOWN}
        if unknown:
            raise TypeError(f"effect '{self.tag}': {', '.join(sorted(unknown))} is not one of {KNOWN}")
        if set(self.varies) - set(self.fields):
            raise TypeError(f"effect '{self.tag}': {', '.join(self.varies)} are not all parameters")
        if self.kind != f"effects.{self.tag}":
            raise TypeError(f"effect '{self.tag}': its kind is '{self.kind}', not 'effects.{self.tag}'")

    def __reduce__(self) -> tuple[Callable[..., Component | None], tuple[str, ...]]:
        """Pickled by tag, as components are.  Raises TypeError for an effect that no list and no entry point names."""
        from . import find_effect

        if find_effect(self.tag) is not self:
            raise TypeError(f"effect '{self.tag}' is not named by an entry point and cannot be found again")
        return find_effect, (self.tag,)

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The parameters by name."""
        return {name: field for name, field in self.fields.items() if isinstance(field, Parameter)}

    @property
    def nulls(self) -> dict[str, float]:
        """Where the parameters stand when it is absent; pivots may stand anywhere."""
        return {name: one.null for name, one in self.parameters.items() if name not in self.pivots}

    def is_absent(self, e: Any) -> bool:
        """Whether every lane of ``params`` has it at its null."""
        nulls = self.nulls
        return bool(nulls) and all(np.all(getattr(e, name) == null) for name, null in nulls.items())

    @property
    def of_the_day(self) -> bool:
        """Whether it is of the trials, not of the ship: current, wind, shallow water, errors of clocks and sensors."""
        return self.place in ("clock", "filter", "flow", "sensor") or bool(self.of_measured)

    @property
    def plain(self) -> dict[str, Parameter]:
        """Those that stand for the effect where nothing more is said: all but pivots, those beside, and its form."""
        more = {*self.pivots, *self.besides, *self.form}
        return {name: one for name, one in self.parameters.items() if name not in more}


@dataclass(frozen=True, kw_only=True, repr=False)
class ClockEffect(Effect):
    """When logged inputs acted: its first parameter is a time [s], and simulators sample the log accordingly.

    of    role of the inputs it is about; None for all of them
    late  who is late by that time: "log", which is a matter of the record alone, or "ship", which then answers late to
          every order, also where nothing is logged
    """

    place = "clock"
    function: None = None
    of: Role | None = None
    late: Literal["log", "ship"] = "log"

    @property
    def of_the_day(self) -> bool:
        """See ``Effect``; a ship that answers late does so on any day."""
        return self.late == "log"


class ActuatorFunction(Protocol):
    """What leaves the actuator of one input at the end of a step of h [s].

    start and end are what reaches it at the ends of the step, before is what left it at the beginning.
    """

    def __call__(self, start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: Any, /) -> Lanes: ...


class RestedFunction(Protocol):
    """What left the actuator of one input before the first sample, from what reaches it there."""

    def __call__(self, reached: Lanes, e: Any, /) -> Lanes: ...


@dataclass(frozen=True, kw_only=True, repr=False)
class ActuatorEffect(Effect):
    """On the way from a logged input to the ship; acts on every input of one role, each by itself.

    rested  what had left it before the first sample, from what reaches it there; None where that is the same
    """

    place = "actuator"
    function: ActuatorFunction
    of: Role
    rested: RestedFunction | None = None


class FlowFunction(Protocol):
    """Surge and sway velocity of the water itself, in the ship's axes [m/s]."""

    def __call__(self, state: State, around: Surroundings, e: Any, /) -> tuple[Lanes, Lanes]: ...


@dataclass(frozen=True, kw_only=True, repr=False)
class FlowEffect(Effect):
    """Water that moves.

    rate  how that velocity changes over ground, turned into the ship's axes [m/s^2]; None where the water is steady
    """

    place = "flow"
    function: FlowFunction
    rate: FlowFunction | None = None


class CoefficientsFunction(Protocol):
    """Coefficients that change, {section.symbol: new value}, from all of them."""

    def __call__(self, values: Mapping[str, Lanes], e: Any, /) -> Mapping[str, Lanes]: ...


@dataclass(frozen=True, kw_only=True, repr=False)
class CoefficientsEffect(Effect):
    """Other coefficients than the profile's; acts before any run."""

    place = "coefficients"
    function: CoefficientsFunction


class FactorsFunction(Protocol):
    """Factors on coefficients where the ship is, in the order of ``changes``."""

    def __call__(self, around: Surroundings, e: Any, /) -> tuple[Lanes, ...]: ...


ENTRAINED = ("particulars.m_x_", "particulars.m_y_", "particulars.J_zz_")
"""Of the particulars what is of the water carried along: the rest stays with a ship."""


@dataclass(frozen=True, kw_only=True, repr=False)
class FactorsEffect(Effect):
    """Coefficients that change on the way, with what is measured around the ship.

    changes  what is multiplied, by name: section.symbol, of the components of the arrangement; a symbol that a ship's
             own component does not have is passed over, unless ``needs`` has it too
    """

    place = "factors"
    function: FactorsFunction
    changes: tuple[str, ...]

    def __post_init__(self) -> None:
        super().__post_init__()
        if any(name.startswith("particulars.") and name not in ENTRAINED for name in self.changes):
            raise TypeError(f"effect '{self.tag}': of the particulars only added masses change on the way")


class ForceFunction(Protocol):
    """Force that is added; found is the arrangement's breakdown, components and p its functions and coefficients."""

    def __call__(self, state: State, around: Surroundings, found: Any, components: Any, p: Any, e: Any, /) -> Force: ...


@dataclass(frozen=True, kw_only=True, repr=False)
class ForceEffect(Effect):
    """A further force."""

    place = "force"
    function: ForceFunction


class LagFunction(Protocol):
    """Force that is added, and rates of the states of its own, ``behind``; h is the step of the integration [s]."""

    def __call__(self, found: Any, behind: Any, h: Lanes, e: Any, /) -> tuple[Force, tuple[Lanes, ...]]: ...


class StartFunction(Protocol):
    """States of its own at the first sample."""

    def __call__(self, found: Any, e: Any, /) -> tuple[Lanes, ...]: ...


@dataclass(frozen=True, kw_only=True, repr=False)
class LagEffect(Effect):
    """A force with a memory: any part of the breakdown, remembered in states that the integrator carries along.

    states  names of these, in the order of ``behind``
    """

    place = "lag"
    function: LagFunction
    start: StartFunction
    states: tuple[str, ...]


class SensorFunction(Protocol):
    """The state as the sensors log it."""

    def __call__(self, state: State, e: Any, /) -> State: ...


@dataclass(frozen=True, kw_only=True, repr=False)
class SensorEffect(Effect):
    """Between the motion and its log; ``inverse`` leads back."""

    place = "sensor"
    function: SensorFunction
    inverse: SensorFunction

    def shown_in(self, parameters: Collection[str]) -> tuple[str, ...]:
        """States whose logs parameters change while the ship moves alike."""
        others = dict.fromkeys((*self.fields, *self.borrowed), 1.0)  # what the ship has, whatever that is
        null = others | {name: one.null for name, one in self.parameters.items()} | dict.fromkeys(self.pivots, 0.5)
        null |= {name: self.parameters[name].null for name in self.read_off}
        off = {name: null[name] + TRIED for name in parameters}
        logs = [self.function(MOVING, self.params(**values)) for values in (null, {**null, **off})]
        return tuple(name for name in State._fields if getattr(logs[0], name) != getattr(logs[1], name))


class FilterFunction(Protocol):
    """What an instrument logs at the end of a step of h [s], and what it remembers then.

    start and end are what reaches it at the ends of the step, held is what it remembered at the beginning.
    """

    def __call__(self, start: State, end: State, held: Any, h: Lanes, e: Any, /) -> tuple[State, tuple[Lanes, ...]]: ...


class SettledFunction(Protocol):
    """What an instrument logs of a motion that has lasted, and what it remembers then."""

    def __call__(self, state: State, e: Any, /) -> tuple[State, tuple[Lanes, ...]]: ...


@dataclass(frozen=True, kw_only=True)
class FilterEffect(Effect):
    """Between what sensors show and the log, with a memory: what averages, is late or drifts.

    settled  what it logs at the first sample, before which the motion has lasted (assumption)
    inverse  leads back from there
    states   names of what it remembers, in the order of ``held``
    """

    place = "filter"
    function: FilterFunction
    settled: SettledFunction
    inverse: SensorFunction
    states: tuple[str, ...] = ()


EFFECTS_BY_PLACE: tuple[type[Effect], ...] = (
    ClockEffect,
    ActuatorEffect,
    FlowEffect,
    CoefficientsEffect,
    FactorsEffect,
    ForceEffect,
    LagEffect,
    SensorEffect,
    FilterEffect,
)
"""Kinds of effects in the order of the data flow."""

PLACES = tuple(kind.place for kind in EFFECTS_BY_PLACE)
"""Where in the data flow effects act, in its order."""
