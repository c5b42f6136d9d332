"""Lets a diagnosis loose on the sets, knowing the files alone, and scores what it says.

``python -m tests.stranger.run --only wind --out found.jsonl --minutes 20``; one JSON line a set, those there are not
run again.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from .sets import CASES, Case, write

OUTCOMES = ("right", "grouped", "partly", "hull", "missed", "unexplained", "wrong", "alarm")
GROUPS = ("nothing", "one", "two", "by-run", "unknown")
HULL = "hull-term"


def score(case: Case, verdict: str, named: set[str], grouped: Iterable[set[str]]) -> str:
    """How an answer does.

    named    tags of the causes that are said
    grouped  tags that the answer leaves open, a set for each cause that is not told apart

    right        all true causes and no other; nothing where nothing was; ``unexplained`` where no program could know
    grouped      as right, with a true cause among others that are not told apart from it
    partly       some of several causes and no wrong one; one akin to what no program could know
    hull         a term of the hull and nothing else, of a hull that is off: true, if not what was hidden
    missed       none is said; unexplained: something is, and not what
    wrong        a cause that is not there; alarm: where nothing is hidden

    Of a hull that is off, terms of the hull are true beside other causes.
    """
    truth = set(case.causes)
    allowed = truth | set(case.akin) | ({HULL} if case.off > 0.0 else set())
    groups = [one for one in grouped if one]
    said = named | set().union(*groups)
    stray = (named - allowed) | set().union(*(one for one in groups if not one & allowed))
    if not said:
        if case.group == "nothing" or case.absorbed:
            return "right" if verdict == "none" else "unexplained"
        if case.group == "unknown":
            return "right" if verdict == "unexplained" else "missed"
        return "missed" if verdict == "none" else "unexplained"
    if stray:
        return "alarm" if case.group == "nothing" else "wrong"
    if not said & (truth | set(case.akin)):
        return "right" if case.absorbed else "hull"
    if not truth <= said:
        return "partly"
    return "right" if truth <= named else "grouped"


def read(found: Mapping[str, Any]) -> tuple[set[str], list[set[str]]]:
    """Tags that an answer names, and those it does not tell apart."""
    named = {cause["effect"] for cause in found["causes"]}
    grouped = []
    for group in found["groups"]:
        tags = set(group)
        if len(tags) > 1:
            grouped.append(tags)
            named -= tags
        else:
            named |= tags
    return named, grouped


def judge(case: Case) -> dict[str, Any]:
    """Make the files of a set, diagnose them and score the answer."""
    from mmgtune import diagnose, load_profile, load_trials

    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        found = diagnose(load_profile(case.ship), load_trials(write(case, Path(folder)))).to_dict()
    named, grouped = read(found)
    sizes = [
        {"effect": one["effect"], **{key: value["value"] for key, value in one["parameters"].items()}}
        for one in found["causes"]
    ]
    return {
        "name": case.name,
        "draw": case.draw,
        "group": case.group,
        "outcome": score(case, found["verdict"], named, grouped),
        "truth": dict(case.causes),
        "off": case.off,
        "rough": case.rough,
        "verdict": found["verdict"],
        "named": sorted(named),
        "grouped": [sorted(one) for one in grouped],
        "by_run": [one["effect"] for one in found["causes"] if one["by_run"]],
        "sizes": sizes,
        "sentence": found["sentence"],
        "share_left": found["unexplained"]["share_of_noise_variance"],
        "chi2": found["chi2_per_residual"],
        "contributions": [
            {key: one[key] for key in ("effect", "share_of_fall", "share_held_out")} for one in found["contributions"]
        ],
        "candidates": [
            {key: one[key] for key in ("effect", "parameters", "by", "score", "J_test")}
            for one in found["candidates"][:8]
        ],
        "whereabouts": (found["whereabouts"] or {}).get("sentence", "") if found["whereabouts"] else "",
        "seconds": round(time.perf_counter() - began, 1),
    }


def table(lines: Iterable[Mapping[str, Any]]) -> str:
    """Outcomes by group, as text."""
    rows = list(lines)
    head = "".join(f"{name:>12}" for name in ("", *OUTCOMES, "of"))
    out = [head]
    for group in (*GROUPS, "all"):
        those = [row for row in rows if group in ("all", row["group"])]
        counts = [sum(row["outcome"] == outcome for row in those) for outcome in OUTCOMES]
        out.append(f"{group:>12}" + "".join(f"{count or '':>12}" for count in counts) + f"{len(those):>12}")
    return "\n".join(out)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.stranger.run", description=__doc__)
    parser.add_argument("--only", default="", help="names or groups that contain one of these, with commas between")
    parser.add_argument("--out", type=Path, default=Path("stranger.jsonl"), help="lines are added to it")
    parser.add_argument("--draw", type=int, default=0, help="other hulls, headings, helmsmen and noise, same causes")
    parser.add_argument("--minutes", type=float, default=1e9, help="begin no further set after so long")
    chosen = parser.parse_args()
    rows = [json.loads(line) for line in chosen.out.read_text().splitlines()] if chosen.out.exists() else []
    for row in rows:  # as the score is now
        row["outcome"] = score(CASES[row["name"]], row["verdict"], set(row["named"]), map(set, row["grouped"]))
    wanted = chosen.only.split(",")
    known = (replace(case, draw=chosen.draw) for case in CASES.values())
    cases = [case for case in known if any(text in case.name or text == case.group for text in wanted)]
    # In no order of groups, so that what a short time allows is a sample of all; slow ships last.
    cases.sort(key=lambda case: (case.ship != "suzaku", zlib.crc32(case.name.encode())))
    began = time.monotonic()
    for case in cases:
        if any((row["name"], row.get("draw", 0)) == (case.name, case.draw) for row in rows):
            continue
        if time.monotonic() - began > 60.0 * chosen.minutes:
            break
        row = judge(case)
        rows.append(row)
        with chosen.out.open("a") as out:
            out.write(json.dumps(row) + "\n")
        print(f"{row['outcome']:12}{row['seconds']:6.0f} s  {case.name}: {row['sentence']}", flush=True)
    names = {case.name for case in cases}
    print(table(row for row in rows if row["name"] in names and row.get("draw", 0) == chosen.draw))


if __name__ == "__main__":
    main()
