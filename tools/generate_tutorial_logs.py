"""Make the raw logs of the tutorial in ``docs/tutorial/logs``: generated, not measured.

The ship is drawn by ``tests.hidden.cases`` and sailed by the plant of ``tests.hidden``, whose equations are written
apart from the program's.  She sails in a current; her receiver stands aft, on the port side.  The logs are written as
a bridge logger writes them: clock, latitude and longitude, knots, degrees from 0 to 360, deg/min, rpm, and a rudder
that counts to port.  One log has a hole, one a wild fix.

    python -m tools.generate_tutorial_logs [FOLDER]
"""

from __future__ import annotations

import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pyproj

from mmgtune.files import write_text
from mmgtune.units import DEG, KNOT
from tests.hidden.cases import null
from tests.hidden.plant import WHITE, noisy, sail

SEED = 11
CURRENT = {"north": 0.2, "east": 0.35}
"""Hidden [m/s]: 0.40 m/s setting towards 060°."""

ANTENNA = {"x": -22.0, "y": -2.5}
"""Of the receiver [m], forward and to starboard of midship; the tutorial's map says so, nothing is hidden here."""

ORIGIN = (34.60, 135.00)
"""Latitude and longitude [deg] of the first sample, about."""

LOGS = ("turn_p35", "turn_m20", "zigzag_20", "zigzag_10")
START = datetime(2024, 5, 14, 1, 0, tzinfo=UTC)
BETWEEN = timedelta(minutes=25)
HOLE = ("turn_p35", range(300, 308))
WILD = ("zigzag_20", 200)

HEAD = """\
# GENERATED, not measured: tools/generate_tutorial_logs.py of mmgtune
# M.V. SUZAKU, trial {name}
"""
COLUMNS = "UTC,Lat [deg],Lon [deg],SOG [kn],COG [deg],HDG [deg],ROT [deg/min],Shaft [rpm],Rudder [deg]\n"


def log(name: str, rows: np.ndarray, start: datetime) -> str:
    """The text of one log; rows (t, x, y, psi, u, v, r, n, delta) of the antenna, each second."""
    crs = f"+proj=tmerc +lat_0={ORIGIN[0]} +lon_0={ORIGIN[1]} +ellps=WGS84 +k_0=1"
    t, x, y, psi, u, v, r, n, delta = rows.T
    longitude, latitude = pyproj.Transformer.from_crs(crs, "EPSG:4326", always_xy=True).transform(y, x)
    course, heading = np.mod((psi + np.arctan2(v, u)) / DEG, 360.0), np.mod(psi / DEG, 360.0)
    speed = np.hypot(u, v) / KNOT
    lines = []
    for k in range(len(t)):
        stamp = (start + timedelta(seconds=float(t[k]))).strftime("%Y-%m-%dT%H:%M:%SZ")
        off = 0.01 if (name, k) == WILD else 0.0
        fix = f"{latitude[k] + off:.7f},{longitude[k]:.7f},{speed[k]:.3f},{course[k]:.2f}"
        if name == HOLE[0] and k in HOLE[1]:
            fix = ",,,"
        lines.append(
            f"{stamp},{fix},{heading[k]:.2f},{60.0 * r[k] / DEG:.2f},{60.0 * n[k]:.1f},{-delta[k] / DEG:.2f}\n"
        )
    return HEAD.format(name=name) + COLUMNS + "".join(lines)


def main(folder: Path) -> None:
    """Write all logs."""
    folder.mkdir(parents=True, exist_ok=True)
    effects = {"current": CURRENT, "antenna": ANTENNA}
    for k, (name, rows) in enumerate(sail(null(SEED).ship, effects, SEED, LOGS).items()):
        measured = noisy(rows, WHITE, np.random.default_rng([SEED, k, 1]))
        write_text(folder / f"{name}.csv", log(name, measured, START + k * BETWEEN))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent / "docs" / "tutorial" / "logs")
