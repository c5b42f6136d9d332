"""What is odd about the measured motion: gaps, jumps, spikes, channels that contradict each other."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...arrays import BoolArray, FloatArray, runs_of_true
from ...inputs import INPUTS
from ...phrases import aboard, counted
from ...units import DEG
from ..headings import full_turns
from ..kinematics import FITS, Reading, lever_of, position_misfits, stretch_of, turning
from ..model import Trial
from ..schema import LARGEST_YAW_RATE, MOTION
from .finding import Finding, Reverse

REPEATED = 0.05
"""Share of samples that repeat the one before, and that do not, from which a channel is taken for one of few digits."""

SMALL = 0.02
"""Share of the level of a channel up to which the step of its last digit may be that of an instrument."""

USUAL = (
    "give velocities over ground (not through the water), in ship axes, in m/s, and both velocities and positions at "
    "midship, not at an antenna or at the centre of gravity"
)
"""What to do where no one reading of velocities and positions makes them agree."""

MENDED = {
    Reading.IN_EARTH_AXES: "turn 'u' and 'v' into ship axes: u cos(psi) + v sin(psi) and v cos(psi) - u sin(psi)",
    Reading.TO_PORT: "change the sign of 'v': positive to starboard",
    Reading.SWAPPED: "swap 'x' and 'y': x is north and y is east",
    Reading.IN_KNOTS: "multiply 'u' and 'v' by 0.5144: they are to be in m/s",
    Reading.NOT_KNOTS: "divide 'u' and 'v' by 0.5144: they are in m/s without it",
    Reading.TO_WEST: "change the sign of 'y': positive east",
    Reading.TWICE: "multiply 'psi' by 180/pi: it is in radians then",
}
"""What makes of a reading that fits the one that is asked for."""

YAW_SIGN = "yaw-sign"
"""Code of a finding that yaw rate and heading turn opposite ways."""

CONTRADICTED = "contradicted"
"""Code of a finding that positions and velocities contradict each other."""

IN_METRES = "give 'x' and 'y' in metres alike: longitudes become metres with the cosine of the latitude"

OF_MIDSHIP = "give positions of midship: [antenna] of the map says where they were measured"

WANDER = 4
"""Windows so many times longer are looked at where no reading fits: positions that wander miss by less in them."""

TURNED, FEWEST_MOVING = 0.3, 8
"""Angle [rad] that the heading turns by at least in a trial whose speeds cannot stand still, and samples of it."""

TO_AND_FRO, STRIDE, FEWEST_SCATTERED = 3.0, 20, 40
"""How many times the way from sample to sample, over so many of them, what is measured must go to and fro by, usually,
and samples it takes to tell."""

FAR_APART, TURNED_APART, OF_EXTENT = 5.0, 1.5 * DEG, 0.02
"""Metres or, of a model, share of all the way, and angle [rad] from which it is spoken of."""

FREER = 2.0
"""What the misfit counts of a reading that has two numbers to choose, among those that have none."""


def motion_findings(trial: Trial, where: str) -> list[Finding]:
    """Findings on the motion channels of a trial that can be used."""
    return [
        *_gaps(trial, where),
        *_jumps(trial, where),
        *_spikes(trial, where),
        *_scattered(trial, where),
        *_yaw(trial, where),
        *_positions(trial, where),
    ]


def sway_findings(trial: Trial, where: str) -> list[Finding]:
    """A sway that is the same throughout, in a ship that turns and whose other speeds change: a column filled in."""
    psi, u, v = (values[np.isfinite(values)] for values in (trial.psi, trial.u, trial.v_m))
    if min(len(psi), len(u), len(v)) < FEWEST_MOVING or np.ptp(psi) < TURNED or np.ptp(u) == 0.0 or np.ptp(v) > 0.0:
        return []
    return [
        Finding(
            "warning",
            f"'v' is {v[0]:.4g} throughout",
            f"{where}, column 'v'",
            "a ship that turns drifts: it was filled in, not measured, and 'u' may be the speed over ground",
            "leave the column out, or mark it as NaN: it counts in no comparison then",
            "constant",
        )
    ]


def _gaps(trial: Trial, where: str) -> list[Finding]:
    """One finding for all columns: sensors that fail together would fill pages."""
    missing = {name: np.isnan(values) for name, values in trial.columns.items() if name in MOTION}
    missing = {name: rows for name, rows in missing.items() if rows.any()}
    if not missing:
        return []
    longest = {name: longest_run(rows) for name, rows in missing.items()}
    worst = max(longest, key=lambda name: longest[name][1] - longest[name][0])
    begins, ends = longest[worst]
    # A gap lasts from the last sample before it to the first one after it, if there is one.
    lasts = trial.t[min(ends, trial.n_samples - 1)] - trial.t[begins - 1]
    counts = sorted({int(rows.sum()) for rows in missing.values()})
    many = f"{counts[0]}" if len(counts) == 1 else f"{counts[0]} to {counts[-1]}"
    *names, last = (f"'{name}'" for name in missing)
    told = f"{', '.join(names)} and {last} have gaps" if names else f"{last} has gaps"
    length = counted(ends - begins, "sample")
    return [
        Finding(
            "warning",
            f"{told}: {many} of {trial.n_samples} samples; the longest has {length}, {lasts:.3g} s",
            f"{where}, column '{worst}', row {begins}",
            "samples in gaps count in no comparison",
            code="gaps",
        )
    ]


def longest_run(rows: BoolArray) -> tuple[int, int]:
    """First row of the longest run of rows (n_samples,) that are so, and the row behind it."""
    return max(runs_of_true(rows), key=lambda run: run[1] - run[0])


def _jumps(trial: Trial, where: str) -> list[Finding]:
    """Heading that is not unwrapped; a gap hides how far the ship turned in it, so jumps across gaps do not count."""
    jumps = full_turns(trial.psi)
    if not jumps.any():
        return []
    row = int(np.flatnonzero(jumps)[0]) + 1
    return [
        Finding(
            "warning",
            f"the heading jumps by a full turn {'once' if jumps.sum() == 1 else f'{jumps.sum()} times'}",
            f"{where}, column 'psi', row {row}",
            "it is not unwrapped; a jump would count as a miss of 360 deg",
            "apply numpy.unwrap to 'psi'",
        )
    ]


def _spikes(trial: Trial, where: str) -> list[Finding]:
    found = []
    for name in trial.columns:
        if name not in MOTION and name not in INPUTS:
            continue
        rows = spikes_of(trial, name)
        if len(rows):
            found.append(
                Finding(
                    "warning",
                    f"'{name}' has {counted(len(rows), 'spike')}",
                    f"{where}, column '{name}', row {rows[0]}",
                    "single samples far off their neighbours",
                    "mark them as NaN" if name in MOTION else "replace them by interpolation",
                )
            )
    return found


def _scattered(trial: Trial, where: str) -> list[Finding]:
    """Positions or headings that go to and fro from one sample to the next, as where two receivers log in turn."""
    found = []
    for names, least, unit in ((("x", "y"), FAR_APART, "m"), (("psi",), TURNED_APART, "deg")):
        values = np.stack([trial.columns[name] for name in names])
        if values.shape[1] < FEWEST_SCATTERED:
            continue
        off = np.linalg.norm(values[:, 1:-1] - 0.5 * (values[:, :-2] + values[:, 2:]), axis=0)
        way = np.linalg.norm(values[:, STRIDE:] - values[:, :-STRIDE], axis=0) / STRIDE
        if not (np.isfinite(off).sum() >= FEWEST_SCATTERED and np.isfinite(way).any()):
            continue
        further = np.linalg.norm(values[:, len(off) // 4 :] - values[:, : values.shape[1] - len(off) // 4], axis=0)
        usual, extent = float(np.nanmedian(off)), float(np.max(np.nanmax(values, axis=1) - np.nanmin(values, axis=1)))
        least = min(least, OF_EXTENT * extent) if unit == "m" else least
        at_rest = unit == "m" and float(np.nanmedian(further)) <= 2.0 * usual
        if at_rest or usual < max(TO_AND_FRO * float(np.nanmedian(way)), least):
            continue
        size, what = usual / (DEG if unit == "deg" else 1.0), " and ".join(f"'{name}'" for name in names)
        found.append(
            Finding(
                "warning",
                f"{what} go{'es' if len(names) == 1 else ''} to and fro by {size:.2g} {unit} from sample to sample",
                f"{where}, column '{names[0]}'",
                "several times the way from one to the next, as where two sensors log in turn, or one is very noisy",
                "import the log of one sensor alone, or leave out what does not belong to it",
                "scattered",
            )
        )
    return found


def spikes_of(trial: Trial, name: str) -> npt.NDArray[np.intp]:
    """Spikes of a channel of the motion or an input; several checks pass over them, so a trial keeps its own."""
    kept: dict[str, npt.NDArray[np.intp]] = trial.__dict__.setdefault("_spikes", {})
    if name not in kept:
        kept[name] = spikes(trial.columns[name], share=0.02 if name in MOTION else 0.2)
    return kept[name]


def spikes(values: FloatArray, share: float) -> npt.NDArray[np.intp]:
    """Rows of single samples that continue neither what comes before nor what comes after.

    A spike is off both by ten times the usual and by ``share`` of the channel's range; a step or a corner fits one
    side.  Where few digits are logged a step of the last of them is none.  The first and last two rows cannot be told.
    """
    if len(values) < 10 or np.isfinite(values).sum() < 10:
        return np.zeros(0, dtype=np.intp)
    here = values[2:-2]
    before, after = 2.0 * values[1:-3] - values[:-4], 2.0 * values[3:-1] - values[4:]
    off = np.minimum(np.abs(here - before), np.abs(here - after))
    if not np.isfinite(off).any():
        return np.zeros(0, dtype=np.intp)
    low, high = np.nanpercentile(values, [1.0, 99.0])
    least = max(14.8 * np.nanmedian(off), share * (high - low), 0.02 * (np.nanmax(values) - np.nanmin(values)))
    # A sample between its neighbours is on the way from one to the other, however fast.
    far = (off > least) & ((here - values[1:-3]) * (here - values[3:-1]) > 0.0)
    if not far.any():
        return np.zeros(0, dtype=np.intp)
    apart = np.minimum(np.abs(here - values[1:-3]), np.abs(here - values[3:-1]))
    return np.flatnonzero(far & (apart > 3.0 * _digit(values))) + 2


def _digit(values: FloatArray) -> float:
    """The usual step of a channel that often repeats its value, because few digits are logged; 0 for any other.

    Of one that hardly ever moves, as revolutions logged in halves, it is what all values are whole multiples of.
    """
    known = values[np.isfinite(values)]
    steps = np.abs(np.diff(known))
    moving = steps[steps > 0.0]
    few = REPEATED * len(steps) < len(moving) < (1.0 - REPEATED) * len(steps)  # one that rests but for spikes is none
    return float(np.median(moving)) if few else _quantum(known)


def _quantum(known: FloatArray) -> float:
    """The step that all values (n,) are whole multiples of, where it is small beside them; else 0."""
    found = np.unique(known)
    level = float(np.median(np.abs(known)))
    step = float(np.min(np.diff(found), initial=np.inf))
    # The same number worked out in two ways, and a spike that happens to be a multiple: 0 among revolutions.
    if not 1e-6 * level < step < SMALL * level:
        return 0.0
    of = known / step
    return step if np.max(np.abs(of - np.round(of))) < 0.01 else 0.0


def _yaw(trial: Trial, where: str) -> list[Finding]:
    turned = turning(trial.columns)
    place = f"{where}, columns 'psi' and 'r'"
    if turned.opposed:
        why = f"she turns {turned.ratio:.3g} times as far by her heading, to the other side"
        fix = Reverse("r", "psi")
        return [Finding("warning", "yaw rate and heading turn opposite ways", place, why, fix, YAW_SIGN)]
    if turned.span > 0.3 and turned.miss > 0.1 * turned.span + 0.1:
        return [
            Finding(
                "warning",
                "the yaw rate does not integrate to the heading",
                place,
                f"they come apart by {turned.miss / DEG:.3g} deg; the heading turns {turned.ratio:.3g} times as far, "
                f"correlation {turned.correlation:.2f}",
                "check sign, scale and bias of 'r' against 'psi'",
                "yaw-rate",
            )
        ]
    yaw = np.abs(trial.r[np.isfinite(trial.r)])
    if np.percentile(yaw, 95.0) > LARGEST_YAW_RATE and _misses(trial, 1.0) > FITS:
        return [
            Finding(
                "warning",
                f"yaw rate up to {yaw.max():.3g} rad/s",
                place,
                "only models shorter than a few metres turn so fast; heading and yaw rate may both be in degrees",
                "check the units of 'psi' and 'r'",
            )
        ]
    return []


def _misses(trial: Trial, unknown: float, longer: int = 1) -> float:
    """How badly velocities explain positions as they stand, ``unknown`` where the ship hardly moves."""
    return position_misfits(trial.columns, longer, (Reading.AS_ASKED,)).get(Reading.AS_ASKED, unknown)


def _positions(trial: Trial, where: str) -> list[Finding]:
    if _misses(trial, 0.0) <= FITS:
        return []
    misfits = position_misfits(trial.columns)
    asked = misfits.pop(Reading.AS_ASKED)
    # Small angles in degrees read as earth axes do; headings surely in degrees make a trial unusable.
    del misfits[Reading.IN_DEGREES]
    enough = min(FITS, 0.5 * asked)
    fitting = [(miss, f"if read {one.words}", MENDED[one]) for one, miss in misfits.items() if miss < enough]
    lever = lever_of(trial.columns)
    if lever is not None and lever.likely and FREER * lever.misfit < enough:
        place = f"if they are of a point about {aboard(lever.x, lever.y, 2)} of midship"
        fitting.append((FREER * lever.misfit, place, OF_MIDSHIP))
    stretch = stretch_of(trial.columns)
    if stretch is not None and stretch.explains(asked):
        divided = " and ".join(f"'{name}' is divided by {by:.3g}" for name, by in stretch.axes.items())
        fitting.append((FREER * stretch.misfit, f"if {divided}", IN_METRES))
    fitting.sort()
    if not fitting and _misses(trial, 0.0, WANDER) <= FITS:
        return []
    fits = "they fit " + ", or ".join(words for _, words, _ in fitting)
    fix = "; or ".join(fix for _, _, fix in fitting)
    if not fitting:
        fits, fix = f"nor do they fit if read in earth axes ({100 * misfits[Reading.IN_EARTH_AXES]:.0f} %)", USUAL
    return [
        Finding(
            "warning",
            "u, v and heading do not integrate to the positions",
            f"{where}, columns 'x', 'y', 'psi', 'u' and 'v'",
            f"read in ship axes they miss by {100 * asked:.0f} % of the distance; {fits}",
            fix,
            CONTRADICTED,
        )
    ]
