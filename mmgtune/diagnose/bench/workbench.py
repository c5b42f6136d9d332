"""The trials, the model with every effect, and refits of any hypothesis on them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypedDict, Unpack

import numpy as np

from ...arrays import FloatArray, IntArray
from ...backends import STATES, Integrator, get_backend
from ...components import split_name
from ...effects import Effect, Parameter, Visited, effect_tags
from ...fitting.box import Box, base_of, choose_targets, group_of, make_box, parameter_of
from ...fitting.least_squares import LeastSquaresResult, solve
from ...fitting.one_sided import followers, tied
from ...fitting.problem import FitProblem
from ...model import Model
from ...objective import LEAST, Objective, cases_of
from ...options import DiagnoseOptions
from ...profile import ShipProfile, read_off, with_all_effects
from ...trial import Coverage, Held, Trial, visited_by
from ...trial.kinematics import motion_noise
from .beliefs import FURTHEST, Beliefs, acting_kinds, forms, let_go, with_ends
from .noise import NoiseModel, by_channel, white
from .runs import between, labels_of
from .slopes import quick_slopes

TOLERANCE = 0.2
"""Fall of chi-squared that counts as none while searching; a fiftieth of what matters."""

STEPS, HARDLY = 20, 0.01
"""Steps of a fit that only has to show what there is to gain, and share of what it is held against that is nothing."""

FORM_OFF = 2.0
"""Standard deviations of a form from which it is another one."""

LOOSE = 3.0
"""Initial states may leave their first sample by this many deviations of white noise before noise is known better."""


@dataclass(frozen=True, eq=False)
class Point:
    """A fitted model.

    names    what was free: targets, then parameters of effects
    unit     (n_names,) position in the box
    offsets  (n_cases, 6) of the initial states
    chi2     sum of squared whitened residuals, of offsets over their deviations, and of what differs between runs over
             its spread
    spreads  of run-specific values, by ``runs.spread_key``, in the unit cube
    promised predicted further fall of chi-squared, by the linear problem of the last step
    """

    names: tuple[str, ...]
    unit: FloatArray
    offsets: FloatArray
    chi2: float
    integrator: Integrator
    spreads: Mapping[str, float] = field(default_factory=dict)
    promised: float = 0.0

    @property
    def foreseen(self) -> float:
        """Chi-squared predicted for the end of the fit if it were continued from here."""
        return self.chi2 - self.promised


class _How(TypedDict, total=False):
    """Keyword arguments of a refit; see ``Workbench.refits``."""

    integrator: Integrator | None
    max_iterations: int
    tolerance: float
    spreads: Mapping[str, float] | None
    hopeless: float


@dataclass(eq=False)
class Workbench:
    """What every part of a diagnosis works with.

    model     with every effect at its null or at the profile's own value
    sigma     (6,) white noise of each channel, from the trials' own columns
    targets   coefficients that may be re-tuned
    believed  of coefficients beside the targets that may move a little, and of the forms of effects
    box       of all these and of every parameter of every hypothesis
    noise     as known so far
    spreads   of values that groups of runs have of their own, by ``runs.spread_key``, in the unit cube
    held      inputs whose log looks held between updates, None where none does
    slopes    integrator of derivatives in refits that need not be precise, None for that of the problem
    updates   samples at which each input of each trial was updated, where logs were held and are read accordingly
    stop      asked within every refit; True ends it where it is
    """

    model: Model
    trials: list[Trial]
    options: DiagnoseOptions
    sigma: FloatArray
    targets: tuple[str, ...]
    box: Box
    problem: FitProblem
    noise: NoiseModel
    spreads: dict[str, float] = field(default_factory=dict)
    held: Held | None = None
    updates: list[list[IntArray]] | None = None
    slopes: Integrator | None = None
    believed: Beliefs = field(default_factory=Beliefs)
    stop: Callable[[], bool] = lambda: False

    @property
    def tuned_alone(self) -> tuple[str, ...]:
        """What is re-tuned without any cause: targets, what has leeway, and the forms of effects that act anyway."""
        return (*self.targets, *self.believed.leeway, *self.believed.of_acting)

    def beliefs(self, names: Sequence[str], spreads: Mapping[str, float]) -> tuple[FloatArray, FloatArray] | None:
        """What is believed of what is free before any trial is looked at; None for nothing.

        -> (k, n_names) matrix A and (n_names,) centre: |A (unit - centre)|^2 is part of chi-squared
        """
        rows = [] if (apart := between(names, spreads)) is None else [apart]
        loose, own = self.believed.rows(names)
        if loose:
            rows.append(own)
        if not rows:
            return None
        centre = np.zeros(len(names))
        centre[loose] = self.null([names[k] for k in loose])
        return np.concatenate(rows), centre

    @cached_property
    def visited(self) -> Visited:
        """What the trials visit."""
        return visited_by(self.trials, self.model.L_pp)

    @property
    def read_off(self) -> dict[str, float]:
        """Pivots of effects that these trials say themselves, by full name."""
        names = [f"{effect.kind}.{name}" for effect in self.model.effects for name in effect.read_off]
        return {name: self.model.profile.value(name) for name in names}

    @cached_property
    def factors(self) -> dict[str, str]:
        """Parameters of effects that are factors on a coefficient of the profile, and that coefficient."""
        return {
            f"{effect.kind}.{name}": coefficient
            for effect in self.model.effects
            for name, coefficient in effect.absorbed.items()
            if effect.nulls[name] == 1.0
        }

    @property
    def price(self) -> float:
        """Fall of chi-squared that a further free number must bring, by the Bayesian information criterion."""
        return math.log(self.problem.n_residuals)

    @property
    def channels(self) -> tuple[str, ...]:
        """Motion channels that count."""
        return tuple(self.noise.channels)

    @property
    def in_noise(self) -> Objective:
        """Objective that divides squares by the white noise of the sensors."""
        return _in_noise(self.sigma, self.channels)

    def sub_box(self, names: Sequence[str]) -> Box:
        """The box of some of its names, in their order."""
        return self.box.part(names)

    def parameter(self, name: str) -> Parameter:
        """A parameter of an effect by its name."""
        found = parameter_of(self.model, name)
        assert found is not None  # asked of parameters of effects only
        return found

    def problem_of(self, names: Sequence[str], integrator: Integrator | None = None) -> FitProblem:
        """The problem of fitting ``names``, everything else at its value in the profile."""
        problem = self.problem.with_targets(self.model, self.sub_box(names))
        return problem if integrator is None else problem.with_integrator(integrator)

    def by_slopes(self, problem: FitProblem) -> FitProblem:
        """A problem of this workbench, simulated as derivatives are that need not be precise."""
        alike = problem.integrator == self.problem.integrator
        return problem.with_integrator(self.slopes) if self.slopes and alike else problem

    def null(self, names: Sequence[str]) -> FloatArray:
        """(n_names,) position of the profile's values: targets at theirs, effects absent."""
        box = self.sub_box(names)
        return np.clip(box.to_unit(box.pre), 0.0, 1.0)

    def refit(self, names: Sequence[str], starts: FloatArray, offsets: FloatArray, **how: Unpack[_How]) -> Point:
        """The best of ``refits``."""
        return min(self.refits(names, starts, offsets, **how), key=lambda end: end.chi2)

    def refits(
        self,
        names: Sequence[str],
        starts: FloatArray,
        offsets: FloatArray,
        *,
        integrator: Integrator | None = None,
        max_iterations: int = 30,
        tolerance: float = TOLERANCE,
        spreads: Mapping[str, float] | None = None,
        hopeless: float = math.inf,
    ) -> list[Point]:
        """Fits of ``names`` from starts (n_names, n_starts), initial states beginning at ``offsets``.

        What is fitted has the forms of its effects besides, before all else.

        spreads   of values that groups of runs have of their own, those of the workbench where None
        hopeless  chi-squared that a fit must promise to fall below after its first steps, to go on
        """
        along, kept = self.believed.moving_with(names)
        names = (*along, *(names[k] for k in kept))
        starts = np.concatenate([np.repeat(self.null(along)[:, None], starts.shape[1], axis=1), starts[kept]])
        problem = self.problem_of(names, integrator).with_offsets(offsets)
        whiten = self.noise.apply if self.noise_known else None
        spreads = self.spreads if spreads is None else spreads
        beliefs = self.beliefs(names, spreads)
        ends = solve(
            problem,
            starts,
            max_iterations=max_iterations,
            stop=self.stop,
            whiten=whiten,
            tolerance=tolerance,
            beliefs=beliefs,
            trusting=True,
            hopeless=hopeless,
            slopes=self.by_slopes(problem).integrator if tolerance >= TOLERANCE else None,
        )
        method = problem.integrator
        further = [end.promised if math.isfinite(end.promised) else 0.0 for end in ends]
        return [
            Point(names, end.unit, end.offsets, self._total(end, beliefs), method, spreads, promised)
            for end, promised in zip(ends, further, strict=True)
        ]

    def gained(self, there: Point, unit: FloatArray, fall: float, hopeless: float = math.inf) -> tuple[float, Point]:
        """Fall of chi-squared by a fit on this workbench of what is free at a point fitted on another, and its end.

        unit      (n_names,) where it starts
        fall      that it is held against: the fit is only as close as shows which share of it there is to gain
        hopeless  as in ``refits``
        """
        end = self.refit(
            there.names,
            unit[:, None],
            there.offsets,
            integrator=there.integrator,
            spreads=there.spreads,
            max_iterations=STEPS,
            tolerance=HARDLY * fall,
            hopeless=hopeless,
        )
        return there.chi2 - end.chi2, end

    def _total(self, end: LeastSquaresResult, beliefs: tuple[FloatArray, FloatArray] | None) -> float:
        """Chi-squared of an end; inf where its numbers ran away: what is compared with others has to have an order."""
        unlike = 0.0 if beliefs is None else float(np.sum((beliefs[0] @ (end.unit - beliefs[1])) ** 2))
        total = float(end.J + np.sum(self.problem.prior * end.offsets**2) + unlike)
        return math.inf if math.isnan(total) else total

    @property
    def noise_known(self) -> bool:
        """Whether noise is other than white with the deviations residuals are divided by."""
        return self.noise.coloured or any(noise.white != 1.0 for noise in self.noise.channels.values())

    def know(self, noise: NoiseModel) -> None:
        """Take another noise model for all that follows."""
        self.noise = noise
        deviation = np.array([np.sqrt(noise.channels[c].variance) if c in noise.channels else LOOSE for c in STATES])
        prior = np.repeat(1.0 / (self.sigma * deviation)[None] ** 2, len(self.trials), axis=0)
        sigma = np.repeat((self.sigma * np.maximum(deviation, LOOSE))[None], len(self.trials), axis=0)
        self.problem = self.problem.with_prior(sigma, prior)

    def known(self) -> dict[str, Any]:
        """What a search finds out about trials and sensors on its way, for ``put_back``."""
        return {name: getattr(self, name) for name in ("trials", "problem", "noise", "spreads", "updates", "slopes")}

    def put_back(self, known: Mapping[str, Any]) -> None:
        """Know what was known before, and nothing of what was found out since."""
        for name, value in known.items():
            setattr(self, name, value)

    def integrate(self, integrator: Integrator) -> None:
        """Simulate by another method in all that follows."""
        self.problem, self.slopes = self.problem.with_integrator(integrator), None

    def find_slopes(self) -> None:
        """Take derivatives by a method that is less work, where those of the targets are nearly the same by it."""
        self.slopes = quick_slopes(self.problem_of(self.targets), self.null(self.targets)) if self.targets else None

    def read_evenly(self) -> None:
        """Take what the log holds for values at its updates, between which inputs change evenly, in all that follows.

        Only where something looks held.
        """
        assert self.held is not None  # asked before
        names = self.model.inputs
        self.updates = [[self.held.updates(trial, name) for name in names] for trial in self.trials]
        self.trials = [self.held.evenly(trial) for trial in self.trials]
        controls = self.problem.cases.controls.copy()
        for into, trial in zip(controls, self.trials, strict=True):
            values = trial.inputs(names)
            into[: len(values)], into[len(values) :] = values, values[-1]
        self.problem = self.problem.with_cases(replace(self.problem.cases, controls=controls))

    def tuned(self, point: Point, trial: Trial | None = None) -> ShipProfile:
        """The profile with the values of a point, those of the groups of a trial too."""
        profile = self.model.profile
        sections = dict(profile.sections)
        own = labels_of(trial) if trial is not None else frozenset()
        values = self.values(point)
        for name, value in (values | followers(self.model.ties, values)).items():
            if group_of(name) and group_of(name) not in own:
                continue
            kind, symbol = split_name(base_of(name))
            coefficients = dict(sections[kind].coefficients)
            coefficients[symbol] = replace(coefficients[symbol], value=value)
            sections[kind] = replace(sections[kind], coefficients=coefficients)
        return replace(profile, sections=sections)

    def is_deformed(self, point: Point, effect: Effect | None = None) -> bool:
        """Whether the form of an effect, or of any where none is named, is far from what its formula has."""
        there = dict(zip(point.names, point.unit, strict=True))
        asked = self.believed.form_of(effect) if effect else self.believed.forms
        form = [name for name in asked if name in there]
        off = np.abs([there[name] for name in form] - self.null(form)) if form else np.zeros(0)
        return bool(np.any(off > FORM_OFF * np.array([self.believed.forms[name] for name in form])))

    def values(self, point: Point) -> dict[str, float]:
        """Values of the free parameters, by name, in profile units."""
        return dict(zip(point.names, self.sub_box(point.names).from_unit(point.unit).tolist(), strict=True))


