"""A trial in memory."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray, numbers_of
from ..displayed import Plotted, inert
from ..errors import Problem, TrialError
from ..inputs import INPUTS, meant_by
from ..phrases import counted
from .headings import going_on
from .metadata import antenna_of, as_json, no_place, noise_problems
from .schema import ATTRIBUTES, CHANNELS


@dataclass(frozen=True, eq=False)
class Trial(Plotted):
    """One manoeuvre: time, motion, inputs, and what is known about them.  All arrays (n_samples,), read-only.

    id         unique within a data set
    source     "measured", "generated", or "" where the file does not say
    t          time [s], strictly increasing
    x, y       midship position, north and east [m]; NaN in gaps, as in all motion channels
    psi        heading [rad], unwrapped
    u, v_m     velocity over ground in ship axes at midship [m/s]; v_m is the file's ``v``
    r          yaw rate [rad/s]
    n, delta   propeller revolutions [1/s], rudder angle [rad]
    extra      further columns by name
    noise      standard deviations of sensor noise by file column, where known
    path       the file it was read from, None where it was made in memory
    sha256     of that file, "" where there is none
    sealed     whether the file holds a digest of columns and facts, which agreed with them
    ignored    columns of the file that hold no numbers and were left out
    part_of    id of the trial this is a window of, "" for a whole trial
    begins     when the time of a window begins, in the time of its whole trial [s]
    group      what it has in common with other runs, such as the day or the loading; "" where the file does not say
    derived    motion columns, by their names in the file, that were worked out from others and measured by nothing
    antenna    forward and to starboard of midship [m], where positions were measured that were moved to midship along
               the heading logged; None where they were not
    cut_from   name of the run that this and other trials were cut from, "" where it is a run of its own

    Raises TrialError for arrays without numbers or of other lengths than ``t``, for ``extra`` that repeats a field, for
    ``noise`` that is none, and for an ``antenna`` that is on no ship.
    """

    id: str
    ship: str
    manoeuvre: str
    source: str
    t: FloatArray
    x: FloatArray
    y: FloatArray
    psi: FloatArray
    u: FloatArray
    v_m: FloatArray
    r: FloatArray
    n: FloatArray
    delta: FloatArray
    extra: dict[str, FloatArray] = field(default_factory=dict)
    noise: dict[str, float] = field(default_factory=dict)
    note: str = ""
    path: Path | None = None
    sha256: str = ""
    sealed: bool = False
    ignored: tuple[str, ...] = ()
    part_of: str = ""
    begins: float = 0.0
    cut_from: str = ""
    group: str = ""
    derived: tuple[str, ...] = ()
    antenna: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        shape = (np.size(self.t),)
        for name in ATTRIBUTES.values():
            object.__setattr__(self, name, _frozen(name, getattr(self, name), shape))
        motion = np.column_stack([getattr(self, name) for name in CHANNELS])
        motion.setflags(write=False)
        object.__setattr__(self, "_motion", motion)
        for name, column in zip(CHANNELS, motion.T, strict=True):  # one copy of each
            object.__setattr__(self, name, column)
        if self.antenna is not None:
            place = antenna_of({"antenna": self.antenna})
            if place is None:
                raise TrialError(no_place(self.antenna, "antenna"))
            object.__setattr__(self, "antenna", place)
        if problems := noise_problems(as_json({"noise": self.noise})["noise"], "noise", tuple(self.extra)):
            raise TrialError(*problems)
        repeated = sorted(set(self.extra) & {*ATTRIBUTES, *ATTRIBUTES.values()})
        if repeated:
            why = "these columns are fields of their own"
            fix = "leave them out of extra"
            raise TrialError(Problem(f"extra columns repeat required ones: {', '.join(repeated)}", "extra", why, fix))
        extra = {name: _frozen(name, values, shape) for name, values in self.extra.items()}
        object.__setattr__(self, "extra", extra)

    def __repr__(self) -> str:
        """In a line."""
        words = [inert(word) for word in (self.ship, self.manoeuvre, self.source) if word]
        return f"Trial({inert(self.id)}: {', '.join([*words, counted(self.n_samples, 'sample')])})"

    @property
    def n_samples(self) -> int:
        """Number of samples."""
        return len(self.t)

    @property
    def run(self) -> str:
        """Name of what was sailed in one go, which trials and windows cut from it share."""
        return self.cut_from or self.whole

    @property
    def whole(self) -> str:
        """Id of the whole trial: its own, or that of the trial this is a window of."""
        return self.part_of or self.id

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]; 0 for a trial without samples."""
        return float(self.t[-1] - self.t[0]) if len(self.t) else 0.0

    @property
    def motion(self) -> FloatArray:
        """(n_samples, 6) x, y, psi, u, v_m, r; read-only."""
        found: FloatArray = self.__dict__["_motion"]
        return found

    def as_measured(self) -> Trial:
        """The trial without what was derived, but for the first sample, which a simulation begins with: it says nothing
        that the others do not, and its noise is not of a sensor."""
        if not self.derived:
            return self
        first = np.arange(self.n_samples) == 0
        kept: Any = {ATTRIBUTES[name]: np.where(first, self.columns[name], np.nan) for name in self.derived}
        return replace(self, **kept)

    def inputs(self, names: Sequence[str]) -> FloatArray:
        """(n_samples, n_inputs) what drove the ship, by names of ``inputs.INPUTS``.

        Raises TrialError for another name, and where the trial has not logged one of them, or with gaps.
        """
        unknown = [name for name in names if name not in INPUTS]
        if unknown:
            where = str(self.path or self.id)
            raise TrialError(*(Problem(f"'{name}' is no input of a ship", where, **meant_by(name)) for name in unknown))
        have = self.columns
        lacking = [name for name in names if name not in have or not np.isfinite(have[name]).all()]
        if lacking:
            raise TrialError(
                *(
                    Problem(
                        f"trial '{self.id}' does not say '{name}' all along",
                        str(self.path or self.id),
                        f"the model is driven by it: {INPUTS[name].words} [{INPUTS[name].unit}]",
                        "log it, fill its gaps, or take a profile whose arrangement does without",
                    )
                    for name in lacking
                )
            )
        return np.column_stack([have[name] for name in names])

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Every column by its name in the file, required ones first."""
        return {name: getattr(self, attribute) for name, attribute in ATTRIBUTES.items()} | self.extra

    @property
    def label(self) -> str:
        """The trial's name for people: its id, and manoeuvre and ship where known."""
        about = ", ".join(word for word in (self.manoeuvre, self.ship) if word)
        return f"{self.id} ({about})" if about else self.id


def fields_of(columns: Mapping[str, FloatArray]) -> dict[str, Any]:
    """Fields of a trial out of all its columns by their names in a file, those of no field as ``extra``; a heading that
    begins anew after a full turn goes on."""
    own: dict[str, Any] = {attribute: columns[name] for name, attribute in ATTRIBUTES.items()}
    own["psi"] = going_on(own["psi"], own["t"], own["r"])
    return own | {"extra": {name: values for name, values in columns.items() if name not in ATTRIBUTES}}


def _frozen(name: str, values: object, shape: tuple[int, ...]) -> FloatArray:
    column = numbers_of(values)
    if column is None:
        why, fix = "a trial has a number for each sample", f"give {name} as numbers, NaN in gaps"
        raise TrialError(Problem(f"{name} holds what is no number", name, why, fix))
    if column.shape != shape:
        what = f"{name} has shape {column.shape}, t has {shape[0]} samples"
        raise TrialError(Problem(what, name, "a trial has a number for each sample", f"give {shape[0]} numbers"))
    column.setflags(write=False)
    return column
