"""Windows of voyages that a diagnosis looks at: a bounded number of logs of hours, as different as they can be had."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...arguments import TrialsGiven, trials_of
from ...arrays import FloatArray
from ...errors import Problem, TrialError
from ...model import Model
from ...options import DiagnoseOptions, VoyageOptions
from ...profile import ShipProfile
from ...trial import Trial, TrialSet, Voyage, VoyageSet, holds_voyages, load_voyages, voyage_windows, window_at
from ...trial.voyages.windows import mean_speed, rest_speed
from ...units import DEG

AT_MOST = 400
"""Windows of a voyage that are compared with each other; of more, so many are drawn."""

GAP = VoyageOptions.gap
"""Longest gap [s] a window may hold."""

SCALES = (3.0 * DEG, 0.3 * DEG, 0.1, 0.5)
"""How far two windows must be apart to count as different: spread of the rudder angle [rad], mean yaw rate [rad/s],
mean speed as a share of the voyage's largest, and either component of the unit vector along the heading."""


@dataclass(frozen=True)
class _Place:
    """Where a window stands in its voyage, and what the ship did in it."""

    row: int
    n_samples: int
    about: tuple[float, ...]


@dataclass(frozen=True)
class Choice:
    """The windows chosen.

    trials   windows by id, each part of its voyage; all of them tune
    voyages  ids, in the order of their files
    of       windows there are, by voyage
    length   of a window [s]
    """

    trials: TrialSet
    voyages: tuple[str, ...]
    of: dict[str, int]
    length: float

    @property
    def sentence(self) -> str:
        """What was looked at."""
        return (
            f"{len(self.trials.trials)} of {sum(self.of.values())} windows of {self.length:g} s from "
            f"{len(self.voyages)} voyages, as many from each where it has them, chosen to differ in rudder activity, "
            "yaw rate, speed and heading."
        )


def looked_at(
    profile: ShipProfile, given: TrialsGiven | VoyageSet, options: DiagnoseOptions
) -> tuple[TrialSet, Choice | None]:
    """Trials as they are given; of voyages the windows chosen, and how.

    Raises TrialError as loading trials does, and ``choose_windows``.
    """
    if isinstance(given, (str, Path)) and holds_voyages(given):
        given = load_voyages(given)
    if isinstance(given, VoyageSet):
        choice = choose_windows(profile, given, options)
        return choice.trials, choice
    return trials_of(given).series_only("a diagnosis"), None


def with_hull_held(options: DiagnoseOptions) -> DiagnoseOptions:
    """The choices for voyages: at steady courses single coefficients of the hull tell little, and have no leeway."""
    return replace(options, leeway=0.0)


def choose_windows(profile: ShipProfile, voyages: VoyageSet, options: DiagnoseOptions) -> Choice:
    """Windows of voyages, as many from each, that differ from each other as much as they can.

    Voyages are read block by block.  Where one has more than AT_MOST windows, so many are drawn by the seed.  The first
    chosen has the most rudder activity; each further one is the farthest from those chosen (Gonzalez 1985), in rudder
    activity, yaw rate, speed and heading.

    Raises TrialError for what is wrong with a file, and where no window could be cut.
    """
    length = options.voyage_window
    slowest = rest_speed(Model(profile).L_pp)
    inputs = [one.name for one in profile.arrangement.inputs]
    rng = np.random.default_rng(options.seed)
    places: dict[str, list[_Place]] = {}
    count: dict[str, int] = {}
    for voyage in voyages.voyages:
        places[voyage.id], count[voyage.id] = _places(voyage, length, inputs, slowest, rng)
    if not any(places.values()):
        raise TrialError(
            Problem(
                "no window could be cut out of these voyages",
                str(voyages.path),
                f"a window is {length:g} s of motion and inputs without a gap longer than {GAP:g} s, under way",
                "give a shorter restart=S, or other voyages",
            )
        )
    shares = _shares([len(found) for found in places.values()], options.windows)
    trials: dict[str, Trial] = {}
    for voyage, share in zip(voyages.voyages, shares, strict=True):
        sha256 = voyage.verify() if share else ""
        for place in _farthest(places[voyage.id], share):
            trial = window_at(voyage, place.row, place.n_samples).trial
            trials[trial.id] = replace(trial, sha256=sha256)
    own = tuple(voyage.id for voyage, share in zip(voyages.voyages, shares, strict=True) if share)
    whole = TrialSet(trials, tuple(trials), (), voyages.ship, voyages.path, voyages.licence, voyages.citation)
    return Choice(whole, own, {name: count[name] for name in own}, length)


def _places(
    voyage: Voyage, length: float, inputs: Sequence[str], slowest: float, rng: np.random.Generator
) -> tuple[list[_Place], int]:
    """Where the windows of a voyage are, AT_MOST of them in their order, and how many there are."""
    kept: list[_Place] = []
    seen = 0
    for window in voyage_windows(voyage, length, gap=GAP, inputs=inputs):
        trial = window.trial
        speed = mean_speed(trial)
        if speed < slowest:
            continue
        heading = float(np.nanmean(trial.psi))
        about = (
            float(np.std(trial.delta)),
            float(np.nanmean(trial.r)),
            speed,
            float(np.cos(heading)),
            float(np.sin(heading)),
        )
        place = _Place(window.row, trial.n_samples, about)
        seen += 1
        if len(kept) < AT_MOST:
            kept.append(place)
        elif (k := int(rng.integers(seen))) < AT_MOST:  # every window is as likely to stay
            kept[k] = place
    return sorted(kept, key=lambda one: one.row), seen


def _shares(available: Sequence[int], total: int) -> list[int]:
    """As many from each as there are to be had; what one lacks the others give."""
    shares = [0] * len(available)
    left = min(total, sum(available))
    while left:
        open_ = [k for k, n in enumerate(available) if shares[k] < n]
        for k in sorted(open_, key=lambda k: shares[k])[:left]:
            shares[k] += 1
            left -= 1
    return shares


def _farthest(places: Sequence[_Place], share: int) -> list[_Place]:
    """So many windows that are far from each other, in the order of the voyage."""
    if share >= len(places):
        return list(places)
    about: FloatArray = np.array([one.about for one in places])
    spread, yaw, speed, course = SCALES
    about = about / [spread, yaw, speed * max(float(about[:, 2].max()), 1e-9), course, course]
    chosen = [int(np.argmax(about[:, 0]))]
    near = np.full(len(places), np.inf)
    while len(chosen) < share:
        near = np.minimum(near, np.linalg.norm(about - about[chosen[-1]], axis=1))
        near[chosen] = -1.0
        chosen.append(int(np.argmax(near)))
    return [places[k] for k in sorted(chosen)]
