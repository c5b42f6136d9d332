"""What bands hold of runs left out: particles drawn from the other runs, on runs they have not seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..bands import Pooled, WindowScore, pooled, pooled_by
from ..fitting import BandsLeftOut, LeftOut, leave_out
from ..fitting.extending import settled
from ..fitting.journal import journalled, remembered
from ..hooks import Hooks
from ..options import LeaveOutOptions, ParticleOptions, PosteriorOptions
from ..profile import ShipProfile, tuned
from ..run_provenance import identity_of, make_provenance
from ..scores import window_scores
from ..threads import blas_on_one_thread
from ..trial import Trial
from .run import posterior


@blas_on_one_thread
def leave_out_with_bands(
    profile: ShipGiven,
    trials: TrialsGiven,
    options: LeaveOutOptions = LeaveOutOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | None = None,
    resume: bool = False,
    command: str = "",
) -> LeftOut:
    """``fitting.leave_out``, and for each part particles of what the other runs leave open, held against the part.

    Each run, or window of it, is foretold from its first measured state by its logged inputs.  A stop between two parts
    leaves those that are done.  Arguments and errors as for ``leave_out``.
    """
    ship, data = ship_of(profile), trials_of(trials)
    identity = identity_of(ship, data, options, make_provenance(ship, data, command)) | {"bands": True}
    with journalled(folder, identity, hooks.stop, resume=resume):
        left = leave_out(ship, data, options, hooks=hooks, folder=folder, resume=resume, command=command)
        start, _ = settled(ship, options, data)
        choices = PosteriorOptions(backend=options.backend, seed=options.seed)
        whole = {name: data.trials[name] for name in data.tune}
        pieces = (data.in_windows(options.restart) if options.restart else data).trials
        scores: list[WindowScore] = []
        parts = 0
        for runs, theta in zip(left.parts, left.thetas, strict=True):
            hooks.on_progress(parts, len(left.parts), "bands")
            if hooks.stop():
                break
            hooks.on_phase(f"bands of {', '.join(runs)}")
            others = [one for one in whole.values() if one.run not in runs]
            own = [one for one in pieces.values() if one.run in runs and one.whole in whole]
            if others and own:
                scores += foretold(tuned(start, theta, {}, {}), others, own, choices)
            parts += 1
    bands = BandsLeftOut(*_pooled(scores, left.sigma), parts)
    return replace(left, bands=bands, interrupted=left.interrupted or parts < left.n_parts)


def _noted(scores: list[WindowScore]) -> list[dict[str, Any]]:
    return [
        {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in asdict(one).items()}
        for one in scores
    ]


def _recalled(noted: list[dict[str, Any]]) -> list[WindowScore]:
    def back(value: Any) -> Any:
        return np.array(value) if isinstance(value, list) else value

    return [WindowScore(**{name: back(value) for name, value in one.items()}) for one in noted]


@remembered(
    asked=lambda profile, others, pieces, options: [
        profile.sha256, [one.id for one in others], [one.id for one in pieces], options.to_dict()
    ],
    note=_noted,
    recall=_recalled,
)  # fmt: skip
def foretold(
    profile: ShipProfile, others: Sequence[Trial], pieces: Sequence[Trial], options: PosteriorOptions
) -> list[WindowScore]:
    """How particles of some trials foretell pieces of others."""
    drawn = posterior(profile, list(others), options).particles
    how = ParticleOptions()
    return window_scores(drawn.predictor(as_logged=True).drawn(how.particles, how.seed), list(pieces))


def _pooled(scores: Sequence[WindowScore], sigma: Mapping[str, float]) -> tuple[dict[str, Pooled], dict[str, Pooled]]:
    if not scores:
        return {}, {}
    by_kind = pooled_by(lambda one: one.manoeuvre or None, scores, sigma)
    return {"": pooled(scores, sigma), **by_kind}, pooled_by(lambda one: one.run, scores, sigma)
