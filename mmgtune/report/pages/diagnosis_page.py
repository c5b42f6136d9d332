"""The report of a diagnosis, put together: the answer first, then why, then what the data could have told at all."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ...how_far_off import mean_off_heading, mean_off_track
from ...phrases import LARGE, QUANTITIES, small
from ...units import DIMENSIONLESS, NORMAL_95, read_as
from .. import advice, findings, measures, motion_block
from ..blocks import Block, Card, Cell, Commands, Fold, Nothing, Page, Prose, Section, Table, cells
from ..common import assumptions, cards_of_misfit, doubts, generated_banner, picture, provenance, ship_name, warnings
from ..figures import svg
from ..figures.differences import differences
from ..figures.plot import Axis, Color, Dots, Figure, Line, Look, Mark, Panel
from ..forces import ship_of
from ..load import DiagnosisRecord, Kind, inputs_of, motions_in
from ..tables import described, tone
from ..wording import (
    CHANNELS,
    NONE,
    UNIT_PERCENT,
    beyond_noise,
    change,
    clean,
    coefficient_text,
    count,
    fixed,
    index_words,
    number,
    percent,
    share,
    short,
    shown,
    span,
    within_noise,
)
from . import unexplained
from .of_runs import of_runs, parameters_of

_WORDS = {
    "none": "nothing found",
    "jumps": "a position that jumps",
    "ends": "a sensor at the end of its range",
    "found": "cause found",
    "not-separable": "causes that cannot be told apart",
    "unexplained": "something unknown",
    "interrupted": "stopped before its end",
}
_RUNS = {"measured": "measured", "before": "without a cause", "after": "with the causes"}

_BARS = 12
"""Hypotheses drawn."""

_FOLLOWS = 0.05
"""Share of an error from which it is said that a quantity predicts it."""

_ALONE = "_alone"
"""How parameters end that stand for what bends the heading alone."""

_LETTERS = svg.LETTERS - 2
"""Letters of a hypothesis' parameters beside its bar: what a narrow page has room for, in brackets."""

_FORCE_WORDS = {
    "dX": "surge [kN]", "dY": "sway [kN]", "dN": "yaw [kN m]",
    "dX'": "surge′ [–]", "dY'": "sway′ [–]", "dN'": "yaw′ [–]",
}  # fmt: skip
"""What is missing of the forces; with a prime, over the square of speed."""


def build(record: DiagnosisRecord) -> Page:
    """Everything the report of a diagnosis says."""
    data = record.data
    unknown = data["verdict"] == "unexplained"
    sections = [
        _motions(record),
        _where(data) if unknown else None,
        _causes(data),
        _voyages(data),
        _retuned(data),
        Section("next", "What to do next", (Commands(advice.after_diagnosis(data)),)),
        _why(data),
        _gain(data),
        None if unknown else _where(data),
        _could_tell(data),
        assumptions(data),
        provenance(data),
    ]
    ship = ship_name(data)
    return Page(
        title=f"{ship}: diagnosis",
        eyebrow=f"{ship} · {_kind(data)}",
        verdict=clean(data.get("headline") or data["sentence"]),
        banners=generated_banner(data["trials"]),
        warnings=(
            *(("The search was interrupted; this is what was known by then.",) if data.get("interrupted") else ()),
            *doubts(data),
            *warnings(data),
        ),
        cards=_cards(record),
        sections=tuple(section for section in sections if section is not None),
    )


def _kind(data: Mapping[str, Any]) -> str:
    """The verdict in a few words."""
    verdict = data["verdict"]
    if verdict == "none":
        verdict = "jumps" if data.get("jumped") else "ends" if data.get("ended") else verdict
    return _WORDS.get(verdict, clean(verdict))


def _held_out(gain: Mapping[str, Any]) -> str:
    """What J is of, and by which method; records of older versions do not say."""
    return ", ".join(clean(word) for word in (gain["held_out"], gain.get("method")) if word)


