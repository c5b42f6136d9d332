"""The coefficients that are tuned and the box they may move in.

Most are searched for as they are.  A parameter whose null is at infinity is searched for by its reciprocal, and a size
with a direction by its two components, so that the null is a point like any other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray, IntArray
from ..components import split_name
from ..displayed import Brief
from ..effects import Parameter
from ..errors import OptionError, Problem, closest
from ..model import Model
from ..profile import scale_of

A_R = 0.5
"""Half width of the box where nothing else is said, as a share of the pre-determined value."""

SCATTERS = 2.0
"""Half width of the box of a coefficient from a formula that says its scatter: nineteen ships of twenty lie within."""


def width_words(a_r: float | None, sign: str = "+-", scatters: float = SCATTERS) -> str:
    """How wide a box is, in words; None where scatters of formulas make it."""
    if a_r is None:
        return f"{scatters:g} scatters of the formulas, else {sign}{A_R:g}"
    return f"{sign}{a_r:g}"


AT = "@"
"""Between a coefficient and the group of cases it is of, in the name of a target: "wake.w_P0@trial:run_1"."""


def base_of(name: str) -> str:
    """The coefficient that a target is the value of, for all cases or for a group of them."""
    return name.partition(AT)[0]


def group_of(name: str) -> str:
    """The group of cases that a target is of, "" for all."""
    return name.partition(AT)[2]


@dataclass(frozen=True, eq=False, repr=False)
class Box(Brief):
    """Targets by name with their pre-determined values, (n_targets,), in profile units, and bounds.

    Searches work in the unit cube: 0 at the lower bound, 1 at the upper.

    low, high   (n_targets,) bounds in coordinates of the search: the value itself, its reciprocal, or a component
    reciprocal  targets searched for by their reciprocal
    polar       pairs of targets, a size and its direction [rad], searched for by their components
    centre, scatter  (n_targets,) what the formula of each gives, and how far ships lie about it, one standard
                deviation; NaN for one that comes from no formula or whose formula does not say.  None for no target
    """

    names: tuple[str, ...]
    pre: FloatArray
    low: FloatArray
    high: FloatArray
    reciprocal: tuple[int, ...] = ()
    polar: tuple[tuple[int, int], ...] = ()
    centre: FloatArray | None = None
    scatter: FloatArray | None = None

    def __len__(self) -> int:
        return len(self.names)

    @property
    def width(self) -> FloatArray:
        """Distance between the bounds."""
        return self.high - self.low

    def part(self, names: Sequence[str]) -> Box:
        """The box of some targets, in their order; one of a group of cases has the bounds of its coefficient."""
        bases = [base_of(name) for name in names]
        at = [self.names.index(base) for base in bases]
        place = {name: k for k, name in enumerate(names)}

        def beside(k: int, j: int) -> int | None:
            """Index of coefficient j of the same group of cases as target k."""
            group = group_of(names[k])
            return place.get(f"{self.names[j]}{AT}{group}" if group else self.names[j])

        pairs = ((k, beside(k, j)) for k, i in enumerate(at) for first, j in self.polar if i == first)
        return Box(
            tuple(names),
            self.pre[at],
            self.low[at],
            self.high[at],
            tuple(k for k, i in enumerate(at) if i in self.reciprocal),
            tuple((k, other) for k, other in pairs if other is not None),
        )

    @property
    def from_formula(self) -> IntArray:
        """Targets whose formula says its scatter, by number."""
        return np.flatnonzero(np.isfinite(self.scatter)) if self.scatter is not None else np.zeros(0, dtype=np.int64)

    def prior_of(self, i: int) -> tuple[float, float] | None:
        """What the formula of target ``i`` gives, and its scatter; None where there is none or it does not say."""
        if self.centre is None or self.scatter is None or not np.isfinite(self.scatter[i]):
            return None
        return float(self.centre[i]), float(self.scatter[i])

    @property
    def relative(self) -> FloatArray:
        """Reference value of relative changes of each target: its pre-determined value, or its width where that is 0 or
        infinite."""
        return np.abs(np.where((self.pre != 0.0) & np.isfinite(self.pre), self.pre, self.width))

    def bound_at(self, i: int, z: float) -> str | None:
        """ "low" or "high" where target ``i`` at z in the cube has its lowest or highest value, None between."""
        if 0.0 < z < 1.0:
            return None
        return "low" if (z <= 0.0) != (i in self.reciprocal) else "high"

    @property
    def charted(self) -> set[int]:
        """Targets that are not searched for as they are."""
        return {*self.reciprocal, *(i for pair in self.polar for i in pair)}

    @property
    def limits(self) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest value of each target, in profile units."""
        low, high = self.low.copy(), self.high.copy()
        for i in self.reciprocal:
            with np.errstate(divide="ignore"):
                low[i], high[i] = 1.0 / self.high[i], 1.0 / self.low[i]
        for i, j in self.polar:
            low[i], low[j], high[j] = 0.0, -np.pi, np.pi
        return low, high

    def to_unit(self, values: npt.ArrayLike) -> FloatArray:
        """Positions in the unit cube of values (n_targets,) or (n_targets, n_candidates)."""
        columns = np.array(values, dtype=float)
        with np.errstate(divide="ignore"):
            for i in self.reciprocal:
                columns[i] = 1.0 / columns[i]
        for i, j in self.polar:
            columns[i], columns[j] = columns[i] * np.cos(columns[j]), columns[i] * np.sin(columns[j])
        low, width = (end if columns.ndim == 1 else end[:, None] for end in (self.low, self.width))
        return (columns - low) / width

    def from_unit(self, unit: npt.ArrayLike) -> FloatArray:
        """Values at positions in the unit cube; exactly the bounds at 0 and 1 (positions outside lie outside)."""
        z = np.asarray(unit, dtype=float)
        low, high = (end if z.ndim == 1 else end[:, None] for end in (self.low, self.high))
        values = np.where(z == 1.0, high, low + z * (high - low))
        with np.errstate(divide="ignore"):
            for i in self.reciprocal:
                values[i] = 1.0 / values[i]
        for i, j in self.polar:
            values[i], values[j] = np.hypot(values[i], values[j]), np.arctan2(values[j], values[i])
        return values


