"""From particles and a question to the trial that tells most."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import get_backend
from ..bands import IndexBand, index_band
from ..displayed import Displayed
from ..errors import OptionError, Problem, ProfileError, kind_of
from ..networks import named_ship
from ..options import PlanOptions, PredictOptions
from ..options.choice import must_be
from ..particles import ParticlePredictor, Particles
from ..posterior.local import least_noise
from ..posterior.room import room_of
from ..predicting.asked import Approach, approach_of
from ..provenance import made_by
from ..run_files import PLAN
from ..threads import blas_on_one_thread
from ..writing_results import place_for, write_record
from .candidates import candidates, logs
from .expected import POINTS, answers, gradient, share_left, slopes_of
from .question import Question, read_question

MOSTLY = 0.5
"""Share of the variance of an answer that its mean slopes must account for, else there is a note."""

REACHED = 0.9
"""Share of the particles that must reach the index."""


@dataclass(frozen=True)
class Expected:
    """A trial, and what it would leave open.

    duration  from the approach to its end [s]
    half      half the band of the question after it, in the unit of the index
    shrinks   share of the band that goes
    """

    id: str
    kind: str
    words: str
    duration: float
    half: float
    shrinks: float

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "id": self.id,
            "kind": self.kind,
            "trial": self.words,
            "duration_s": self.duration,
            "half_width_after": self.half,
            "shrinks": self.shrinks,
        }


@dataclass(frozen=True, eq=False)
class TrialPlan(Displayed):
    """Trials by what they tell of a question, best first.

    model   what the particles were called
    band    of the question now; half  of its width
    linear  share of the variance of the question that its mean slopes account for
    lost    trials that cannot be simulated or judged, in words
    notes   what to know, in sentences
    """

    written_by = "write_plan"

    particles: Particles
    model: str
    question: Question
    band: IndexBand
    half: float
    linear: float
    trials: tuple[Expected, ...]
    lost: tuple[str, ...]
    notes: tuple[str, ...]
    options: PlanOptions
    wall_s: float

    def __repr__(self) -> str:
        """In a line."""
        best = f"{self.trials[0].words} first" if self.trials else "none"
        return f"TrialPlan({self.question.text}: {len(self.trials)} trials, {best})"

    @property
    def best(self) -> Expected:
        """The one that tells most."""
        return self.trials[0]

    def to_dict(self, command: str = "") -> dict[str, Any]:
        """For JSON."""
        facts: Mapping[str, Any] = self.particles.facts
        return {
            "schema": 1,
            "kind": "plan",
            "model": self.model,
            "ship": self.particles.profile.id,
            "sha256": self.particles.profile.sha256,
            "learnt_from": facts.get("trials"),
            "temper": facts.get("temper"),
            "question": {
                "text": self.question.text,
                "asked": self.question.plain,
                "index": self.question.index.key,
                "words": self.question.index.words,
                "unit": self.question.index.unit,
                "order": self.question.asked.words,
                **self.band.to_dict(),
                "half_width": self.half,
            },
            "linear_share": self.linear,
            "trials": [one.to_dict() for one in self.trials],
            "left_out": list(self.lost),
            "notes": list(self.notes),
            "options": self.options.to_dict(),
            "provenance": made_by(command),
            "wall_s": self.wall_s,
        }


@blas_on_one_thread
def plan_trial(model: str | Path | Particles, question: str, options: PlanOptions = PlanOptions()) -> TrialPlan:
    """Which trial to sail next: of those that can be sailed, how far each would shrink the band of a question.

    model     particles of ``posterior``: an object, a run folder or its file
    question  an index and a manoeuvre: "tactical diameter, turn -35"
    Each trial is thought to be sailed on the day of the others, logged by the same sensors and believed as far as they.
    Raises OptionError for what is no question, for one that many particles do not answer, and for a model without
    particles; ProfileError for particles that ``posterior`` did not make.
    """
    must_be(options, PlanOptions)
    began = time.perf_counter()
    particles = _particles(model)
    room = room_of(particles)
    approach = approach_of(particles.predictor(), PredictOptions(speed=options.speed, rpm=options.rpm))
    asked = read_question(question, particles.predictor(), approach)
    order = [particles.names.index(name) for name in room.names]
    z = room.coordinates(particles.values[order])
    C = np.cov(z)
    band = _band(particles, asked, approach, options)
    assert band.half is not None  # both ends are reached
    assert band.deviation is not None  # by several particles
    chosen = np.random.default_rng(options.seed).permutation(len(particles))[:POINTS]
    g = gradient(particles, room, z[:, chosen], asked, approach, options.backend)
    if not np.isfinite(g).all():
        raise OptionError(Problem(f"'{question[:80]}' changes by jumps", "question", fix="ask for a harder manoeuvre"))
    values = np.array([[particles.profile.value(name)] for name in room.names])
    middle = room.coordinates(values)[:, 0]
    noise = _noise(particles)
    temper = _temper(particles)
    backend, integrator = get_backend(options.backend), options.make_integrator()
    linear = float(g @ C @ g) / band.deviation**2
    found, lost = [], []
    possible = candidates(particles.profile, approach, options.kind, options.half_speed)
    for one, trial in zip(possible, logs(particles.profile, possible, noise), strict=True):
        if trial is None:
            lost.append(f"{one.words}: the ship leaves what the model can do")
            continue
        J = slopes_of(room, trial, middle, backend, integrator)
        left = share_left(g, C, J, temper, len(particles))
        if math.isnan(left):
            lost.append(f"{one.words}: {len(particles)} particles are too few to say what it tells")
            continue
        duration = float(trial.t[-1] - trial.t[0])
        found.append(Expected(one.id, one.kind, one.words, duration, left * band.half, 1.0 - left))
    if not found:
        why = "; ".join(lost) or "the steering gear or the equations of the model do not reach them"
        raise OptionError(Problem("no trial of these kinds can be judged", "kind", why, "ask for others"))
    return TrialPlan(
        particles=particles,
        model=str(model) if isinstance(model, str | Path) else particles.profile.id,
        question=asked,
        band=band,
        half=band.half,
        linear=linear,
        trials=tuple(sorted(found, key=lambda one: -one.shrinks)),
        lost=tuple(lost),
        notes=tuple(_notes(particles, band, linear)),
        options=options,
        wall_s=time.perf_counter() - began,
    )


def write_plan(result: TrialPlan, folder: Path | str, command: str = "", *, overwrite: bool = False) -> dict[str, Any]:
    """Write the record into a run folder.  Returns it.

    Raises OutputError where one is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, TrialPlan, folder, PLAN, overwrite=overwrite) as place:
        return write_record(result.to_dict(command), place, PLAN)