def _cards(record: DiagnosisRecord) -> tuple[Card, ...]:
    data, gain = record.data, record.data["gain"]
    if data["causes"]:
        removed = share(gain["share_above_noise_removed"])
        causes = " and ".join(clean(cause["effect"]) for cause in data["causes"])
        interval = gain["share_ci95"]
        sure = f"95\u00a0% interval over trials: {span(*interval)}" if interval else "on one trial"
        return (
            *cards_of_misfit({}, record.results, where="held out")[:2],
            Card("Error beyond noise removed", removed, note=f"by {causes}; {sure}", tone="good"),
            _misfit(gain),
        )
    cards = []
    for label, mean, written in (
        ("Off track, held out", mean_off_track, lambda value: f"{shown(value, 3)} m"),
        ("Off heading, held out", mean_off_heading, findings.degrees),
    ):
        size = mean(record.results, "before")
        if size is not None:
            cards.append(Card(label, written(size), note="re-tuned model, root mean square of each trial, mean"))
    left = beyond_noise(data["unexplained"]["share_of_noise_variance"])
    structured = data["unexplained"]["structured"]
    note = "looks like something that happened" if structured else "what is left looks like noise"
    if data["unexplained"].get("changed_within"):
        note = "as far as what a sensor did is taken for noise"
    if data["unexplained"].get("best_known") and not structured:
        note = "with what comes closest in place"
    note += "; of the trials looked at, over their noise from sample to sample"
    cards.append(Card("Left beyond the sensors' noise", left, note=note, tone="bad" if structured else ""))
    return (*cards, Card("Misfit J, held out", shown(gain.get("J_test_before")), note=f"re-tuned, {_held_out(gain)}"))


def _misfit(gain: Mapping[str, Any]) -> Card:
    """J before and after; the share of it that is noise no cause removes."""
    before, after = gain.get("J_test_before"), gain.get("J_test_after")
    moved = change(before, after)
    note = "; ".join(filter(None, (_held_out(gain), clean(gain.get("J_is_of", "")))))
    return Card("Misfit J, held out", f"{shown(before)} → {shown(after)}", percent(moved), note, tone(moved))


def _motions(record: DiagnosisRecord) -> Section | None:
    """Held-out tracks: without and with the causes, or of the re-tuned model alone where there is none."""
    data, rows = record.data, record.results
    words = dict(_RUNS) if data["causes"] else {"measured": "measured", "before": "re-tuned model"}
    if data["causes"]:
        before, after = (shown(mean_off_track(rows, when), 3) for when in ("before", "after"))
        caption = f"Mean distance off track: {before} m re-tuned without a cause, {after} m with it."
    else:
        before = shown(mean_off_track(rows, "before"), 3)
        caption = f"The re-tuned model is {before} m off track in the mean."
    data_tables = motion_block.numbers(rows, record.motions, words)
    block = motion_block.of_trials(
        rows, record.motions, record.inputs, caption, words=words, ship=record.ship, data=data_tables
    )
    title = "Held-out trials" if data["gain"].get("held_out_code") == "test" else "Trials"
    return None if block is None else Section("motions", title, (block,))


def _voyages(data: Mapping[str, Any]) -> Section | None:
    """What differs from voyage to voyage; records of trials, and of older versions, have nothing of it."""
    told = data.get("voyages")
    if not told:
        return None
    blocks: list[Block] = [Prose((clean(told["sentence"]),))]
    if told["differences"]:
        title = "What differs from voyage to voyage"
        drawn = differences(told["differences"])
        caption = "Voyages in their order; of those without a point the windows do not tell. The numbers are below."
        blocks.append(picture(drawn, title, caption))
    for one in told["differences"]:
        blocks.append(Prose((clean(one["sentence"]),)))
        names = [name for name in one["by_voyage"][0] if name != "voyage"]
        rows = [
            cells(
                clean(row["voyage"]),
                shown(told["windows"].get(row["voyage"])),
                *(word for name in names for word in _with_error(row[name])),
            )
            for row in one["by_voyage"]
        ]
        relative = ", over its mean" if one["relative_to_mean"] else ""
        what = f"{clean(one['quantity']).capitalize()} of each voyage{relative}, with its 95 % half width"
        heads = tuple(head for name in names for head in (_head(name, one["unit"]), "±"))
        table_of = f"{clean(one['quantity'])}-by-voyage"
        blocks.append(
            Table(table_of, what, ("voyage", "windows", *heads), tuple(rows), tuple(range(1, 2 + len(heads))))
        )
    return Section("voyages", "From voyage to voyage", tuple(blocks))


