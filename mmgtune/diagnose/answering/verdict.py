"""What was found, and what it comes to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ...displayed import Plotted
from ...options import DiagnoseOptions
from ...profile import ShipProfile
from ...trial import Coverage
from ..causes.belief import MOSTLY, Belief
from ..causes.cause import Candidate, Cause, Detectability, Trace
from ..causes.doubted import Doubted, Leading
from ..evidence.misread import Misread, both
from ..evidence.whereabouts import Whereabouts
from ..record import Record, kind_of, record_of
from ..searching.instead import Instead
from ..signatures.retuned import Retuned
from ..voyages.difference import Difference
from ..voyages.windows import Choice
from .separate import Suggestion

VERDICTS = ("none", "found", "not-separable", "unexplained", "interrupted")
"""Codes; people read ``Diagnosis.sentence``."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Answer(Belief, Plotted):
    """All that a diagnosis found, with what is to be said of it; ``Diagnosis`` says what the fields are."""

    profile: ShipProfile
    options: DiagnoseOptions
    traces: tuple[Trace, ...]
    candidates: tuple[Candidate, ...]
    detectability: tuple[Detectability, ...]
    suggestion: Suggestion | None
    theta: Mapping[str, float]
    retuned: Mapping[str, float]
    noise: Mapping[str, Mapping[str, float]]
    evidence: Mapping[str, Any]
    provenance: Mapping[str, Any]
    wall_s: float
    coverage: Coverage | None = None
    warnings: tuple[str, ...] = ()
    interrupted: bool = False
    whereabouts: Whereabouts | None = None
    doubted: Doubted | None = None
    leading: Leading | None = None
    moved: tuple[Retuned, ...] = ()
    instead: Instead | None = None
    contradicted: str = ""
    swell: str = ""
    jumped: Mapping[str, float] = field(default_factory=dict)
    ended: Mapping[str, float] = field(default_factory=dict)
    misread: Misread = field(default_factory=dict)
    choice: Choice | None = None
    differing: tuple[Difference, ...] = ()
    read_off: Mapping[str, float] = field(default_factory=dict)

    @property
    def verdict(self) -> str:
        """One of ``VERDICTS``."""
        if self.interrupted:
            return "interrupted"
        if self.swell:
            return "none"
        if self.fails if self.causes else self.leaves_shape or self.contradicted:
            return "found" if any(one.explained >= MOSTLY for one in self.between) else "unexplained"
        if self.groups:
            return "not-separable"
        return "found" if self.causes or self.between else "none"

    @property
    def leaves_shape(self) -> bool:
        """Whether what is left shows something that is wrong, here or on the trials kept for testing."""
        return self._shows or self.misses_test

    @property
    def wrong_logs(self) -> Misread:
        """Logs that are off in single runs, put right or left out of what was looked at, or not."""
        return both(self.misread, self.leftover.misread)

    @property
    def _shows(self) -> bool:
        """Whether what is left of the trials looked at, or was left out of these, shows something that is wrong."""
        left = self.leftover
        return left.structured or bool(left.offsets or left.changed or self.wrong_logs)

    @property
    def kind(self) -> str:
        """What kind of answer this is, as the study counts them; "" for one that was stopped."""
        verdict = self.verdict
        return kind_of(verdict, self.named, self.groups if verdict == "not-separable" else ())

    @property
    def record(self) -> Record | None:
        """How often such an answer was right in the study; None of a search that was stopped, of voyages, and where
        logs are to be put right before anything is looked for."""
        return record_of(self.kind) if self.kind and not (self.between or self.looked_for_none) else None

    @property
    def looked_for_none(self) -> bool:
        """Whether no cause was looked for, as logs or profile are to be put right first."""
        return bool(self.contradicted) and not self.candidates

    @property
    def between(self) -> tuple[Difference, ...]:
        """What differs from voyage to voyage."""
        return tuple(one for one in self.differing if one.pattern in ("each", "trend"))

    @property
    def of_a_sensor(self) -> bool:
        """Whether a log whose factor changes within trials, or that is off in single runs, shows, and no cause worth
        speaking of."""
        return bool(self.leftover.changed or self.wrong_logs) and not self.tells_a_part

    @property
    def misses_test(self) -> bool:
        """Whether the model fits the trials looked at without any cause, and those kept for testing show that something
        is wrong all the same."""
        return not (self.causes or self._shows or self.choice) and self.gain.missed

    @property
    def names_causes(self) -> bool:
        """Whether causes are named that a reader may rely on, be it one of a group."""
        return self.verdict in ("found", "not-separable")

    @property
    def named(self) -> tuple[Cause, ...]:
        """The causes a reader may rely on: none where something unknown is at work too, or the search was stopped."""
        return () if self.verdict in ("unexplained", "interrupted") else self.causes
