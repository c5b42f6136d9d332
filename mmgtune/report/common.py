"""Parts that the reports of a fit and of a sweep share."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from itertools import chain, repeat
from typing import Any

from ..how_far_off import mean_off_heading, mean_off_track
from ..profile.doubts import in_words
from .advice import shortest
from .blocks import Block, Card, Fold, Picture, Prose, Section, Table
from .figures.plot import Figure
from .tables import pairs, tone
from .wording import NONE, change, clean, count, number, percent, piece_of, sentence, shown


def generated_banner(trials: Mapping[str, Any]) -> tuple[str, ...]:
    """A banner where any trial was generated rather than measured."""
    sources = trials.get("source") or {}
    made = [str(name) for name, source in sources.items() if source == "generated"]
    if not made:
        return ()
    if len(made) == len(sources):
        said = "The trials in this data set are generated, not measured."
        return (f"{said} What follows says how the method works, not how the real ship moves.",)
    return (
        f"{len(made)} of the {len(sources)} trials in this data set are generated, not measured: "
        + ", ".join(clean(name) for name in made)
        + ".",
    )


def banner_of_sources(sources: Sequence[str] | None, learned: bool = False) -> tuple[str, ...]:
    """A banner where all trials of a model were generated.

    sources  of the trials, each once
    learned  whether the model is a network that learned from them
    """
    if list(sources or ()) != ["generated"]:
        return ()
    if learned:
        return (
            "The trials it learned from are generated, not measured: this says how the method works, not the ship.",
        )
    return ("The trials are generated, not measured: this says how the method works, not how a real ship moves.",)


def ship_name(data: Mapping[str, Any]) -> str:
    """What the ship of a run is called: her name, or else the id of her profile."""
    return clean(data["profile"].get("name") or data["profile"].get("id") or "the ship")


def warnings(data: Mapping[str, Any]) -> tuple[str, ...]:
    """What a reader must know, less what the banner says already; records of older versions have no codes."""
    said = ("generated",) if generated_banner(data["trials"]) else ()
    codes = chain(data.get("warning_codes") or (), repeat(""))
    found = zip(data.get("warnings") or (), codes, strict=False)
    return tuple(sentence(text) for text, code in found if code not in said)


STOPPED = "The training was stopped before its end."


def of_training(data: Mapping[str, Any], verdict: str) -> str:
    """The headline of a training: first of all that it was stopped, where it was."""
    return f"{STOPPED} {verdict}" if data["interrupted"] else verdict


def stopped_early(data: Mapping[str, Any]) -> tuple[str, ...]:
    """How a training that was stopped goes on."""
    return ("The training was stopped early; --resume continues it.",) if data["interrupted"] else ()


def doubts(record: Mapping[str, Any]) -> tuple[str, ...]:
    """Which numbers of a profile may be wrong, in sentences; records of older versions do not say."""
    return tuple(f"{clean(words)}." for words in in_words(record.get("doubts") or ()))


def misfit_card(label: str, before: Any, after: Any, none: str) -> Card:
    """J of a set before and after tuning, or why there is none."""
    if number(after) is None:
        return Card(label, NONE, note=none)
    moved = change(before, after)
    return Card(label, f"{shown(before)} → {shown(after)}", percent(moved), "", tone(moved))


def cards_of_misfit(data: Mapping[str, Any], results: Sequence[Mapping[str, Any]], where: str = "") -> tuple[Card, ...]:
    """How far off in metres and degrees, on trials not tuned on where there are any, and J after that.

    where  what the trials are, where all are of one kind
    """
    held = [row for row in results if row.get("role") == "test"]
    rows = held if held and not where else list(results)
    where = where or ("test trials" if held else "trials tuned on")
    means = {"track_m": mean_off_track, "heading_deg": mean_off_heading}
    off = {key: {which: mean(rows, which) for which in ("before", "after")} for key, mean in means.items()}
    trials = {row.get("part_of") or row["id"] for row in rows}
    cut = {"windows": len(rows)} if any(row.get("part_of") for row in rows) else {}
    cards = list(off_cards({"trials": len(trials), **cut, **off}, where, piece_of(rows)))
    tuned = change(data.get("J_tune_before"), data.get("J_tune"))
    if held and number(data.get("J_test")) is not None:
        moved = change(data.get("J_test_before"), data["J_test"])
        values = f"{shown(data.get('J_test_before'))} → {shown(data['J_test'])}"
        said = f"trials tuned on: {percent(tuned)}" if tuned is not None else ""
        cards.append(Card("Misfit J, test trials", values, percent(moved), said, tone(moved)))
    elif number(data.get("J_tune")) is not None:
        none = "no test set: nothing shows yet how this does on other trials"
        values = f"{shown(data.get('J_tune_before'))} → {shown(data['J_tune'])}"
        cards.append(Card("Misfit J, trials tuned on", values, percent(tuned), none, tone(tuned)))
    return tuple(cards)


def off_cards(off: Mapping[str, Any], where: str, piece: str = "window") -> tuple[Card, ...]:
    """How far off track [m] and heading [deg] trials are before and after tuning, as ``sweep.json`` says it.

    where  what the trials are
    piece  what one is where trials were cut
    """
    trials = count(off["trials"], "trial")
    note = f"root mean square of each trial, mean of {trials}"
    if "windows" in off:
        note = f"root mean square of each {piece}, mean of {count(off['windows'], piece)} of {trials}"
    cards = []
    for key, label, unit, digits in (("track_m", "Off track", " m", 3), ("heading_deg", "Off heading", "°", 2)):
        before, after = (number(off[key].get(which)) for which in ("before", "after"))
        if before is not None and after is not None:
            moved = change(before, after)
            value = f"{shown(before, digits)} → {shown(after, digits)}{unit}"
            cards.append(Card(f"{label}, {where}", value, percent(moved), note, tone(moved)))
    return tuple(cards)


def picture(figure: Figure, title: str, caption: str, *data: Table) -> Picture:
    """A figure with its caption and data."""
    return Picture(figure.name, title, caption, figure, data)


def assumptions(data: Mapping[str, Any]) -> Section | None:
    """What had to be assumed."""
    items = data.get("assumptions") or []
    if not items:
        return None
    table = pairs(
        "assumptions-table",
        "What the sources leave open, and what was taken",
        ("assumption", "taken, and why"),
        (
            (
                str(row.get("name", "")),
                ": ".join(filter(None, (str(row.get("value") or ""), str(row.get("note") or "")))),
            )
            for row in items
        ),
        raw=True,
    )
    said = f"{count(len(items), 'number')} that the sources leave open, and what was taken"
    return Section("assumptions", "Assumptions", (Fold(said, (table,)),))


def provenance(data: Mapping[str, Any]) -> Section:
    """Where everything came from: command, versions, hashes, sources."""
    profile, trials = data["profile"], data["trials"]
    items = [
        ("ship profile", shortest(profile.get("path") or "", "ship_profiles")),
        ("profile's hash (SHA-256)", profile.get("sha256")),
        ("simulated by", _simulated_by(data)),
        ("profile's source", profile.get("source")),
        ("profile's licence, of the data it was tuned to", profile.get("licence")),
        ("to be cited for these", profile.get("citation")),
        ("trials", shortest(trials.get("path") or "", "trials")),
        ("licence of the trials", trials.get("licence")),
        ("to be cited for the trials", trials.get("citation")),
        ("tuned on", ", ".join(map(str, trials.get("tune") or [])) or "none"),
        ("tested on", ", ".join(map(str, trials.get("test") or [])) or "none"),
    ]
    cited = tuple(clean(text) for text in data.get("citations") or ())
    sources = (Prose(("To be cited with these results:",)), Prose(cited, listed=True)) if cited else ()
    return provenance_section(data, items, "trial", options_fold(data.get("options")), sources)


def provenance_section(
    data: Mapping[str, Any],
    items: Sequence[tuple[str, Any]],
    hashed: str,
    options: Sequence[Fold] = (),
    below: Sequence[Block] = (),
) -> Section:
    """How a run was made: command and time, ``items`` as far as they are known, and folds of details.

    hashed   what has hashes, in the singular: "trial"
    options  see ``options_fold``
    """
    versions = [(str(name), str(text)) for name, text in sorted((data.get("environment") or {}).items())]
    hashes = [(str(name), str(text)) for name, text in (data["trials"].get("sha256") or {}).items()]
    folded = [
        Fold(summary, (pairs(f"{id}-table", summary, titles, rows),))
        for id, summary, titles, rows in (
            ("versions", "Versions", ("program", "version"), versions),
            ("hashes", f"Hashes of the {hashed}s", (hashed, "SHA-256"), hashes),
        )
        if rows
    ]
    rows = [*_of_run(data), *_known(items)]
    table = pairs("provenance-table", "How this run was made", ("what", "value"), rows)
    return Section("provenance", "Provenance", (table, *options, *folded, *below))


def _of_run(data: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Command, date, version and time of a run, as far as its record says them."""
    time = f"{shown(data['wall_s'], 3)} s" if number(data.get("wall_s")) is not None else None
    of = [("command", data.get("command")), ("made", data.get("created")), ("mmgtune", data.get("mmgtune"))]
    return _known([*of, ("time taken", time)])


