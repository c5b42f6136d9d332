"""What is known of a published formula besides its equation: where it comes from and for which ships it holds."""

from typing import NamedTuple


class Formula(NamedTuple):
    """A formula from main dimensions.

    source  paper, and through whom its numbers came where the paper itself was not at hand
    valid   ratios of the ships it was made from: {ratio: (lowest, highest)}, [-]; the ratios are those of ``ratios``.
            Empty where the source gives none
    said    where these limits stand, or that they are from memory
    """

    source: str
    valid: dict[str, tuple[float, float]]
    said: str = ""


def ratios(L, B, d, C_b):
    """The ratios that limits of formulas are counted in, by name: floats or (n_lanes,); L, B, d [m], C_b [-]."""
    return {"L/B": L / B, "B/d": B / d, "C_b": C_b, "C_b B/L": C_b * B / L, "2 d/L": 2.0 * d / L}