def make_box(model: Model, targets: Sequence[str], a_r: float | None, scatters: float = SCATTERS) -> Box:
    """The box pre +- a_r |pre| (Suyama et al. 2023, eq. 38), or a coefficient's own bounds where its profile has some.

    Without a_r it is pre +- ``scatters`` for a coefficient whose formula says its scatter, pre +- 0.5 |pre| for others.
    Limits of what is possible (a wake fraction below 1, say) cut the box where it would go beyond them.  Raises
    OptionError for a_r <= 0, no targets, and targets that are 0 and have no bounds of their own.
    """
    if a_r is not None and not (np.isfinite(a_r) and a_r > 0.0):
        raise OptionError(
            Problem(
                f"a_r is {a_r:g}",
                "a_r",
                "the box would have no room",
                "give the half width as a share, such as a_r=0.5",
            )
        )
    if not targets:
        raise OptionError(
            Problem(
                "no coefficient to tune",
                "targets",
                "the profile lists none",
                'name some, such as targets="hull.Y_*"',
            )
        )
    problems: list[Problem] = []
    bounds: list[tuple[float, float]] = []
    reciprocal: list[int] = []
    polar: list[tuple[int, int]] = []
    scale = scale_of(model.profile)
    for i, name in enumerate(targets):
        coefficient = model.profile.coefficient(name)
        value = model.profile.value(name)
        parameter = parameter_of(model, name)
        if parameter is not None:
            chart = parameter.chart
            low, high = coefficient.bounds or parameter.bounds(scale)
            if chart == "reciprocal":
                reciprocal.append(i)
                low, high = (1.0 / high, 1.0 / low) if coefficient.bounds else (low, high)
            if chart == "polar" and _direction_of(model, name) in targets:
                polar.append((i, list(targets).index(_direction_of(model, name))))
                low = -high
            bounds.append((low, high))
            continue
        if coefficient.bounds is not None:
            bounds.append(coefficient.bounds)
            continue
        if a_r is None and coefficient.scatter is not None:
            bounds.append((value - scatters * coefficient.scatter, value + scatters * coefficient.scatter))
            continue
        if value == 0.0:
            problems.append(
                Problem(
                    f"target '{name}' is 0",
                    "targets",
                    "a box of +- a_r times its value has no width",
                    "give it bounds in the profile, { value = 0.0, bounds = [low, high] }, or leave it out",
                )
            )
        half = (A_R if a_r is None else a_r) * abs(value)
        bounds.append((value - half, value + half))
    if problems:
        raise OptionError(*problems)
    for i, j in polar:
        bounds[j] = bounds[i]
    low, high = np.array(bounds).T
    pre = np.array([model.profile.value(name) for name in targets])
    for i, name in enumerate(targets):
        if i in reciprocal or any(i in pair for pair in polar):
            continue
        section, symbol = split_name(name)
        field = model.profile.sections[section].component.fields[symbol]
        if field.low is not None:
            low[i] = max(low[i], field.low + 1e-6 * abs(pre[i]))
        if field.high is not None:
            high[i] = min(high[i], field.high - 1e-6 * abs(pre[i]))
    return Box(tuple(targets), pre, low, high, tuple(reciprocal), tuple(polar), *_formulas(model, targets))


