"""The report of a sweep over ranges a_r, put together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ... import limits
from ...documents import parsed
from ...errors import OptionError
from ...run_files import FIT
from .. import advice, misfit
from ..blocks import Card, Cell, Commands, Page, Prose, Section, Table, cells
from ..common import (
    assumptions,
    cards_of_misfit,
    generated_banner,
    misfit_card,
    off_cards,
    picture,
    provenance,
    ship_name,
    warnings,
)
from ..figures import of_fit as figures
from ..load import Kind, SweepRecord
from ..tables import described
from ..wording import NONE, TRIALS_OF_ROLE, clean, coefficient_text, listing, number, short

_JUDGES = {"test set": "the test trials", "leave-one-trial-out": "leaving each trial out in turn"}


def build(record: SweepRecord) -> Page:
    """Everything the report of a sweep says."""
    data, runs = record.data, record.runs
    recommended = data.get("recommended") or {}
    best = number(recommended.get("a_r"))
    off = misfit.off_figure(record, best)
    sections = [
        Section(
            "ranges",
            "Which range?",
            (
                *((picture(off, "Metres and degrees off", misfit.off_finding(record)),) if off else ()),
                picture(misfit.figure(record, best), "Misfit", misfit.finding(record)),
                *_overfitting(data),
                misfit.table(record),
            ),
        ),
        _coefficients(runs, best),
        Section("next", "What to do next", (Commands(advice.after_sweep(data)),)),
        assumptions(data),
        provenance(data),
    ]
    ship = ship_name(data)
    return Page(
        title=f"{ship}: how far may MMG coefficients move?",
        eyebrow=f"{ship} · fine-tuning in {len(runs)} ranges around the pre-determined values",
        verdict=clean(
            recommended.get("sentence")
            or (f"Use a_r = {best:g}." if best is not None else "No range can be recommended.")
        ),
        banners=generated_banner(data["trials"]),
        warnings=warnings(data),
        cards=_cards(record, best),
        sections=tuple(section for section in sections if section is not None),
    )


def _coefficients(runs: Sequence[Mapping[str, Any]], best: float | None) -> Section | None:
    """Tuned values and places in the box, for every range."""
    names = list(dict.fromkeys(str(row["name"]) for run in runs for row in run["coefficients"]))
    if not names:
        return None
    places = figures.box_positions(
        [short(name) for name in names],
        [f"{run['a_r']:g}" for run in runs],
        [[_place(run, name) for run in runs] for name in names],
    )
    caption = _place_finding(names, runs)
    caption += " −1 is the low bound (▼), 0 the pre-determined value, +1 the high bound (▲)."
    blocks = (picture(places, "Place in the box", caption), _values(names, runs, best))
    return Section("coefficients", "Tuned coefficients", blocks)


def _cards(record: SweepRecord, best: float | None) -> tuple[Card, ...]:
    data, runs = record.data, record.runs
    by = clean((data.get("recommended") or {}).get("by") or "")
    notes = [f"±{100.0 * best:g}\u00a0%"] if best is not None else []
    notes += [f"chosen by {_JUDGES.get(by, by)}"] if by else []
    shown_cards = [Card("Recommended range", f"a_r = {best:g}" if best is not None else NONE, note=", ".join(notes))]
    run = next((run for run in runs if best is not None and number(run["a_r"]) == best), None)
    found = (data.get("overfitting") or {}).get("found")
    off = _off(record, run) if run is not None else ()
    shown_cards = [*off, *shown_cards]
    if run is not None and (len(off) < 2 or found is None):  # four cards at most: J stands in the headline too
        none = "no test set: each trial was left out in turn" if data.get("leave_one_out") else "no test set"
        if number(run.get("J_test")) is not None:
            shown_cards.append(misfit_card("Misfit J, test trials", data.get("J_test_before"), run.get("J_test"), none))
        else:
            card = misfit_card("Misfit J, trials tuned on", data.get("J_tune_before"), run.get("J_tune"), "")
            shown_cards.append(replace(card, note=none))
    if found is not None:
        shown_cards.append(
            Card(
                "Over-fitting",
                "found" if found else "not found",
                tone="bad" if found else "good",
                note="wider ranges do worse on trials not tuned on" if found else "in these ranges",
            )
        )
    return tuple(shown_cards)[:4]


def _off(record: SweepRecord, run: Mapping[str, Any]) -> tuple[Card, ...]:
    """How far off the fit of a range is, in metres and degrees, on trials held out where there are any; of records
    without that from the range's own folder, nothing where that is not there.
    """
    role = next((one for one in TRIALS_OF_ROLE if one in (run.get("off") or {})), None)
    if role is not None:
        return off_cards(run["off"][role], TRIALS_OF_ROLE[role])
    folder = misfit.run_folder(run)
    path = record.folder / (folder or "") / FIT
    if folder is None or not path.is_file():
        return ()
    fit = parsed(limits.text(path, limits.RECORD_BYTES, OptionError))
    return cards_of_misfit({}, fit["trial_results"])


def _overfitting(data: Mapping[str, Any]) -> tuple[Prose, ...]:
    found = data.get("overfitting") or {}
    if not found.get("sentence"):
        return ()
    return (Prose((clean(found["sentence"]),), tone="warning" if found.get("found") else ""),)


def _find(run: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    return next((row for row in run["coefficients"] if row["name"] == name), {})


def _place(run: Mapping[str, Any], name: str) -> float | None:
    """-1 at the low bound, +1 at the high one."""
    position = number(_find(run, name).get("position"))
    return None if position is None else 2.0 * position - 1.0


def _values(names: Sequence[str], runs: Sequence[Mapping[str, Any]], best: float | None) -> Table:
    rows = []
    for name in names:
        first = next((row for run in runs if (row := _find(run, name))), {})
        line: list[str | Cell] = [
            short(clean(name)),
            described(first),
            coefficient_text(first.get("pre_determined", "")),
        ]
        for run in runs:
            row = _find(run, name)
            bound = {"low": " ▼", "high": " ▲"}.get(str(row.get("at_bound")), "")
            line.append(Cell(coefficient_text(row.get("value", "")) + bound, "note" if bound else ""))
        rows.append(cells(*line))
    titles = [f"a_r = {run['a_r']:g}" + (" ✓" if number(run["a_r"]) == best else "") for run in runs]
    return Table(
        "values-table",
        "Tuned values for every range; ▼ at the low, ▲ at the high bound; ✓ recommended",
        ("symbol", "meaning", "pre-determined", *titles),
        tuple(rows),
        numeric=range(2, 3 + len(runs)),
    )


def _place_finding(names: Sequence[str], runs: Sequence[Mapping[str, Any]]) -> str:
    stuck = []
    for name in names:
        sides = {_find(run, name).get("at_bound") for run in runs}
        if len(sides) == 1 and sides != {None}:
            stuck.append(short(clean(name)))
    if not stuck:
        return "No coefficient ends on the same bound in every range."
    verb = "ends" if len(stuck) == 1 else "end"
    return f"{listing(stuck, 12)} {verb} on the same bound however wide the range."


def _inside(record: SweepRecord) -> Iterator[Path]:
    """Folders of the sweep's runs that lie in its own."""
    for run in record.runs:
        name = misfit.run_folder(run)
        if name is not None and (record.folder / name / FIT).is_file():
            yield record.folder / name


KIND = Kind("sweep", ("profile", "trials", "runs", "recommended"), SweepRecord, build, _inside)
