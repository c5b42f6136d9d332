"""What becomes of a resistance that was fitted to motion ahead, where the ship goes astern."""

import numpy as np

FADES_BELOW = 0.05
"""Share of the speed that is surge [-] below which the resistance fades, to change sign when going astern."""


def resistance_ahead(R_0, flow):
    """R_0' as it opposes the motion ahead: all of it ahead, its negative astern, little where hardly any way is surge.

    R_0 [prime], flow Flow: floats or (n_lanes,).  An assumption of this program.
    """
    return R_0 * np.minimum(np.maximum(flow.u / (FADES_BELOW * flow.U), -1.0), 1.0)
