"""The one rotation between the earth frame and the ship's axes, against its definition, and that it is the only one."""

import re
from pathlib import Path

import numpy as np
import pytest

import mmgtune
from mmgtune.physics.frame import to_earth, to_ship


def test_headings_and_sides():
    """Heading east, ahead is east and starboard is south."""
    assert to_earth(0.5 * np.pi, 1.0, 0.0) == pytest.approx((0.0, 1.0))
    assert to_earth(0.5 * np.pi, 0.0, 1.0) == pytest.approx((-1.0, 0.0))
    assert to_ship(0.5 * np.pi, 0.0, 1.0) == pytest.approx((1.0, 0.0))


def test_there_and_back():
    psi, ahead, starboard = np.array([[0.3, 2.0, -4.0], [1.0, 2.0, 0.1], [0.5, -1.0, 3.0]])
    back = to_ship(psi, *to_earth(psi, ahead, starboard))
    assert np.array(back) == pytest.approx(np.array([ahead, starboard]))


ROTATION = re.compile(r"cos\w*(?:\([^()]*\))? [-+] [^,;\n]*\* *(?:np\.|math\.)?sin")
"""A component turned: something times a cosine, plus or minus something times a sine."""


def test_it_is_the_only_copy():
    package = Path(mmgtune.__file__).parent
    copies = [path for path in package.rglob("*.py") if ROTATION.search(path.read_text(encoding="utf-8"))]
    assert [path.name for path in copies] == ["frame.py"]