def _particles(model: str | Path | Particles) -> Particles:
    if isinstance(model, Particles):
        return model
    found = named_ship(model)
    if not isinstance(found, ParticlePredictor) or found.particles is None:
        called = f"'{model}'" if isinstance(model, str | Path) else kind_of(model)
        what = f"{called} has no particles of coefficients"
        fix = "draw them with mmgtune posterior, and name its run folder"
        raise OptionError(Problem(what, "model", "only they say what is open", fix))
    return found.particles


def _band(particles: Particles, question: Question, approach: Approach, options: PlanOptions) -> IndexBand:
    """The band now, of the particles that reach the index.  Raises OptionError where too few do."""
    n = min(options.particles, len(particles))
    values: FloatArray = answers(particles.predictor().drawn(n, options.seed), question, approach)
    reached = values[np.isfinite(values)]
    if len(reached) < max(REACHED * n, 10):
        what = f"{n - len(reached)} of {n} particles never reach the {question.index.words}"
        raise OptionError(Problem(what, "question", "no width of a band says how open it is", "ask another question"))
    whole = index_band(reached, 0.01 * options.level, endless=False)
    return IndexBand(whole.mean, whole.deviation, whole.low, whole.median, whole.high, len(reached), n)


def _temper(particles: Particles) -> float:
    """Variance that residuals count with.  Raises ProfileError where the particles do not say it."""
    known = particles.facts.get("temper")
    if not isinstance(known, (int, float)) or not known > 0.0:
        what = "the particles do not say how much trials were believed"
        raise ProfileError(Problem(what, "temper", fix="draw them with mmgtune posterior"))
    return float(known)


def _noise(particles: Particles) -> FloatArray:
    known = particles.facts.get("noise")
    least = least_noise(particles.profile)
    if not isinstance(known, list) or len(known) != len(least):
        return least
    if not all(isinstance(one, (int, float)) and 0.0 <= one < np.inf for one in known):
        what, why = "the particles say a noise that no sensor has", f"it is {known}"
        raise ProfileError(Problem(what, "noise", why, "draw them with mmgtune posterior"))
    return np.maximum(known, least)


def _notes(particles: Particles, band: IndexBand, linear: float) -> list[str]:
    found = [*particles.doubted]
    if linear < MOSTLY:
        found.append(
            "the answer bends much over what is open: ships like that shrank their bands further than is said here, "
            "and the order held"
        )
    if band.reached < band.particles:
        found.append(f"{band.particles - band.reached} of {band.particles} particles never reach it and are left out")
    if "noise" not in particles.facts:
        found.append("the particles do not say what noise their trials had: that of a model basin is taken")
    if len(particles) < 2 * len(particles.names):
        found.append(
            f"{len(particles)} particles are few for {len(particles.names)} numbers: draw some hundreds with posterior"
        )
    return found
