"""What a user can choose where networks are trained."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import Problem
from .choice import INPUT, REPRODUCE, Options, again, choice
from .tuning import LeaveOutOptions

TRAINING = "Training"
"""Panel of the help."""

MOST_MEMBERS = 1000
"""Networks of an ensemble."""

TYPES = ("1", "2", "3", "4", "5")
"""Types of networks in Wakita et al. 2022, Table 7."""


ROLES = {"test": "held out", "validation": "kept back", "learned": "learned from"}
"""Trials by what they are to a training, in words."""


@dataclass(frozen=True)
class TrainingOptions(Options):
    """Choices of every training."""

    steps: int = choice(600, "Updates of the weights.", least=1, most=1_000_000, panel=TRAINING)
    batch: int = choice(256, "Windows in each update.", least=1, most=65_536, panel=TRAINING)
    rate: float = choice(2e-3, "Largest rate of learning.", above=0.0, most=1.0, panel=TRAINING)
    width: int = choice(200, "Units of a layer.", least=1, most=4096, panel=TRAINING)
    validation: float = choice(
        0.2,
        "Share of each kind of manoeuvre kept back, as whole runs, to choose the best weights by.",
        least=0.0,
        most=0.8,
        panel=TRAINING,
    )
    restart: float | None = again(LeaveOutOptions, "restart", 100.0)
    validate_every: int = choice(
        25,
        "Updates between two validations, and between two checkpoints; the last is always one.",
        least=1,
        most=1_000_000,
        panel=TRAINING,
    )
    step: float | None = choice(
        None, "Time between samples in training.", unit="s", least=1e-3, most=3600, panel=TRAINING
    )
    seed: int = choice(
        1, "Seed of the first network, and of which runs are kept back.", least=1, most=2**62, panel=REPRODUCE
    )


@dataclass(frozen=True)
class LearnOptions(TrainingOptions):
    """All choices of ``learn rnn``."""

    type: str = choice(
        "1",
        "Network and loss of Wakita et al. 2022, Table 7: 1 truncated memory, 2 standard memory, 3 loss of "
        "accelerations; 4 and 5 as 1, on fewer trials.",
        values=TYPES,
        called="type",
        panel=INPUT,
    )
    seeds: int = choice(5, "Networks trained, each from a start of its own.", least=1, most=100, panel=TRAINING)
    memory: int = choice(10, "Samples that truncated memory reaches back.", least=1, most=1000, panel=TRAINING)
    horizon: int = choice(60, "Samples that a window of the loss has.", least=2, most=100_000, panel=TRAINING)
    validation: float = again(
        TrainingOptions,
        "validation",
        but="0: all runs are learned from, and the mean of the last updates' weights is kept.",
    )
    mirrored: bool = choice(
        False,
        "Take port and starboard for mirror images: networks give the mean of what they see on either side.",
        panel=TRAINING,
    )
    step: float | None = again(TrainingOptions, "step", but="Default: that of most trials.")


@dataclass(frozen=True)
class HybridOptions(TrainingOptions):
    """All choices of ``learn hybrid``."""

    steps: int = again(TrainingOptions, "steps", 400)
    rate: float = again(TrainingOptions, "rate", 3e-3)
    width: int = again(TrainingOptions, "width", 32)
    penalty: tuple[float, ...] = choice(
        (15.0,),
        "Weights of the penalty on what the network adds, with commas, tried in turn; validation chooses.",
        least=0.0,
        most=1e6,
        panel=TRAINING,
    )
    folds: int = choice(
        1,
        "Parts the runs are left out in, one after the other; 1: a share of them is, once.",
        least=1,
        most=100,
        panel=TRAINING,
    )
    refit: bool = choice(
        True,
        "Tune a tuned profile anew without the runs kept back, so that it has not seen them either; the profile kept "
        "stays as it is.",
        panel=TRAINING,
    )
    lag: float | None = choice(
        None,
        "Time constant of its memory of velocities. Default: half the time of a ship length.",
        unit="s",
        above=0.0,
        panel=TRAINING,
    )
    step: float | None = again(TrainingOptions, "step", but="Default: three hundredths of the time of a ship length.")

    def problems(self) -> list[Problem]:
        """Some runs have to be kept back."""
        found = super().problems()
        if self.folds == 1 and self.validation == 0.0:
            why = "only runs not learned from say whether a network is better than none, and after how many updates"
            found.append(Problem("no run is kept back", "validation", why, "write validation=0.2, or folds=5"))
        return found


@dataclass(frozen=True)
class EnsembleOptions(TrainingOptions):
    """All choices of ``learn ensemble``."""

    members: int = choice(
        15, "Networks trained, each from a start of its own.", least=1, most=MOST_MEMBERS, panel=TRAINING
    )
    layers: int = choice(3, "Hidden layers of a network.", least=1, most=20, panel=TRAINING)
    width: int = again(TrainingOptions, "width", 256)
    steps: int = again(TrainingOptions, "steps", 3000)
    batch: int = again(TrainingOptions, "batch", 32)
    rate: float = again(TrainingOptions, "rate", 3e-3)
    horizon: int = again(LearnOptions, "horizon", 100)
    initial: int = choice(
        30,
        "Observations from which a further network estimates the velocities a window begins with; 0: they are taken "
        "as observed.",
        least=0,
        most=1000,
        panel=TRAINING,
    )
    sigma_u: float = choice(0.01, "Noise of the measured surge velocity.", unit="m/s", above=0.0, panel=TRAINING)
    sigma_v: float = choice(0.01, "Noise of the measured sway velocity.", unit="m/s", above=0.0, panel=TRAINING)
    sigma_r: float = choice(0.1, "Noise of the measured yaw rate.", unit="deg/s", above=0.0, panel=TRAINING)
    validation: float = choice(
        0.0,
        "Share of each kind of manoeuvre kept back, as whole runs, to watch the training by; it chooses nothing.",
        least=0.0,
        most=0.8,
        panel=TRAINING,
    )
    validate_every: int = again(TrainingOptions, "validate_every", 50)
    step: float | None = again(TrainingOptions, "step", 1.0)

    def problems(self) -> list[Problem]:
        """The observations of a start lie in the window that begins there."""
        found = super().problems()
        if self.initial > self.horizon:
            what = f"{self.initial} observations of a window of {self.horizon} steps"
            found.append(Problem(what, "initial", fix=f"write initial={self.horizon} or less"))
        return found


@dataclass(frozen=True)
class MixtureOptions(Options):
    """All choices of ``learn mixture``."""

    share: tuple[float, ...] = choice(
        (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7),
        "Shares of the networks in the accelerations, with commas, tried in turn; the trials choose.",
        above=0.0,
        most=0.99,
        panel=TRAINING,
    )
    restart: float | None = again(LeaveOutOptions, "restart", 100.0)
