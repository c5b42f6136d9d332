"""What a network was made from: in full in the record of a run, without this machine's paths in the model's file."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ..options import Options
from ..profile import ShipProfile
from ..provenance import made_by
from ..run_provenance import facts_of_profile
from ..trial import Trial, TrialSet


def provenance_of(
    profile: ShipProfile, data: TrialSet, used: Sequence[Trial], options: Options, command: str
) -> dict[str, Any]:
    """Program, profile, trials and their licence, options; ``used`` are the trials that learning or choosing saw."""
    made = made_by(command)
    made["environment"] |= {name: version(name) for name in ("jax", "optax")}
    return {
        **made,
        "profile": facts_of_profile(profile),
        "trials": {
            "path": str(data.path) if data.path else "",
            "ship": data.ship,
            "sources": sorted({trial.source for trial in used}),
            "licence": data.licence,
            "citation": data.citation,
            "sha256": data.hashes(),
            "learned_from": [trial.id for trial in used],
        },
        "options": options.to_dict(),
    }


def travelling(provenance: dict[str, Any]) -> dict[str, Any]:
    """Provenance for a file that others get: names in place of paths, and no command, which may hold some."""
    found = {key: value for key, value in provenance.items() if key != "command"}
    for part in ("profile", "trials"):
        found[part] = {**found[part], "path": Path(found[part]["path"]).name}
    return found