def _head(name: str, unit: str) -> str:
    return clean(name) if unit in DIMENSIONLESS else f"{clean(name)} [{clean(unit)}]"


def _with_error(value: Mapping[str, Any]) -> tuple[str, str]:
    error = number(value["stderr"])
    return (shown(value["value"], 3), NONE if error is None else shown(NORMAL_95 * error, 2)) if error else (NONE, NONE)


def _causes(data: Mapping[str, Any]) -> Section | None:
    listed = data["causes"] or data["unexplained"]["best_known"]
    said: list[Block] = [Prose((clean(data["record"]["sentence"]),))] if data.get("record") else []
    if not listed and data["verdict"] == "none":
        looked = len(
            {row["effect"] for row in data["candidates"]} | {row["effect"] for row in data.get("detectability") or ()}
        )
        more = (
            f"{count(looked, 'effect was', 'effects were')} looked at; what these trials would have shown stands below."
        )
        nothing = Nothing("No cause was found.", more if looked else "")
        why = [Prose((clean(data["explained"]),))] if data.get("explained") else []
        return Section("causes", "Causes", (*why, nothing, *said, *unexplained.traces(data)))
    blocks: list[Block] = [*said]
    if not listed:
        blocks += unexplained.traces(data)
        return Section("causes", "Causes", tuple(blocks)) if blocks else None
    if not data["causes"]:
        closest = clean(data.get("explained") or "")
        blocks += [Prose((closest,))] if closest else []
        blocks.append(
            Prose(("None of these can be relied on while something unknown is at work besides.",), tone="warning")
        )
    rows = []
    for cause in listed:
        for name, value in cause["parameters"].items():
            low, high = value["ci95"]
            unit, factor = read_as(clean(value["unit"]), number(value["value"]) or 0.0)
            interval = f"{_end(low, factor)} … {_end(high, factor)}"
            size = shown(factor * value["value"]) if number(value["value"]) is not None else "∞"
            rows.append(cells(clean(cause["effect"]), clean(name), size, interval, _unit(unit), _p(cause["p_value"])))
        if not cause["parameters"] and not cause.get("by_run"):
            rows.append(cells(clean(cause["effect"]), NONE, NONE, NONE, NONE, _p(cause["p_value"])))
    if rows:
        blocks.append(
            Table(
                "causes-table",
                "What was found, with its size" if data["causes"] else "What comes closest, with its size",
                ("effect", "parameter", "value", "95 % interval", "unit", "by chance"),
                tuple(rows),
                (2, 3, 5),
                (("by chance", "probability that chance alone brings as much in a search like this one"),),
                cards=True,
            )
        )
    for cause in listed:
        blocks += of_runs(cause)
    if data["groups"]:
        for group in data["groups"]:
            blocks.append(Prose((f"These trials do not tell apart: {', '.join(map(clean, group))}.",)))
    suggestion = data["suggested_trial"]
    if suggestion:
        blocks.append(Prose((_telling(suggestion),)))
    blocks += unexplained.traces(data)
    return Section("causes", "Causes" if data["causes"] else "What comes closest", tuple(blocks))


def _telling(suggestion: Mapping[str, Any]) -> str:
    """What would tell the causes apart, and how far; records of older versions know a trial alone."""
    told = clean(suggestion.get("in_words") or f"A trial that would tell: {suggestion['manoeuvre']}.")
    if not suggestion["manoeuvre"]:
        return told
    apart = shown(suggestion["largest_position_difference_m"], 3)
    in_all = shown(suggestion["distance_in_noise_deviations"], 3)
    where = "There" if suggestion.get("trial_tells", True) else f"In the best, {clean(suggestion['manoeuvre'])},"
    return f"{told} {where} the explanations differ by up to {apart} m, in all {in_all} deviations of the noise."


