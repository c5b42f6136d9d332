"""What an effect is: a way in which ship, surroundings or sensors differ from the model, absent at known values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ..components import Component, Field

PLACES = ("clock", "actuator", "flow", "coefficients", "force", "lag", "sensor")
"""Where in the data flow an effect acts, in the order of the flow.

clock         when the logged inputs acted; the simulators sample the log accordingly, no function
actuator      f(start, end, before, h [s], e) -> Control that leaves it at the end of a step of h; start and end are
              what reaches it at the ends of the step, before is what left it at the beginning (Control each)
flow          f(State, Air, e) -> surge and sway velocity of the water itself in ship axes [m/s]
coefficients  f(values {section.symbol: number or array}, e) -> those that change, {section.symbol: new value}
force         f(State, Air, Breakdown, Components, Coefficients, e) -> Force that is added
lag           f(hull Force, lagging Y [N], lagging N [N m], h [s], e) -> Force that is added, rates of the two; h is
              the step of the integration
sensor        f(State, e) -> State as the sensors log it, and ``inverse`` back
"""


class Scale(NamedTuple):
    """Size of a ship, for bounds and typical values that hold for models and tankers alike."""

    L: float  # length between perpendiculars [m]
    d: float  # draught [m]
    U: float  # approach speed, or a tenth of sqrt(g L) where the profile has none [m/s]
    force: float  # 0.5 rho L d U^2 [N]


@dataclass(frozen=True)
class Parameter(Field):
    """One number of an effect.

    null      value at which the effect is absent
    bounds    lowest and highest value looked at when searching for the effect, by ship; ``bounds_source`` says why
    typical   a size worth finding, by ship: signatures are taken over this distance from the null
    chart     "linear"; "reciprocal" where the null is at infinity; "polar" for a size followed by its direction
    """

    null: float = 0.0
    bounds: Callable[[Scale], tuple[float, float]] = lambda _: (-1.0, 1.0)
    typical: Callable[[Scale], float] = lambda _: 0.1
    chart: str = "linear"
    bounds_source: str = ""

    def __post_init__(self) -> None:
        if self.default is None:
            object.__setattr__(self, "default", self.null)


@dataclass(frozen=True)
class Effect(Component):
    """An effect: a component of kind "effects.<tag>" with a place in the data flow.

    borrowed   fields of ``params`` after the parameters, with the profile's coefficient each is filled from
    variants   sets of parameters that are searched for together; each set is one hypothesis
    sentence   the cause in words a captain understands, from {parameter: number with unit and interval, as text}
    absorbed   coefficients of the profile that do the same as a parameter, {parameter: section.symbol}: where that one
               is tuned, the parameter is not searched for
    needs      coefficients the effect changes; it does not apply to a profile without them
    inverse    of a sensor
    of_measured_wind  parameters that act on measured wind; others of the same effect stand in where there is none
    """

    place: str = "force"
    borrowed: Mapping[str, str] = field(default_factory=dict)
    variants: tuple[tuple[str, ...], ...] = ()
    sentence: Callable[[Mapping[str, str]], str] = lambda _: ""
    absorbed: Mapping[str, str] = field(default_factory=dict)
    needs: tuple[str, ...] = ()
    inverse: Callable[..., Any] | None = None
    of_measured_wind: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if (*self.fields, *self.borrowed) != self.params._fields:
            raise TypeError(f"effect '{self.tag}': {(*self.fields, *self.borrowed)} are not {self.params._fields}")
        if self.place not in PLACES:
            raise TypeError(f"effect '{self.tag}': place '{self.place}' is not one of {', '.join(PLACES)}")
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
