"""A network beside a model of forces, trained and chosen: what ``mmgtune learn hybrid`` does."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..backends import STATES
from ..displayed import Plotted
from ..errors import OptionError, Problem, must_be_a
from ..files import kept_in
from ..hooks import Hooks
from ..model import Model
from ..networks.hybrid import Hybrid, HybridPredictor
from ..networks.residual import Ranges, ResidualWeights
from ..objective import spread, varying
from ..options.choice import must_be
from ..options.learning import HybridOptions
from ..predictor import as_predictor
from ..profile import ShipProfile
from ..scores import TrialScore, score
from ..trial import Trial
from . import records
from .choosing import pieces_of
from .gains import Gain, Trained, curve_of, gains_of
from .hybrid import HybridAim, ResidualLoss, first_residual, ranges_of
from .keeping import Kept
from .provenance import provenance_of, travelling
from .refitting import refitted, tuned_names
from .samples import Samples, samples_of
from .splitting import Split, fold_runs, split_runs
from .task import warned
from .training import Plan, Progressed, Trainer, needed

LAG, STEP = 0.5, 0.03
"""Memory, and step of training, as shares of the time the ship takes for her length at her root mean square speed."""

LEAST = 0.02
"""Share of the error that a network must remove on unseen runs to be kept."""

DECAY = 1e-4
"""Decay of the weights in each update, relative to the rate."""


@dataclass(frozen=True, eq=False)
class LearnedHybrid(Plotted):
    """A hybrid, and how it was chosen.

    hybrid   what does best on runs that were not learned from; the model of forces alone where nothing does better, and
             where the training was stopped before one was chosen and trained on all runs
    penalty  weight of the penalty chosen, None where nothing is gained
    step     updates after which it does best
    step_s   of the integration within training [s]
    tried    of each weight of the penalty the score by step, 1 being the model of forces alone
    gains    on the runs that chose, by kind of manoeuvre
    scores   of the trials held out, before and after
    warnings  what to know of it: that the trials are of another ship, where they are
    """

    written_by = "write_learned"

    hybrid: Hybrid
    penalty: float | None
    step: int
    step_s: float
    tried: dict[float, list[dict[str, float]]]
    gains: tuple[Gain, ...]
    splits: tuple[Split, ...]
    test: tuple[Trial, ...]
    scores: dict[str, tuple[TrialScore, ...]]
    sigma: dict[str, float]
    options: HybridOptions
    provenance: dict[str, Any]
    events: tuple[dict[str, Any], ...]
    interrupted: bool
    wall_s: float
    warnings: tuple[str, ...] = ()

    @property
    def gained(self) -> bool:
        """Whether the network does better than none."""
        return self.penalty is not None

    def as_ship(self) -> Hybrid:
        """What was trained: what the result stands for where a ship is wanted."""
        return self.hybrid

    def __repr__(self) -> str:
        """In a line."""
        said = ", ".join(f"{one.manoeuvre} {100 * one.share:.0f} %" for one in self.gains) if self.gained else "no gain"
        return f"LearnedHybrid({self.hybrid.profile.id}: {said})"

    def to_dict(self) -> dict[str, Any]:
        """The document of ``hybrid.json``: everything but the weights."""
        return records.of_hybrid(self)


def learn_hybrid(
    ship: ShipGiven,
    trials: TrialsGiven,
    options: HybridOptions = HybridOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | str | None = None,
    resume: bool = False,
    command: str = "",
) -> LearnedHybrid:
    """Train a network on what a profile leaves of the trials that tune; keep it only where it helps unseen runs.

    ship    profile, as tuned; its coefficients stay
    hooks   what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder  for checkpoints; None for none
    resume  go on with what is there: the result is that of a run without a stop, bit for bit
    Raises OptionError for too few runs or trials from which nothing can be learned, and where JAX is missing.
    """
    folder = kept_in(folder, resume)
    must_be(options, HybridOptions)
    must_be_a(hooks, Hooks, "hooks")
    began = time.perf_counter()
    needed()
    profile, data = ship_of(ship), trials_of(trials).series_only("a network")
    tune = [data.trials[id] for id in data.tune]
    test = tuple(data.trials[id] for id in data.test)
    splits = splits_of(tune, options)
    step, lag = times_of(profile, tune, options)
    sigma = varying(spread(tune), "trials", "give trials that do")
    identity = {
        "profile": profile.sha256,
        "trials": data.hashes(),
        "tune": list(data.tune),
        "options": options.to_dict(),
    }
    total = (len(splits) * len(options.penalty) + 1) * options.steps
    deviations = np.array([sigma[name] for name in STATES])
    work = _Work(profile, tune, splits, options, step, lag, deviations, hooks, Kept(folder, identity, resume), total)
    ranges = work.ranges
    trained: dict[float, list[Trained]] = {}
    for penalty in options.penalty:
        trained[penalty] = [work.train(penalty, split) for split in splits]
    tried = {penalty: curve_of(of) for penalty, of in trained.items()}
    steps = [(penalty, row) for penalty, rows in tried.items() for row in rows]
    penalty, best = min(steps, key=lambda one: one[1]["score"], default=(0.0, None))
    gains: list[Gain] = []
    events: list[dict[str, Any]] = []
    step_kept = 0
    if best is not None and best["score"] < 1.0 - LEAST:
        step_kept = int(best["step"])
        weights, events = work.train_on_all(penalty, step_kept)
        if not work.stopped:
            gains = gains_of(trained[penalty], step_kept, options.seed)
    if not gains:
        weights = first_residual(len(ranges.deviation), options.width, options.seed)  # adds nothing
    made = provenance_of(profile, data, tune, options, command)
    hybrid = Hybrid(profile, weights, ranges, lag, {**travelling(made), "type": "hybrid"})
    pieces = pieces_of(test, options.restart)
    models = {"before": as_predictor(profile), "after": HybridPredictor(hybrid)}
    return LearnedHybrid(
        hybrid,
        penalty if gains else None,
        step_kept,
        step,
        tried,
        tuple(gains),
        tuple(splits),
        test,
        {which: tuple(score(one, pieces, sigma)) for which, one in models.items()} if pieces else {},
        sigma,
        options,
        made,
        (*(event for of in trained.values() for one in of for event in one.events), *events),
        work.stopped,
        time.perf_counter() - began,
        warned(profile, data),
    )


def splits_of(trials: Sequence[Trial], options: HybridOptions) -> list[Split]:
    """Parts of the runs that are kept back in turn.  Raises OptionError for too few."""
    if options.folds > 1:
        return fold_runs(trials, options.folds, options.seed)
    return [split_runs(trials, options.validation, options.seed)]


def times_of(profile: ShipProfile, trials: Sequence[Trial], options: HybridOptions) -> tuple[float, float]:
    """Step of the integration within training, and time constant of the network's memory [s].

    Raises OptionError where the ship never moves.
    """
    length_time = profile.L_pp / _speed(trials)
    return options.step or STEP * length_time, options.lag or LAG * length_time


@dataclass(eq=False)
class _Work:
    """What all trainings of a run share."""

    profile: ShipProfile
    tune: Sequence[Trial]
    splits: Sequence[Split]
    options: HybridOptions
    step: float
    lag: float
    sigma: Any
    hooks: Hooks
    kept: Kept
    total: int
    done: int = 0
    stopped: bool = False
    _without: dict[tuple[str, ...], Model] = field(default_factory=dict)
    _trainer: Trainer | None = None

    @cached_property
    def model(self) -> Model:
        """The model of forces as given."""
        return Model(self.profile)

    def unseen(self, learn: Sequence[Trial]) -> Model:
        """The model of forces as it would be had it been tuned to these trials alone."""
        ids = tuple(trial.id for trial in learn)
        if ids not in self._without:
            self._without[ids] = self.model
            if self.options.refit and tuned_names(self.profile):
                self.hooks.on_progress(self.done, self.total, "tuning the model of forces without the runs kept back")
                again = refitted(self.profile, learn, restart=self.options.restart, stop=self.hooks.stop)
                self._without[ids] = Model(again)
        return self._without[ids]

    def samples(self, trials: Sequence[Trial]) -> Samples:
        """Trials on the step of training."""
        return samples_of(trials, self.model.inputs, self.step, self.model.draught)

    @cached_property
    def all_samples(self) -> Samples:
        """All runs that tune."""
        return self.samples(self.tune)

    @cached_property
    def ranges(self) -> Ranges:
        """What the data says of features, the same for all parts."""
        return ranges_of(self.all_samples, self.lag, [one.role for one in self.model.arrangement.inputs])

    @cached_property
    def loss(self) -> ResidualLoss:
        """What is made small: compiled once for all trainings.

        Windows are as long as is asked for, or as every part of the runs has one without an end.
        """
        longest = min(max(trial.duration for trial in split.learn) for split in self.splits)
        horizon = max(2, round(min(longest, self.options.restart or longest) / self.step - 0.5))
        return ResidualLoss(self.model, memory=self.lag, step=self.step, horizon=horizon)

    @cached_property
    def plan(self) -> Plan:
        """How long, how fast."""
        one = self.options
        return Plan(one.steps, one.batch, one.rate, one.validate_every, DECAY)

    def train(self, penalty: float, split: Split) -> Trained:
        """Train on the one part of the runs, judge by the other."""
        model = self.unseen(split.learn)
        self.stopped = self.stopped or self.hooks.stop()  # then the model was not tuned to its end
        aim = self.aim(model, penalty, split.learn, split.choose)
        now = self._run(aim, f"penalty {penalty:g}", None)
        return Trained(aim.alone(now.mean) if now.curve else {}, aim.runs, now.curve, now.events)

    def train_on_all(self, penalty: float, until: int) -> tuple[ResidualWeights, list[dict[str, Any]]]:
        """Train on all runs, for as long as did best on unseen ones; and what went wrong."""
        now = self._run(self.aim(self.model, penalty, self.tune, ()), "all runs", until)
        return ResidualWeights(*(np.asarray(one, dtype=np.float64) for one in now.mean)), now.events

    def aim(self, model: Model, penalty: float, learn: Sequence[Trial], choose: Sequence[Trial]) -> HybridAim:
        """What is trained for."""
        aim = HybridAim(
            self.loss,
            model,
            self.samples(learn) if len(learn) < len(self.tune) else self.all_samples,
            choose,
            self.ranges,
            sigma=self.sigma,
            penalty=penalty,
            restart=self.options.restart,
            rows=len(self.all_samples.states),
        )
        if not len(aim.starts):
            raise OptionError(
                Problem(
                    f"no trial has {self.loss.horizon * self.step:g} s without a gap",
                    "restart",
                    "windows without gaps are what is learned from",
                    "write a smaller restart, or give longer trials",
                )
            )
        return aim

    def _run(self, aim: HybridAim, words: str, until: int | None) -> Progressed:
        options = self.options
        self._trainer = trainer = self._trainer.on(aim) if self._trainer else Trainer(aim, self.plan)
        begin = first_residual(len(self.ranges.deviation), options.width, options.seed)
        before, number = self.done, self.done // options.steps
        now = self.kept.begun(number, trainer.begin(begin))

        def told(one: Progressed) -> None:
            self.kept.keep(number, one)
            row = one.curve[-1]
            said = f", validation {100 * row['score']:.1f} % of the model's error" if aim.runs else ""
            self.hooks.on_progress(before + one.step, self.total, f"{words}, loss {row['loss']:.4g}{said}")

        if not self.stopped and now.step < (until or options.steps):
            now = trainer.run(now, options.seed, until=until, on_validation=told, stop=self.hooks.stop)
        self.stopped = self.stopped or self.hooks.stop()
        self.done += options.steps
        return now


def _speed(trials: Sequence[Trial]) -> float:
    """Root mean square speed [m/s]."""
    squares = np.concatenate([trial.u**2 + trial.v_m**2 for trial in trials]) if trials else np.zeros(0)
    squares = squares[np.isfinite(squares)]
    if not squares.size or not squares.mean() > 0.0:
        raise OptionError(Problem("the ship does not move in these trials", "trials", "", "give trials under way"))
    return float(np.sqrt(squares.mean()))
