"""KVLCC2 with the coefficients of Yasukawa & Yoshimura 2015: turning indices of an independent run of them."""

import numpy as np
import pytest

from mmgtune.manoeuvres import turning_indices
from mmgtune.orders import TurningOrder, run_manoeuvre
from mmgtune.profile import load_profile


@pytest.mark.parametrize(
    ("name", "degrees", "advance", "diameter"),
    [
        ("kvlcc2_l7", 35, 3.08, 3.12),
        ("kvlcc2_l7", -35, 3.09, 3.10),
        ("kvlcc2", 35, 2.98, 3.00),
        ("kvlcc2", -35, 3.01, 3.01),
    ],
)
def test_turning_indices(name, degrees, advance, diameter):
    profile = load_profile(name)
    scale = profile.L_pp / profile.approach.speed
    motion = run_manoeuvre(
        profile, TurningOrder(np.radians(degrees), at=scale, until=3.5), longest=40 * scale, sample=0.02 * scale
    )
    indices = turning_indices(motion.track(), profile.L_pp)
    assert indices.advance / profile.L_pp == pytest.approx(advance, abs=0.05)
    assert indices.tactical_diameter / profile.L_pp == pytest.approx(diameter, abs=0.05)