_STANDS_IN = (
    "targets stand in for one another and for what is no target, and the ship may be otherwise: sentences name only "
    "what fouling changes (R_0, X_0F), and mass, inertia and hull derivatives that the trials contradict"
)


def _retuned(data: Mapping[str, Any]) -> Section | None:
    """Targets as they were re-tuned, what is surest to differ from the profile first."""
    rows = data.get("retuned") or ()
    if not rows:
        return None
    lines = []
    for row in rows:
        error, before = number(row["stderr"]), row["pre_determined"]
        half = None if error is None or not before else 100.0 * NORMAL_95 * error / abs(before)
        lines.append(
            cells(
                short(clean(row["name"])),
                described(row) + ("" if row.get("target", True) else "; no target"),
                coefficient_text(before),
                coefficient_text(row["value"]),
                Cell(percent(change(before, row["value"])), "note" if row["far"] else ""),
                NONE if half is None else f"{shown(half, 2)}{UNIT_PERCENT}",
            )
        )

    def table(id: str, caption: str, of: Sequence[tuple[Cell, ...]]) -> Table:
        return Table(
            id,
            caption,
            ("symbol", "meaning", "pre-determined", "re-tuned", "change", "±"),
            tuple(of),
            numeric=range(2, 6),
            cards=True,
            about=(
                ("re-tuned", _STANDS_IN),
                ("±", "half the 95 % interval of the change, the model's form taken as right; empty at a bound"),
            ),
        )

    far = [line for line, row in zip(lines, rows, strict=True) if row["far"]]
    every = Fold("All targets", (table("retuned-table", "Targets, the surest to differ first", lines),))
    surely = table("far-table", "More than a tenth off the profile's value, by three standard errors", far)
    return Section("retuned", "What re-tuning changed", (surely, every) if far else (every,))


def _unit(unit: str) -> str:
    """A unit in a column of its own, a dash where a number is pure."""
    return NONE if unit in DIMENSIONLESS else unit


def _why(data: Mapping[str, Any]) -> Section | None:
    fitted = [row for row in data["candidates"] if (row["gain"] or 0.0) >= 1.0]
    if not data["candidates"]:
        return None
    table = Table(
        "candidates-table",
        f"{count(len(data['candidates']), 'hypothesis', 'hypotheses')} at the first look",
        ("effect", "parameters", "score [–]", "fall of chi-squared [–]", "by chance", "J, held out"),
        tuple(
            cells(
                clean(row["effect"]),
                clean(", ".join(parameters_of(row))),
                shown(row["score"], 3),
                "not refitted" if row["gain"] is None else shown(row["gain"], 3) if row["gain"] >= 1.0 else "none",
                _p(row["p_value"]) if (row["gain"] or 0.0) >= 1.0 else NONE,
                shown(row["J_test"]),
            )
            for row in data["candidates"]
        ),
        (2, 3, 4, 5),
        (
            ("score", "fall of chi-squared that the first derivatives promise"),
            ("chi-squared", "squared differences over the variance of the sensors' noise, added up"),
            ("by chance", "probability that chance alone brings as much in a search like this one"),
            ("J", measures.J),
        ),
        raw=True,
    )
    every = Fold(f"All hypotheses: {len(data['candidates'])}", (table,))
    if not data["causes"]:
        sentence = "No single hypothesis is enough."
        if data["verdict"] == "none":
            trace, nothing = "Beyond chance there are traces alone.", "No hypothesis explains more than chance would."
            sentence = trace if data.get("traces") else nothing
        drawn = (Fold("What each alone would explain", (_candidates(fitted, data),)),) if fitted else ()
        return Section("why", "What was looked at", (Prose((sentence,)), *drawn, every))
    return Section("why", "Why this and not another", (_candidates(fitted, data), every) if fitted else (every,))


