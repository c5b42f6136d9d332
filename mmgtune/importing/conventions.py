"""Signs and axes a map does not state: told from the motion where it leaves no doubt, asked for otherwise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..errors import LogError, Problem
from ..inputs import INPUTS
from ..physics.frame import to_ship
from ..trial.kinematics import FITS, Reading, position_misfits, turning
from ..units import DEG
from .maps.mapping import LogMap
from .motion import moved

AXES = {
    Reading.AS_ASKED: "ship axes, v to starboard",
    Reading.TO_PORT: "ship axes, v to port",
    Reading.IN_EARTH_AXES: "earth axes",
}
"""Readings of velocities that a map may leave open, in words."""
CLEAR = 4.0
"""How many times worse every other reading must fit."""
FEWEST_OVER = 50
"""Samples with the rudder over from which a side is told."""


class NoYawRate(LogError):
    """What a map calls the yaw rate does not follow the heading; that is the first of the problems."""


@dataclass(frozen=True)
class RudderEvidence:
    """How a ship answers her rudder.

    agreement  mean yaw rate towards the side of the rudder over mean size of yaw rate: 1 always towards it, -1 away
    gain       yaw acceleration per rudder angle over its standard error, from the best line through both
    samples    number of samples under way with the rudder over
    """

    agreement: float
    gain: float
    samples: int

    @property
    def side(self) -> int:
        """1 where she turns towards positive rudder to starboard, -1 to port, 0 where that is in doubt."""
        return 0 if self.doubt else int(np.sign(self.gain))

    @property
    def doubt(self) -> str:
        """Why the side is in doubt, "" where it is not."""
        if self.samples < FEWEST_OVER:
            return f"the rudder is over, under way ahead, in {self.samples} samples; {FEWEST_OVER} are needed"
        gain, agreement = abs(self.gain), abs(self.agreement)
        if not ((gain >= 8.0 and agreement >= 0.3) or (gain >= 4.0 and agreement >= 0.9)):
            least = 4 if agreement >= 0.9 else 8
            if gain < least:
                # A ship that turns to one side throughout does not show that it is the rudder she turns by.
                return f"yaw acceleration per rudder angle {self.gain:+.1f} standard errors; {least} are needed"
            return "she turns to either side of it"
        if np.sign(self.gain) != np.sign(self.agreement):
            return "yaw acceleration per rudder angle and yaw rate speak for opposite sides"
        return ""

    def __str__(self) -> str:
        return (
            f"agreement of sides {self.agreement:+.2f}, yaw acceleration per rudder angle {self.gain:+.0f} standard "
            f"errors, {self.samples} samples"
        )


def rudder_evidence(t: FloatArray, columns: dict[str, FloatArray]) -> RudderEvidence:
    """What a motion says about the sign of the rudder; columns u, r, delta, n, (n_samples,)."""
    delta, r = columns["delta"], columns["r"]
    ahead = np.isfinite(r) & np.isfinite(delta) & (columns["u"] > 0.0) & (columns["n"] > 0.0)
    over = ahead & (np.abs(delta) > 2.0 * DEG)
    size = float(np.mean(np.abs(r[over]))) if over.any() else 0.0
    if over.sum() < FEWEST_OVER or size == 0.0:
        return RudderEvidence(0.0, 0.0, int(over.sum()))
    agreement = float(np.mean(np.sign(delta[over]) * r[over])) / size
    # First order: r grows with the rudder and dies away with itself.  Over strides long enough to see through noise.
    stride = max(1, len(t) // 400)
    rows = np.arange(0, len(t) - stride, stride)
    sums = [np.concatenate([[0.0], np.cumsum(np.where(ahead, values, 0.0))]) for values in (delta, r, ahead)]
    mean = [(one[rows + stride] - one[rows]) / stride for one in sums]
    whole = ahead[rows] & ahead[rows + stride] & (mean[2] > 0.999)
    if whole.sum() < 20:
        return RudderEvidence(agreement, 0.0, int(over.sum()))
    change = (r[rows + stride] - r[rows])[whole]
    matrix = np.column_stack([mean[0][whole], mean[1][whole], np.ones(int(whole.sum()))])
    solution, *_ = np.linalg.lstsq(matrix, change, rcond=None)
    rest = change - matrix @ solution
    variance = float(rest @ rest) / max(1, len(rest) - 3) * np.linalg.pinv(matrix.T @ matrix)[0, 0]
    return RudderEvidence(agreement, float(solution[0] / max(np.sqrt(variance), 1e-300)), int(over.sum()))


def settle(t: FloatArray, columns: dict[str, FloatArray], log_map: LogMap, measured: set[str], where: str) -> list[str]:
    """Bring r, u and v to the trial format's signs and axes, in place; what was found, in sentences.

    columns   x, y, psi, r and, where measured, u and v, (n_samples,)
    measured  quantities that come from columns of the log, with signs it may not have stated as sentences of NMEA
              0183 do

    Raises LogError with every question the motion does not answer.
    """
    problems: list[Problem] = []
    said = []
    assumed = [
        f"{what} taken as {how}"
        for name, what, how in (("y", "y", "east of x"), ("psi", "the heading", "clockwise from north"))
        if name in log_map.sources and log_map.sources[name].column and log_map.sources[name].positive is None
    ]
    if assumed:
        # Both the other way round is a mirror image, which no motion can tell from the ship herself.
        said.append(f"{' and '.join(assumed)}, as the map says nothing else")
    said += _yaw(t, columns, log_map, measured, where, problems)
    refusal = NoYawRate if problems else LogError
    of_table = all(name in log_map.sources and log_map.sources[name].column for name in ("u", "v"))
    if {"u", "v"} <= measured and of_table:
        said += _axes(t, columns, log_map, where, problems)
    if problems:
        raise refusal(*problems)
    return said


def settle_rudders(t: FloatArray, columns: dict[str, FloatArray], log_map: LogMap, where: str) -> list[str]:
    """Turn every rudder to starboard, in place, where the map does not say how it counts; what was found.

    columns  u, r and n, settled, and the rudders, (n_samples,)

    Raises LogError with every rudder whose sign the motion does not tell.
    """
    problems: list[Problem] = []
    said = []
    for name, source in log_map.sources.items():
        rudder = name in INPUTS and INPUTS[name].role == "rudder"
        if not rudder or source.column is None or source.positive is not None:
            continue
        evidence = rudder_evidence(t, {**columns, "delta": columns[name]})
        if evidence.side == 0:
            what = "rudder angle" if name == "delta" else f"{INPUTS[name].words}, '{name}',"
            problems.append(
                Problem(
                    f"does a positive {what} turn the ship to starboard or to port?",
                    f"{where}, map {log_map.place(name)}",
                    f"the map does not say, and this motion does not show it: {evidence}",
                    f'say positive = "starboard" or positive = "port" in [columns.{name}]',
                )
            )
            continue
        if evidence.side < 0:
            columns[name] = -columns[name]
        side = "starboard" if evidence.side > 0 else "port"
        which = "rudder" if name == "delta" else name
        said.append(f"{which}: a positive angle of the log turns the ship to {side}, as the motion shows ({evidence})")
    if problems:
        raise LogError(*problems)
    return said


def _yaw(
    t: FloatArray,
    columns: dict[str, FloatArray],
    log_map: LogMap,
    measured: set[str],
    where: str,
    problems: list[Problem],
) -> list[str]:
    source = log_map.sources.get("r")
    if "r" not in measured or source is None or source.column is None or source.positive is not None:
        return []
    turned = turning({"t": t, "psi": columns["psi"], "r": columns["r"]})
    if turned.span < 0.1 or abs(turned.correlation) < 0.9:
        problems.append(
            Problem(
                "is the yaw rate positive to starboard or to port?",
                f"{where}, map {log_map.place('r')}",
                f"the map does not say; its integral and the heading have a correlation of {turned.correlation:.2f} "
                f"over {turned.span / DEG:.3g} deg",
                'say positive = "starboard" or positive = "port" in [columns.r]',
            )
        )
        return []
    if turned.correlation < 0.0:
        columns["r"] = -columns["r"]
    side = "starboard" if turned.correlation > 0.0 else "port"
    return [f"yaw rate: positive to {side} in the log, as the heading shows (correlation {turned.correlation:+.3f})"]


def _axes(
    t: FloatArray, columns: dict[str, FloatArray], log_map: LogMap, where: str, problems: list[Problem]
) -> list[str]:
    """Velocities into ship axes, with v to starboard."""
    stated = log_map.sources["v"].positive
    point = log_map.point or "midship"
    if log_map.axes == "earth":
        columns["u"], columns["v"] = to_ship(columns["psi"], columns["u"], columns["v"])
        return ["velocities: earth axes, as the map says", *moved(columns, log_map, point)]
    if log_map.axes == "ship" and stated is not None:
        return ["velocities: ship axes, as the map says", *moved(columns, log_map, point)]
    tried = dict(columns)
    moved(tried, log_map, point)
    misfits = position_misfits({name: tried[name] for name in ("x", "y", "psi", "u", "v")} | {"t": t})
    open_to = {Reading.AS_ASKED}
    if stated is None:
        open_to.add(Reading.TO_PORT)
    if log_map.axes is None:
        open_to.add(Reading.IN_EARTH_AXES)
    known = sorted((miss, AXES[reading], reading) for reading, miss in misfits.items() if reading in open_to)
    shown = ", ".join(f"{words}: {100.0 * miss:.1f} %" for miss, words, _ in known)
    if not known or known[0][0] > FITS or (len(known) > 1 and known[1][0] < CLEAR * known[0][0]):
        asks = (
            "are u and v in ship axes or in earth axes?"
            if log_map.axes is None
            else "is v positive to starboard or to port?"
        )
        problems.append(
            Problem(
                asks,
                f"{where}, map {log_map.place('v')}",
                "the map does not say, and the positions do not tell; misses of the distance run: " + (shown or "none"),
                'say axes = "ship" or "earth" in [velocity], and positive = "starboard" or "port" in [columns.v]',
            )
        )
        return []
    _, words, best = known[0]
    if best is Reading.IN_EARTH_AXES:
        columns["u"], columns["v"] = to_ship(columns["psi"], columns["u"], columns["v"])
    elif best is Reading.TO_PORT:
        columns["v"] = -columns["v"]
    return [
        f"velocities: {words}, as the positions show (misses of the distance run: {shown})",
        *moved(columns, log_map, point),
    ]
