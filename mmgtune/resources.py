"""The ship profiles, sample trials and maps for logs that travel with the program, found by name."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def folder(name: str) -> Path:
    """The folder ``ship_profiles`` or ``trials``: package data where installed, the checkout's own otherwise."""
    installed = _PACKAGE / "data" / name
    return installed if installed.is_dir() else _PACKAGE.parent / name


def profile_names() -> list[str]:
    """Names of the bundled profiles."""
    return sorted(path.stem for path in folder("ship_profiles").glob("*.toml"))


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
