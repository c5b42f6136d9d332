"""Folders of made trials: what sensors show, and beside it what was true."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..displayed import Displayed
from ..errors import OptionError, Problem, among, must_be_a
from ..files import all_or_none, path_of, refuse_existing, write_text
from ..model import Model
from ..motions import Motion, generated_trial
from ..options import MakeOptions
from ..options.choice import must_be
from ..phrases import capital, counted
from ..profile import ShipProfile, froude_scaled, load_profile
from ..trial import Trial, write_trial
from ..units import DEG
from .sailing import Sailed
from .sets import PLANS, Plan, sailed

SHIPS = {"vectwin": "vectwin_3m"}
"""Profiles that trials are made of, by what the command calls them."""

LENGTH = 150.0
"""Of the ship at full scale [m]: section 6.1."""

NOISE = {
    "model": {"u": 0.01, "v": 0.01, "r": 0.1 * DEG},
    "full": {"u": 0.01, "v": 0.01, "r": 0.01 * DEG},
}
"""Standard deviations of white noise [m/s, m/s, rad/s], tables 2 and 5; positions and heading have none there."""

NOTE = (
    "Generated, not measured: {profile} of mmgtune{larger}, {manoeuvre}, set {set}, seed {seed}; actuators and wind as "
    "Wakita et al. (ensemble learning, appendix A) have them. {shown}"
)
SHOWN = {True: "White noise on u, v and r; the truth is beside it.", False: "The truth, without noise."}

SPLIT = """# {about}: made, not measured. All of them: each set of the paper has a folder of its own.
ship = "{ship}"
tune = [{ids}]
"""


@dataclass(frozen=True, repr=False)
class Made(Displayed):
    """What was written.

    sets     for each its name, what it is, folder, number of trials, time [s] and samples
    profile  file of the ship at full scale, None where it is the bundled one
    """

    ship: str
    sets: tuple[dict[str, Any], ...]
    profile: Path | None

    def __repr__(self) -> str:
        """In a line."""
        trials = counted(sum(one["trials"] for one in self.sets), "trial")
        return f"Made({self.ship}, {counted(len(self.sets), 'set')} of {trials})"

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        profile = str(self.profile) if self.profile else self.ship
        return {
            "schema": 1,
            "kind": "made",
            "ship": self.ship,
            "profile": profile,
            "sets": [dict(one) for one in self.sets],
        }


@all_or_none()
def make_trials(ship: str, out: Path | str, options: MakeOptions = MakeOptions(), *, overwrite: bool = False) -> Made:
    """Make sets of trials of a ship in ``out``, each in a folder of its own with the truth in ``truth``.

    At full scale the profile of the ship is written beside them.  The same seed makes the same trials, whichever
    other sets are made.  Raises OptionError for an unknown ship, OutputError where there are such files already.
    """
    must_be(options, MakeOptions)
    must_be_a(ship, str, "ship")
    if ship not in SHIPS:
        raise OptionError(Problem(f"no trials can be made of '{ship}'", "ship", **among(ship, tuple(SHIPS))))
    model = Model(load_profile(SHIPS[ship]))
    scale = LENGTH / model.L_pp if options.scale == "full" else 1.0
    profile = model.profile
    if scale != 1.0:
        profile = froude_scaled(profile, scale, id=f"{ship}_{LENGTH:g}m", name=f"VecTwin ship, {LENGTH:g} m")
    plans = [plan for name, plan in PLANS.items() if not options.sets or name in options.sets]
    out = path_of(out)
    own = out / f"{profile.id}.toml" if scale != 1.0 else None
    folders = [out / plan.name for plan in plans]
    refuse_existing([*folders, *([own] if own else [])], overwrite)
    if own:
        write_text(own, profile.text)
    rows = []
    for plan, folder in zip(plans, folders, strict=True):
        found, samples = sailed(model, plan, options, float(np.sqrt(scale)))
        rng = np.random.default_rng([options.seed, [*PLANS].index(plan.name), 1])
        for k, n_samples in enumerate(samples):
            truth = _truth(profile, plan, found, k, int(n_samples), scale, options)
            write_trial(truth, folder / "truth" / f"{truth.id}.parquet", overwrite=True)
            shown = _shown(truth, NOISE[options.scale], rng)
            write_trial(shown, folder / f"{truth.id}.parquet", overwrite=True)
        ids = ", ".join(f'"{one}"' for one in plan.ids)
        for place in (folder, folder / "truth"):
            about = capital(plan.about)
            write_text(place / "split.toml", SPLIT.format(about=about, ship=profile.id, ids=ids))
        counts = {
            "trials": len(samples),
            "seconds": float((samples - 1).sum() * options.sample),
            "samples": int(samples.sum()),
        }
        rows.append({"set": plan.name, "about": plan.about, "folder": str(folder), **counts})
    return Made(profile.id, tuple(rows), own)


def _truth(
    profile: ShipProfile, plan: Plan, found: Sailed, k: int, n_samples: int, scale: float, options: MakeOptions
) -> Trial:
    """One ship of a set as a trial, at its scale."""
    root = float(np.sqrt(scale))
    inputs = profile.arrangement.inputs
    speed, direction = found.wind[:n_samples, :, k].T
    motion = Motion(
        id=plan.ids[k],
        t=options.sample * np.arange(float(n_samples)),
        states=found.states[:n_samples, :, k] * [scale, scale, 1.0, root, root, 1.0 / root],
        controls=found.controls[:n_samples, :, k] * [1.0 if one.unit == "rad" else 1.0 / root for one in inputs],
        diverged=False,
        inputs=tuple(one.name for one in inputs),
    )
    note = NOTE.format(
        profile=SHIPS["vectwin"],
        larger=f", {scale:g} times as long by Froude's law" if scale != 1.0 else "",
        manoeuvre=plan.manoeuvres[k],
        set=plan.name,
        seed=options.seed,
        shown=SHOWN[False],
    )
    wind = {"wind_speed": root * speed, "wind_dir": direction}
    return generated_trial(motion, ship=profile.id, manoeuvre=plan.manoeuvres[k], note=note, beside=wind)


def _shown(truth: Trial, noise: dict[str, float], rng: np.random.Generator) -> Trial:
    """The trial as noisy sensors show it."""
    drawn = rng.standard_normal((3, truth.n_samples)) * _column([*noise.values()])
    return replace(
        truth,
        u=truth.u + drawn[0],
        v_m=truth.v_m + drawn[1],
        r=truth.r + drawn[2],
        noise=dict(noise),
        note=truth.note.replace(SHOWN[False], SHOWN[True]),
    )


def _column(values: list[float]) -> FloatArray:
    return np.array(values)[:, None]