def noise_levels(trials: Sequence[Trial]) -> FloatArray:
    """(6,) deviation of the noise by channel: the median over trials of what second differences and rounding show."""
    shown = np.maximum(by_channel(trials, motion_noise), _of_slopes(trials))
    return np.asarray(np.maximum(shown, least_noise(trials)))


def least_noise(trials: Sequence[Trial]) -> FloatArray:
    """(6,) deviation of the noise by channel where generated trials show none: a millionth of the largest value.

    Positions and headings count from where the trial starts.  Of a channel that stays at 0, of a metre, a radian, the
    largest speed, or a radian in the time the ship takes for a metre.
    """
    largest = np.nanmax([np.nanmax(np.abs(_from_start(trial)), axis=0) for trial in trials], axis=0)
    speed = max(float(np.max(largest[3:5])), 1e-3)
    return np.asarray(1e-6 * np.where(largest > LEAST, largest, [1.0, 1.0, 1.0, speed, speed, speed]))


def _from_start(trial: Trial) -> FloatArray:
    """(n, 6) the motion, its positions and heading without those of the first sample that has one."""
    places = trial.motion[:, :3]
    first = places[np.argmax(np.isfinite(places), axis=0), range(3)]
    return np.column_stack([places - first, trial.motion[:, 3:]])


