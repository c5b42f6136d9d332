"""Latitude and longitude to metres north and east of a local origin."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..errors import LogError, Problem
from ..phrases import counted
from ..physics.frame import to_ship
from .maps.mapping import LogMap
from .record import Record, Series

NAMES = {"transverse-mercator": "tmerc", "azimuthal-equidistant": "aeqd"}
FARTHEST = 200e3
"""Distance [m] from the origin beyond which a trial is no trial."""


def with_local_positions(record: Record, log_map: LogMap) -> Record:
    """The record with x and y [m] in place of latitude and longitude; as it is where it has none.

    Raises LogError where they are swapped, or no position on earth.
    """
    if "latitude" not in record.series or "longitude" not in record.series:
        return record
    import pyproj

    latitude, longitude = record.series["latitude"], record.series["longitude"]
    lat, lon = latitude.values, longitude.values
    finite = np.isfinite(lat) & np.isfinite(lon)
    if not finite.any():
        raise LogError(Problem("no position is valid", str(record.path), "every latitude or longitude is missing"))
    largest = float(np.abs(lat[finite]).max())
    beyond = finite & (np.abs(lat) > 90.0)
    if beyond.sum() > 0.01 * finite.sum():
        row = int(np.flatnonzero(beyond)[0])
        _require_numbers(record, lat[beyond])
        why = f"latitude reaches {largest:.6g} deg, which is beyond a pole; longitude is {lon[row]:.6g} there"
        place = f"{record.path}, at {latitude.t[row]:.6g} s"
        raise LogError(
            Problem("latitude and longitude are swapped?", place, why, "exchange the two columns in the map")
        )
    finite &= ~beyond
    if len(lat[finite]) > 10 and all((one[finite] == np.round(one[finite])).all() for one in (lat, lon)):
        what = "the position never changes: latitude and longitude are whole degrees"
        why = f"latitude is {lat[finite][0]:g} and longitude {lon[finite][0]:g} at the start"
        fix = 'where the minutes are in a column of their own, say minutes = "..." beside its column'
        raise LogError(Problem(what, str(record.path), why, fix))
    origin = log_map.origin or (float(lat[finite][0]), float(lon[finite][0]))
    crs = f"+proj={NAMES[log_map.projection]} +lat_0={origin[0]!r} +lon_0={origin[1]!r} +ellps=WGS84 +units=m +k_0=1"
    project = pyproj.Transformer.from_crs("EPSG:4326", crs, always_xy=True)
    x, y = np.full(len(lat), np.nan), np.full(len(lat), np.nan)
    east, north = project.transform(lon[finite], lat[finite])
    x[finite], y[finite] = north, east
    _near(record, latitude.t, x, y)
    series = {name: one for name, one in record.series.items() if name not in ("latitude", "longitude")}
    note = (
        f"positions: {log_map.projection.replace('-', ' ')} projection of WGS 84, "
        f"origin {origin[0]:.7f}, {origin[1]:.7f} deg ({'from the map' if log_map.origin else 'the first fix'})"
    )
    series |= {"x": Series(latitude.t, x), "y": Series(latitude.t, y)}
    return replace(record, series=series, notes=[*record.notes, note])


def _near(record: Record, t: FloatArray, x: FloatArray, y: FloatArray) -> None:
    """Blank single wild positions; refuse a record that lies in two places."""
    away = np.hypot(x - np.nanmedian(x), y - np.nanmedian(y)) > FARTHEST
    wild = away | (np.isinf(x) | np.isinf(y))
    if wild.sum() > 0.01 * len(x):
        row = int(np.flatnonzero(wild)[0])
        place = f"{record.path}, at {t[row]:.6g} s"
        distance = float(np.hypot(x[row] - np.nanmedian(x), y[row] - np.nanmedian(y))) / 1e3
        raise LogError(
            Problem(
                "the position jumps to another part of the earth",
                place,
                f"{wild.sum()} of {len(x)} positions lie some {distance:.4g} km from the others",
                "latitude and longitude may be swapped or have lost their sign there: correct the log, or cut it",
            )
        )
    if wild.any():
        x[wild] = y[wild] = np.nan
        record.spikes["x"] = record.spikes.get("x", 0) + int(wild.sum())
        record.notes.append(f"{wild.sum()} positions on another part of the earth were left out")


def _require_numbers(record: Record, beyond: FloatArray) -> None:
    """Raise LogError where latitudes beyond a pole (n,) are one and the same number, which stands for none."""
    code = float(beyond[0])
    if (beyond == code).all() and abs(code) > 360.0:
        what = f"{counted(len(beyond), 'latitude')} {'is' if len(beyond) == 1 else 'are'} {code:.10g}"
        fix = f'say missing = ["{code:.10g}"] in [log]'
        raise LogError(Problem(what, str(record.path), "the number seems to stand for no value", fix))


def not_mirrored(columns: dict[str, FloatArray], where: str) -> None:
    """Raise LogError where a ship moves along her heading only if north and east are exchanged.

    columns  x, y [m] and psi [rad] on a uniform time, (n_samples,)
    """
    stride = max(1, len(columns["x"]) // 100)
    x, y = np.diff(columns["x"][::stride]), np.diff(columns["y"][::stride])
    psi = columns["psi"][::stride]
    psi = 0.5 * (psi[1:] + psi[:-1])
    known = np.isfinite(x) & np.isfinite(y) & np.isfinite(psi)
    way = float(np.sum(np.hypot(x[known], y[known])))
    if known.sum() < 10 or way == 0.0:
        return
    along, mirrored = (
        float(np.sum(to_ship(psi[known], north[known], east[known])[0])) / way for north, east in ((x, y), (y, x))
    )
    if along < 0.5 and mirrored > 0.8:
        why = (
            f"{100 * along:.0f} % of the way is made good along the heading, {100 * mirrored:.0f} % with them exchanged"
        )
        raise LogError(
            Problem("latitude and longitude are swapped?", where, why, "exchange the two columns in the map")
        )
