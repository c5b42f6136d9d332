"""The report of a fit, put together."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from .. import advice, codes, confidence, findings, measures, motion_block, tables, tables_of_motion
from ..band_indices import indices_table
from ..blocks import Card, Commands, Fold, Page, Prose, Section
from ..common import assumptions, cards_of_misfit, generated_banner, picture, provenance, ship_name, warnings
from ..figures import of_fit as figures
from ..forces import ship_of
from ..load import Kind, RunRecord, history_in, inputs_of, motions_in
from ..wording import change, clean, number, percent, sentence, shown

_METHOD = re.compile(r"\bJ \([^()]*\)")
"""J with the way of simulation it is of, as a terminal names it; a page has that under how it was made."""

BANDS = "How sure predictions are"
"""Heading of the section."""


def build(record: RunRecord) -> Page:
    """Everything the report of a fit says."""
    data = record.data
    sections = [
        _motions(record),
        _trials(record),
        _indices(record),
        _stated(record),
        _coefficients(record),
        Section("next", "What to do next", (Commands(advice.after_fit(data)),)),
        _bands(record),
        confidence.best_fit(record),
        confidence.identifiability(record),
        assumptions(data),
        provenance(data),
    ]
    ship = ship_name(data)
    a_r = number(data["options"].get("a_r"))
    reach = f", coefficients within ±{shown(100.0 * a_r, 3)} %" if a_r is not None else ""
    return Page(
        title=f"{ship}: fine-tuned MMG coefficients",
        eyebrow=f"{ship} · fine-tuned MMG coefficients{reach}",
        verdict=_METHOD.sub("the misfit J", clean(data.get("verdict") or _verdict(record))),
        lead=(f"The misfit J: {measures.J}.",) if record.results else (),
        banners=generated_banner(data["trials"]),
        warnings=warnings(data),
        cards=_cards(record),
        sections=tuple(section for section in sections if section is not None),
    )


def _trials(record: RunRecord) -> Section | None:
    if not record.results:
        return None
    table = replace(tables.trials(record), about=codes.of_rows(record.results))
    return Section("trials", "Trials", (table, Prose((findings.misfit(record.data["options"]),))))


def _stated(record: RunRecord) -> Section | None:
    table = tables.stated(record)
    return None if table is None else Section("stated", "Stated indices", (table,))


def _verdict(record: RunRecord) -> str:
    data = record.data
    moved = percent(change(data.get("J_tune_before"), data["J_tune"]))
    return f"Tuning changed the misfit J on the trials tuned on by {moved}."


def _cards(record: RunRecord) -> tuple[Card, ...]:
    rows = record.coefficients
    bound = sum(bool(row.get("at_bound")) for row in rows)
    loose = sum(row.get("determined") is False for row in rows)
    note = f"{loose} not determined by these trials" if loose else "all determined by these trials"
    held = Card("Coefficients at a bound", f"{bound} of {len(rows)}", note=note, tone="note" if bound else "")
    return (*cards_of_misfit(record.data, record.results), held)


def _motions(record: RunRecord) -> Section | None:
    results = record.results
    said = f"{findings.tracks(results)} {findings.histories(results)}" if results else ""
    data = (*motion_block.numbers(results, record.motions), tables.errors(record))
    block = motion_block.of_trials(results, record.motions, record.inputs, said, ship=record.ship, data=data)
    return None if block is None else Section("motions", "Tracks and time histories", (block,))


def _indices(record: RunRecord) -> Section | None:
    table = tables.indices(record)
    if table is None:
        return None
    mean = tables_of_motion.index_errors(record.results)
    if mean is None or len(record.results) < 2:
        return Section("indices", "Manoeuvring indices", (table,))
    every = Fold("Every trial: measured, before and after", (table,))
    return Section("indices", "Manoeuvring indices", (mean, every))


def _coefficients(record: RunRecord) -> Section | None:
    rows = record.coefficients
    if not rows:
        return None
    drawn = picture(figures.forest(rows), "Coefficients in their box", findings.forest(rows))
    return Section("coefficients", "Coefficients", (drawn, tables.coefficients(rows)))


def _bands(record: RunRecord) -> Section | None:
    """The usual manoeuvres with bands, and what these are made of; of a fit without them the command that gives some.

    None of a fit to stated indices alone, which show no motion that bands could be made of.
    """
    bands = record.data.get("bands") or {}
    if not bands:
        return Section("bands", BANDS, (Commands(advice.for_bands(record.data)),)) if record.results else None
    found = bands.get("predicted") or {"runs": (), "level": 90.0, "particles": 0}
    shown_runs = [indices_table(run, float(found["level"]), found["particles"] > 1) for run in found["runs"]]
    said = [sentence(text) for text in (*(bands.get("warnings") or ()), *(bands.get("sentences") or ()))]
    return Section("bands", BANDS, (Prose(tuple(said), listed=True), *filter(None, shown_runs)))


def _read(folder: Path, data: Mapping[str, Any]) -> RunRecord:
    inputs = inputs_of(folder, data)
    return RunRecord(folder, data, history_in(folder), motions_in(folder, inputs), inputs, ship_of(folder))


KIND = Kind("fit", ("profile", "trials", "options", "J_tune", "coefficients", "trial_results"), _read, build)
