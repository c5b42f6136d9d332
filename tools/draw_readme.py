"""Draw ``docs/assets/tuned.svg``, the picture of the README: what its example of the library draws.

python tools/draw_readme.py
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np

import mmgtune

PICTURE = Path(__file__).parent.parent / "docs" / "assets" / "tuned.svg"
UNSEEN = ["turn_m35", "zigzag_20", "turn_p20"]
"""Trials that the fit is not tuned to."""


def main() -> None:
    """Fit the bundled ship to her bundled trials, and draw three that it has not seen."""
    mpl.use("Agg")
    mpl.rcParams |= {"svg.hashsalt": "mmgtune", "svg.fonttype": "path"}
    options = mmgtune.FitOptions(a_r=0.5, method="least-squares")
    result = mmgtune.fit("suzaku", "suzaku", options)
    assert not set(UNSEEN) & set(mmgtune.load_trials("suzaku").tune)
    first, *_ = np.ravel(result.plot.tracks(UNSEEN))
    first.figure.savefig(PICTURE, metadata={"Date": None})


if __name__ == "__main__":
    main()
