"""What is measured around a ship is one field and one source of it."""

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmgtune.physics.quantities import HELD, UNKNOWN, Surroundings
from mmgtune.trial.surroundings import SOURCES, surroundings
from tests.trial.made import made

ROOT = Path(__file__).parents[2]

FIELD = ("physics/quantities.py", "    wind_known: Lanes", "    stream_east: Lanes\n    wind_known: Lanes")
SOURCE = (
    "trial/surroundings.py",
    "measured_waves(trial),\n",
    """measured_waves(trial),
    ("stream_east",): lambda trial, _: trial.extra.get("stream", 0.0 * trial.t)[:, None],
""",
)

STREAM = """
from dataclasses import replace
from typing import NamedTuple
import numpy as np
from mmgtune.backends import Integrator
from mmgtune.effects import FlowEffect, Parameter
from mmgtune.model import Model
from mmgtune.physics.frame import to_ship
from mmgtune.profile import Coefficient, Section, load_profile
from mmgtune.simulation import simulate
from mmgtune.trial import load_trials

class Stream(NamedTuple):
    share: object

def stream(state, around, e):
    return to_ship(state.psi, 0.0 * state.psi, e.share * around.stream_east)

EFFECT = FlowEffect(kind="effects.stream", tag="stream", title="measured stream", params=Stream, function=stream,
                    cites=(), fields={"share": Parameter("share of the measured stream", "-")}, variants=(("share",),))

if __name__ == "__main__":
    import stream as module
    ship = load_profile("suzaku")
    sections = {**ship.sections, "effects.stream": Section(module.EFFECT, {"share": Coefficient(1.0, "-")}, "-")}
    model = Model(replace(ship, sections=sections))
    trial = load_trials("suzaku").trials["turn_p35"]
    flowing = replace(trial, extra={"stream": 0.5 + 0.1 * np.sin(trial.t / 30.0)})
    rk4 = Integrator("rk4")
    a, b = (simulate(model, [flowing], integrator=rk4, backend=name)[0].states for name in ("compiled", "numpy"))
    assert np.allclose(a, b, rtol=1e-9, atol=1e-9), "back ends differ"
    still = simulate(model, [trial], integrator=rk4)[0].states
    drifted = (a - still)[-1, 1]
    assert drifted > 0.3 * trial.duration, drifted
    print("drifts")
"""


def test_each_field_has_one_source():
    """In some order, none twice and none left out; nothing measured is 0 throughout."""
    assert sorted(name for names in SOURCES for name in names) == sorted(Surroundings._fields)
    assert (surroundings(made(), None) == 0.0).all()
    assert set(UNKNOWN) == {0.0}
    assert {name for name in Surroundings._fields if name.endswith(("known", "rate"))} == set(HELD)


@pytest.mark.slow(30)
def test_another_is_one_field_and_one_source(tmp_path):
    """In a copy of the program with these two edits: both back ends give it to an effect, step by step."""
    shutil.copytree(ROOT / "mmgtune", tmp_path / "mmgtune", ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("ship_profiles", "trials"):
        (tmp_path / name).symlink_to(ROOT / name)
    for path, old, new in (FIELD, SOURCE):
        file = tmp_path / "mmgtune" / path
        text = file.read_text(encoding="utf-8")
        assert text.count(old) == 1
        file.write_text(text.replace(old, new), encoding="utf-8")
    (tmp_path / "stream.py").write_text(STREAM, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    ran = subprocess.run(
        [sys.executable, "stream.py"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.strip() == "drifts"


def test_wind_of_a_trial_is_in_its_surroundings():
    trial = made()
    blown = {"wind_speed": np.full(trial.n_samples, 8.0), "wind_dir": np.full(trial.n_samples, np.pi)}
    found = surroundings(replace(trial, extra=blown), None)
    assert found[:, Surroundings._fields.index("wind_north")] == pytest.approx(8.0)
    assert (found[:, Surroundings._fields.index("wind_known")] == 1.0).all()
