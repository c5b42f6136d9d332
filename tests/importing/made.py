"""Generated logs: bundled trials and simple turns written as loggers write them, with what goes wrong in real ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from operator import xor
from pathlib import Path

import numpy as np
import pandas as pd

from mmgtune.errors import LogError
from mmgtune.importing import import_logs, parse_map
from mmgtune.resources import folder
from mmgtune.trial import Trial, read_trial
from mmgtune.units import DEG, KNOT
from tests.trial.made import made

MAP = """
schema = 1
[time]
column = "time"
unit = "s"
[velocity]
axes = "ship"
[columns]
x = { column = "north", unit = "m" }
y = { column = "east", unit = "m" }
psi = { column = "heading", unit = "deg" }
u = { column = "ahead", unit = "kn" }
v = { column = "abeam", unit = "kn", positive = "starboard" }
r = { column = "rate", unit = "deg/min", positive = "starboard" }
n = { column = "shaft", unit = "rpm" }
delta = { column = "rudder", unit = "deg", positive = "starboard" }
"""
UNITLESS = MAP.replace('column = "time"\nunit = "s"', 'column = "time"')
"""The map of ``logged``."""


def suzaku(name: str = "turn_p35") -> Trial:
    """A bundled trial, itself generated."""
    return read_trial(folder("trials") / "suzaku" / f"{name}.parquet")


def turn(**facts: object) -> Trial:
    """A smooth zigzag without noise: 400 samples, 1 s apart."""
    return made("zigzag", zigzag=True, samples=400, **facts)


def logged(trial: Trial) -> dict[str, np.ndarray]:
    """A trial's columns as a logger writes them: degrees from 0 to 360, knots, revolutions a minute."""
    return {
        "time": np.array(trial.t),
        "north": np.array(trial.x),
        "east": np.array(trial.y),
        "heading": np.mod(trial.psi / DEG, 360.0),
        "ahead": trial.u / KNOT,
        "abeam": trial.v_m / KNOT,
        "rate": trial.r / DEG * 60.0,
        "shaft": trial.n * 60.0,
        "rudder": trial.delta / DEG,
    }


def write_csv(path: Path, columns: Mapping[str, object], **how: object) -> Path:
    """A CSV log of any columns."""
    pd.DataFrame(dict(columns)).to_csv(path, index=False, **how)
    return path


def printed(columns: Mapping[str, np.ndarray], decimal: str = ".", digits: int = 9) -> dict[str, list[str]]:
    """Numbers as texts with so many decimals."""
    return {name: [f"{one:.{digits}f}".replace(".", decimal) for one in column] for name, column in columns.items()}


def with_sides(angles: np.ndarray, form: str = "{size}{side}", sides: str = "PS") -> list[str]:
    """Angles as an indicator prints them: 35.0S, 0.1P."""
    port, starboard = sides.split() if " " in sides else sides
    return [form.format(size=f"{abs(one):.9f}", side=starboard if one > 0.0 else port) for one in angles]


def imported(log: Path, text: str = MAP, **options: object) -> Trial:
    """The one trial a log becomes, read back from its file."""
    out = log.parent / "out"
    result = import_logs([log], parse_map(text), out, overwrite=True, **options)
    assert len(result.files) == 1, [trial.id for trial in result.trials]
    return read_trial(result.files[0])


def said(log: Path, text: str = MAP, **options: object) -> str:
    """The quality report of a log, as text."""
    return import_logs([log], parse_map(text), log.parent / "out", dry_run=True, **options).text()


def refusal(work: Callable[[], object]) -> str:
    """What a refused log or map is answered with, all problems; fails where it is not refused."""
    try:
        work()
    except LogError as error:
        return str(error)
    raise AssertionError("was not refused")


def close(trial: Trial, other: Trial, tolerance: float = 1e-9) -> None:
    """Fail where two trials differ by more than a share of each channel's size."""
    assert trial.n_samples == other.n_samples
    assert np.abs(trial.t - (other.t - other.t[0])).max() < 1e-6
    for name in ("x", "y", "psi", "u", "v_m", "r", "n", "delta"):
        ours, theirs = getattr(trial, name), getattr(other, name)
        assert np.abs(ours - theirs).max() <= tolerance * max(1.0, float(np.abs(theirs).max())), name


def sentence(body: str) -> str:
    """A sentence with its checksum."""
    return f"${body}*{reduce(xor, body.encode()):02X}"


def angle(degrees: float, whole: int, sides: str) -> str:
    """ "3512.34567,N" from degrees."""
    size = abs(degrees)
    return f"{int(size):0{whole}d}{(size - int(size)) * 60.0:09.6f},{sides[int(degrees < 0.0)]}"


def nmea(trial: Trial, start: float = 86390.0, origin: tuple[float, float] = (35.0, 139.0), fast: int = 1) -> list[str]:
    """A trial as sentences from a receiver, a gyro, a rudder sensor and a shaft, over midnight where so started.

    fast  headings a fix
    """
    import pyproj

    crs = f"+proj=tmerc +lat_0={origin[0]} +lon_0={origin[1]} +ellps=WGS84 +k_0=1"
    longitude, latitude = pyproj.Transformer.from_crs(crs, "EPSG:4326", always_xy=True).transform(trial.y, trial.x)
    north = trial.u * np.cos(trial.psi) - trial.v_m * np.sin(trial.psi)
    east = trial.u * np.sin(trial.psi) + trial.v_m * np.cos(trial.psi)
    course = np.mod(np.arctan2(east, north) / DEG, 360.0)
    speed = np.hypot(north, east) / KNOT
    lines = []
    for k, t in enumerate(trial.t):
        now = (start + t) % 86400.0
        stamp = f"{int(now // 3600):02d}{int(now % 3600 // 60):02d}{now % 60:05.2f}"
        lat, lon = angle(latitude[k], 2, "NS"), angle(longitude[k], 3, "EW")
        lines.append(sentence(f"GPGGA,{stamp},{lat},{lon},1,09,0.9,10.0,M,38.0,M,,"))
        lines.append(sentence(f"GPVTG,{course[k]:.5f},T,,M,{speed[k]:.6f},N,,K,A"))
        last = k + 1 == trial.n_samples
        for i in range(fast):
            psi = trial.psi[k] if last else trial.psi[k] + (trial.psi[k + 1] - trial.psi[k]) * i / fast
            lines.append(sentence(f"HEHDT,{np.mod(psi / DEG, 360.0):.5f},T"))
        lines.append(sentence(f"TIROT,{trial.r[k] / DEG * 60.0:.5f},A"))
        lines.append(sentence(f"IIRSA,{trial.delta[k] / DEG:.5f},A,,"))
        lines.append(sentence(f"IIRPM,S,1,{trial.n[k] * 60.0:.5f},100.0,A"))
        lines.append(sentence("WIMWV,45.0,R,10.0,N,A"))
    return lines
