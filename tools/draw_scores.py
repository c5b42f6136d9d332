"""Scores of profiles by run as a figure, from what ``mmgtune validate --json`` printed.

    mmgtune validate esso_osaka_3m esso_osaka_3m_tuned esso --window 100 --json > scores.json
    python tools/draw_scores.py scores.json docs/esso-osaka.svg

No measured value is in the figure, only scores.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from matplotlib import pyplot as plt

plt.switch_backend("Agg")
plt.rcParams |= {"svg.hashsalt": "mmgtune", "svg.fonttype": "none"}


def draw(document: dict[str, Any], path: Path) -> None:
    """A dot a run and profile, runs by kind of manoeuvre and by the first profile's score."""
    profiles = document["profiles"]
    kinds = list(profiles[0]["by_manoeuvre"])
    first = sorted(profiles[0]["trials"], key=lambda row: (kinds.index(row["manoeuvre"]), row["L_MSE"]))
    figure, axis = plt.subplots(figsize=(9, 4))
    for profile, colour in zip(profiles, ("#b2182b", "#1b7837", "#2166ac"), strict=False):
        scores = {row["id"]: row["L_MSE"] for row in profile["trials"]}
        axis.semilogy([scores[row["id"]] for row in first], "o", color=colour, label=profile["profile"])
    ends = [k for k in range(1, len(first)) if first[k]["manoeuvre"] != first[k - 1]["manoeuvre"]]
    for begin, end in zip([0, *ends], [*ends, len(first)], strict=True):
        axis.axvline(end - 0.5, color="0.8", linewidth=0.8)
        axis.text(0.5 * (begin + end - 1), axis.get_ylim()[1], first[begin]["manoeuvre"], ha="center", va="bottom")
    axis.set_xticks([])
    axis.set_xlabel("run")
    axis.set_ylabel(f"L_MSE, windows of {document['window_s']:g} s")
    axis.legend(frameon=False, loc="lower right")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


if __name__ == "__main__":
    draw(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8")), Path(sys.argv[2]))
