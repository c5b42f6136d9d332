"""Words put together as in a sentence."""

import math

import pytest

from mmgtune.phrases import aboard, figures, on_compass


@pytest.mark.parametrize(
    ("ahead", "across", "said"),
    [
        (11.2, -3.0, "11.2 m forward and 3 m to port"),
        (-1.8437, 4.45, "1.84 m aft and 4.45 m to starboard"),
        (0.0, 0.0, "0 m forward and 0 m to starboard"),
    ],
)
def test_a_place_aboard_is_told_by_words_and_no_sign(ahead, across, said):
    assert aboard(ahead, across) == said


@pytest.mark.parametrize(
    ("value", "digits", "said"),
    [(114.7, 2, "110"), (0.4913, 2, "0.49"), (3.0, 2, "3"), (-151.0, 2, "-150"), (169.3, 3, "169"), (0.0, 2, "0")],
)
def test_numbers_have_no_power_of_ten(value, digits, said):
    assert figures(value, digits) == said


def test_a_place_far_off_is_told_in_metres():
    """ "About 1.1e+02 m aft" was said of an antenna."""
    assert aboard(-114.7, 0.4913, 2) == "110 m aft and 0.49 m to starboard"


@pytest.mark.parametrize(("degrees", "said"), [(-0.3, "0°"), (359.7, "0°"), (-90.0, "270°"), (42.6, "43°")])
def test_north_is_0_and_never_360(degrees, said):
    assert on_compass(math.radians(degrees)) == said