def _known(items: Sequence[tuple[str, Any]]) -> list[tuple[str, str]]:
    """Items that have a value."""
    return [(name, str(text)) for name, text in items if text not in (None, "")]


def _simulated_by(data: Mapping[str, Any]) -> str | None:
    """The integrator and its substeps; None where a record does not say, or was made by several models."""
    options = data.get("options") or {}
    name, substeps = data.get("integrator") or options.get("integrator"), options.get("substeps")
    if not isinstance(name, str):
        return None
    return f"{name}, {substeps} substeps" if isinstance(substeps, int) and substeps > 1 and "," not in name else name


def made_table(data: Mapping[str, Any], items: Sequence[tuple[str, str]]) -> Table:
    """How a run was made, of records with little of it."""
    return pairs("provenance-table", "How this was made", ("what", "value"), [*_of_run(data), *items])


def sources_rows(trials: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Licence and citation of trials, as far as these say them."""
    return _known([("licence of the trials", trials.get("licence")), ("cite for them", trials.get("citation"))])


def made_rows(data: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Command, version and time of a run whose record has a ``provenance``."""
    made = data["provenance"]
    return [
        ("command", clean(made["command"] or NONE)),
        ("made by", f"mmgtune {clean(made['mmgtune'])}, {clean(made['created'])}"),
        ("time", f"{shown(data['wall_s'], 3)} s"),
    ]


def options_fold(options: Mapping[str, Any] | None, summary: str = "Options") -> tuple[Fold, ...]:
    """The options that a run was given; none where its record has none."""
    rows = [(clean(name), _option(value)) for name, value in (options or {}).items()]
    return (Fold(summary, (pairs("options-table", "Options", ("option", "value"), rows),)),) if rows else ()


def _option(value: Any) -> str:
    """The value of an option as people say it."""
    if value is None or value == []:
        return NONE
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return ", ".join(map(_option, value))
    return clean(value if isinstance(value, str) else json.dumps(value, ensure_ascii=False))
