"""The published table of the study of hidden effects, from its results.

python -m tests.hidden.table [docs/hidden.jsonl] [docs/hidden.md]
"""

from __future__ import annotations

import json
import math
import statistics
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from mmgtune.effects import find_effect
from mmgtune.files import write_text

from .cases import LADDER
from .study import N_CASES, SEEDS
from .unknown import JUMP, UNKNOWN

COLOURS = {"right": "#1b7837", "grouped": "#a6dba0", "missed": "#d9d9d9", "unexplained": "#92c5de", "wrong": "#b2182b"}
"""Outcomes of a single hidden effect."""

Row = dict[str, Any]

HEAD = f"""# Hidden effects: what was found of what was there

Written by `python -m tests.hidden.table` from the results of `make hidden`. Each case is a ship drawn at random (twelve
coefficients within ±22 %), sailed by a plant of its own with something hidden in it, measured with noise (0.4 m, 0.17°,
0.02 m/s, 0.03°/s), and diagnosed from the files alone: five trials to look at, five held out. **All of it is generated;
no measured ship is in this table.**

The single effects by size of one seed share ship, headings, revolutions and noise, and differ in what is hidden alone:
sizes of an effect compare directly, but of noise there are {SEEDS} independent draws, not {5 * SEEDS * len(LADDER)}.
What is *measured otherwise* has noise of its own each: ten trials, half of them held out or none, or two turns and two
zigzags with none held out; a sample every 1, 5 or 10 s; a third of that noise, as much, or three times as much, with a
memory of 30 s or without, stated in the log or not.

"""

AMISS = """
## What went amiss

Every case above its limit that was missed, called unexplained, found in part or named wrong, and every wrong name
below; numbers in SI units.

"""


def page(rows: Sequence[Row]) -> str:
    """The page."""
    sets: dict[str, list[Row]] = {}
    for row in rows:
        sets.setdefault(row["set"], []).append(row)
    parts = [
        HEAD,
        *_summary(sets),
        "\n## Detection limits\n\n",
        *_limits(sets),
        "\n## Every effect by size\n\n",
        *_effects(sets),
        "\n## In no registry\n\n",
        *_unknown(sets.get("unknown", [])),
        AMISS,
        *_amiss(sets),
    ]
    return "".join(parts)


def _share(rows: Iterable[Row], *outcomes: str) -> str:
    listed = list(rows)
    if not listed:
        return "-"
    good = sum(row["outcome"] in outcomes for row in listed)
    return f"{good} of {len(listed)} ({100.0 * good / len(listed):.0f} %)"


def _summary(sets: dict[str, list[Row]]) -> list[str]:
    single = [row for name, rows in sets.items() if ":" in name for row in rows]
    above = [row for row in single if row["above_limit"]]
    below = [row for row in single if not row["above_limit"]]
    by_seed: dict[str, list[bool]] = {}
    for row in single:
        if row["outcome"] in ("right", "grouped"):
            by_seed.setdefault(row["case"].rpartition("-")[2], []).extend(row["covered"])
    inside = [held for seed in by_seed.values() for held in seed]
    shares = [100.0 * sum(seed) / len(seed) for seed in by_seed.values() if seed]
    some, threes = sets.get("otherwise", []), sets.get("triple", [])
    gears = sets.get("gear-of-two-rates", [])
    of_runs = [row for row in sets.get("of-runs", []) if row["of_runs"]]
    seconds = [row["seconds"] for rows in sets.values() for row in rows]
    coverage = f"{sum(inside)} of {len(inside)} ({100.0 * sum(inside) / len(inside):.1f} %)" if inside else "-"
    if shares:
        coverage += f"; by seed {min(shares):.0f} to {max(shares):.0f} %"
    lines = [
        ("nothing hidden, called clear", _share(sets.get("null", []), "clear"), "95 %"),
        (
            "nothing hidden, noise autocorrelated over 30 s, called clear",
            _share(sets.get("null-autocorrelated", []), "clear"),
            "95 %",
        ),
        ("larger than the stated detection limit: named, or in the group", _share(above, "right", "grouped"), "95 %"),
        ("larger than the stated detection limit: named alone", _share(above, "right"), "85 %"),
        ("larger than the stated detection limit: named wrong", _share(above, "wrong"), "at most 2 %"),
        ("smaller, or no limit stated: named all the same", _share(below, "right", "grouped"), "-"),
        ("smaller, or no limit stated: named wrong", _share(below, "wrong"), "-"),
        ("95 % intervals of named effects that hold the truth", coverage, "90-98 %"),
        ("two effects of typical size, both found", _share(sets.get("pair", []), "right", "grouped"), "80 %"),
        ("measured otherwise, typical size: named, or in the group", _share(some, "right", "grouped"), "-"),
        ("measured otherwise, typical size: named wrong", _share(some, "wrong"), "-"),
        ("three effects of typical size, all found", _share(threes, "right", "grouped"), "60 %"),
        ("three effects of typical size, a wrong name", _share(threes, "wrong"), "at most 5 %"),
        ("another value in each run: named as such", _share(of_runs, "right", "grouped"), "-"),
        ("a gear slower to one side: named, or in the group", _share(gears, "right", "grouped"), "-"),
        ("effects in no registry, no wrong name", _share(sets.get("unknown", []), "right", "missed"), "90 %"),
        ("seconds a diagnosis, median, one core of a busy machine", f"{statistics.median(seconds):.0f}", "-"),
    ]
    done = sum(len(rows) for rows in sets.values())
    codes = Counter(row.get("code", "earlier") for rows in sets.values() for row in rows)
    told = ", ".join(f"{n} by {code}" for code, n in codes.most_common())
    head = f"{done} of the {N_CASES} cases of the study have been run so far; `make hidden` runs the rest."
    head += f"{_first(sets)}\n\n"
    table = ["| | result | aim |\n|---|---|---|\n", *(f"| {what} | {share} | {aim} |\n" for what, share, aim in lines)]
    by_code = f"\nCases by fingerprint of the source that diagnosed them: {told}.\n" if len(codes) > 1 else ""
    return [head if done < N_CASES else "", *table, by_code]