FEWEST = 4
"""Samples that show the noise of a channel."""


def _of_slopes(trials: Sequence[Trial]) -> FloatArray:
    """(6,) deviation of velocities that no trial measured but in the first sample: that of a slope from one sample of
    the positions, or of the heading, to the next; 0 of what was measured."""
    x, y, psi = by_channel(trials, motion_noise)[:3]
    step = float(np.median([np.median(np.diff(trial.t)) for trial in trials]))
    slopes = np.array([0.0, 0.0, 0.0, max(x, y), max(x, y), psi]) / step
    measured = [np.isfinite(trial.motion).sum(axis=0) >= FEWEST for trial in trials]
    return np.where(np.any(measured, axis=0), 0.0, slopes)


def _in_noise(sigma: FloatArray, channels: Sequence[str]) -> Objective:
    return Objective(dict(zip(STATES, sigma, strict=True)), dict.fromkeys(channels, 1.0))


def make_workbench(
    profile: ShipProfile,
    trials: Sequence[Trial],
    options: DiagnoseOptions,
    names: Sequence[str] = (),
    coverage: Coverage | None = None,
) -> Workbench:
    """The workbench of a profile and the trials causes are looked for on.

    names     parameters of effects that will be fitted, besides the targets
    coverage  what trials visit, which says what is tied; that of these trials where None
    Raises OptionError for targets, box or channels that make no sense.
    """
    own = Model(profile)
    targets = choose_targets(own, options.targets, options.fixed)
    targets, ties = tied(profile, targets, coverage or Coverage.of(trials, own.L_pp))
    asked = {*options.effects, *(name.split(".")[1] for name in names)} if options.effects else set()
    whole = with_all_effects(profile, asked)
    model = Model(read_off(whole, visited_by(trials, own.L_pp), effect_tags()), ties)
    sigma = noise_levels(trials)
    channels = [c for c in STATES if not options.channels or c in {"v_m" if o == "v" else o for o in options.channels}]
    objective = _in_noise(sigma, channels)
    cases = cases_of(list(trials), objective, model.inputs, model.draught)
    loose = let_go(own, targets, options.fixed) if options.leeway else ()
    anyway = acting_kinds(profile, trials) if options.leeway else frozenset()
    moving = anyway | {split_name(base_of(name))[0] for name in names}
    shapes = forms(model, moving) if options.leeway else {}
    box = make_box(model, tuple(dict.fromkeys((*targets, *loose, *names, *shapes))), options.a_r, FURTHEST)
    box = with_ends(box, loose, options.leeway)
    problem = FitProblem.of(
        model=model,
        cases=cases,
        box=box,
        backend=get_backend(options.backend),
        integrator=Integrator(options.integrator, options.substeps),
        sigma=np.repeat(LOOSE * sigma[None], len(trials), axis=0),
    ).with_groups([labels_of(trial) for trial in trials])
    held = Held.of(trials)
    return Workbench(
        model,
        list(trials),
        options,
        sigma,
        targets,
        box,
        problem,
        white(cases),
        held=held,
        believed=Beliefs.of(box, loose, options.leeway, shapes, anyway, formulas=options.a_r is None),
    )
