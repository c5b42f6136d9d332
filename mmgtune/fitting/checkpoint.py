"""Checkpoints of a search: the costs of every generation so far, and what they belong to.

A search is a function of its seed and these costs, so replaying them restores it exactly.  Nothing in the file is
executed on loading.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import OptionError, Problem, brief, reason
from ..files import atomic
from ..run_files import CHECKPOINT
from ..run_folders import RESULTS

EVERY = 25
"""Generations between two checkpoints: about a second of work."""


@dataclass(eq=False)
class Checkpoint:
    """A checkpoint file of one run folder.

    identity  everything the costs depend on: hashes of profile and trials, options, versions
    """

    folder: Path
    identity: dict[str, Any]
    costs: list[FloatArray] = field(default_factory=list)

    @property
    def path(self) -> Path:
        """The file."""
        return self.folder / CHECKPOINT

    def save(self, costs: list[FloatArray]) -> None:
        """Write the costs of all generations so far, whole or not at all."""
        with atomic(self.path) as part, part.open("wb") as file:
            np.savez(
                file,
                identity=np.array(json.dumps(self.identity, sort_keys=True)),
                sizes=np.array([len(c) for c in costs], dtype=np.int64),
                costs=np.concatenate(costs) if costs else np.zeros(0),
            )

    def load(self) -> list[FloatArray]:
        """Costs by generation.  Raises OptionError where there is no checkpoint or it belongs to another fit."""
        if not self.path.is_file():
            raise nothing_to_resume(self.folder, "checkpoint")
        try:
            with self.path.open("rb") as file, np.load(file, allow_pickle=False) as data:
                identity = dict(json.loads(str(data["identity"])))
                sizes, costs = data["sizes"], data["costs"].astype(np.float64, casting="safe")
            parts = np.split(costs, np.cumsum(sizes)[:-1]) if len(sizes) else []
        except Exception as error:  # the library raises what it comes across where a file is damaged
            raise OptionError(
                Problem(
                    "the checkpoint cannot be read",
                    str(self.path),
                    reason(error),
                    "delete it, or run without resume=True",
                )
            ) from error
        differing(identity, self.identity, self.path)
        return parts


def nothing_to_resume(
    folder: Path, lacking: str, so: str = "the run never began", results: Sequence[str] = RESULTS
) -> OptionError:
    """The error of a run that cannot be continued; of one that has ended it says so, and how to have its report.

    lacking, so  what the folder does not hold, and what that means
    results      what a run that has ended leaves
    """
    result = next((name for name in results if (folder / name).is_file()), None)
    why, fix = f"the folder holds no {lacking}: {so}", "run without resume=True"
    if result is not None:
        why = f"the run there has ended: {result} is its result"
        report = f"mmgtune report {shlex.quote(str(folder))}"
        fix = f"{report} renders its report; force=True in the place of resume=True repeats it"
    return OptionError(Problem("nothing to resume", str(folder), why, fix))


def _changes(key: str, before: Any, now: Any) -> list[str]:
    """Differences in one part of an identity, in words; for options with both values."""
    if before == now:
        return []
    if key != "options" or not isinstance(before, dict) or not isinstance(now, dict):
        return [key]
    names = [name for name in sorted({*before, *now}) if before.get(name) != now.get(name)]
    return [f"{name} ({brief(now.get(name))}, was {brief(before.get(name))})" for name in names]


def differing(recorded: dict[str, Any], now: dict[str, Any], path: Path) -> None:
    """Raises OptionError where what a file was made from is not what the run is of now."""
    changed = [word for key in sorted({*recorded, *now}) for word in _changes(key, recorded.get(key), now.get(key))]
    if changed:
        raise OptionError(
            Problem(
                "the checkpoint belongs to another run",
                str(path),
                f"different now: {', '.join(changed)}",
                "repeat the command it was made with, or run without resume=True",
            )
        )
