"""What is said of a sum of causes that is not believed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...phrases import in_percent, small
from .belief import Belief
from .cause import Cause

LEADS = 0.8
"""Share of the error that the first cause of a sum must remove alone, where nothing was fitted too, for its size to be
told though the sum is not believed."""


@dataclass(frozen=True)
class Doubted:
    """A sum of causes that explains more than the one that is named, and is not believed.

    effects  their tags
    why      what speaks against it, in words
    by_run   tags of those that have a value of each run
    """

    effects: tuple[str, ...]
    why: str
    by_run: tuple[str, ...] = ()

    @classmethod
    def of(cls, answer: Belief) -> Doubted:
        """The causes of an answer that is unclear."""
        by_run = tuple(dict.fromkeys(cause.tag for cause in answer.causes if cause.runs))
        return cls(tuple(tag for tag, _ in answer.contributions), answer.unclear, by_run)

    @property
    def sentence(self) -> str:
        """What would explain more, and why it is not believed."""
        tags = dict.fromkeys(self.effects)
        sum_ = " + ".join(f"{tag} of each run" if tag in self.by_run else tag for tag in tags)
        return f"More would be removed by {sum_}, but {self.why}, so the rest has no name."

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"effects": list(self.effects), "why": self.why}


@dataclass(frozen=True, eq=False)
class Leading:
    """The first of causes that are not believed together, where it alone removes most of the error.

    explained  share removed of the error on the trials it was found on; held_out: of the error on held-out trials
    """

    cause: Cause
    explained: float
    held_out: float

    @classmethod
    def of(cls, whole: Belief, first: Belief) -> Leading | None:
        """From the answer with all causes, which has the size of the first, and the answer with the first alone, which
        has its gain, and its size where its form is plainer; None where the gain is small, or the size is not
        determined or none of the runs, or sizes of runs point everywhere."""
        explained, held_out = first.explained_share, first.gain.share_removed
        if not first.causes or min(explained, held_out) < LEADS:
            return None
        alone = first.causes[0]
        cause = next(one for one in whole.causes if one.tag == alone.tag)
        if (cause.runs is None, cause.estimates.keys()) != (alone.runs is None, alone.estimates.keys()):
            cause = alone
        doubtful = cause.runs is not None and (bool(cause.runs.doubt) or cause.runs.points_everywhere)
        return cls(cause, explained, held_out) if cause.sized and not (cause.at_ends or doubtful) else None

    @property
    def sentence(self) -> str:
        """How large it would be."""
        share, words = in_percent(min(self.explained, self.held_out)), self.cause.sentence
        return f"Most of it, {share}, would be {self.cause.tag}: {small(words)}."

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        shares = {"share_explained": self.explained, "share_held_out": self.held_out}
        return {**self.cause.to_dict(), **shares, "sentence": self.sentence}
