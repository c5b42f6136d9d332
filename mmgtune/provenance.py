"""Which program made a result, when, and with which versions."""

from __future__ import annotations

import platform
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from typing import Any


def made_by(command: str) -> dict[str, Any]:
    """Which program made a result, when, how, and with which versions."""
    versions = {"python": platform.python_version()}
    for package in ("numpy", "scipy", "numba", "cma"):
        try:
            versions[package] = version(package)
        except PackageNotFoundError:  # pragma: no cover - all are dependencies
            versions[package] = "unknown"
    return {
        "mmgtune": own_version(),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": command,
        "environment": versions,
    }


def own_version() -> str:
    """Of the program; "unknown" where it is not installed."""
    try:
        return version("mmgtune")
    except PackageNotFoundError:
        return "unknown"
