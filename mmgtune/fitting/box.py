"""The coefficients that are tuned and the box they may move in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
import numpy.typing as npt

from ..errors import OptionError, Problem, closest
from ..model import Model

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Box:
    """Targets by name with their pre-determined values and bounds, (n_targets,) each, in profile units.

    Searches work in the unit cube: 0 at the lower bound, 1 at the upper.
    """

    names: tuple[str, ...]
    pre: FloatArray
    low: FloatArray
    high: FloatArray

    def __len__(self) -> int:
        return len(self.names)

    @property
    def width(self) -> FloatArray:
        """Distance between the bounds."""
        return self.high - self.low

    def to_unit(self, values: npt.ArrayLike) -> FloatArray:
        """Positions in the unit cube of values (n_targets,) or (n_targets, n_candidates)."""
        columns = np.asarray(values, dtype=float)
        low, width = (end if columns.ndim == 1 else end[:, None] for end in (self.low, self.width))
        return (columns - low) / width

    def from_unit(self, unit: npt.ArrayLike) -> FloatArray:
        """Values at positions in the unit cube; exactly the bounds at 0 and 1 (positions outside lie outside)."""
        z = np.asarray(unit, dtype=float)
        low, high = (end if z.ndim == 1 else end[:, None] for end in (self.low, self.high))
        return np.where(z == 1.0, high, low + z * (high - low))


def make_box(model: Model, targets: Sequence[str], a_r: float) -> Box:
    """The box pre +- a_r |pre| (Suyama et al. 2023, eq. 38), or a coefficient's own bounds where its profile has some.

    Limits of what is possible (a wake fraction below 1, say) cut the box where it would go beyond them.  Raises
    OptionError for a_r <= 0, no targets, and targets that are 0 and have no bounds of their own.
    """
    if not (np.isfinite(a_r) and a_r > 0.0):
        raise OptionError(
            Problem(
                f"a_r is {a_r:g}",
                "--ar",
                "the box would have no room",
                "give the half width as a share, such as --ar 0.5",
            )
        )
    if not targets:
        raise OptionError(
            Problem(
                "no coefficient to tune",
                "--targets",
                "the profile lists none",
                'name some, such as --targets "hull.Y_*"',
            )
        )
    problems: list[Problem] = []
    bounds: list[tuple[float, float]] = []
    for name in targets:
        coefficient = model.profile.coefficient(name)
        value = model.profile.value(name)
        if coefficient.bounds is not None:
            bounds.append(coefficient.bounds)
            continue
        if value == 0.0:
            problems.append(
                Problem(
                    f"target '{name}' is 0",
                    "--targets",
                    "a box of +- a_r times its value has no width",
                    "give it bounds in the profile, { value = 0.0, bounds = [low, high] }, or leave it out",
                )
            )
        bounds.append((value - a_r * abs(value), value + a_r * abs(value)))
    if problems:
        raise OptionError(*problems)
    low, high = np.array(bounds).T
    pre = np.array([model.profile.value(name) for name in targets])
    for i, name in enumerate(targets):
        section, _, symbol = name.partition(".")
        field = model.profile.sections[section].component.fields[symbol]
        if field.low is not None:
            low[i] = max(low[i], field.low + 1e-6 * abs(pre[i]))
        if field.high is not None:
            high[i] = min(high[i], field.high - 1e-6 * abs(pre[i]))
    return Box(tuple(targets), pre, low, high)


def choose_targets(model: Model, patterns: Sequence[str], fixed: Sequence[str] = ()) -> tuple[str, ...]:
    """Names of the coefficients to tune: those the patterns match, the profile's own list where there are none.

    A pattern is a name, "R_0" for any section, or has wildcards: "hull.Y_*".  A pattern skips coefficients that are
    0 without bounds of their own.  Raises OptionError for a pattern or a ``fixed`` name that matches nothing.
    """
    profile = model.profile
    names = [name for name in profile.names() if not _is_choice(model, name)]

    def matching(pattern: str, among: Sequence[str], option: str) -> list[str]:
        found = [n for n in among if fnmatchcase(n, pattern) or fnmatchcase(n.partition(".")[2], pattern)]
        if not found:
            raise OptionError(
                Problem(
                    f"no coefficient is called '{pattern}'",
                    option,
                    fix=closest(pattern, [*names, *(n.partition(".")[2] for n in names)]),
                )
            )
        return found

    chosen: list[str] = []
    for pattern in patterns or profile.targets:
        found = matching(pattern, names, "--targets")
        if any(sign in pattern for sign in "*?["):
            found = [n for n in found if profile.value(n) != 0.0 or profile.coefficient(n).bounds is not None]
        chosen += found
    for pattern in fixed:
        held = matching(pattern, names, "--fix")
        chosen = [name for name in chosen if name not in held]
    return tuple(dict.fromkeys(chosen))


def _is_choice(model: Model, name: str) -> bool:
    section, _, symbol = name.partition(".")
    return bool(model.profile.sections[section].component.fields[symbol].choices)
