"""The ship profiles, sample trials and maps for logs that travel with the program, found by name."""

from __future__ import annotations

import warnings
from pathlib import Path

from .errors import MmgtuneError, Problem, brief, kind_of, reason
from .run_files import CALM, MODEL, PARTICLES, PROFILE

_PACKAGE = Path(__file__).resolve().parent

DOCUMENTS = (".html", ".json", ".jsonl", ".md", ".npz", ".pdf", ".svg")
"""How names of files end that runs leave behind and that hold no ship."""


def folder(name: str) -> Path:
    """The folder ``ship_profiles`` or ``trials``: package data where installed, the checkout's own otherwise."""
    installed = _PACKAGE / "data" / name
    return installed if installed.is_dir() else _PACKAGE.parent / name


def must_be_name(name: object, kind: str, error: type[MmgtuneError]) -> None:
    """Raises an error of that class for what is neither a name nor a path; ``kind`` is what it would be the name of.

    Names that no file can have are none either: empty ones, too long ones, and those with a zero byte.
    """
    if not isinstance(name, (str, Path)):
        why = f"a {kind} is found by a path or a bundled name, and {kind_of(name)} is neither"
        writer = getattr(name, "written_by", "")
        fix = (
            f"write it first: mmgtune.{writer}(RESULT, FOLDER), and give FOLDER" if writer else "give a text or a Path"
        )
        raise error(Problem(f"no name of a {kind}", brief(name), why, fix))
    if not str(name).strip():
        why = "an empty text would mean the folder one is in"
        raise error(Problem(f"no name of a {kind}", brief(str(name)), why, "give a path or a bundled name"))
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


def in_run(name: str | Path, file: str) -> Path | None:
    """One of the files that a run folder holds of a ship, None where it is not there or might not be the one meant.

    A folder in which several profiles lie is no run folder.
    """
    path = Path(name) / file
    if not path.is_file():
        return None
    others = {one.name for one in path.parent.glob("*.toml")} - {PROFILE, CALM}
    return None if file == PROFILE and others else path


def ship_in(name: str | Path) -> Path | None:
    """What a run folder holds of a ship, whichever it is; particles and trained models before a profile."""
    return next(filter(None, (in_run(name, file) for file in (PARTICLES, MODEL, PROFILE))), None)


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