def _candidates(fitted: Sequence[Mapping[str, Any]], data: Mapping[str, Any]) -> Block:
    named = [clean(cause["effect"]) for cause in data["causes"]]
    best = fitted[0]
    likely = number(best["p_value"])
    falls = f"chi-squared falls by {shown(best['gain'], 3)}"
    if clean(best["effect"]) in named:
        caption = f"Alone, {clean(best['effect'])} explains most: {falls}."
    elif named:
        caption = f"Alone, {clean(best['effect'])} explains most: {falls}. {_better(best, named, data['gain'])}"
    elif likely is not None and likely > 0.01:
        caption = f"The largest, {clean(best['effect'])}, is no more than chance brings in {share(likely)} of searches."
    else:
        caption = f"The largest is {clean(best['effect'])}, {falls}."
    return picture(_candidates_figure(fitted, named), "What each hypothesis alone would explain", caption)


def _better(alone: Mapping[str, Any], named: Sequence[str], gain: Mapping[str, Any]) -> str:
    """Why what explains most by itself is not the answer: what both leave on trials that were not used."""
    answer, other = number(gain.get("J_test_after")), number(alone.get("J_test"))
    words = " and ".join(named)
    if answer is None or other is None or answer >= other:
        return f"Named is {words}."
    together = f"{words} together leave" if len(named) > 1 else f"{words} leaves"
    return f"On trials not used {together} J = {shown(answer)}, {clean(alone['effect'])} alone {shown(other)}."


def _label(row: Mapping[str, Any]) -> str:
    """A hypothesis by its parameters, or by how many these are, so that no two are cut to the same.

    What all of the parameters have at their end stands there once.
    """
    names = [str(name) for name in row["parameters"]]
    alone = len(names) > 1 and all(name.endswith(_ALONE) for name in names)
    names = [name.removesuffix(_ALONE) for name in names] if alone else names
    more = [*(["alone"] if alone else []), *(["of each run"] if row.get("by") else [])]
    words = ", ".join([*names, *more])
    if len(words) > _LETTERS:
        words = ", ".join([f"{len(names)} values", *more])
    return f"{clean(row['effect'])} ({clean(words)})"


def _candidates_figure(rows: Sequence[Mapping[str, Any]], named: Sequence[str]) -> Figure:
    """The fall of chi-squared of each hypothesis; those of the causes that were found stand out."""
    rows = rows[:_BARS]
    gains = [max(float(row["gain"]), 0.1) for row in rows]
    log = max(gains) > 30.0 * min(gains)
    least = 0.5 * min(gains) if log else 0.0
    marks: list[Mark] = []
    for k, gain in enumerate(gains):
        color: Color = "after" if clean(rows[k]["effect"]) in named else "muted"
        marks.append(Line((least, gain), (k, k), Look(color, 3.0)))
        marks.append(Dots((gain,), (k,), Look(color, marker="o", size=9.0)))
    ticks = tuple((float(k), _label(row)) for k, row in enumerate(rows))
    y = Axis(low=len(rows) - 0.4, high=-0.6, ticks=ticks, grid=False)
    x = Axis("fall of chi-squared when refitted [–]", low=least, log=log)
    panel = Panel(tuple(marks), x, y, shape=-(31.0 * len(rows) + 48.0))
    return Figure("candidates", "What each hypothesis alone would explain", (panel,))


def _gain(data: Mapping[str, Any]) -> Section:
    """Scores of the trials that were not used, before and after."""
    gain, found = data["gain"], bool(data["causes"])
    rows = [
        cells(measures.with_unit(name), shown(a, 3), *_after(a, gain["measures_after"].get(name), found))
        for name, a in gain["measures_before"].items()
    ]
    for name, a in gain["index_errors_before"].items():
        words, unit = index_words(name)
        b = gain["index_errors_after"].get(name)
        rows.append(cells(f"error of {words} [{unit or NONE}]", shown(a, 3), *_after(a, b, found)))
    heads = ("before", "after", "change") if found else ("re-tuned model",)
    scores = Table(
        "gain-table",
        f"Means over trials, {clean(gain['held_out'])}",
        ("measure", *heads),
        tuple(rows),
        range(1, 1 + len(heads)),
        (*measures.about(list(gain["measures_before"])), ("error of …", "mean size of the error of an index")),
    )
    trials = Table(
        "gain-by-trial",
        "J by trial",
        ("trial", *heads[:-1]) if found else ("trial", "re-tuned model"),
        tuple(
            cells(clean(row["trial"]), shown(row["J_before"]), *([shown(row["J_after"])] if found else []))
            for row in gain["by_trial"]
        ),
        range(1, 3),
        (("J", measures.J),),
    )
    title = "The gain on trials not used" if found else "How well the re-tuned model does"
    if found:
        return Section("gain", title, (scores, Fold("J by trial", (trials,))))
    return Section("gain", title, (Fold("Measures and J by trial", (scores, trials)),))


