"""Words put together as in a sentence."""

import pytest

from mmgtune.phrases import aboard


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
