"""The five networks of Wakita et al. 2022, Table 7: memory, loss and training data by number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from ..errors import OptionError, Problem
from ..options.learning import LearnOptions
from ..trial import Trial

TZB = (
    "turn_14-Sep-2020_13_39_32",
    "turn_14-Sep-2020_14_16_04",
    "turn_14-Sep-2020_15_58_08",
    "turn_cut_14-Sep-2020_16_09_02",
    "zigzag_31-Jul-2020_13_22_52",
    "zigzag_31-Jul-2020_13_29_19",
    "zigzag_31-Jul-2020_13_50_28",
    "zigzag_31-Jul-2020_13_57_45",
    "zigzag_31-Jul-2020_14_03_39",
    "berthing_12-Nov-2020_11_14_47",
    "berthing_12-Nov-2020_13_37_05",
)
"""Train-TZB of Table 6, by the names of the published files: no random manoeuvres."""

TZRB = (
    "turn_cut_14-Sep-2020_15_58_08",
    "turn_cut_14-Sep-2020_16_09_02",
    "zigzag_31-Jul-2020_13_22_52",
    "zigzag_31-Jul-2020_13_50_28",
    "random_06-Aug-2020_16_24_25_4",
    "random_06-Aug-2020_16_24_25_6",
    "berthing_12-Nov-2020_11_14_47",
    "berthing_12-Nov-2020_13_37_05",
)
"""Train-TZRB: as much time, with random manoeuvres."""


@dataclass(frozen=True)
class Recipe:
    """One of the types.

    truncated  whether the memory is built anew from the last samples at each step, else it runs on
    loss       what is made small
    runs       ids of the trials it is trained on, None for all
    """

    truncated: bool = True
    loss: Literal["trajectory", "acceleration"] = "trajectory"
    runs: tuple[str, ...] | None = None

    def memory(self, options: LearnOptions) -> int | None:
        """Samples the memory reaches back, None where it runs on."""
        return options.memory if self.truncated else None

    def trials(self, given: Sequence[Trial], where: str) -> list[Trial]:
        """Those of the given trials that it is trained on.  Raises OptionError where some are not there."""
        if self.runs is None:
            return list(given)
        lacking = sorted({*self.runs} - {trial.id for trial in given})
        if lacking:
            raise OptionError(
                Problem(
                    f"{len(lacking)} of the runs that this type is trained on are not among the trials",
                    where,
                    f"types 4 and 5 are type 1 on certain runs of the paper; not there: {', '.join(lacking[:3])} ...",
                    "write type=1: it takes the trials that there are",
                )
            )
        return [trial for trial in given if trial.id in self.runs]

    @property
    def words(self) -> str:
        """In a line."""
        kind = "truncated" if self.truncated else "standard"
        of = "" if self.runs is None else f", on {len(self.runs)} runs of the paper"
        return f"{kind} memory, loss of {'trajectories' if self.loss == 'trajectory' else 'accelerations'}{of}"


RECIPES: dict[str, Recipe] = {
    "1": Recipe(),
    "2": Recipe(truncated=False),
    "3": Recipe(loss="acceleration"),
    "4": Recipe(runs=TZB),
    "5": Recipe(runs=TZRB),
}
