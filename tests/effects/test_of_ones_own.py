"""An effect that a package brings is a full citizen: simulated by both back ends, searched for, named, written."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

# Its functions are called like a variable of the kernel and like a function of the program.
TUG = """
from typing import Any, NamedTuple
from mmgtune.effects import ForceEffect, LagEffect, Parameter
from mmgtune.physics.quantities import Force, Lanes, State, Surroundings

class Tug(NamedTuple):
    pull: Lanes

def f(state: State, around: Surroundings, found: Any, components: Any, p: Any, e: Tug) -> Force:
    return Force(X=0.0 * e.pull, Y=e.pull, N=-30.0 * e.pull)

TUG = ForceEffect(
    kind="effects.tug", tag="tug", title="a tug at the stern", params=Tug, function=f, cites=(),
    fields={"pull": Parameter("pull of the tug, to starboard", "N",
                              bounds=lambda ship: (-0.02 * ship.force, 0.02 * ship.force),
                              typical=lambda ship: 0.002 * ship.force)},
    variants=(("pull",),), sentence=lambda v: f"A tug pulled the stern to starboard with {v['pull']}",
)

class Race(NamedTuple):
    slow: Lanes
    quick: Lanes

def settled(found: Any, e: Race) -> tuple[Lanes, Lanes, Lanes]:
    return found.rudder.force.N, found.rudder.force.N, found.total.X

def memory(found: Any, behind: Any, h: Lanes, e: Race) -> tuple[Force, tuple[Lanes, Lanes, Lanes]]:
    slow, quick, total = behind
    N = found.rudder.force.N
    rates = (N - slow) / (e.slow + 4.0), (N - quick) / (e.quick + 4.0), found.total.X - total
    share = e.slow * e.quick / (1.0 + e.slow * e.quick)  # none at its null
    return Force(X=0.0 * total, Y=0.0 * slow, N=share * (0.5 * (slow + quick) - N)), rates

RACE = LagEffect(
    kind="effects.race", tag="race", title="rudder force with two memories", params=Race, function=memory,
    start=settled, states=("slow", "quick", "total"), cites=(), variants=(("slow", "quick"),),
    fields={"slow": Parameter("slow time constant", "s"), "quick": Parameter("quick time constant", "s")},
)
"""

LAGGING = """
import numpy as np
from mmgtune.backends import Integrator
from mmgtune.model import Model
from mmgtune.profile import load_profile, with_effects
from tests.backends.test_agree import zigzag_like
from tests.runs import states
ship = load_profile("suzaku")
late = Model(with_effects(ship, {"race": {"slow": 20.0, "quick": 3.0}, "memory": {"time_constant": 4.0}}, "a test"))
cases = zigzag_like(late, 300)
for integrator in (Integrator("euler"), Integrator("rk4", 2)):
    a, b = (states(late, cases, backend=name, integrator=integrator) for name in ("compiled", "numpy"))
    assert np.allclose(a, b, rtol=1e-9), "back ends differ"
assert np.abs(a - states(Model(ship), cases)).max() > 1.0, "nothing lags"
print("lags")
"""

FOUND = """
import dataclasses, sys
from pathlib import Path
import numpy as np
from mmgtune.model import Model
from mmgtune.profile import load_profile, with_effects
from mmgtune.motions import simulate_trials, as_trial
from mmgtune.backends import Integrator
from mmgtune.trial import load_trials, write_trial
ship = load_profile("suzaku")
pulled = with_effects(ship, {"tug": {"pull": 3000.0}}, "a test")
rng = np.random.default_rng(5)
trials = list(load_trials("suzaku").trials.values())[:4]
for trial, motion in zip(trials, simulate_trials(pulled, trials, integrator=Integrator("rk4")), strict=True):
    noisy = motion.states + rng.normal(size=motion.states.shape) * [0.3, 0.3, 0.002, 0.02, 0.02, 0.0005]
    run = as_trial(ship, dataclasses.replace(motion, states=noisy))
    write_trial(run, Path(sys.argv[1]) / f"{run.id}.parquet")
"""


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """An environment in which the package is installed, entry points and all."""
    folder = tmp_path_factory.mktemp("site")
    (folder / "tugs.py").write_text(TUG)
    info = folder / "tugs-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: tugs\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[mmgtune.effects]\ntug = tugs:TUG\nrace = tugs:RACE\n")
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), str(Path(__file__).parents[2])])}


def python(environment: dict[str, str], *arguments: str) -> str:
    done = subprocess.run([sys.executable, *arguments], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.long
def test_lags_may_remember_any_force_in_any_number_of_states(environment):
    assert python(environment, "-c", LAGGING).strip() == "lags"


@pytest.mark.long
def test_diagnose_names_it_and_writes_it(environment, tmp_path):
    import json

    trials, out = tmp_path / "trials", tmp_path / "out"
    trials.mkdir()
    python(environment, "-c", FOUND, str(trials))
    asked = ("--effects", "tug,rudder-offset,current,propeller-side-force", "--targets", "R_0,w_P0,N_r,Y_v")
    said = python(
        environment, "-m", "mmgtune", "diagnose", "-p", "suzaku", "-t", str(trials), *asked, "--out", str(out),
        "--quiet", "--json",
    )  # fmt: skip
    found = json.loads(said)
    assert [cause["effect"] for cause in found["causes"]] == ["tug"], found["sentence"]
    assert found["sentence"].startswith("A tug pulled the stern to starboard with ")
    assert found["causes"][0]["parameters"]["pull"]["value"] == pytest.approx(3000.0, rel=0.15)
    assert "[effects.tug]" in (out / "profile.toml").read_text()
