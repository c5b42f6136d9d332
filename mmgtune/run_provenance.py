"""What a result was made from: profile, trials and choices, and on what terms these are to be had."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .options import Options
from .profile import ShipProfile
from .provenance import made_by
from .trial import Coverage, TrialSet


def identity_of(
    profile: ShipProfile, trials: TrialSet, options: Options, provenance: Mapping[str, Any]
) -> dict[str, Any]:
    """Everything a run depends on: a run that was stopped is continued only where none of it has changed."""
    return {
        "profile": profile.sha256,
        "trials": trials.hashes(),
        "tune": [*trials.tune, *trials.tune_stated],
        "test": [*trials.test, *trials.test_stated],
        "options": options.to_dict(),
        "versions": {**provenance["environment"], "mmgtune": provenance["mmgtune"]},
    }


def make_provenance(profile: ShipProfile, trials: TrialSet, command: str) -> dict[str, Any]:
    """What a fit, or another run, was made from, and with which versions."""
    made = made_by(command)
    environment = made.pop("environment")
    return {
        **made,
        "profile": facts_of_profile(profile),
        "trials": {
            "path": str(trials.path) if trials.path else "",
            "ship": trials.ship,
            "licence": trials.licence,
            "citation": trials.citation,
            "tune": [*trials.tune, *trials.tune_stated],
            "test": [*trials.test, *trials.test_stated],
            "coverage": Coverage.of([trials.trials[name] for name in trials.tune], profile.L_pp).to_dict(),
            "sha256": trials.hashes(),
            "source": {name: trial.source for of in (trials.trials, trials.stated) for name, trial in of.items()},
        },
        "environment": environment,
    }


def facts_of_profile(profile: ShipProfile) -> dict[str, str]:
    """What a profile was read from, and on what terms."""
    return {
        "id": profile.id,
        "name": profile.name,
        "path": str(profile.path) if profile.path else "",
        "sha256": profile.sha256,
        "source": profile.source,
        "licence": profile.licence,
        "citation": profile.citation,
    }
