"""Channels against each other and against what ships can do: factors, signs and columns that were never measured."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ...components.speeds import too_fast
from ...physics.constants import GRAVITY
from ...physics.frame import to_earth
from ...units import DEG
from ..headings import full_turns
from ..kinematics import halfway, middle
from ..model import Trial
from .control_checks import rudders_of, steered
from .finding import Finding
from .in_parts import part_findings
from .motion_checks import spikes_of
from .position_jumps import jump_findings

FASTEST = {
    "x": (100.0, "m/s"), "y": (100.0, "m/s"), "psi": (3.0, "rad/s"), "u": (5.0, "m/s^2"), "v": (5.0, "m/s^2"),
    "r": (3.0, "rad/s^2"),
}  # fmt: skip
"""Change per second that neither ships nor models of a metre make, by channel."""
FASTEST_SHIP = 60.0
"""Speed [m/s] that no ship makes, whatever her length."""
AMIDSHIPS = 3.0 * DEG
"""Rudder angle below which a ship goes about straight on."""
OUTWARD = 10.0 * DEG
"""Angle of any rudder from which a pair of them, turned outward, takes off way."""
FEWEST = 5
"""Samples of an approach that say anything."""
STEADY = 0.1
"""Spread of the way per turn within an approach, as a share, beyond which the ship gathers or loses speed."""
USUAL_RUDDER = 50.0 * DEG
"""Angle beyond which hardly any rudder goes: common ones stop at 35 to 45 deg."""
ADVANCE = (0.004, 0.12)
"""Way a ship makes with each turn of her propeller, in her lengths; usual ones make 0.01 to 0.04."""
ON_APPROACH = (0.006, 0.08)
"""The same on a straight course at a steady speed, where neither turns nor changes of speed widen it."""
WAY = "way"
"""Code of a finding on that."""
STRIDES = 24
"""Parts of a record in which the way is compared."""

ASTERN = 0.05
"""Share of a run with the propeller turning astern from which it may be that which swings the ship."""


def cross_findings(
    trial: Trial, where: str, L_pp: float | None, contradicted: bool, ended: Collection[str] = ()
) -> list[Finding]:
    """Findings on channels that contradict each other.

    L_pp          of the ship [m], None where it is not known: what needs it is left out then
    contradicted  whether positions and velocities have been found to differ as a whole
    ended         channels whose sensors are at the end of their range, which is told of them already
    """
    changes = _changes(trial, where)
    found = [*changes.values(), *_speed(trial, where, L_pp), *_revolutions(trial, where, L_pp)]
    if not contradicted:
        found += way_by_axis(trial, where) if "u" not in ended else []
        found += part_findings(trial, where, ended)
        if not {"x", "y"} & changes.keys():
            found += jump_findings(trial, where)
    return [*found, *_rudder(trial, where)]


def _warning(what: str, where: str, why: str, fix: str) -> Finding:
    return Finding("warning", what, where, why, fix)


def _changes(trial: Trial, where: str) -> dict[str, Finding]:
    """Steps that no ship makes, by channel; single samples inside a record are spikes, and full turns are jumps of the
    heading."""
    found = {}
    for name, (most, unit) in FASTEST.items():
        values = trial.columns[name]
        kept = np.isfinite(values)
        kept[spikes_of(trial, name)] = False
        rows = np.flatnonzero(kept)
        if len(rows) < 10:
            continue
        step = np.diff(values[rows])
        if name == "psi":
            step = np.where(full_turns(values[rows]), 0.0, step)
        rate = np.abs(step) / np.diff(trial.t[rows])
        # Where noise at a high rate makes such steps all along, they say nothing.
        odd = (rate > most) & (rate > 20.0 * np.median(rate))
        if odd.any():
            k = int(np.argmax(np.where(odd, rate, 0.0)))
            found[name] = _warning(
                f"'{name}' changes by {abs(step[k]):.3g} within {np.diff(trial.t[rows])[k]:.3g} s",
                f"{where}, column '{name}', row {rows[k + 1]}",
                f"that is {rate[k]:.3g} {unit}, and no ship makes more than {most:g}: damage, or records joined",
                "mark wrong samples as NaN, or cut the trial there",
            )
    return found


def _speed(trial: Trial, where: str, L_pp: float | None) -> list[Finding]:
    speed = np.hypot(trial.u, trial.v_m)
    speed = speed[np.isfinite(speed)]
    usual = float(np.percentile(speed, 90.0)) if len(speed) else 0.0
    if L_pp is None:
        if usual <= FASTEST_SHIP:
            return []
        why = "no ship is as fast"
    else:
        if (froude := too_fast(usual, L_pp)) is None:
            return []
        why = f"a Froude number of {froude:.2g} with {L_pp:.4g} m between perpendiculars; ships stay below 0.5"
    return [
        _warning(
            f"the ship makes {usual:.3g} m/s", f"{where}, columns 'u' and 'v'", why, "check the unit of 'u' and 'v'"
        )
    ]


def _revolutions(trial: Trial, where: str, L_pp: float | None) -> list[Finding]:
    """Propellers that stand, turn astern or turn far too fast or slowly for the way the ship makes."""
    u, n = trial.u, trial.n
    known = np.isfinite(u)
    half = len(u) // 2
    third, last = (part[np.isfinite(part)] for part in (u[half : half + half // 2], u[half + half // 2 :]))
    place = f"{where}, columns 'n' and 'u'"
    if known.sum() < 40 or not len(third) or not len(last):
        return []
    begun, ended = float(np.mean(third)), float(np.mean(last))
    # A ship whose propeller does not drive her loses a tenth of her way with each length, more in a turn.  Where her
    # length is not known it is taken for that at a Froude number of 0.1, which few go slower than.
    length = L_pp if L_pp is not None else float(np.nanmax(np.abs(u))) ** 2 / (0.01 * GRAVITY)
    run = float(np.nansum(np.abs(u[half + 1 :]) * np.diff(trial.t)[half:]))
    keeps = begun > 0.0 and ended > 0.93 * begun and np.mean(u[known] > 0.0) > 0.95 and run > 2.5 * length
    said = f"she goes ahead at {begun:.3g} m/s in the third quarter of the trial and {ended:.3g} m/s in the last"
    largest = float(np.abs(n).max())
    if keeps and largest < 1e-3:
        fix = "write the measured revolutions into 'n'"
        return [_warning("the propeller stands all the time, and the ship keeps her way", place, said, fix)]
    if keeps and np.mean(n < 0.0) > 0.95:
        fix = "change the sign of 'n': ahead is positive"
        return [_warning("the propeller turns astern, and the ship keeps going ahead", place, said, fix)]
    if L_pp is None:
        return []
    steady = way_per_turn(trial)
    way = steady if steady is not None else usual_way(trial) if keeps else None
    low, high = ON_APPROACH if steady is not None else ADVANCE
    return [] if way is None or low <= way / L_pp <= high else [way_finding(way, L_pp, trial, where)]


def way_finding(way: float, L_pp: float, trial: Trial, where: str, as_others: bool = False) -> Finding:
    """That a way with each turn of the propeller [m] is none that ships make."""
    much = "little" if way < ON_APPROACH[0] * L_pp else "much"
    others = ", as in the other trials" if as_others else ""
    said = f"the ship makes {way:.3g} m with each turn of the propeller, {way / L_pp:.2g} of her length: too {much}"
    why = "ships make 0.01 to 0.04 of their length; a unit may be wrong, or a gear between engine and shaft"
    fix = "check the unit of 'n' (revolutions per second of the shaft) and of 'u'"
    return replace(_warning(said + others, f"{where}, columns 'n' and 'u'", why, fix), code=WAY)


def usual_way(trial: Trial) -> float | None:
    """Metres ahead with each turn of the propeller, unless rudders brake; None where she hardly goes ahead."""
    u, n = trial.u, trial.n
    known = np.isfinite(u)
    ahead = known & (u > 0.5 * np.nanmax(np.where(known, u, -np.inf))) & (n > 0.2 * float(np.abs(n).max()))
    ahead &= steered(trial)
    return float(np.median(u[ahead] / n[ahead])) if ahead.sum() >= 20 else None


def way_per_turn(trial: Trial) -> float | None:
    """Metres ahead with each turn of the propeller on the straight course a trial begins with; None where none is."""
    with np.errstate(all="ignore"):
        straight = (np.abs(trial.delta) < AMIDSHIPS) & (trial.u > 0.0) & (trial.n > 0.3 * np.abs(trial.n).max())
        straight &= trial.u > 0.5 * np.nanmax(trial.u, initial=0.0)  # not while she gathers way
        straight &= np.max(np.abs(rudders_of(trial)), axis=0) < OUTWARD
        end = len(straight) if straight.all() else int(np.argmin(straight))
        if end < FEWEST:
            return None
        low, usual, high = np.percentile(trial.u[:end] / trial.n[:end], [10.0, 50.0, 90.0])
    return float(usual) if high - low < STEADY * usual else None


def axis_factors(trial: Trial) -> dict[str, tuple[float, float]]:
    """By axis, "x" and "y": how many times as far positions go as u, v and heading say, and its standard error.

    Only axes along which the ship makes enough way to tell.
    """
    dt = np.diff(trial.t)
    ways = to_earth(halfway(trial.psi), middle(trial.u), middle(trial.v_m))
    found = {}
    for name, way, position in zip(("x", "y"), ways, (trial.x, trial.y), strict=True):
        logged, moved = way * dt, np.diff(position)
        both = np.isfinite(logged) & np.isfinite(moved)
        bounds = np.linspace(0, len(dt), STRIDES + 1).astype(np.intp)[:-1]
        if both.sum() < 4 * STRIDES or both.mean() < 0.5:
            continue
        a, b = (np.add.reduceat(np.where(both, values, 0.0), bounds) for values in (logged, moved))
        size = float(a @ a)
        if size <= 0.0:
            continue
        factor = float(a @ b) / size
        rest = b - factor * a
        found[name] = factor, float(np.sqrt(rest @ rest / (len(a) - 1) / size))
    return found


def way_by_axis(trial: Trial, where: str) -> list[Finding]:
    """Positions of an axis that go a whole factor further than the velocities say."""
    factors = axis_factors(trial)
    wrong = {
        name: factor
        for name, (factor, error) in factors.items()
        if abs(factor - 1.0) > 0.25 and error < 0.05 * abs(factor)
    }
    found = []
    for name, factor in wrong.items():
        other = "y" if name == "x" else "x"
        right = other in factors and other not in wrong and factors[other][1] < 0.05
        fits = f"; '{other}' agrees with them ({factors[other][0]:.3g} times)" if right else ""
        found.append(
            _warning(
                f"'{name}' goes {factor:.3g} times as far as 'u', 'v' and 'psi' say",
                f"{where}, columns '{name}', 'u', 'v' and 'psi'",
                f"a factor or a unit of '{name}' is wrong{fits}"
                if right
                else "a unit of positions or velocities is wrong",
                f"divide '{name}' by {factor:.3g} if that is a known factor, such as 10, 60 or 1.944; import it again",
            )
        )
    return found


def _rudder(trial: Trial, where: str) -> list[Finding]:
    """Rudders that stand while the ship is steered, and angles beyond what rudders do."""
    delta, r = trial.delta, trial.r
    place = f"{where}, columns 'delta' and 'r'"
    largest = float(np.percentile(np.abs(delta), 95.0))
    if largest > USUAL_RUDDER:
        return [
            _warning(
                f"the rudder is over by {largest / DEG:.3g} deg",
                f"{where}, column 'delta'",
                "most rudders stop at 35 to 45 deg; a factor may be wrong",
                "check the unit and the scale of 'delta'; nothing is to be done where her rudder does go so far",
            )
        ]
    known = np.isfinite(r)
    rate = r[known]
    if known.sum() < 40 or float(np.ptp(delta)) > 0.5 * DEG:
        return []
    heading = trial.psi[np.isfinite(trial.psi)]
    turned = float(np.ptp(heading)) if len(heading) else 0.0
    steady = _smoothed(rate, max(1, len(rate) // 50))
    port, starboard = float(steady.min()), float(steady.max())
    both = turned > 10.0 * DEG and min(starboard, -port) > 0.3 * max(starboard, -port)
    half = len(steady) // 2
    # After a turn a ship goes on turning for a while, and an unstable one for good, but no faster than at first.
    begun, ended = (float(np.mean(np.abs(part))) for part in (steady[: half // 4 + 1], steady[half:]))
    gains = turned > 30.0 * DEG and ended > 2.0 * begun and float(np.abs(delta).max()) < 1.0 * DEG
    # No sensor reads the same for ever.
    lost = np.ptp(delta) == 0.0 and abs(delta[0]) < 1.0 * DEG and turned > 90.0 * DEG
    lost = lost and ended > 0.5 * float(np.abs(steady).max())
    if not both and (_reversed(trial) or not (gains or lost)):
        return []
    stands = f"stands at {float(np.median(delta)) / DEG:.3g} deg all the time"
    return [
        _warning(
            f"the rudder {stands}, and the ship is steered",
            place,
            f"she turns through {turned / DEG:.3g} deg, at up to {starboard / DEG:.2g} deg/s to starboard and "
            f"{-port / DEG:.2g} deg/s to port: 'delta' was not measured, or was lost",
            "write the measured rudder angle into 'delta'",
        )
    ]


def _reversed(trial: Trial) -> bool:
    """Whether the propeller was put astern in the run, which swings a ship that nobody steers."""
    return bool(np.mean(trial.n < 0.0) > ASTERN)


def _smoothed(values: FloatArray, width: int) -> FloatArray:
    """Running means over ``width`` samples."""
    summed = np.concatenate([[0.0], np.cumsum(values)])
    return np.asarray((summed[width:] - summed[:-width]) / width)