def _first(sets: dict[str, list[Row]]) -> str:
    """Which effects were run in full before others, and what is left of the shares without these."""
    first = [tag for tag in LADDER if all(len(sets.get(f"{tag}:{level}", [])) == SEEDS for level in range(5))]
    if not first:
        return ""
    rest = [row for name, rows in sets.items() if ":" in name and name.split(":")[0] not in first for row in rows]
    above = [row for row in rest if row["above_limit"]]
    nulls = len(sets.get("null", []))
    return (
        f" They are no even sample: all sizes of {', '.join(f'`{tag}`' for tag in first)} and {nulls} cases of nothing "
        f"hidden were run ahead of the others. Without these effects {_share(above, 'right', 'grouped')} of what is "
        f"larger than its limit is named, or in the group, and {_share(above, 'right')} alone. What sums of "
        "causes must be to be believed was set on cases that are counted here: on new ones it may do worse."
    )


def _limits(sets: dict[str, list[Row]]) -> list[str]:
    """Median over cases of the limits the program stated, by effect and parameter."""
    stated: dict[tuple[str, str, str], list[float]] = {}
    for rows in sets.values():
        for row in rows:
            for limit in row["limits"]:
                for name, value in limit["detection_limit"].items():
                    key = (limit["effect"], name, limit["units"][name])
                    if value is not None:
                        stated.setdefault(key, []).append(_for_people(value, limit["units"][name])[0])
    parts = [
        "Five trials of SUZAKU in the noise above, medians over the cases; a report states those of its own data.\n\n",
        "| effect | parameter | named from |\n|---|---|---|\n",
    ]
    order = list(LADDER)
    for tag, name, unit in sorted(stated, key=lambda key: order.index(key[0])):
        value = statistics.median(stated[tag, name, unit])
        parts.append(f"| `{tag}` | {name} | {value:.4g} {_for_people(0.0, unit)[1]} |\n")
    return parts


def _for_people(value: float, unit: str) -> tuple[float, str]:
    """Angles in degrees; pure numbers and the prime system without a unit."""
    if unit in ("rad", "rad/s", "rad/s^2"):
        return math.degrees(value), unit.replace("rad", "°")
    return value, "" if unit in ("-", "prime") else unit


def _effects(sets: dict[str, list[Row]]) -> list[str]:
    parts = ["| effect | " + " | ".join(f"size {level}" for level in range(5)) + " |\n|---|---|---|---|---|---|\n"]
    for tag in LADDER:
        levels = [sets.get(f"{tag}:{level}", []) for level in range(5)]
        kinds = [None] if tag == "hull-term" else sorted({tuple(row["hidden"][tag]) for rows in levels for row in rows})
        for kind in kinds:
            cells = [_cell(tag, [row for row in rows if kind in (None, tuple(row["hidden"][tag]))]) for rows in levels]
            parts.append(f"| `{tag}`{f' ({_names(kind)})' if kind else ''} | {' | '.join(cells)} |\n")
    parts.append(
        "\n![share of cases by outcome, effect and size](hidden.svg)\n\n"
        "Sizes are distances from where the effect is absent; of a depth, a rate limit and a stall, the value itself.\n"
        "Size 3 is typical, 4 about twice that, 2 about a third, 1 and 0 far below (`tests/hidden/cases.py`); those\n"
        "of a hull term depend on the term.\n"
    )
    return parts


def _names(kind: Sequence[str]) -> str:
    return ", ".join(name for name in kind if name != "direction")