def _after(before: Any, after: Any, found: bool) -> list[str | Cell]:
    """Value and change with the causes, nothing where there are none."""
    moved = change(before, after)
    return [shown(after, 3), Cell(percent(moved), tone(moved))] if found else []


def _where(data: Mapping[str, Any]) -> Section | None:
    """Where the error lives: by channel and by force, and what is left."""
    evidence = data.get("evidence") or {}
    unknown = data["verdict"] == "unexplained"
    blocks: list[Block] = [*(unexplained.blocks(data) if unknown else ()), _left(data)]
    if "excess_before" in evidence:
        blocks.append(_residuals(evidence, bool(data["causes"])))
    forces = [
        _forces(evidence[f"forces_{which}"], which, words)
        for which, words in (("before", "without a cause"), ("after", "with the causes"))
        if evidence.get(f"forces_{which}") and (which == "before" or data["causes"])
    ]
    if forces and unknown:
        blocks += forces
    elif forces:
        blocks.append(Fold("Residual forces: what each quantity alone predicts of them", tuple(forces)))
    return Section("evidence", "Where the error lives" if unknown else "What is left", tuple(blocks))


def _residuals(evidence: Mapping[str, Any], found: bool) -> Table:
    runs = ("before", "after") if found else ("before",)
    rows = []
    for name in evidence["excess_before"]:
        words = CHANNELS[name].words if name in CHANNELS else name
        whole = [_over_noise(evidence[f"excess_{which}"].get(name)) for which in runs]
        begun = [_times(evidence[f"short_horizon_{which}"].get(name)) for which in runs]
        rows.append(cells(clean(words), *whole, *begun))
    heads: tuple[str, ...] = ("error over noise, before [–]", "after", "restarted, before [–]", "after")
    heads = heads if found else ("error over noise [–]", "restarted [–]")
    return Table(
        "residuals-table",
        "Error of each channel",
        ("channel", *heads),
        tuple(rows),
        range(1, 1 + len(heads)),
        (
            ("error over noise", "root mean square error of whole trials over that of the sensor's noise: 1 is noise"),
            ("restarted", "the same of simulations begun anew every minute"),
        ),
    )


def _over_noise(excess: Any) -> str:
    """How many times the noise an error is, from its variance beyond that of the noise as a share of it."""
    size = number(excess)
    return NONE if size is None else _times(math.sqrt(max(1.0 + size, 0.0)))


def _times(value: Any) -> str:
    """How many times the noise, to a tenth where that says something."""
    size = number(value)
    return fixed(size, 1) if size is not None and size < 10.0 else shown(size, 2)


def _forces(forces: Mapping[str, Any], which: str, words: str) -> Table:
    variables = list(dict.fromkeys(name for shares in forces["explained"].values() for name in shares))
    return Table(
        f"forces-{which}",
        f"Residual forces by inverse dynamics {words}",
        ("force", *(QUANTITIES.get(name, name) for name in variables), "noise"),
        tuple(
            cells(
                _FORCE_WORDS.get(axis, clean(axis)),
                *(_bold(shares.get(name), shares.values()) for name in variables),
                share(forces["noise"].get(axis)),
            )
            for axis, shares in forces["explained"].items()
        ),
        tuple(range(1, len(variables) + 2)),
        (
            ("column", "share of the force's variance that this quantity alone predicts, on samples not used for it"),
            ("noise", "share of it that is noise of the sensors"),
            ("with ′", "over 0.5 ρ L d U²: what grows with the square of speed is constant in it"),
        ),
    )


