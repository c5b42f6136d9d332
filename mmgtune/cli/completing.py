"""What the shell completes: names that travel with the program, files of the kinds that are taken, words of options."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import typer

from ..options.choice import Choice

OF_PROFILE = ("targets", "fixed")
"""Options that name coefficients of the profile."""

Complete = Callable[[Any, str], list[str]]
"""From the context of the command and what is typed so far to what it may become."""


def profiles(incomplete: str) -> list[str]:
    """Bundled profiles, and TOML files."""
    from ..resources import profile_names

    return [*begun(profile_names(), incomplete), *paths(incomplete, (".toml",))]


def models(incomplete: str) -> list[str]:
    """Bundled profiles and trained models, and their files."""
    from ..resources import network_names, profile_names

    return [*begun([*profile_names(), *network_names()], incomplete), *paths(incomplete, (".toml", ".safetensors"))]


def trials(incomplete: str) -> list[str]:
    """Bundled data sets, folders and trial files."""
    from ..resources import trial_set_names

    return [*begun(trial_set_names(), incomplete), *paths(incomplete, (".parquet",))]


def models_and_trials(incomplete: str) -> list[str]:
    """Where models stand, and behind them trials."""
    return list(dict.fromkeys([*models(incomplete), *trials(incomplete)]))


def maps(incomplete: str) -> list[str]:
    """Bundled maps for logs."""
    from ..resources import import_map_names

    return begun(import_map_names(), incomplete)


def particulars(incomplete: str) -> list[str]:
    """Bundled particulars, and TOML files."""
    from ..resources import particulars_names

    return [*begun(particulars_names(), incomplete), *paths(incomplete, (".toml",))]


def words(known: Sequence[str]) -> Callable[[str], list[str]]:
    """One of some words, or several with commas between."""

    def complete(incomplete: str) -> list[str]:
        return listed(known, incomplete)

    return complete


def of_choice(name: str, known: Choice) -> Complete | None:
    """What completes an option, by its field; None where any text may stand."""

    def complete(ctx: typer.Context, incomplete: str) -> list[str]:
        if known.names is not None:
            return listed(known.names(), incomplete)
        return listed(known.values or _coefficients(ctx), incomplete)

    return complete if known.names is not None or known.values or name in OF_PROFILE else None


def _coefficients(ctx: typer.Context) -> list[str]:
    """Names of the coefficients of the profile that is named in the command line; none where it cannot be read."""
    from ..errors import MmgtuneError
    from ..profile import load_profile

    try:
        return load_profile(str(ctx.params.get("profile") or "suzaku")).names()
    except (MmgtuneError, OSError):
        return []


def begun(known: Iterable[str], incomplete: str) -> list[str]:
    """Words that begin so."""
    return [word for word in known if word.startswith(incomplete)]


def listed(known: Iterable[str], incomplete: str) -> list[str]:
    """The last of several words with commas between, those before it as they are."""
    before, comma, last = incomplete.rpartition(",")
    return [f"{before}{comma}{word}" for word in begun(known, last)]


def paths(incomplete: str, suffixes: Sequence[str]) -> list[str]:
    """Folders, and files of some kinds, that begin so; nothing before a letter is typed, as names come first."""
    if not incomplete:
        return []
    folder = Path(incomplete if incomplete.endswith("/") else Path(incomplete).parent)
    try:
        there = sorted(folder.iterdir())
    except OSError:
        return []
    shown = [(one, f"{one}/" if one.is_dir() else str(one)) for one in there if not one.name.startswith(".")]
    return [text for one, text in shown if text.startswith(incomplete) and (one.is_dir() or one.suffix in suffixes)]
