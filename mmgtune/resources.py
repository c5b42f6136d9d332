"""The ship profiles, sample trials and maps for logs that travel with the program, found by name."""

from __future__ import annotations

import warnings
from pathlib import Path

from .errors import MmgtuneError, Problem, brief, kind_of, reason

_PACKAGE = Path(__file__).resolve().parent


def folder(name: str) -> Path:
    """The folder ``ship_profiles`` or ``trials``: package data where installed, the checkout's own otherwise."""
    installed = _PACKAGE / "data" / name
    return installed if installed.is_dir() else _PACKAGE.parent / name


def must_be_name(name: object, kind: str, error: type[MmgtuneError]) -> None:
    """Raises an error of that class for what is neither a name nor a path; ``kind`` is what it would be the name of.

    Names that no file can have are none either: too long ones, and those with a zero byte.
    """
    if not isinstance(name, (str, Path)):
        why = f"a {kind} is found by a path or a bundled name, and {kind_of(name)} is neither"
        raise error(Problem(f"no name of a {kind}", brief(name), why, "give a text or a Path"))
    try:
        Path(name).exists()
    except OSError as wrong:
        raise error(Problem(f"no name of a {kind}", brief(str(name)), reason(wrong), "correct the path")) from wrong


def taken(name: str | Path, there: bool, bundled: Path) -> Path | None:
    """What a name means: the path where there is something, else what is bundled, None where that is not either.

    there    whether there is such a path
    bundled  where it would be

    Warns where the path hides what is bundled.
    """
    path = Path(name)
    known = path.name == str(name) and bundled.exists()
    if not there:
        return bundled if known else None
    if known and path.resolve() != bundled.resolve():
        words = f"'{name}' is {path.resolve()}, not what is bundled under that name, which is {bundled}"
        warnings.warn(words, stacklevel=1)
    return path


def looked_for(name: str | Path, kind: str = "") -> str:
    """Why a path or bundled name means nothing: where it was looked for.

    kind  of what is bundled, "profile" or "data set"; "" where nothing is
    """
    path = Path(name)
    there = f"there is no {path}" if path.is_absolute() else f"there is no '{name}' in {Path.cwd()}"
    return there if len(path.parts) > 1 or not kind else f"{there}, and no bundled {kind} of that name"


def profile_names() -> list[str]:
    """Names of the bundled profiles."""
    return sorted(path.stem for path in folder("ship_profiles").glob("*.toml"))


def network_names() -> list[str]:
    """Names of the bundled networks, which stand beside the profiles."""
    return sorted(path.stem for path in folder("ship_profiles").glob("*.safetensors"))


def particulars_names() -> list[str]:
    """Names of the bundled files of particulars."""
    return sorted(path.stem for path in particulars().glob("*.toml"))


def particulars() -> Path:
    """The folder of the bundled files of particulars."""
    return folder("ship_profiles") / "particulars"


def trial_set_names() -> list[str]:
    """Names of the bundled data sets."""
    return sorted(path.name for path in folder("trials").glob("*") if path.is_dir())


def import_map_names() -> list[str]:
    """Names of the bundled maps for logs."""
    return sorted(path.stem for path in import_maps().glob("*.toml"))


def import_maps() -> Path:
    """The folder of the bundled maps for logs; it lies inside the package."""
    return _PACKAGE / "importing" / "presets"
