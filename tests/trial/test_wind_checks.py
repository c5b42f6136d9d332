"""Wind in columns of another kind of wind: it turns with the ship."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.arrays import FloatArray
from mmgtune.trial import Trial, check_trial
from mmgtune.units import DEG

from .made import made

TRUE, APPARENT = ("wind_speed", "wind_dir"), ("wind_speed_app", "wind_dir_app")


def blown(pair: tuple[str, str], apparent: bool, from_bow: bool, trial: Trial, gusts: float = 0.1) -> Trial:
    """The trial in 9 m/s from 300 deg, measured as said and written in those columns."""
    rng = np.random.default_rng(4)
    size = 9.0 * (1.0 + gusts * rng.standard_normal(len(trial.t)))
    comes_from = 300.0 * DEG + gusts * rng.standard_normal(len(trial.t))
    north, east = size * np.cos(comes_from), size * np.sin(comes_from)  # where it comes from
    if apparent:
        north = north + trial.u * np.cos(trial.psi) - trial.v_m * np.sin(trial.psi)
        east = east + trial.u * np.sin(trial.psi) + trial.v_m * np.cos(trial.psi)
    angle: FloatArray = np.arctan2(east, north) - (trial.psi if from_bow else 0.0)
    return replace(trial, extra={pair[0]: np.hypot(north, east), pair[1]: np.mod(angle, 2.0 * np.pi)})


def warned(trial: Trial) -> list[str]:
    return [one.why + "; " + one.fix for one in check_trial(trial) if "wind over the ground" in one.what]


@pytest.mark.parametrize(
    ("pair", "apparent", "from_bow", "said"),
    [
        (TRUE, False, False, None),
        (APPARENT, True, True, None),
        (TRUE, True, True, "the apparent wind, its direction from the bow; if they do, rename them 'wind_speed_app'"),
        (APPARENT, False, False, "the true wind, its direction from north; if they do, rename them 'wind_speed' and"),
        (TRUE, False, True, "the true wind, its direction from the bow; if they do, work 'wind_speed' and 'wind_dir'"),
        (APPARENT, True, False, "the apparent wind, its direction from north; if they do, work 'wind_speed' and"),
    ],
)
def test_wind_that_turns_with_the_ship(pair: tuple[str, str], apparent: bool, from_bow: bool, said: str | None) -> None:
    found = warned(blown(pair, apparent, from_bow, made(seed=1)))
    assert len(found) == (said is not None)
    assert said is None or said in found[0]


def test_no_reading_is_doubted_where_the_ship_hardly_turns_or_the_wind_is_that_unsteady() -> None:
    assert warned(blown(TRUE, True, True, made(seed=1, zigzag=True))) == []
    assert warned(blown(TRUE, False, False, made(seed=1), gusts=0.6)) == []