def _bold(value: Any, others: Iterable[Any]) -> Cell:
    """The largest share of a row stands out."""
    best = max((number(other) or 0.0 for other in others), default=0.0)
    size = number(value)
    return Cell(share(size), "note" if size is not None and size == best and size > 0.2 else "")


def _left(data: Mapping[str, Any]) -> Block:
    left = data["unexplained"]
    size = beyond_noise(left["share_of_noise_variance"])
    if not left["structured"]:
        more = "" if within_noise(left["share_of_noise_variance"]) else f"Its variance beyond theirs: {size}."
        return Nothing("What is left looks like the noise of the sensors.", more)
    known = number(left["share_of_noise_variance"]) or 0.0
    said = (
        f"The error is {size} from sample to sample"
        if known >= LARGE
        else f"What is left is {size} of the noise's variance beyond that noise"
    )
    sentences = [f"On the trials looked at: {small(said)}, and looks like something that happened."]
    for pair, value in left["correlation"].items():
        sentences.append(
            f"Correlation of what {clean(pair)} say of it: {shown(value, 2)} (1: the same thing seen twice)."
        )
    for channel, best in left["largest_share_by_one_quantity"].items():
        if (number(best["share"]) or 0.0) < _FOLLOWS:
            continue
        words = CHANNELS[channel].words if channel in CHANNELS else clean(channel)
        sentences.append(f"Of the error of {words}, {clean(best['quantity'])} predicts {share(best['share'])}.")
    return Prose(tuple(sentences), listed=True)


def _could_tell(data: Mapping[str, Any]) -> Section | None:
    rows = data.get("detectability") or []
    if not rows:
        return None
    table = Table(
        "detectability-table",
        "Effects by how clearly these trials would show them",
        ("effect", "share", "found from", "closest"),
        tuple(
            cells(
                clean(f"{row['effect']} ({', '.join(row['parameters'])})"),
                share(row["share_surviving"]),
                clean(_limits(row)),
                clean(_twins(row)),
            )
            for row in sorted(rows, key=lambda row: -row["share_surviving"])
        ),
        (1,),
        (
            ("share", "of the effect's signature that re-tuning the coefficients cannot imitate"),
            ("found from", "the size from which it would be found"),
            ("closest", "effects whose signatures are alike; the smaller the angle, the harder to tell apart"),
        ),
        cards=True,
    )
    forms = count(len(rows), "form of an effect", "forms of effects")
    said = f"{forms}: the size from which each would be found, and what is like it"
    return Section("detectability", "What these trials could tell", (Fold(said, (table,), data["verdict"] == "none"),))


def _twins(row: Mapping[str, Any]) -> str:
    """Effects that look alike in these trials, each once, by its nearest form."""
    nearest: dict[str, float] = {}
    for twin in row["twins"]:
        nearest[twin["effect"]] = min(twin["angle_deg"], nearest.get(twin["effect"], 180.0))
    return ", ".join(f"{name} {angle:.0f}°" for name, angle in nearest.items())


def _end(value: Any, factor: float) -> str:
    return "∞" if value is None else shown(factor * value)


def _limits(row: Mapping[str, Any]) -> str:
    """Sizes from which an effect would be found, in units people read."""
    found = []
    for name, limit in row["detection_limit"].items():
        if limit is not None:
            unit, factor = read_as(row["units"].get(name, ""), limit)
            pure = unit in DIMENSIONLESS
            space = "" if pure or unit.startswith("°") else " "
            found.append(f"{name} {shown(factor * limit, 4 if pure else 2)}{space}{'' if pure else unit}")
    return ", ".join(found) or "not within its range"


def _p(value: Any) -> str:
    found = number(value)
    return NONE if found is None else "< 0.0001" if found < 1e-4 else shown(found, 2)


def _read(folder: Path, data: Mapping[str, Any]) -> DiagnosisRecord:
    inputs = inputs_of(folder, data)
    return DiagnosisRecord(folder, data, motions_in(folder, inputs), inputs, ship_of(folder))


KIND = Kind(
    "diagnosis",
    ("profile", "trials", "verdict", "sentence", "causes", "candidates", "gain", "trial_results"),
    _read,
    build,
)
