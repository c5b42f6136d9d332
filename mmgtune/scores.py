"""How well a model follows trials it is given: J of the fine-tuning paper and the standardised error L_MSE."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arguments import ShipGiven, TrialsGiven, some_of
from .arrays import FloatArray, IntArray
from .backends import STATES, Integrator
from .bands import WindowScore, score_window
from .displayed import Brief
from .drawing_anew import interval_of
from .errors import OptionError, Problem, brief, kind_of
from .evaluation import TrialRecord, records
from .limits import as_float, is_real
from .model import Model
from .motions import begun
from .networks import named_ship
from .objective import spread, varying
from .predictor import Predictor, as_predictor, cases_from, draught_of, portions, predicted
from .trial import Trial

SEED = 1
"""Of the runs that are drawn anew for an interval."""


@dataclass(frozen=True, repr=False)
class TrialScore(Brief):
    """One member on one trial, or on one window of it.

    trial      id of the whole trial
    run        name of the run it belongs to
    J          sum of squared differences of position and heading over L_pp and pi/4 (Suyama et al. 2023, eq. 39-40)
    squares    sum over samples of each state's squared difference over its sigma squared, by state
    counts     samples compared, by state: those after the first at which it was measured
    n_samples  samples after the first at which any was
    method     how it was simulated
    member     of the predictor, from 0
    """

    id: str
    trial: str
    run: str
    manoeuvre: str
    J: float
    squares: Mapping[str, float]
    counts: Mapping[str, int]
    n_samples: int
    method: str = ""
    member: int = 0

    @property
    def L_MSE(self) -> float:
        """Sum over the six states of the mean over their samples (Wakita et al. 2022, eq. 26); inf where diverged."""
        return L_MSE([self])


def L_MSE_by_state(scores: Sequence[TrialScore]) -> dict[str, float]:
    """The parts of the standardised error over several trials: the mean over all samples of each state.

    Each sample counts alike; a state that no trial measured is left out.
    """
    counts = {name: sum(score.counts.get(name, 0) for score in scores) for name in STATES}
    return {
        name: float(sum(score.squares.get(name, 0.0) for score in scores) / n) for name, n in counts.items() if n > 0
    }


def L_MSE(scores: Sequence[TrialScore]) -> float:
    """The standardised error over several trials, the sum of its parts by state; NaN where there is none."""
    parts = L_MSE_by_state(scores)
    return float(sum(parts.values())) if parts else float("nan")


def off_by(scores: Sequence[TrialScore], sigma: Mapping[str, float]) -> dict[str, float]:
    """Root mean square distance off track [m] and error of heading [deg] over all samples; not finite where diverged.

    sigma  what the scores were divided by
    """
    squares = {name: part * sigma[name] ** 2 for name, part in L_MSE_by_state(scores).items()}
    place, heading = squares.get("x", np.nan) + squares.get("y", np.nan), squares.get("psi", np.nan)
    return {
        "position_rms_m": float(np.sqrt(place)),
        "heading_rms_deg": float(np.degrees(np.sqrt(heading))),
    }


def by_manoeuvre(scores: Sequence[TrialScore]) -> dict[str, list[TrialScore]]:
    """Scores by kind of manoeuvre, "" where trials do not say."""
    return _grouped(scores, lambda score: score.manoeuvre)


def by_run(scores: Sequence[TrialScore]) -> dict[str, list[TrialScore]]:
    """Scores by run: windows of one, and trials cut from one, together."""
    return _grouped(scores, lambda score: score.run)


def by_trial(scores: Sequence[TrialScore]) -> dict[str, list[TrialScore]]:
    """Scores by trial: the windows of one together."""
    return _grouped(scores, lambda score: score.trial)


def _grouped(scores: Sequence[TrialScore], key: Callable[[TrialScore], str]) -> dict[str, list[TrialScore]]:
    groups: dict[str, list[TrialScore]] = {}
    for score in scores:
        groups.setdefault(key(score), []).append(score)
    return groups


def by_member(scores: Sequence[TrialScore]) -> list[list[TrialScore]]:
    """Scores by member of the predictor, in order."""
    groups: dict[int, list[TrialScore]] = {}
    for one in scores:
        groups.setdefault(one.member, []).append(one)
    return [groups[member] for member in sorted(groups)]


def score(
    ship: ShipGiven | Model | Predictor,
    trials: TrialsGiven,
    sigma: Mapping[str, float] | None = None,
    *,
    theta: FloatArray | None = None,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
    offsets: FloatArray | None = None,
) -> list[TrialScore]:
    """Scores of trials, each simulated from its first measured state with its measured inputs.

    ship, trials  objects, paths or bundled names; ``ship`` may be any predictor, ``trials`` a list of trials
    sigma  what differences of each state are divided by in L_MSE [SI]; their spread in the trials where None
    theta  (n_rows, n_members) coefficients of a profile or model, its own where None
    offsets  (n_trials, 6) added to the first measured states, where these are estimated
    -> trial by trial, and of each all members
    Raises TrialError where there are no trials, and OptionError for a sigma that lacks a state or is not above 0.
    Windows of long trials are trials like any other (``TrialSet.in_windows``).
    """
    predictor = as_predictor(named_ship(ship, integrator), theta=theta, integrator=integrator, backend=backend)
    several = some_of(trials)
    sigma = varying(spread(several), "trials", "give sigma") if sigma is None else scales_of(sigma)
    return [score_of(record, sigma) for record in records(predictor, several, offsets=offsets)]


def scales_of(sigma: object) -> dict[str, float]:
    """What differences of each state are divided by.

    Raises OptionError where one is missing, unknown or no number above 0.
    """
    example = "give one for each of " + ", ".join(STATES)
    why = "differences of each state are divided by its own"
    if not isinstance(sigma, Mapping):
        raise OptionError(Problem(f"sigma is {kind_of(sigma)}", "sigma", why, f"{example}, by name"))
    unknown = [name for name in sigma if name not in STATES]
    if unknown:
        raise OptionError(Problem(f"sigma is of no state {brief(unknown[0])}", "sigma", why, example))
    missing = [name for name in STATES if name not in sigma]
    if missing:
        raise OptionError(Problem(f"sigma says nothing of {', '.join(missing)}", "sigma", why, example))
    for name, value in sigma.items():
        if not is_real(value) or not 0.0 < as_float(value) < math.inf:
            raise OptionError(Problem(f"sigma of {name} is {brief(value)}", "sigma", why, "give a number above 0"))
    return {name: float(sigma[name]) for name in STATES}


def window_scores(
    predictor: Predictor, trials: Sequence[Trial], offsets: FloatArray | None = None
) -> list[WindowScore]:
    """How well all members together foretell trials, or windows of them, each from its first measured state.

    offsets  (n_trials, 6) added to the first measured states, where these are estimated

    Each sample of each state after the first counts where it was measured.
    """
    found = []
    for portion in portions([trial.n_samples for trial in trials], predictor.n_members):
        some = trials[portion]
        start = None if offsets is None else begun(some, offsets[portion])
        made = predicted(predictor, cases_from(some, tuple(predictor.inputs), draught_of(predictor), initial=start))
        for i, trial in enumerate(some):
            states, truth = made.states[i, :, 1 : trial.n_samples], trial.motion[1:]
            facts = trial.id, trial.whole, trial.run, trial.manoeuvre
            found.append(score_window(*facts, states, made.diverged[i], truth, _noise_of(trial)))
    return found


def _noise_of(trial: Trial) -> FloatArray:
    """(3,) standard deviations of the sensors of u, v_m, r as the trial states them; NaN where it does not."""
    stated = [trial.noise.get(column, 0.0) for column in ("u", "v", "r")]
    return np.array([sigma if sigma > 0.0 else np.nan for sigma in stated])


def score_of(record: TrialRecord, sigma: Mapping[str, float]) -> TrialScore:
    """The score of one record; ``sigma`` as for ``score``."""
    trial = record.trial
    return TrialScore(
        trial.id,
        trial.whole,
        trial.run,
        trial.manoeuvre,
        record.J,
        {name: value / sigma[name] ** 2 for name, value in record.squares.items()},
        record.counts,
        int(record.measured.counted.any(axis=1).sum()),
        record.method,
        record.member,
    )


def summary(scores: Sequence[TrialScore]) -> dict[str, Any]:
    """Scores over everything, by kind of manoeuvre and by trial, for JSON; what diverged is null.

    Of a predictor with several members these are the means over the members, and ``members`` has each one's own.
    """
    members = by_member(scores)
    found = {
        **_row(scores),
        "by_manoeuvre": {kind: {"runs": len(by_run(of)), **_row(of)} for kind, of in by_manoeuvre(scores).items()},
        "trials": [
            {"id": id, "manoeuvre": of[0].manoeuvre, "windows": len(by_member(of)[0]), **_row(of)}
            for id, of in by_trial(scores).items()
        ],
    }
    if len(members) > 1:
        found["members"] = [
            {
                "member": of[0].member,
                **_row(of),
                "trials": [{"id": id, **_row(own)} for id, own in by_trial(of).items()],
            }
            for of in members
        ]
    return found


def _row(scores: Sequence[TrialScore]) -> dict[str, Any]:
    """J and L_MSE of some trials, the mean over members."""
    members = by_member(scores)
    parts = [L_MSE_by_state(of) for of in members]
    return {
        "J": _mean([sum(one.J for one in of) for of in members]),
        "L_MSE": _mean([L_MSE(of) for of in members]),
        "L_MSE_by_state": {name: _mean([of[name] for of in parts]) for name in parts[0]},
        "n_samples": sum(one.n_samples for one in members[0]),
    }


def _mean(values: Sequence[float]) -> float | None:
    """The mean, None where it is not a number that JSON has."""
    mean = sum(values) / len(values)
    return float(mean) if np.isfinite(mean) else None


def _share_gone(before: float, after: float) -> float:
    """Of an error; of none, nothing is."""
    if before == 0.0:
        return 0.0 if after == 0.0 else -np.inf
    return 1.0 - after / before


def improvement(
    before: Sequence[TrialScore],
    after: Sequence[TrialScore],
) -> tuple[float, tuple[float, float] | None]:
    """Share of L_MSE that is gone, and its 95 % interval by drawing runs anew; None with fewer than three runs.

    before, after  scores of the same trials by two models
    """
    share = _share_gone(L_MSE(before), L_MSE(after))
    old, new = by_run(before), by_run(after)
    runs = list(old)
    if len(runs) < 3:
        return share, None

    def gone(chosen: IntArray) -> float:
        a = L_MSE([score for k in chosen for score in new[runs[k]]])
        b = L_MSE([score for k in chosen for score in old[runs[k]]])
        return _share_gone(b, a)

    return share, interval_of(gone, len(runs), SEED)
