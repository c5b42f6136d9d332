"""What is to be learned from what: trials, type and options put together, before anything is trained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..errors import OptionError, Problem
from ..networks.model import sided
from ..networks.motion import mirror
from ..objective import spread, varying
from ..options.learning import MOST_MEMBERS, EnsembleOptions, LearnOptions, TrainingOptions
from ..phrases import capital
from ..profile import ShipProfile
from ..trial import Trial, TrialSet, another_ship
from .recipes import RECIPES, Recipe
from .samples import Samples, own_step, samples_of
from .splitting import Split, split_runs


def warned(profile: ShipProfile, data: TrialSet) -> tuple[str, ...]:
    """Where trials are of another ship than a profile, that they are, in a sentence."""
    return tuple(f"{capital(words)}." for words in another_ship(data.ship, profile.id))


@dataclass(frozen=True, eq=False)
class Material:
    """What networks that need no model of forces are trained on.

    inputs   what drives the ship
    samples  of the runs that are learned from
    sigma    deviation of each state over all runs that tune: what errors are counted in
    test     trials that play no part but for the scores at the end
    """

    profile: ShipProfile
    data: TrialSet
    options: TrainingOptions
    inputs: tuple[str, ...]
    split: Split
    samples: Samples
    sigma: dict[str, float]
    test: tuple[Trial, ...]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Where the trials are of another ship than the profile, that they are, in a sentence."""
        return warned(self.profile, self.data)

    @property
    def by_role(self) -> dict[str, tuple[Trial, ...]]:
        """Trials that are scored at the end, by role; the first of them speaks for what was learned.

        Those held out, "test", and those kept back, "validation"; where there are neither, those "learned" from.
        """
        apart = {"test": self.test, "validation": self.split.choose}
        return {role: of for role, of in apart.items() if of} or {"learned": self.split.learn}


@dataclass(frozen=True, eq=False)
class Task(Material):
    """A training of recurrent networks that can begin."""

    options: LearnOptions
    recipe: Recipe

    @property
    def memory(self) -> int | None:
        """Samples the memory reaches back, None where it runs on."""
        return self.recipe.memory(self.options)

    @property
    def signs(self) -> FloatArray | None:
        """(n_features,) as of ``mirror`` where port and starboard are to be mirror images, else None."""
        roles = [one.role for one in self.profile.arrangement.inputs]
        return np.asarray(mirror(roles)) if self.options.mirrored else None

    @property
    def updates(self) -> int:
        """Updates of all seeds together."""
        return self.options.seeds * self.options.steps


def make_task(profile: ShipProfile, data: TrialSet, options: LearnOptions) -> Task:
    """The training of a type on the trials that tune.  Raises what ``material_of`` does.

    Raises OptionError too for mirror images of inputs that have a side.
    """
    recipe = RECIPES[options.type]
    on_a_side = sided([one.name for one in profile.arrangement.inputs])
    if options.mirrored and on_a_side:
        why = f"{', '.join(on_a_side)} would have to change places"
        raise OptionError(Problem("this ship cannot be mirrored", "mirrored", why, "write mirrored=False"))
    trials = recipe.trials([data.trials[id] for id in data.tune], str(data.path or "trials"))
    return Task(**vars(material_of(profile, data, trials, options, options.horizon)), recipe=recipe)


def material_of(
    profile: ShipProfile, data: TrialSet, trials: Sequence[Trial], options: TrainingOptions, horizon: int
) -> Material:
    """Trials to learn from, some of them kept back, on one time step.

    horizon  steps that a window of the loss has

    Raises OptionError for too few runs, and for trials from which nothing can be learned; TrialError for a trial that
    has not logged what drives the ship.
    """
    kept = options.validation > 0.0
    split = split_runs(trials, options.validation, options.seed) if kept else Split(tuple(trials), ())
    inputs = tuple(one.name for one in profile.arrangement.inputs)
    step = options.step or own_step(split.learn)
    samples = samples_of(split.learn, inputs, step)
    if not len(samples.starts(horizon)):
        raise OptionError(
            Problem(
                f"no trial is as long as a window of {horizon} samples, {horizon * step:g} s",
                str(data.path or "trials"),
                "windows without gaps are what is learned from",
                "write a smaller horizon, or give longer trials",
            )
        )
    sigma = varying(spread([*split.learn, *split.choose]), "trials", "give trials that do")
    test = tuple(data.trials[id] for id in data.test)
    return Material(profile, data, options, inputs, split, samples, sigma, test)


@dataclass(frozen=True, eq=False)
class EnsembleTask(Material):
    """A training of an ensemble that can begin."""

    options: EnsembleOptions

    @property
    def noise(self) -> FloatArray:
        """(3,) deviations of the measured u, v_m [m/s], r [rad/s]: the roots of Sigma of eq. 18."""
        options = self.options
        return np.array([options.sigma_u, options.sigma_v, np.radians(options.sigma_r)])

    def seed(self, k: int) -> int:
        """Seed of member k; no two ensembles of other seeds share one."""
        return MOST_MEMBERS * self.options.seed + k


def ensemble_task(profile: ShipProfile, data: TrialSet, options: EnsembleOptions) -> EnsembleTask:
    """The training of an ensemble on the trials that tune.  Raises what ``material_of`` does."""
    trials = [data.trials[id] for id in data.tune]
    return EnsembleTask(**vars(material_of(profile, data, trials, options, options.horizon)))
