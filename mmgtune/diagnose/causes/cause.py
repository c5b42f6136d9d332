"""Causes, as a diagnosis looks for them and names them: their sizes and limits, and why one is a trace."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from ...displayed import Brief
from ...documents import finite
from ...effects import Effect, Parameter, SensorEffect
from ...phrases import capital, small
from ..bench.runs import IN_WORDS
from ..signatures.intervals import AT_END, Estimate
from ..signatures.wording import parameters_in_words
from .by_run import ByRun
from .contributions import Contribution

LONG = 40
"""Letters of a list of parameters that fit into a line of a table."""


@dataclass(frozen=True, eq=False)
class Cause:
    """An effect that was found, with the sizes of its parameters; ``effect`` None for what is none.

    words      what it is then: the integration step where they are empty
    estimates  of what is the same in all runs
    runs       what differs between them, None where nothing does
    has        what the profile has already of terms that are to be added, by name
    """

    tag: str
    effect: Effect | None
    estimates: Mapping[str, Estimate]
    p_value: float
    gain_test: float | None
    runs: ByRun | None = None
    words: str = ""
    has: Mapping[str, float] = field(default_factory=dict)

    @property
    def sentence(self) -> str:
        """The cause in words."""
        if self.effect is None and self.words:
            return self.words
        if self.effect is None:
            return "The integration step of the simulation is too coarse"
        if self.runs is not None:
            return self.runs.sentence
        told = parameters_in_words(self.effect, self.estimates)
        if told and set(told) <= set(self.has):
            return self._more_of(told)
        own = self.effect.sentence(told)
        return f"{own}; by the profile {small(self._stated)}" if self._stated else own

    def _more_of(self, told: Mapping[str, str]) -> str:
        """Terms of which the profile has something: none of them is lacking."""
        fields = self.effect.parameters if self.effect else {}
        each = [
            f"the {fields[name].label} of the hull is off by {value}: the profile has {self.has[name]:.4g}"
            for name, value in told.items()
        ]
        return capital("; ".join(each))

    @property
    def _stated(self) -> str:
        """What the profile has of it, in words; "" where nothing, or what it has where nothing else is said."""
        fields = self.effect.parameters if self.effect else {}
        known = {
            name: one
            for name, one in self.estimates.items()
            if one.stated not in (None, fields[name.rpartition(".")[2]].default)
        }
        plain = {name: Estimate(name, one.stated or 0.0, None, None, None) for name, one in known.items()}
        return self.effect.sentence(parameters_in_words(self.effect, plain)) if self.effect and plain else ""

    @property
    def sized(self) -> bool:
        """Whether the interval of any of its parameters leaves out the value at which it is absent, or that the profile
        has."""
        if self.effect is None or not self.estimates:
            return True
        plain, sizes, fields = self.effect.plain, self._sizes, self.effect.parameters
        own = {name: one for name, one in self._estimated.items() if name in sizes or (name in plain and one.stated)}
        nulls = {name: fields[name].null if one.stated is None else one.stated for name, one in own.items()}
        return any(
            not (-math.inf if one.low is None else one.low)
            <= nulls[name]
            <= (math.inf if one.high is None else one.high)
            for name, one in own.items()
        )

    @property
    def of_logs(self) -> bool:
        """Whether it is an error in logs of the motion, which changes nothing that the ship does."""
        return isinstance(self.effect, SensorEffect)

    @property
    def of_one_log(self) -> bool:
        """Whether it is an error in the log of a single state, as the scale of a gyro is."""
        names = [name.rpartition(".")[2] for name in self.estimates]
        return isinstance(self.effect, SensorEffect) and len(self.effect.shown_in(names)) == 1

    @property
    def _sizes(self) -> dict[str, Estimate]:
        """Estimates by name, but those of directions and of the form of the effect."""
        fields = [*self.effect.parameters.items()] if self.effect else []
        directions = {name for (_, before), (name, _) in pairwise(fields) if before.chart == "polar"}
        named = {name for name, _ in fields} - directions - set(self.effect.form if self.effect else ())
        return {name: one for name, one in self._estimated.items() if name in named}

    @property
    def _estimated(self) -> dict[str, Estimate]:
        """Estimates by name."""
        return {name.rpartition(".")[2]: one for name, one in self.estimates.items()}

    @property
    def at_ends(self) -> bool:
        """Whether all its sizes are at the ends of their ranges: another cause may be what would take them further."""
        return self.runs is None and bool(self._sizes) and all(one.at_end for one in self._sizes.values())

    @property
    def form_at_end(self) -> list[str]:
        """Parts of its form that are at the end of their range, in words: but those there that have no such part, as a
        rudder that stalls all at once."""
        if self.effect is None:
            return []
        ended = {full.rpartition(".")[2]: one for full, one in self.estimates.items() if one.at_end}
        fields = self.effect.parameters
        told = [name for name in self.effect.form if name in ended and not _is_plain(fields[name], ended[name])]
        return [f"{fields[name].label}, {ended[name].value:.3g}" for name in told]

    def to_dict(self) -> dict[str, Any]:
        """For JSON; values in the unit named, interval ends null where infinite."""
        fields = self.effect.parameters if self.effect else {}
        return {
            "effect": self.tag,
            "parameters": {
                name: {
                    "value": finite(e.value),
                    "ci95": [e.low, e.high],
                    "unit": fields[name].unit,
                    "profile": None if e.stated is None else finite(e.stated),
                }
                for full, e in self.estimates.items()
                for name in [full.rpartition(".")[2]]
            },
            "p_value": self.p_value,
            "gain_test": self.gain_test,
            "by_run": self.runs.to_dict() if self.runs else None,
            "sentence": self.sentence,
        }


@dataclass(frozen=True, eq=False)
class Trace:
    """A cause that is statistically there, and without which a user would notice nothing.

    alike  tags of causes that these trials do not tell it from
    """

    cause: Cause
    contribution: Contribution
    alike: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """What it is, and why it is no more than that."""
        return self.told("one more")

    def told(self, which: str) -> str:
        """The sentence, of "one more" or of "another" where there was one before."""
        if self.alike:
            told = f"too little to be told: {' or '.join((self.cause.tag, *self.alike))}, or coefficients that are off"
            return f"There is a trace of {which}, {told}. If the first: {small(self.words)}."
        why = "it changes nothing that would be noticed"
        if self.contribution.like_hull:
            why = "a hull further off than believed would explain it as well"
        elif self.contribution.harmful:
            why = "held-out trials are told no better with it"
        return f"There is a trace of {which}, left out as {why}: {small(self.words)}."

    @property
    def words(self) -> str:
        """The cause as a sentence without its full stop; its name where its size is not told."""
        effect = self.cause.effect
        if effect is None or self.cause.sized:
            return self.cause.sentence
        return f"{effect.title}, of a size that is not told"

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            **self.cause.to_dict(),
            "sentence": self.words,
            "contribution": self.contribution.to_dict(),
            "alike": list(self.alike),
        }


@dataclass(frozen=True)
class Candidate:
    """A hypothesis that was looked at: score and refit at the first look; J on the test trials.

    gain       fall of chi-squared by the refit; of one that was given up, as far as it had come; None without a refit
    p_value    probability that chance brings as much; None without a refit
    unvisited  what the trials would have to visit for it to be believed, "" where they do
    by         what has a value of its own: "" for one for all, else a grouping of runs
    """

    effect: str
    parameters: tuple[str, ...]
    score: float
    gain: float | None
    p_value: float | None
    J_test: float | None
    unvisited: str = ""
    by: str = ""

    @property
    def label(self) -> str:
        """In a line, of long lists the beginning."""
        each = f", by {IN_WORDS[self.by]}" if self.by else ""
        names = ", ".join(self.parameters)
        if len(names) > LONG:
            names = f"{', '.join(self.parameters[:2])}, {len(self.parameters) - 2} more"
        return f"{self.effect} ({names}{each})"

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "effect": self.effect,
            "parameters": list(self.parameters),
            "by": self.by or None,
            "score": self.score,
            "gain": self.gain,
            "p_value": self.p_value,
            "J_test": self.J_test,
            "unvisited": self.unvisited,
        }


@dataclass(frozen=True, repr=False)
class Detectability(Brief):
    """What these trials could tell of a hypothesis, before looking at what they do tell.

    share    of its signature that re-tuning does not imitate
    power    length of that, in deviations of the noise, for a typical size
    limit    size from which it would be found, by parameter, in the parameter's unit
    twins    effects its signature is closest to, with the angle between [deg]
    """

    effect: str
    parameters: tuple[str, ...]
    share: float
    power: float
    limit: dict[str, float | None]
    units: dict[str, str]
    twins: tuple[tuple[str, float], ...]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "effect": self.effect,
            "parameters": list(self.parameters),
            "share_surviving": self.share,
            "power": self.power,
            "detection_limit": self.limit,
            "units": self.units,
            "twins": [{"effect": tag, "angle_deg": angle} for tag, angle in self.twins],
        }


def _is_plain(parameter: Parameter, ended: Estimate) -> bool:
    """Whether a part of a form ended where the formula has it, or where it is left out."""
    if ended.value == parameter.null:
        return True
    width = math.inf if ended.low is None or ended.high is None else ended.high - ended.low
    return math.isfinite(width) and abs(ended.value - float(parameter.default or 0.0)) <= AT_END * width