def _formulas(model: Model, targets: Sequence[str]) -> tuple[FloatArray | None, FloatArray | None]:
    """What the formulas of targets give, before any tuning, and their scatter; see ``Box``."""
    known = [model.profile.coefficient(name) for name in targets]
    if all(one.scatter is None for one in known):
        return None, None
    centre = [
        model.profile.value(name) if one.pre_determined is None else one.pre_determined
        for name, one in zip(targets, known, strict=True)
    ]
    scatter = np.array([np.nan if one.scatter is None else one.scatter for one in known])
    return np.where(np.isfinite(scatter), centre, np.nan), scatter


def parameter_of(model: Model, name: str) -> Parameter | None:
    """The parameter of an effect called that, None for a coefficient of a component."""
    section, symbol = split_name(base_of(name))
    found = model.profile.sections[section].component.fields[symbol]
    return found if isinstance(found, Parameter) else None


def _direction_of(model: Model, name: str) -> str:
    """The direction that belongs to a size: the parameter after it."""
    section, symbol = split_name(name)
    symbols = list(model.profile.sections[section].component.fields)
    return f"{section}.{symbols[symbols.index(symbol) + 1]}"


def choose_targets(model: Model, patterns: Sequence[str], fixed: Sequence[str] = ()) -> tuple[str, ...]:
    """Names of the coefficients to tune: those the patterns match, the profile's own list where there are none.

    A pattern is a name, "R_0" for any section, or has wildcards: "hull.Y_*".  A pattern with wildcards skips
    coefficients that are 0 without bounds of their own.

    Raises OptionError for a pattern or a ``fixed`` name that matches nothing.
    """
    profile = model.profile
    names = [name for name in profile.names() if not _is_choice(model, name)]

    def matching(pattern: str, among: Sequence[str], option: str) -> list[str]:
        found = [n for n in among if fnmatchcase(n, pattern) or fnmatchcase(split_name(n)[1], pattern)]
        if not found:
            raise OptionError(
                Problem(
                    f"no coefficient is called '{pattern}'",
                    option,
                    f"of the {len(names)} coefficients that the profile lets be tuned none fits that",
                    closest(pattern, [*names, *(split_name(n)[1] for n in names)]),
                )
            )
        return found

    chosen: list[str] = []
    for pattern in patterns or profile.targets:
        found = matching(pattern, names, "targets")
        if any(sign in pattern for sign in "*?["):
            found = [n for n in found if profile.value(n) != 0.0 or profile.coefficient(n).bounds is not None]
        chosen += found
    for pattern in fixed:
        held = matching(pattern, names, "fixed")
        chosen = [name for name in chosen if name not in held]
    return tuple(dict.fromkeys(chosen))


def _is_choice(model: Model, name: str) -> bool:
    section, symbol = split_name(name)
    return bool(model.profile.sections[section].component.fields[symbol].choices)
