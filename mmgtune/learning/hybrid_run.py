"""A network beside a model of forces, trained and chosen: what ``mmgtune learn hybrid`` does."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from ..backends import STATES
from ..errors import OptionError, Problem
from ..fitting.run import facts_of_profile, made_by
from ..given import ShipGiven, TrialsGiven, ship_of, trials_of
from ..model import Model
from ..networks.hybrid import Hybrid, HybridPredictor
from ..networks.residual import Ranges, ResidualWeights
from ..objective import spread
from ..options.learning import HybridOptions
from ..predictor import as_predictor
from ..profile import ShipProfile
from ..trial import Trial, TrialSet
from ..validation import TrialScore, score
from . import keeping
from .choosing import pieces_of
from .hybrid import HybridAim, first_residual, ranges_of, ratios, relative
from .refitting import refitted, tuned_names
from .run import Hooks
from .samples import Samples, samples_of
from .splitting import Split, fold_runs, split_runs
from .training import Plan, Progressed, Trainer

LAG, STEP = 0.5, 0.03
"""Memory, and step of training, as shares of the time the ship takes for her length at her root mean square speed."""

DRAWS = 2000
"""Times runs are drawn anew for an interval."""


@dataclass(frozen=True)
class Gain:
    """What the network removes of the error on runs it has not seen, of one kind of manoeuvre.

    share     of L_MSE that is gone
    interval  95 %, by drawing runs anew; None with fewer than three
    """

    manoeuvre: str
    runs: int
    before: float
    after: float
    share: float
    interval: tuple[float, float] | None

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "manoeuvre": self.manoeuvre,
            "runs": self.runs,
            "L_MSE_before": self.before,
            "L_MSE_after": self.after,
            "share_removed": self.share,
            "share_removed_ci95": self.interval,
        }


@dataclass(frozen=True, eq=False)
class LearnedHybrid:
    """A hybrid, and how it was chosen.

    hybrid   what does best on runs that were not learned from; the model of forces alone where nothing does better
    quiet    weight of the penalty chosen, None where nothing is gained
    step     updates after which it does best
    tried    of each weight of the penalty the score by step, 1 being the model of forces alone
    gains    on the runs that chose, by kind of manoeuvre
    scores   of the trials held out, before and after
    """

    hybrid: Hybrid
    quiet: float | None
    step: int
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

    @property
    def gained(self) -> bool:
        """Whether the network does better than none."""
        return self.quiet is not None

    def __repr__(self) -> str:
        """In a line."""
        said = ", ".join(f"{one.manoeuvre} {100 * one.share:.0f} %" for one in self.gains) if self.gained else "no gain"
        return f"LearnedHybrid({self.hybrid.profile.id}: {said})"


def learn_hybrid(
    ship: ShipGiven,
    trials: TrialsGiven,
    options: HybridOptions = HybridOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | None = None,
    resume: bool = False,
    command: str = "",
) -> LearnedHybrid:
    """Train a network on what a profile leaves of the trials that tune; keep it only where it helps unseen runs.

    ship    profile, as tuned; its coefficients stay
    folder  for checkpoints; None for none
    resume  go on with what is there: the result is that of a run without a stop, bit for bit
    Raises OptionError for too few runs or trials from which nothing can be learned, and where JAX is missing.
    """
    began = time.perf_counter()
    profile, data = ship_of(ship), trials_of(trials).series_only("a network")
    tune = [data.trials[id] for id in data.tune]
    test = tuple(data.trials[id] for id in data.test)
    several = options.folds > 1
    splits = fold_runs(tune, options.folds, options.seed) if several else []
    splits = splits or [split_runs(tune, options.validation, options.seed)]
    length_time = profile.L_pp / _speed(tune)
    step, lag = options.step or STEP * length_time, options.lag or LAG * length_time
    sigma = spread(tune)
    work = _Work(profile, options, step, lag, np.array([sigma[name] for name in STATES]), hooks, folder, resume)
    work.identity = {
        "profile": profile.sha256,
        "trials": data.hashes(),
        "tune": list(data.tune),
        "options": options.to_dict(),
        "versions": {name: version(name) for name in ("jax", "jaxlib", "optax", "numpy")},
    }
    work.total = (len(splits) * len(options.quiet) + 1) * options.steps
    if resume and folder is not None and not list(folder.glob("training-*.safetensors")):
        why = "the folder holds no checkpoint: the run ended, or never came to its first validation"
        raise OptionError(Problem("nothing to resume", str(folder), why, "run without resume=True"))
    ranges = work.ranges(tune)
    trained: dict[float, list[_Trained]] = {}
    for quiet in options.quiet:
        trained[quiet] = [work.train(quiet, split, ranges) for split in splits]
    tried = {quiet: _curve(of) for quiet, of in trained.items()}
    quiet, best = min(
        ((quiet, row) for quiet, rows in tried.items() for row in rows),
        key=lambda one: one[1]["score"],
        default=(0.0, {"score": 1.0, "step": 0.0}),
    )
    gained = best["score"] < 1.0
    chosen = trained[quiet]
    weights = chosen[0].best
    if gained:
        weights = work.train_on_all(quiet, tune, ranges, int(best["step"]))
    if not gained:
        weights = weights._replace(W_3=np.zeros_like(weights.W_3))
    facts = _facts(profile, data, options, command)
    hybrid = Hybrid(profile, weights, ranges, lag, {**facts, "type": "hybrid"})
    pieces = pieces_of(test, options.restart)
    models = {"before": as_predictor(profile), "after": HybridPredictor(hybrid)}
    return LearnedHybrid(
        hybrid,
        quiet if gained else None,
        int(best["step"]),
        tried,
        tuple(_gains(chosen, int(best["step"]), options.seed)) if gained else (),
        tuple(splits),
        test,
        {which: tuple(score(one, pieces, sigma)) for which, one in models.items()} if pieces else {},
        sigma,
        options,
        facts,
        tuple(event for of in trained.values() for one in of for event in one.events),
        work.stopped,
        time.perf_counter() - began,
    )


@dataclass(frozen=True, eq=False)
class _Trained:
    """A training of one part: errors of unseen runs by step, with and without the network."""

    best: ResidualWeights
    alone: dict[str, float]
    runs: dict[str, tuple[str, int]]
    curve: list[dict[str, float]]
    events: list[dict[str, Any]]


@dataclass(eq=False)
class _Work:
    """What all trainings of a run share."""

    profile: ShipProfile
    options: HybridOptions
    step: float
    lag: float
    sigma: Any
    hooks: Hooks
    folder: Path | None
    resume: bool
    identity: dict[str, Any] | None = None
    total: int = 0
    done: int = 0
    stopped: bool = False
    _without: dict[tuple[str, ...], Model] = field(default_factory=dict)

    @cached_property
    def model(self) -> Model:
        """The model of forces as given."""
        return Model(self.profile)

    def unseen(self, learn: Sequence[Trial]) -> Model:
        """The model of forces as it would be had it been tuned to these trials alone."""
        ids = tuple(trial.id for trial in learn)
        if ids not in self._without:
            refit = self.options.refit and tuned_names(self.profile)
            if refit:
                self.hooks.on_progress(self.done, self.total, "tuning the model of forces without the runs kept back")
            again = refitted(self.profile, learn, restart=self.options.restart, stop=self.hooks.stop)
            self._without[ids] = Model(again) if refit else self.model
        return self._without[ids]

    def samples(self, trials: Sequence[Trial]) -> Samples:
        """Trials on the step of training."""
        return samples_of(trials, self.model.inputs, self.step, self.model.draught)

    def ranges(self, trials: Sequence[Trial]) -> Ranges:
        """What the data says of features, the same for all parts."""
        return ranges_of(self.samples(trials), self.lag, [one.role for one in self.model.arrangement.inputs])

    def train(self, quiet: float, split: Split, ranges: Ranges) -> _Trained:
        """Train on the one part of the runs, judge by the other."""
        aim = self.aim(self.unseen(split.learn), quiet, split.learn, split.choose, ranges)
        now = self._run(aim, f"penalty {quiet:g}", None)
        best = ResidualWeights(*(np.asarray(one, dtype=np.float64) for one in now.best))
        return _Trained(best, aim.alone(now.mean), aim.runs, now.curve, now.events)

    def train_on_all(self, quiet: float, trials: Sequence[Trial], ranges: Ranges, until: int) -> ResidualWeights:
        """Train on all runs, for as long as did best on unseen ones."""
        now = self._run(self.aim(self.model, quiet, trials, trials, ranges), "all runs", until)
        return ResidualWeights(*(np.asarray(one, dtype=np.float64) for one in now.mean))

    def aim(
        self, model: Model, quiet: float, learn: Sequence[Trial], choose: Sequence[Trial], ranges: Ranges
    ) -> HybridAim:
        """What is trained for."""
        samples = self.samples(learn)
        longest = max(int(n) for n in np.diff(samples.first)) - 1
        horizon = min(longest, max(2, round(self.options.restart / self.step))) if self.options.restart else longest
        aim = HybridAim(
            model,
            samples,
            choose,
            ranges,
            memory=self.lag,
            sigma=self.sigma,
            horizon=horizon,
            quiet=quiet,
            restart=self.options.restart,
        )
        if not len(aim.starts):
            raise OptionError(
                Problem(
                    f"no trial has {horizon * self.step:g} s without a gap",
                    "restart",
                    "windows without gaps are what is learned from",
                    "write a smaller restart, or give longer trials",
                )
            )
        return aim

    def _run(self, aim: HybridAim, words: str, until: int | None) -> Progressed:
        options = self.options
        trainer = Trainer(aim, Plan(options.steps, options.batch, options.rate, options.validate_every, DECAY))
        begin = first_residual(len(np.asarray(aim.ranges.deviation)), options.width, options.seed)
        now = trainer.begin(begin)
        path = None if self.folder is None else self.folder / keeping.named(self.done // options.steps)
        assert self.identity is not None
        identity = self.identity
        if path is not None and self.resume and path.is_file():
            now = keeping.load(path, now, identity)
        before = self.done

        def told(one: Progressed) -> None:
            if path is not None:
                keeping.save(path, one, identity)
            row = one.curve[-1]
            said = f"{words}, loss {row['loss']:.4g}, validation {100 * row['score']:.1f} % of the model's error"
            self.hooks.on_progress(before + one.step, self.total, said)

        if not self.stopped and now.step < (until or options.steps):
            now = trainer.run(now, options.seed, until=until, on_validation=told, stop=self.hooks.stop)
        self.stopped = self.stopped or self.hooks.stop()
        self.done += options.steps
        return now


DECAY = 1e-4
"""Decay of the weights in each update, relative to the rate."""


def _curve(parts: Sequence[_Trained]) -> list[dict[str, float]]:
    """Score by step over the runs of all parts together."""
    alone = {run: value for one in parts for run, value in one.alone.items()}
    runs = {run: of for one in parts for run, of in one.runs.items()}
    found = []
    for rows in zip(*(one.curve for one in parts), strict=False):  # as far as all have come
        errors = {run: row[run] for one, row in zip(parts, rows, strict=True) for run in one.runs}
        by_kind = ratios(alone, errors, runs)
        mean_loss = float(np.mean([row["loss"] for row in rows]))
        found.append({"step": rows[0]["step"], "loss": mean_loss, "score": relative(alone, errors, runs), **by_kind})
    return found


def _gains(parts: Sequence[_Trained], step: int, seed: int) -> list[Gain]:
    """The gain by kind of manoeuvre on runs not learned from, after so many updates."""
    rows = [next(row for row in one.curve if row["step"] == step) for one in parts]
    all_runs = [
        (kind, n, one.alone[run], row[run])
        for one, row in zip(parts, rows, strict=True)
        for run, (kind, n) in one.runs.items()
    ]
    found = []
    for kind in sorted({one[0] for one in all_runs}):
        n, before, after = np.array([one[1:] for one in all_runs if one[0] == kind]).T
        old, new = float(n @ before / n.sum()), float(n @ after / n.sum())
        interval = None
        if len(n) > 2:
            rng = np.random.default_rng([seed, 6])
            drawn = rng.integers(len(n), size=(DRAWS, len(n)))
            shares = 1.0 - (n * after)[drawn].sum(axis=1) / (n * before)[drawn].sum(axis=1)
            low, high = np.percentile(shares, [2.5, 97.5])
            interval = float(low), float(high)
        found.append(Gain(kind, len(n), old, new, 1.0 - new / old, interval))
    return found


def _speed(trials: Sequence[Trial]) -> float:
    """Root mean square speed [m/s]."""
    squares = np.concatenate([trial.u**2 + trial.v_m**2 for trial in trials]) if trials else np.zeros(0)
    squares = squares[np.isfinite(squares)]
    if not squares.size or not squares.mean() > 0.0:
        raise OptionError(Problem("the ship does not move in these trials", "trials", "", "give trials under way"))
    return float(np.sqrt(squares.mean()))


def _facts(profile: Any, data: TrialSet, options: HybridOptions, command: str) -> dict[str, Any]:
    """What a hybrid was made from."""
    made = made_by(command)
    made["environment"] |= {name: version(name) for name in ("jax", "optax")}
    return {
        **made,
        "profile": facts_of_profile(profile),
        "trials": {
            "path": str(data.path) if data.path else "",
            "ship": data.ship,
            "sources": sorted({data.trials[id].source for id in data.tune}),
            "licence": data.licence,
            "citation": data.citation,
            "sha256": data.hashes(),
            "learned_from": list(data.tune),
        },
        "options": options.to_dict(),
    }
