"""The sentences under the figures: what each of them shows, said in numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..how_far_off import mean_off_track, off_heading, off_track
from .wording import CHANNELS, change, clean, count, count_of_trials, fixed, listing, number, percent, short, shown


def misfit(options: Mapping[str, Any]) -> str:
    """What J is, from the options of the run."""
    scales, parts = options.get("scales") or {}, []
    for name in options.get("channels") or ("x", "y", "psi"):
        channel, scale = CHANNELS.get(str(name)), number(scales.get(name))
        words = channel.words if channel else clean(name)
        if channel and scale is not None:
            words += f" (by {shown(scale * channel.factor, 3)} {channel.unit})"
        parts.append(words)
    return (
        "J adds up, over all samples of a trial, the squared differences between simulation and measurement in "
        f"{listing(parts, 9)}, each divided by a scale so that they count alike; 0 would be a perfect fit. Off track: "
        "root-mean-square distance between the two positions, before → after tuning."
    )


def off_track_words(row: Mapping[str, Any], when: str) -> str:
    """How far off a trial is, in metres and degrees; empty where it is not known."""
    distance, heading = off_track(row, when), off_heading(row, when)
    parts = [f"{shown(distance, 3)} m" if distance is not None else "", degrees(heading) if heading is not None else ""]
    said = " and ".join(part for part in parts if part)
    return f"{said} off (root mean square)" if said else ""


def degrees(value: float) -> str:
    """An angle as it is written in sentences: two digits, none after ten degrees."""
    return f"{shown(value, 2)}°"


def tracks(results: Sequence[Mapping[str, Any]], after_words: str = "after tuning") -> str:
    """What tuning, or what else a run did, made of the tracks."""
    before, after = mean_off_track(results, "before"), mean_off_track(results, "after")
    if before is None or after is None:
        return "Tracks of the trials; no distances were recorded."
    verb = "closes from" if after < before else "opens from" if after > before else "stays at"
    text = f"The gap to the measured track {verb} {shown(before, 3)} m to {shown(after, 3)} m (root mean square"
    text += f", mean of {count_of_trials(results)})." if len(results) > 1 else ")."
    worst = max(results, key=lambda row: off_track(row, "after") or 0.0)
    if len(results) > 1:
        text += f" The worst {after_words} is {clean(worst['id'])}, {shown(off_track(worst, 'after'), 3)} m."
    return text


def distances(results: Sequence[Mapping[str, Any]]) -> str:
    """In how many trials the simulation came closer."""
    pairs = [(off_track(row, "before"), off_track(row, "after")) for row in results]
    known = [(first, last) for first, last in pairs if first is not None and last is not None]
    closer = sum(last < first for first, last in known)
    of = count_of_trials([row for row, pair in zip(results, pairs, strict=True) if None not in pair])
    if known and closer == len(known):
        where = f"all {of}" if closer > 1 else "this trial"
        return f"The simulated ship comes closer to the measured one in {where}."
    return f"The simulated ship comes closer to the measured one in {closer} of {of}."


def histories(results: Sequence[Mapping[str, Any]]) -> str:
    """Which channel gained most, and which got worse."""
    gains: dict[str, tuple[float, float]] = {}
    for name in CHANNELS:
        found = [(row.get("rms") or {}).get(name) or {} for row in results]
        pairs = [(number(pair.get("before")), number(pair.get("after"))) for pair in found]
        known = [(first, last) for first, last in pairs if first is not None and last is not None]
        if known:
            before = math.sqrt(sum(first**2 for first, _ in known) / len(known))
            gains[name] = before, math.sqrt(sum(last**2 for _, last in known) / len(known))
    gains = {name: pair for name, pair in gains.items() if name in ("psi", "u", "v_m", "r")}
    if not gains:
        return "Time histories of the trials."
    parts = []
    for name, (before, after) in gains.items():
        channel = CHANNELS[name]
        first, last = shown(before * channel.factor, 2), shown(after * channel.factor, 2)
        parts.append(f"{channel.words} {first} → {last} {channel.unit} ({percent(change(before, after))})")
    worse = [CHANNELS[name].words for name, (before, after) in gains.items() if after > 1.01 * before]
    end = f" {listing(worse).capitalize()} got worse." if worse else ""
    return "Error over all trials, before → after tuning: " + ", ".join(parts) + "." + end


def forest(rows: Sequence[Mapping[str, Any]]) -> str:
    """How many coefficients end on a bound or are not determined."""
    bound = [short(clean(row["name"])) for row in rows if row.get("at_bound")]
    loose = [short(clean(row["name"])) for row in rows if row.get("determined") is False]
    text = f"{len(bound)} of {count(len(rows), 'coefficient')} end on a bound of the box"
    text += f" ({listing(bound, 12)})" if bound else ""
    if loose:
        text += f"; {listing(loose)} {'is' if len(loose) == 1 else 'are'} not determined by these trials"
    return text + "."


def correlation(names: Sequence[str], matrix: Sequence[Sequence[Any]]) -> str:
    """The strongest correlation."""
    best: tuple[float, str, str] | None = None
    for i, name in enumerate(names):
        for j in range(i):
            value = number(matrix[i][j])
            if value is not None and (best is None or abs(value) > abs(best[0])):
                best = value, short(clean(name)), short(clean(names[j]))
    if best is None:
        return "No correlations could be computed."
    value, one, two = best
    if abs(value) > 0.9:
        return f"{one} and {two} are hardly told apart (correlation {fixed(value, 2)}); trust their combination more."
    text = f"Among these {len(names)} coefficients the strongest correlation is {fixed(value, 2)}, of {one} and {two}"
    return text + ": each has an effect of its own."


def convergence(data: Mapping[str, Any]) -> str:
    """What the search spent and whether its restarts agree."""
    agreement = data.get("agreement") or {}
    restarts, same = agreement.get("restarts"), agreement.get("restarts_agreeing")
    text = f"The search reached J = {shown(data.get('J_tune'))} in {shown(data.get('evaluations'), 9)} evaluations"
    if isinstance(restarts, int) and isinstance(same, int) and restarts > 0:
        text += f"; {same} of {count(restarts, 'restart')} ended at the same J"
    return text + "."


def agreement(data: Mapping[str, Any]) -> list[str]:
    """What speaks for this being the best fit in the box."""
    found, sentences = data.get("agreement") or {}, []
    tolerance = number(found.get("tolerance"))
    within = f" within {shown(100.0 * tolerance, 2)}\u00a0%" if tolerance is not None else ""
    if found.get("restarts"):
        sentences.append(
            f"{found.get('restarts_agreeing', 0)} of {count(int(found['restarts']), 'restart')} of the "
            f"evolution strategy reached the same J{within}."
        )
    if found.get("starts"):
        sentences.append(
            f"{found.get('starts_agreeing', 0)} of {count(int(found['starts']), 'start')} of least squares, "
            f"a method that shares nothing with it, reached the same J{within}."
        )
    difference = number(found.get("relative_difference"))
    if difference is not None and found.get("restarts") and found.get("starts"):
        sentences.append(
            f"The two methods' best J differ by {shown(100.0 * difference, 2)}\u00a0% "
            f"({shown(found.get('J_cmaes'), 6)} and {shown(found.get('J_least_squares'), 6)})."
        )
    gradient = number((data.get("certificate") or {}).get("projected_gradient"))
    if gradient is not None:
        sentences.append(
            f"Slope left inside the box (projected gradient, relative): {shown(gradient, 2)}; 0 at a minimum."
        )
    return sentences
