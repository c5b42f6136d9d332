"""Make the sample trials of SUZAKU in ``trials/suzaku``: generated, not measured.

The measured trials of the paper are not public.  As "the ship" this takes the coefficients the paper found for it at
a_r = 0.5 (Suyama et al. 2023, Table 7), the closest public knowledge of the real one, and runs it through the tests of
the paper with what a real trial has and a simulation does not: a steering gear of limited rate, revolutions that drop
as the turn slows the ship, an arbitrary heading, and sensor noise.  It integrates at 0.1 s (Runge-Kutta), so that a fit
at the paper's 1 s (Euler) meets an error of its own.

    python tools/generate_suzaku_trials.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from mmgtune.files import write_text
from mmgtune.motions import Motion
from mmgtune.orders import Helmsman, TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.profile import load_profile, tuned
from mmgtune.trial import Trial, write_trial

SHIP = {
    "hull.R_0": 0.0207,
    "propeller.t_P": 0.0400,
    "wake.w_P0": 0.6330,
    "wake.C_w": -3.0,
    "rudder.t_R": -0.0290,
    "rudder.a_H": 0.2370,
    "rudder.x_H_": -0.9075,
    "rudder.eps": 1.1872,
    "rudder.kappa": 0.4014,
    "rudder.l_R_": -1.3320,
    "rudder.gamma_Rp": 0.3655,
    "rudder.gamma_Rn": 0.2580,
}
"""Suyama et al. 2023, Table 7, row a_r = 0.5."""

NOISE = {"x": 0.4, "y": 0.4, "psi": np.radians(0.17), "u": 0.02, "v": 0.02, "r": np.radians(0.03)}
"""Standard deviations of white sensor noise: m, m, rad, m/s, m/s, rad/s."""

INPUT_NOISE = {"n": 0.002, "delta": np.radians(0.05)}

DURATION = {10: 800.0, 20: 600.0, 35: 480.0, 40: 480.0}
"""Length of the turning tests [s] by rudder angle [deg]."""

RPM_DROP = 0.08
"""Share of the revolutions lost where the ship has lost all of its speed."""

SPLIT = """# The split of Suyama et al. 2023, section 6: each angle once in each set, to either side.
# The zigzags belong to neither.
ship = "suzaku"
tune = ["turn_p10", "turn_m20", "turn_p35", "turn_m40"]
test = ["turn_m10", "turn_p20", "turn_m35", "turn_p40"]
"""

NOTE = (
    "Generated, not measured: SUZAKU with the a_r = 0.5 coefficients of Suyama et al. 2023, Table 7; steering gear "
    "2.32 deg/s, revolutions dropping in the turn, white sensor noise, integrated at 0.1 s. Seed {seed}."
)


def generate(folder: Path) -> None:
    """Write all trials and the split to ``folder``, replacing what is there."""
    pre_determined = load_profile("suzaku")
    ship = tuned(pre_determined, SHIP, {}, {})
    runs: list[tuple[str, str, Helmsman, float]] = []
    for angle in (10, 20, 35, 40):
        for sign, letter in ((1, "p"), (-1, "m")):
            order = TurningOrder(np.radians(sign * angle), until=np.inf)
            runs.append((f"turn_{letter}{angle}", "turning", order, DURATION[angle]))
    for angle in (10, 20):
        runs.append((f"zigzag_{angle}", "zigzag", ZigzagOrder(np.radians(angle), np.radians(angle)), 900.0))
    for seed, (name, manoeuvre, helmsman, longest) in enumerate(runs, start=1):
        rng = np.random.default_rng(seed)
        motion = run_manoeuvre(
            ship,
            helmsman,
            id=name,
            speed=3.1,
            n=rng.uniform(100.0, 106.0) / 60.0,
            heading=rng.uniform(-np.pi, np.pi),
            longest=longest,
            step=0.1,
            engine=lambda share: 1.0 - RPM_DROP * (1.0 - share),
        )
        write_trial(measured(motion, manoeuvre, seed, rng), folder / f"{name}.parquet", overwrite=True)
    write_text(folder / "split.toml", SPLIT)


def measured(motion: Motion, manoeuvre: str, seed: int, rng: np.random.Generator) -> Trial:
    """The run as noisy sensors would log it."""
    deviations = np.array(list(NOISE.values()))
    states = motion.states + deviations * rng.standard_normal(motion.states.shape)
    n = motion.controls[:, 0] + INPUT_NOISE["n"] * rng.standard_normal(len(motion.t))
    delta = motion.controls[:, 1] + INPUT_NOISE["delta"] * rng.standard_normal(len(motion.t))
    return Trial(
        id=motion.id,
        ship="suzaku",
        manoeuvre=manoeuvre,
        source="generated",
        t=motion.t,
        x=states[:, 0],
        y=states[:, 1],
        psi=states[:, 2],
        u=states[:, 3],
        v_m=states[:, 4],
        r=states[:, 5],
        n=n,
        delta=delta,
        extra={},
        noise={key: float(value) for key, value in NOISE.items()},
        note=NOTE.format(seed=seed),
        path=None,
        sha256="",
    )


if __name__ == "__main__":
    generate(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent / "trials" / "suzaku")
