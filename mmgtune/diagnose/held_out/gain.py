"""What the causes gain on trials they were not found on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np

from ...arrays import FloatArray
from ...backends import STATES
from ...displayed import Brief
from ...documents import finite
from ...drawing_anew import interval_of
from ...fitting.box import group_of
from ...fitting.comparison import ComparedTrials, TrialComparison
from ...fitting.least_squares import fit_offsets, squares_by_case
from ...fitting.problem import FitProblem
from ...model import Model
from ...objective import make_objective
from ...trial import Trial
from ..bench.inputs import DRAWS, changes
from ..bench.noise import ChannelNoise
from ..bench.workbench import Point, Workbench
from ..searching.search import Found
from ..signatures.intervals import OF_BOX, covariance
from .elsewhere import FIRST, estimated_there, first_part
from .unseen import Beside, Unseen, problem_on

RELEVANT = 0.05
"""Error beyond noise that is worth speaking of, as a share of the noise."""

BAND = 3.0
"""Multiple of the chi-squared expected from uncertain coefficients up to which they may be behind it: few directions
count."""

WORSE = 0.1
"""Share by which causes may make the error on test trials larger by chance."""

MISSED = 2.0
"""Error on test trials, over the noise of the sensors, from which these show that something is wrong."""

MOST = 0.9
"""Share of the error above noise on held-out trials that the right causes remove at least."""

MOST_RUNS, FAR_BEYOND = 2.0 / 3.0, 10.0
"""Share of the runs, at least two, that the others predict to within noise with the right causes; and the error of
these runs without the causes, as a multiple of what noise may bring."""

HeldOut = Literal["test", "each", "only"]
HELD_OUT: dict[HeldOut, str] = {
    "test": "test trials",
    "each": "each trial in turn",
    "only": "the trials themselves: there is only one",
}
"""Trials the gain is measured on, in words."""

LOST = 1e12
"""Sum of squares that stands for a diverged run."""

INDICES = ("tactical_diameter_m", "advance_m", "overshoot_1_deg", "overshoot_2_deg")
"""Indices whose errors are reported."""


@dataclass(frozen=True, eq=False, repr=False)
class Gain(Brief):
    """Before and after the causes, on held-out trials with their initial states estimated.

    held_out    the test trials; each in turn where there are none; the only one where there is but one
    compared    every held-out trial, "before" and "after"; ``compared.to_frame()`` has a row a trial
    excess      (n_trials, 2) chi-squared beyond the noise of the sensors, freed of its memory, before and after
    floor       chi-squared of all held-out trials by noise alone
    chance      standard deviation of chi-squared by noise alone
    first_part  share of each run that what differs between runs was estimated on; ``excess`` counts what follows alone
    unsure      chi-squared expected beyond noise from the uncertainty of coefficients and winds; 0 where nothing
                remains to be explained and it was not worked out
    """

    held_out: HeldOut
    compared: ComparedTrials
    excess: FloatArray
    floor: float
    chance: float
    first_part: float = 0.0
    unsure: float = 0.0

    @property
    def remains(self) -> bool:
        """Whether the causes leave more than noise on held-out trials, remove less than ``MOST`` of the error there,
        and do not predict most runs to within noise."""
        left = self.leaves_beside(BAND * self.unsure) and self.share_removed < MOST
        return left and not self.tells_most_runs

    def leaves_beside(self, excused: float = 0.0) -> bool:
        """Whether the causes leave more on held-out trials than noise and ``excused`` chi-squared."""
        return float(self.excess[:, 1].sum()) > RELEVANT * self.floor + 3.0 * self.chance + excused

    @property
    def tells_most_runs(self) -> bool:
        """Whether most of several runs are predicted to within noise by the others, and none worse than without
        causes."""
        told, runs = self.runs_told
        return told > 1 and told >= MOST_RUNS * runs

    @cached_property
    def runs_told(self) -> tuple[int, int]:
        """Runs left out in turn that the other runs predict to within noise with the causes, and far from it without;
        and the number of runs. None where a run is predicted worse with the causes, by more than uncertain coefficients
        explain.

        Coefficients that only a single run determines make it badly predicted by the others, whatever the cause.
        """
        runs = [one.trial.run for one in self.compared]
        if self.held_out != "each":
            return 0, len(dict.fromkeys(runs))
        samples = np.array([one.trial.n_samples for one in self.compared], dtype=float)
        told, worse = 0, False
        for run in dict.fromkeys(runs):
            own = np.array([one == run for one in runs])
            share = float(samples[own].sum() / samples.sum())
            noise = RELEVANT * share * self.floor + 3.0 * np.sqrt(share) * self.chance
            before, after = self.excess[own].sum(axis=0)
            told += bool(after <= noise and before > FAR_BEYOND * noise)
            worse = worse or bool(after > max(before, noise, self.unsure))
        return 0 if worse else told, len(dict.fromkeys(runs))

    @property
    def left(self) -> float:
        """Error that the causes leave on held-out trials, over the noise of the sensors, which it includes."""
        return float(np.sqrt(1.0 + max(float(self.excess[:, 1].sum()), 0.0) / self.floor))

    @property
    def missed(self) -> bool:
        """Whether test trials are predicted so badly that something is wrong which the other trials do not show."""
        return self.held_out == "test" and self.remains and self.left > MISSED

    @property
    def form_is_off(self) -> bool:
        """Whether causes that tell most of the error leave far more than noise on test trials, and more than uncertain
        coefficients may be behind."""
        far = self.left > MISSED and self.leaves_beside(BAND * self.unsure)
        return self.held_out == "test" and far and not self.remains

    @property
    def tells_nothing(self) -> bool:
        """Whether uncertain coefficients may be behind all of the error, that without the causes too."""
        return float(self.excess[:, 0].sum()) <= self.unsure

    @property
    def too_few(self) -> bool:
        """Whether the other runs predict a run badly that is fitted well together with them: they are too few for what
        is re-tuned."""
        return self.held_out == "each" and self.left > MISSED

    @property
    def worse(self) -> bool:
        """Whether test trials are predicted worse with the causes than without, beyond chance, all together and most of
        them.

        Held-out error alone is no evidence where each run is left out: the targets themselves are known too badly then.
        """
        before, after = self.excess.sum(axis=0).tolist()
        most = float(np.mean(self.excess[:, 1] > self.excess[:, 0])) > 0.5
        return self.held_out == "test" and after - before > max(WORSE * before, 3.0 * self.chance) and most

    @property
    def mostly_remains(self) -> bool:
        """Whether the causes leave more than half of the error on test trials, and more than was to be expected."""
        return self.held_out == "test" and self.remains and self.share_removed < 0.5

    @property
    def J(self) -> tuple[float | None, float | None]:
        """J before and after over all held-out trials (Suyama et al. 2023, eq. 40)."""
        before = sum(one.J["before"] for one in self.compared)
        after = sum(one.J["after"] for one in self.compared)
        return finite(before), finite(after)

    @property
    def J_is_of(self) -> str:
        """What J counts, where it falls by far less than the error beyond noise does; else ""."""
        before, after = self.J
        if before is None or after is None or before - after >= 0.5 * self.share_removed * before:
            return ""
        return "J counts positions and heading alone, and their noise"

    @property
    def share_removed(self) -> float:
        """Share of the error above noise that the causes remove."""
        return _share(self.excess)

    @cached_property
    def interval(self) -> tuple[float, float] | None:
        """95 % interval of ``share_removed`` over trials; None for a single one, as nothing tells how much they
        differ."""
        if len(self.excess) < 2:
            return None
        return interval_of(lambda drawn: _share(self.excess[drawn]), len(self.excess), 0)

    @property
    def surely_removed(self) -> float:
        """The lower end of that interval; of a single trial the share itself."""
        return self.interval[0] if self.interval else self.share_removed

    def measures(self, which: str) -> dict[str, float]:
        """Means over trials of the seven distance measures, "before" or "after"."""
        found = [one.records[which].measures for one in self.compared]
        names = dict.fromkeys(name for one in found for name in one)
        return {name: float(np.mean([one[name] for one in found if name in one])) for name in names}

    @property
    def words(self) -> str:
        """What was held out, in words."""
        return HELD_OUT[self.held_out]

    @property
    def of_runs_in_words(self) -> str:
        """What stood for run-specific parameters on held-out trials, in words."""
        if not self.first_part:
            return "Nothing is taken for a single run: what is held out has the values of all."
        return (
            "What differs between runs was estimated in each held-out run from the first "
            f"{100.0 * self.first_part:.0f} % of it; the share of the error removed counts what comes after, J all."
        )

    @property
    def method(self) -> str:
        """How the trials were simulated."""
        return self.compared[0].records["after"].method

    def index_errors(self, which: str) -> dict[str, float]:
        """Mean absolute errors of manoeuvring indices, "before" or "after"."""
        errors: dict[str, list[float]] = {}
        for one in self.compared:
            for name in INDICES:
                measured, simulated = one.indices["measured"].get(name), one.indices[which].get(name)
                if measured is not None and simulated is not None:
                    errors.setdefault(name, []).append(abs(simulated - measured))
        return {name: float(np.mean(values)) for name, values in errors.items()}

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "held_out": self.words,
            "held_out_code": self.held_out,
            "method": self.method,
            "trials": [one.trial.id for one in self.compared],
            "J_test_before": self.J[0],
            "J_test_after": self.J[1],
            "J_is_of": self.J_is_of,
            "share_above_noise_removed": self.share_removed,
            "share_ci95": list(self.interval) if self.interval else None,
            "measures_before": {name: finite(value) for name, value in self.measures("before").items()},
            "measures_after": {name: finite(value) for name, value in self.measures("after").items()},
            "index_errors_before": self.index_errors("before"),
            "index_errors_after": self.index_errors("after"),
            "of_single_runs": {
                "estimated_on_first_share_of_run": self.first_part or None,
                "in_words": self.of_runs_in_words,
            },
            "by_trial": [
                {"trial": one.trial.id, "J_before": finite(one.J["before"]), "J_after": finite(one.J["after"])}
                for one in self.compared
            ],
        }


def _share(excess: FloatArray) -> float:
    before, after = np.maximum(excess.sum(axis=0), 0.0)
    return float(1.0 - after / before) if before > 0.0 else 0.0


def held_out(found: Found, unseen: Unseen) -> Gain:
    """The gain on test trials; where there are none, on each trial with everything refitted without it.

    Windows of one trial are left out together.
    """
    gain = measured(found, unseen)
    bench, test = unseen.bench, unseen.test
    if gain.held_out == "only" or not (gain.remains or gain.form_is_off):
        return gain
    n = len({trial.run for trial in bench.trials})
    scale = 1.0 if test else n / (n - 1.0)  # fitted without one of the runs
    return replace(gain, unsure=scale * expected(bench, found, test or bench.trials))


def expected(bench: Workbench, found: Found, trials: Sequence[Trial]) -> float:
    """Chi-squared expected on unseen trials from parameter and wind uncertainty alone (median over draws).

    Initial states are re-estimated to first order in each draw.  Where trials turn to one side only,
    coefficients of the other are anywhere in their box.
    """
    names, spread = covariance(bench, found.final)
    beside = Beside.of(bench, (found.base, found.final), trials)
    at = beside.units[-1]
    offsets = fit_offsets(beside.scaled, at, whiten=_freeing(bench, beside.scaled))
    rng = np.random.default_rng(0)
    drawn = np.zeros((DRAWS, 0))
    if names:  # what is at a bound is not in doubt, and a short list of targets may all be there
        drawn = rng.multivariate_normal(np.zeros(len(names)), spread, DRAWS, method="eigh")
    columns = np.repeat(at[:, None], DRAWS, axis=1)
    rows = [beside.wide.names.index(name) for name in names]
    columns[rows] = np.clip(at[rows][:, None] + drawn.T, 0.0, 1.0)
    problem = beside.judged
    base = problem.residuals(at[:, None], offsets[:, None]).T
    runs = _with_other_ties(problem, columns, np.repeat(offsets[:, None], DRAWS, axis=1), rng)
    runs = runs[:, np.isfinite(runs).all(axis=0)]
    winds = changes(problem, at, offsets, bench.options.seed, logged=False)[:, : runs.shape[1]]
    moved, by_offset = runs - base + winds, problem.offset_slopes(at, offsets)[1]
    if freeing := _freeing(bench, problem):
        moved, by_offset = freeing(moved), freeing(by_offset)
    moved = problem.without_offsets(moved, by_offset, problem.prior)
    return float(np.median(np.sum(moved**2, axis=0))) if moved.shape[1] else 0.0


def _with_other_ties(
    problem: FitProblem, columns: FloatArray, offsets: FloatArray, rng: np.random.Generator
) -> FloatArray:
    """Residuals (n_rows, n_candidates) of candidates (n_targets, n_candidates), each with coefficients that are tied
    somewhere else in the box of those that they follow."""
    ties = [tie for tie in problem.model.ties if tie.to in problem.box.names]
    if not ties:
        return problem.residuals(columns, offsets).T
    held = [tie for tie in problem.model.ties if tie not in ties]
    leaders = problem.box.part([tie.to for tie in ties])
    off = np.sqrt(OF_BOX) * leaders.width / np.abs(leaders.pre)
    found = []
    for k in range(columns.shape[1]):
        factors = np.maximum(1.0 + off * rng.standard_normal(len(ties)), 0.0)
        other = [tie._replace(ratio=tie.ratio * float(by)) for tie, by in zip(ties, factors, strict=True)] + held
        drawn = problem.with_targets(Model(problem.model.profile, other), problem.box)
        found.append(drawn.residuals(columns[:, k : k + 1], offsets[:, k : k + 1])[0])
    return np.stack(found, axis=1)


def measured(found: Found, unseen: Unseen) -> Gain:
    """The gain as by ``held_out``, with ``unsure`` left at 0."""
    bench, test = unseen.bench, unseen.test
    if test:
        compared, excess = _on(bench, found.base, found.final, test)
        by_noise, used = _chance(bench, test, found.final), _share_used(found.final, test)
        return Gain("test", ComparedTrials(compared), excess, *by_noise, used)
    every: list[TrialComparison] = []
    rows = []
    for (before, after), trials in unseen.fits((found.base, found.final)):
        compared, excess = _on(bench, before, after, trials)
        every += compared
        rows.append(excess)
    if len({trial.run for trial in bench.trials}) < 2:
        return Gain("only", ComparedTrials(every), np.concatenate(rows), *_chance(bench, bench.trials))
    used = FIRST if any(group_of(name) for name in found.final.names) else 0.0
    left = (1.0 - used) * sum(trial.n_samples for trial in bench.trials)
    return Gain("each", ComparedTrials(every), np.concatenate(rows), *_by_noise(bench, left), used)


def _share_used(point: Point, trials: Sequence[Trial]) -> float:
    """Share of each run on which run-specific parameters are estimated."""
    return FIRST if first_part(point, trials).any() else 0.0


def _chance(bench: Workbench, trials: Sequence[Trial], point: Point | None = None) -> tuple[float, float]:
    """Expectation and deviation of chi-squared by noise alone, on the samples after the part that run-specific
    parameters are estimated on."""
    used = 0 if point is None else int(first_part(point, trials).sum())
    return _by_noise(bench, sum(trial.n_samples for trial in trials) - used)


def _by_noise(bench: Workbench, n: float) -> tuple[float, float]:
    """Expectation and deviation of chi-squared of n samples; noise with a memory has few independent samples."""
    channels = _counted(bench).values()
    expected = n * sum(noise.variance for noise in channels)
    variance = 0.0
    for noise in channels:
        longer = (1.0 + noise.phi**2) / (1.0 - noise.phi**2)
        variance += 2.0 * n * (noise.white**2 + 2.0 * noise.white * noise.fading + longer * noise.fading**2)
    return float(expected), float(np.sqrt(variance))


def _is_freed(bench: Workbench) -> bool:
    """Whether residuals are freed of the memory of noise before they are squared.

    What wanders by metres for minutes, as positions of a satellite receiver do, would hide all that a cause explains.
    Noise that may be an error of the model would be freed of that.
    """
    return bench.noise.coloured and not bench.noise.may_be_error


def _counted(bench: Workbench) -> Mapping[str, ChannelNoise]:
    """Noise by channel of the residuals that are squared."""
    return dict.fromkeys(bench.channels, ChannelNoise()) if _is_freed(bench) else bench.noise.channels


def _freeing(bench: Workbench, problem: FitProblem) -> Callable[[FloatArray], FloatArray] | None:
    """The map that frees residuals (n_residuals, ...) of the memory of noise; None where this is not done."""
    return replace(bench.noise, cases=problem.cases).apply if _is_freed(bench) else None


def J_of(bench: Workbench, point: Point, test: Sequence[Trial]) -> float | None:
    """J of a point over test trials, their initial states estimated; None without such trials."""
    if not test:
        return None
    point = estimated_there(bench, point, test)
    problem = problem_on(bench, point, test, make_objective(bench.model.L_pp))
    offsets = fit_offsets(problem, point.unit)
    return finite(float(problem.costs(point.unit[:, None], offsets[:, None])[0]))


def _on(
    bench: Workbench, before: Point, after: Point, trials: Sequence[Trial]
) -> tuple[list[TrialComparison], FloatArray]:
    """Comparisons and chi-squared above noise (n_trials, 2) on trials; the latter on what follows the part of each that
    something is estimated on."""
    beside = Beside.of(bench, (before, after), trials)
    compared = beside.compared()
    judged = beside.judged
    floor = np.array([_floor(bench, judged, case) for case in range(len(trials))])
    excess = np.empty((len(trials), 2))
    freeing = _freeing(bench, beside.scaled), _freeing(bench, judged)
    for k, unit in enumerate(beside.units):
        offsets = fit_offsets(beside.scaled, unit, whiten=freeing[0])
        excess[:, k] = squares_by_case(judged, unit, offsets, freeing[1]) - floor
    return compared, np.where(np.isfinite(excess), excess, LOST)


def _floor(bench: Workbench, problem: FitProblem, case: int) -> float:
    """Chi-squared that noise alone brings to a case."""
    counts = (problem.cases.weight[case] > 0.0).sum(axis=0)
    return float(sum(counts[STATES.index(name)] * noise.variance for name, noise in _counted(bench).items()))
