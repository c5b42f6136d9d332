"""What is to be learned from what: trials, type and options put together, before anything is trained."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import OptionError, Problem
from ..objective import spread
from ..options.learning import LearnOptions
from ..profile import ShipProfile
from ..trial import Trial, TrialSet
from .recipes import RECIPES, Recipe
from .samples import Samples, own_step, samples_of
from .splitting import Split, split_runs


@dataclass(frozen=True, eq=False)
class Task:
    """A training that can begin.

    inputs   what drives the ship
    samples  of the runs that are learned from
    sigma    deviation of each state over all runs that tune: what errors are counted in
    test     trials that play no part but for the scores at the end
    """

    profile: ShipProfile
    data: TrialSet
    options: LearnOptions
    recipe: Recipe
    inputs: tuple[str, ...]
    split: Split
    samples: Samples
    sigma: dict[str, float]
    test: tuple[Trial, ...]

    @property
    def memory(self) -> int | None:
        """Samples the memory reaches back, None where it runs on."""
        return self.recipe.memory(self.options)

    @property
    def updates(self) -> int:
        """Updates of all seeds together."""
        return self.options.seeds * self.options.steps


def make_task(profile: ShipProfile, data: TrialSet, options: LearnOptions) -> Task:
    """The training of a type on the trials that tune.

    Raises OptionError for too few runs, and for trials from which nothing can be learned; TrialError for a trial that
    has not logged what drives the ship.
    """
    recipe = RECIPES[options.type]
    where = str(data.path or "trials")
    split = split_runs(recipe.trials([data.trials[id] for id in data.tune], where), options.validation, options.seed)
    inputs = tuple(one.name for one in profile.arrangement.inputs)
    step = options.step or own_step(split.learn)
    samples = samples_of(split.learn, inputs, step)
    if not len(samples.starts(options.horizon)):
        raise OptionError(
            Problem(
                f"no trial is as long as a window of {options.horizon} samples, {options.horizon * step:g} s",
                where,
                "windows without gaps are what is learned from",
                "write a smaller horizon, or give longer trials",
            )
        )
    sigma = spread([*split.learn, *split.choose])
    test = tuple(data.trials[id] for id in data.test)
    return Task(profile, data, options, recipe, inputs, split, samples, sigma, test)