def _cell(tag: str, rows: Sequence[Row]) -> str:
    """Size and outcomes of the cases of one effect at one level."""
    counts = Counter(row["outcome"] for row in rows)
    outcomes = ", ".join(f"{n} {outcome}" for outcome, n in counts.most_common()) or "-"
    return outcomes if tag == "hull-term" or not rows else f"{_size(tag, rows[0]['hidden'][tag])}: {outcomes}"


def _size(tag: str, hidden: Mapping[str, float]) -> str:
    """How far an effect is from its null, with its unit."""
    effect = find_effect(tag)
    assert effect is not None  # it is in the ladder
    parameters = [effect.parameters[name] for name in hidden if name != "direction"]
    values = [value for name, value in hidden.items() if name != "direction"]
    if parameters[0].chart == "reciprocal":
        size = values[0]
    elif tag == "propeller-side-force":  # the same factor on both
        size = values[0] - parameters[0].null
    else:
        size = math.hypot(*(value - one.null for value, one in zip(values, parameters, strict=True)))
    number, unit = _for_people(size, parameters[0].unit)
    return f"{number:.3g} {unit}".strip()


def _amiss(sets: dict[str, list[Row]]) -> list[str]:
    """Cases that did not come out as they should have: every one above its limit, and every wrong name below."""
    parts = ["| hidden | above its limit | outcome | named |\n|---|---|---|---|\n"]
    listed = [row for name, rows in sets.items() if name != "unknown" for row in rows]
    for row in sorted(listed, key=lambda row: row["case"]):
        good = row["outcome"] in ("right", "grouped", "clear")
        if good or (not row["above_limit"] and row["outcome"] not in ("wrong", "alarm")):
            continue
        hidden = " and ".join(f"`{tag}` {_told(values)}" for tag, values in row["hidden"].items()) or "nothing"
        named = ", ".join(f"`{cause['effect']}` {_told(cause['parameters'])}" for cause in row["causes"]) or "-"
        above = {True: "yes", False: "no", None: "none stated"}[row["above_limit"]]
        parts.append(f"| {hidden} | {above} | {row['outcome']} | {named} |\n")
    return parts


def _told(parameters: Mapping[str, Any]) -> str:
    values = {name: value["value"] if isinstance(value, dict) else value for name, value in parameters.items()}
    return ", ".join(f"{name} {value:.3g}" for name, value in values.items())


def _unknown(rows: Sequence[Row]) -> list[str]:
    parts = ["| hidden | magnitude | outcome | verdict | named |\n|---|---|---|---|---|\n"]
    for row in rows:
        (tag,) = row["hidden"]
        magnitude = f"{row['hidden'][tag]['magnitude']:.3g} {UNKNOWN[tag].unit}"
        named = ", ".join([cause["effect"] for cause in row["causes"]] + [JUMP] * row.get("jumped", False)) or "-"
        parts.append(
            f"| {tag.removeprefix('unknown-')} | {magnitude} | {row['outcome']} | {row['verdict']} | {named} |\n"
        )
    return parts


def figure(rows: Sequence[Row], path: Path) -> None:
    """Bars of the outcomes of each effect by size, as SVG."""
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams |= {"svg.hashsalt": "mmgtune", "svg.fonttype": "none"}
    from matplotlib import pyplot as plt

    columns = 4
    figure, axes = plt.subplots(-(-len(LADDER) // columns), columns, figsize=(10, 11), sharex=True, sharey=True)
    for axis, tag in zip(axes.flat, LADDER, strict=False):
        bottom = [0.0] * 5
        for outcome, colour in COLOURS.items():
            shares = []
            for level in range(5):
                here = [row["outcome"] for row in rows if row["set"] == f"{tag}:{level}"]
                shares.append(sum(_said(one) == outcome for one in here) / max(1, len(here)))
            axis.bar(range(5), shares, bottom=bottom, color=colour, label=outcome, width=0.9)
            bottom = [low + share for low, share in zip(bottom, shares, strict=True)]
        axis.set_title(tag, fontsize=9)
        axis.set_xticks(range(5))
        axis.set_yticks([0.0, 0.5, 1.0])
    for axis in axes.flat[len(LADDER) - columns : len(LADDER)]:  # the lowest of each column
        axis.tick_params(labelbottom=True)
    for axis in axes.flat[len(LADDER) :]:
        axis.axis("off")
    figure.supxlabel("size (3 is typical)")
    figure.supylabel("share of cases")
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="lower right", ncols=2, frameon=False)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def _said(outcome: str) -> str:
    return outcome if outcome in COLOURS else "missed"


if __name__ == "__main__":
    source = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/hidden.jsonl")
    results = [json.loads(line) for line in source.read_text(encoding="utf-8").splitlines()]
    target = Path(sys.argv[2] if len(sys.argv) > 2 else "docs/hidden.md")
    write_text(target, page(results))
    figure(results, target.with_suffix(".svg"))
