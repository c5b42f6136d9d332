"""What differed from run to run: a value of each run, or group of runs, with its interval."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.special import fdtrc

from ...arrays import FloatArray
from ...documents import finite
from ...effects import Effect, Visited
from ...fitting.box import AT
from ...phrases import listed, on_compass
from ...trial import Trial, visited_by
from ...units import DIMENSIONLESS, NORMAL_95
from ..bench.runs import FEWEST_GROUPS, IN_WORDS, groups_of, name_of
from ..signatures.intervals import Estimate
from ..signatures.wording import LITTLE, error_in_words, quantity, range_in_words

ALIKE = 0.2
"""Difference from the mean of all runs, over that, up to which values with a direction are much the same."""

WIDE = 2.0 * math.pi / 3.0
"""Sector [rad] beyond which directions have nothing in common."""

CERTAIN = 3.0
"""Standard errors from which the value of a run is other than none at all."""

SEVERAL, CLEARLY = 4, 2.0
"""Groups of which one alone may be chance, and times what is certain from which it is not."""

IN_STEP = 2.0
"""Standard error of a value over that of its distance from the mean of all, from which all are known better beside each
other than alone: what they have in common is then told once."""

ODD = 5.0
"""Times the range of the values of all other runs by which a run is off that is named."""

GIVEN: dict[str, tuple[Callable[[Visited], float], str]] = {
    "the largest rudder angle": (lambda run: run.largest_rudder, "rad"),
    "the revolutions": (lambda run: float(np.nanmean(run.shaft)) if np.isfinite(run.shaft).any() else math.nan, "1/s"),
}
"""What is ordered in a run and may be behind values that differ from run to run, and its unit.  Not how she moves: that
follows from such values."""

FEWEST_KINDS, APART, BY_CHANCE = 3, 0.1, 3e-3
"""Kinds of runs it takes, share of the largest by which what was ordered differs between those of different kinds, and
probability (F-test) that values lie along a line with it by chance from which they do not."""

Told = tuple[float, float | None]
"""A value and its standard error."""


@dataclass(frozen=True, eq=False)
class ByRun:
    """Values of an effect, one for each group of runs.

    by      the grouping; see ``runs``
    groups  labels of the groups
    trials  ids of the trials of each
    values  estimates by group and parameter, in profile units
    given   what was ordered in the runs of each, by what it is called in words: see ``GIVEN``
    """

    effect: Effect
    variant: tuple[str, ...]
    by: str
    groups: tuple[str, ...]
    trials: tuple[tuple[str, ...], ...]
    values: tuple[Mapping[str, Estimate], ...]
    given: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        effect: Effect,
        variant: tuple[str, ...],
        by: str,
        groups: Sequence[str],
        trials: Sequence[Trial],
        found: Mapping[str, Estimate],
    ) -> ByRun:
        """From estimates by the name of the target."""
        order = sorted(groups)
        of_group = [[trial for trial in trials if f"{by}:{groups_of(trial)[by]}" == label] for label in order]
        ids = [tuple(dict.fromkeys(trial.whole for trial in own)) for own in of_group]
        values = [{name: found[f"{effect.kind}.{name}{AT}{label}"] for name in variant} for label in order]
        visited = [visited_by(own, 1.0) for own in of_group]
        given = {what: tuple(asked(one) for one in visited) for what, (asked, _) in GIVEN.items()}
        return cls(effect, variant, by, tuple(order), tuple(ids), tuple(values), given)

    @property
    def unit(self) -> str:
        """Unit of the first size."""
        return self.effect.parameters[self.variant[0]].unit

    def size(self, k: int) -> Told:
        """The value of a group that is spoken of first: the speed of a current, or the parameter itself."""
        pair = next((pair for pair in self.effect.told_as if set(pair) <= set(self.variant)), None)
        if pair is None:
            first = self.values[k][self.variant[0]]
            return first.value, first.stderr
        north, east = (self.values[k][name] for name in pair)
        length = math.hypot(north.value, east.value)
        share = [one.value / max(length, 1e-12) * (one.stderr or 0.0) for one in (north, east)]
        return length, math.hypot(*share)

    def towards(self, k: int) -> Told | None:
        """The direction of a group's value [rad], where it has one."""
        pair = next((pair for pair in self.effect.told_as if set(pair) <= set(self.variant)), None)
        if pair is not None:
            north, east = (self.values[k][name] for name in pair)
            length = max(math.hypot(north.value, east.value), 1e-12)
            error = math.hypot(east.value * (north.stderr or 0.0), north.value * (east.stderr or 0.0)) / length**2
            return math.atan2(east.value, north.value) % (2.0 * math.pi), error
        if self.effect.parameters[self.variant[0]].chart == "polar":
            second = self.values[k][self.variant[1]]
            return second.value % (2.0 * math.pi), second.stderr
        return None

    def shows(self, k: int) -> bool:
        """Whether the values of a group are beyond doubt other than none at all."""
        return self._far(k) > CERTAIN**2 + len(self._sizes)

    @property
    def in_none(self) -> bool:
        """Whether no group has a value beyond doubt, nor one that stands out beside the others."""
        return not any(map(self.shows, range(len(self.groups)))) and self._differ_in_step is None

    def _far(self, k: int) -> float:
        """How far the values of a group are from none at all: squares of their standard errors, summed."""
        far = 0.0
        for name in self._sizes:
            one, parameter = self.values[k][name], self.effect.parameters[name]
            if parameter.chart == "reciprocal":  # an end of its interval is infinite where there may be none
                far += 0.0 if one.high is None else math.inf
            elif one.stderr:
                far += ((one.value - parameter.null) / one.stderr) ** 2
        return far

    def from_mean(self, k: int) -> Told | None:
        """Distance of a group's value from the mean of all, where these distances are known better than the values;
        else None."""
        own = [one[self.variant[0]] for one in self.values]
        if len(self.variant) > 1 or len(own) < 2 or not all(self._better_apart(one) for one in own):
            return None
        return own[k].value - float(np.mean([one.value for one in own])), own[k].apart

    @staticmethod
    def _better_apart(one: Estimate) -> bool:
        return one.apart is not None and one.stderr is not None and one.stderr > IN_STEP * one.apart

    @property
    def doubt(self) -> str:
        """Why the values are none of the runs, in words; "" where nothing says so."""
        if with_what := self.goes_with:
            return f"its values go with {with_what}, and so with something else than the run"
        return f"only one {IN_WORDS[self.by]} has a value for certain, and hardly" if self._hangs_on_one else ""

    @property
    def _hangs_on_one(self) -> bool:
        """Whether of several groups a single one has a value for certain, and hardly, and none stands out beside the
        others: a value of a run bends to whatever else is in it."""
        clearly = (CLEARLY * CERTAIN) ** 2 + len(self._sizes)
        shown = [k for k in range(len(self.groups)) if self.shows(k)]
        alone = len(self.groups) >= SEVERAL and len(shown) == 1 and self._far(shown[0]) <= clearly
        return alone and self._differ_in_step is None

    @property
    def goes_with(self) -> str:
        """Order that the values of all groups follow along a straight line, beyond chance: then the cause goes with the
        order, not with the run. In words; "" for none.
        """
        return self._following(lambda kinds: len(kinds) >= FEWEST_KINDS)

    @property
    def may_go_with(self) -> str:
        """Order that the values may follow where there are only two kinds of runs, some of each: these may also have
        been run at different places."""
        return self._following(lambda kinds: len(kinds) == 2 and min(kinds) > 1)

    def _following(self, enough: Callable[[list[int]], bool]) -> str:
        """Order that the values follow along a straight line, where there are enough runs of each kind; see
        ``goes_with``.

        Only for effects with one size: two may follow anything.
        """
        if len(self.variant) > 1:
            return ""
        values = np.array([self.size(k)[0] for k in range(len(self.groups))])
        for what, (_, unit) in GIVEN.items():
            at = np.array(self.given.get(what, ()))
            kinds = _kinds(at)
            if enough(kinds) and _along_a_line(at, values):
                some = np.argsort(at)[[0, len(at) // 2, -1] if len(kinds) > 2 else [0, -1]]
                told = [f"{quantity(values[k], None, self.unit)} at {quantity(at[k], None, unit)}" for k in some]
                return f"{what} of the runs ({', '.join(told)})"
        return ""

    @property
    def _differ_in_step(self) -> float | None:
        """Standard error of distances from the mean of all, where some are beyond doubt other than none; else None."""
        apart = [told for k in range(len(self.groups)) if (told := self.from_mean(k))]
        errors = [error for _, error in apart if error]
        if not errors or not any(abs(value) > CERTAIN * error for value, error in apart if error):
            return None
        return max(errors)

    @property
    def _sizes(self) -> tuple[str, ...]:
        """Parameters that are sizes, no directions."""
        polar = self.effect.parameters[self.variant[0]].chart == "polar"
        return self.variant[:1] if polar else self.variant

    @property
    def sentence(self) -> str:
        """In words."""
        word = IN_WORDS[self.by]
        subject = self.effect.subject or self.effect.title
        shown = [k for k in range(len(self.groups)) if self.shows(k)]
        if (beside := self._differ_in_step) is not None:
            told = self._in_step_in_words(beside)
            return f"The {subject} differed from {word} to {word}: {told}{self._at_end}{self._doubted}"
        if not shown:
            return f"The {subject} may have differed from {word} to {word}, in none for certain{self._doubted}"
        sizes = [self.size(k)[0] for k in shown]
        others = len(self.groups) - len(shown)
        text = f"The {subject} differed from {word} to {word}: "
        if self.by == "group" and len(shown) == len(self.groups) == FEWEST_GROUPS and not self._much_alike:
            each = listed([self._told_of(k) for k in shown])
            return text + self._number_of + each + self._within() + self._doubted
        if self._much_alike:
            text = f"The {subject} was much the same in each {word}: "
        if len(shown) == 1 and others:
            value, error = self.size(shown[0])
            size = quantity(value, None if error is None else NORMAL_95 * error, self.unit) + self._of_what
            where = name_of(self.groups[shown[0]])
            text += f"{self._number_of}{size} in {where}, and none for certain in the {_others(others)}"
        else:
            if others:
                of_all = range_in_words(min(sizes), max(sizes), self.unit) + self._of_what
            else:
                of_all = self._of_all(max(error or 0.0 for _, error in map(self.size, shown)))
            text += f"{self._number_of}{of_all}{self._each_known_to(shown)}"
            several = [name_of(self.groups[k]) for k in shown]
            text += f" in {listed(several, 4)}, and none for certain in the {_others(others)}" if others else ""
        return text + self._all_towards(shown) + self._within() + self._at_end + self._doubted

    def _told_of(self, k: int) -> str:
        """Size, direction and name of a group, in words."""
        value, error = self.size(k)
        size = quantity(value, None if error is None else NORMAL_95 * error, self.unit) + self._of_what
        return f"{size}{self._all_towards([k]).removeprefix(',')} in {name_of(self.groups[k])}"

    def _each_known_to(self, shown: Sequence[int]) -> str:
        """The error of values that are much the same, where it is larger than they differ by; else ""."""
        sizes, errors = zip(*(self.size(k) for k in shown), strict=True)
        half = NORMAL_95 * max(error or 0.0 for error in errors)
        if not self._much_alike or half <= max(sizes) - min(sizes):
            return ""
        return f", each known to ± {error_in_words(half, self.unit)}"

    @property
    def _doubted(self) -> str:
        """Warning that something other than the run may be behind the values; "" for none."""
        if with_what := self.may_go_with:
            return f"; it goes with {with_what}, so that what changes with it would look the same"
        return ""

    def _in_step_in_words(self, beside: float) -> str:
        """From the least to the largest, with what is common to all errors told once."""
        common = max(error or 0.0 for _, error in map(self.size, range(len(self.groups))))
        half, between = (error_in_words(NORMAL_95 * error, self.unit) for error in (common, beside))
        of_all = self._number_of + self._of_all(beside, in_step=True)
        return f"{of_all}, known to ± {between} beside each other and to ± {half} all together"

    def _of_all(self, error: float, in_step: bool = False) -> str:
        """From the least to the largest, or that of one run and those of all others, which are alike.

        error    standard error of a difference
        in_step  whether values differ beyond doubt, however little
        """
        sizes = np.array([self.size(k)[0] for k in range(len(self.groups))])
        far = np.abs(sizes - np.median(sizes))
        odd = int(np.argmax(far))
        rest = np.delete(sizes, odd)
        off, apart = abs(sizes[odd] - rest.mean()), float(np.ptp(rest))
        if len(rest) < FEWEST_GROUPS or self._directed or off <= max(ODD * apart, CERTAIN * error):
            little = 0.0 if in_step else LITTLE
            return range_in_words(float(sizes.min()), float(sizes.max()), self.unit, little) + self._of_what
        alike = range_in_words(float(rest.min()), float(rest.max()), self.unit)
        own = f"{quantity(float(sizes[odd]), None, self.unit)}{self._of_what} in {name_of(self.groups[odd])}"
        return f"{own} and {alike} in the other {len(rest)}"

    @property
    def _directed(self) -> bool:
        """Whether the values have directions."""
        return self.towards(0) is not None

    @property
    def _at_end(self) -> str:
        """Whose values are at the end of what was looked for, in words; "" for nobody's."""
        ended = [k for k in range(len(self.groups)) if any(self.values[k][name].at_end for name in self._sizes)]
        shown = listed([name_of(self.groups[k]) for k in ended if self.shows(k)], 4)
        return f"; in {shown} it is at the end of what was looked for, and may lie beyond it" if shown else ""

    @property
    def _much_alike(self) -> bool:
        """Whether what has a direction differs little beside its mean."""
        values = self._vectors
        return bool(len(values)) and bool(np.abs(values - values.mean()).max() < ALIKE * abs(values.mean()))

    @property
    def _vectors(self) -> npt.NDArray[np.complex128]:
        """Values of the groups in the plane, of what has a direction."""
        towards = [self.towards(k) for k in range(len(self.groups))]
        return np.array([self.size(k)[0] * np.exp(1j * told[0]) for k, told in enumerate(towards) if told])

    def _all_towards(self, shown: Sequence[int]) -> str:
        """The directions of the values of some groups, in words; "" for what has none."""
        sense = "towards" if self.effect.told_as else "from"
        if self._much_alike:
            return f", {sense} {on_compass(np.angle(self._vectors.mean()))}"
        sector = self._sector(shown)
        if sector is None:
            return ""
        if sector[1] - sector[0] > WIDE:
            return f", {sense} no common direction"
        ends = dict.fromkeys(f"{round(math.degrees(end)) % 360:03d}" for end in sector)
        return f", {sense} {' to '.join(ends)}°"

    def _sector(self, groups: Iterable[int]) -> tuple[float, float] | None:
        """From which direction to which [rad] the values of some groups point; None where they have none."""
        angles = np.array([told[0] for k in groups if (told := self.towards(k))])
        if not len(angles):
            return None
        middle = float(np.angle(np.exp(1j * angles).sum()))
        off = [math.remainder(angle - middle, 2.0 * math.pi) for angle in angles.tolist()]
        return middle + min(off), middle + max(off)

    @property
    def points_everywhere(self) -> bool:
        """Whether the values have directions, and no common one: two numbers of each run fit nearly anything."""
        sector = self._sector(range(len(self.groups)))
        return sector is not None and sector[1] - sector[0] > WIDE

    @property
    def _of_what(self) -> str:
        """What a factor is of, behind the number."""
        factor = self.effect.parameters[self.variant[0]].null == 1.0 and not self.effect.subject
        return " times the model's" if factor else ""

    @property
    def _number_of(self) -> str:
        """What a number without a unit is, before it, where the effect has several that may differ."""
        subject = self.effect.subject or self.effect.title
        return f"{self._what} " if self.unit in DIMENSIONLESS and self._what != subject else ""

    def _within(self) -> str:
        """What changed within runs, in words."""
        pairs = [pair for pair in self.effect.told_as if set(pair) <= set(self.variant)][1:]
        told = []
        for pair in pairs:
            most = max(math.hypot(*(one[name].value for name in pair)) for one in self.values)
            told.append(quantity(most, None, self.effect.parameters[pair[0]].unit))
        return f", and changed within a {IN_WORDS[self.by]} by up to {' and '.join(told)}" if told else ""

    def table(self) -> list[tuple[str, ...]]:
        """Group, size and, where it has one, direction in words, the first row heads."""
        rows: list[tuple[str, ...]] = [(IN_WORDS[self.by], self._what)]
        rows[0] += ("direction",) if self._directed else ()
        rows[0] += ("from the mean",) if self.from_mean(0) is not None else ()
        for k, label in enumerate(self.groups):
            value, error = self.size(k)
            direction = self.towards(k)
            size = quantity(value, None if error is None else NORMAL_95 * error, self.unit) + self._of_what
            rows.append((name_of(label), size, *(() if direction is None else (_degrees(*direction),))))
            if (apart := self.from_mean(k)) is not None:
                rows[-1] += (quantity(apart[0], None if apart[1] is None else NORMAL_95 * apart[1], self.unit),)
        return rows

    @property
    def _what(self) -> str:
        """What differs, in words: which of several things where the effect has more than one that may."""
        several = sum(set(variant) <= set(self.effect.varies) for variant in self.effect.variants) > 1
        if several and len(self.variant) == 1:
            return self.effect.parameters[self.variant[0]].label
        return self.effect.subject or self.effect.title

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        sizes = [self.size(k)[0] for k in range(len(self.groups))]
        return {
            "by": self.by,
            "unit": self.unit,
            "least": finite(min(sizes)),
            "largest": finite(max(sizes)),
            "values": [self._row(k) for k in range(len(self.groups))],
        }

    def _row(self, k: int) -> dict[str, Any]:
        value, error = self.size(k)
        direction, apart = self.towards(k), self.from_mean(k)
        return {
            "group": name_of(self.groups[k]),
            "trials": list(self.trials[k]),
            "size": finite(value),
            "size_stderr": error,
            "from_mean": None if apart is None else apart[0],
            "from_mean_stderr": None if apart is None else apart[1],
            "direction_deg": None if direction is None else math.degrees(direction[0]),
            "direction_stderr_deg": None if direction is None or direction[1] is None else math.degrees(direction[1]),
            "parameters": {
                name: {
                    "value": finite(one.value),
                    "stderr": one.stderr,
                    "ci95": [one.low, one.high],
                    "unit": self.effect.parameters[name].unit,
                }
                for name, one in self.values[k].items()
            },
        }


def _kinds(at: FloatArray) -> list[int]:
    """How many runs there are of each kind by what was ordered (n,), none where that is not known of all."""
    if not len(at) or not np.isfinite(at).all():
        return []
    among = np.sort(at)
    ends = np.flatnonzero(np.diff(among) > APART * np.abs(at).max()) + 1
    return [len(one) for one in np.split(among, ends)]


def _along_a_line(at: FloatArray, values: FloatArray) -> bool:
    """Whether values (n,) follow what was ordered (n,) along a line, by no chance."""
    if len(at) <= FEWEST_KINDS or not np.isfinite(values).all() or not np.ptp(values):
        return False
    told = float(np.corrcoef(at, values)[0, 1]) ** 2
    free = len(values) - 2
    return float(fdtrc(1, free, free * told / max(1.0 - told, 1e-15))) < BY_CHANCE


def _others(n: int) -> str:
    """So many others, in words."""
    return "other one" if n == 1 else f"other {n}"


def _degrees(angle: float, error: float | None) -> str:
    half = "" if error is None or not math.isfinite(error) else f" ± {math.degrees(NORMAL_95 * error):.0f}"
    return f"{math.degrees(angle):03.0f}{half}°" if not half or NORMAL_95 * (error or 0.0) < math.pi else "any"
