"""The report of a fit, put together."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import advice, charts, confidence, figures, findings, tables, tables_of_motion, tracks
from .band_indices import indices_table
from .common import assumptions, generated_banner, misfit_tile, picture, provenance, warnings
from .drawing import Drawn
from .load import Kind, RunRecord, history_in, inputs_of, motions_in
from .page import Commands, Details, Histories, Page, Prose, Section, Tile
from .wording import change, clean, count, number, percent, sentence, shown

BANDS = "How sure predictions are"
"""Heading of the section."""


def build(record: RunRecord) -> Page:
    """Everything the report of a fit says."""
    data = record.data
    drawings: dict[str, Drawn] = {}
    sections = [
        _trials(record),
        _tracks(record, drawings),
        _histories(record, drawings),
        _indices(record),
        _stated(record),
        _coefficients(record, drawings),
        confidence.best_fit(record, drawings),
        confidence.identifiability(record, drawings),
        _bands(record),
        Section("next", "What to do next", (Commands(advice.after_fit(data)),)),
        assumptions(data),
        provenance(data),
    ]
    ship = clean(data["profile"].get("name") or data["profile"].get("id") or "the ship")
    a_r = number(data["options"].get("a_r"))
    reach = f", coefficients within ±{shown(100.0 * a_r, 3)} %" if a_r is not None else ""
    return Page(
        title=f"{ship}: fine-tuned MMG coefficients",
        eyebrow=f"{ship} · fine-tuned MMG coefficients{reach}",
        verdict=clean(data.get("verdict") or _verdict(record)),
        banners=generated_banner(data["trials"]),
        warnings=warnings(data),
        tiles=_tiles(record),
        sections=tuple(section for section in sections if section is not None),
        figures=drawings,
    )


def _trials(record: RunRecord) -> Section | None:
    if not record.results:
        return None
    return Section("trials", "Trials", (tables.trials(record), Prose((findings.misfit(record.data["options"]),))))


def _stated(record: RunRecord) -> Section | None:
    table = tables.stated(record)
    return None if table is None else Section("stated", "Stated indices", (table,))


def _verdict(record: RunRecord) -> str:
    data = record.data
    moved = percent(change(data.get("J_tune_before"), data["J_tune"]))
    return f"Tuning changed the misfit J on the trials tuned on by {moved}."


def _tiles(record: RunRecord) -> tuple[Tile, ...]:
    data, rows = record.data, record.coefficients
    before, after = (findings.mean_off_track(record.results, when) for when in ("before", "after"))
    bound = sum(bool(row.get("at_bound")) for row in rows)
    loose = sum(row.get("determined") is False for row in rows)
    tiles = [
        misfit_tile("Misfit J, trials tuned on", data.get("J_tune_before"), data["J_tune"], "not computed"),
        misfit_tile(
            "Misfit J, test trials",
            data.get("J_test_before"),
            data.get("J_test"),
            "no test set: nothing shows yet how this does on other trials",
        ),
    ]
    if before is not None and after is not None:
        moved = change(before, after)
        tiles.append(
            Tile(
                "Distance off track",
                f"{shown(before, 3)} → {shown(after, 3)} m",
                percent(moved),
                f"root mean square, mean of {count(len(record.results), 'trial')}",
                tables.tone(moved),
            )
        )
    note = f"{loose} not determined by these trials" if loose else "all determined by these trials"
    tiles.append(Tile("Coefficients at a bound", f"{bound} of {len(rows)}", note=note, tone="note" if bound else ""))
    return tuple(tiles)


def _tracks(record: RunRecord, drawings: dict[str, Drawn]) -> Section | None:
    rows = tracks.chosen(record.results)
    if not rows:
        return None
    left = len(record.results) - len(rows)
    spacing = tracks.tick_spacing(rows, record.motions)
    note = f" Marks every {spacing:.0f} s; + is the start; every panel has its own scale."
    if left:
        note += f" Shown are the {len(rows)} trials with the greatest J after tuning; {left} more are in the tables."
    drawings["tracks"] = Drawn(
        "tracks",
        "Measured and simulated tracks of each trial, north up",
        lambda: tracks.draw_tracks(rows, record.motions),
    )
    drawings["distances"] = Drawn(
        "distances",
        "Distance of the simulated from the measured position over time",
        lambda: tracks.draw_distances(rows, record.motions),
    )
    return Section(
        "tracks",
        "Tracks",
        (
            picture(
                drawings["tracks"],
                "Tracks",
                findings.tracks(record.results) + note,
                tables_of_motion.positions(rows, record.motions, spacing),
            ),
            picture(
                drawings["distances"],
                "Distance off track",
                findings.distances(record.results),
                tables_of_motion.distances(rows, record.motions),
            ),
        ),
    )


def _histories(record: RunRecord, drawings: dict[str, Drawn]) -> Section | None:
    names = [str(row["id"]) for row in record.results if str(row["id"]) in record.motions]
    if not names:
        return None
    payload, thinned = charts.histories(names, record.motions, record.inputs)
    for trial in payload["trials"]:
        trial["name"] = clean(trial["name"])
    notes = ["All motions, at full resolution, are in motions.parquet in the run folder."]
    if thinned:
        notes.insert(
            0,
            "Long histories are drawn from the least and the greatest sample of every stretch, so that no "
            "peak is lost.",
        )
    worst = max((row for row in record.results if str(row["id"]) in record.motions), key=_misfit_of)
    drawings["histories"] = Drawn(
        "histories",
        "Measured and simulated time histories of the trial that fits worst",
        lambda: tracks.draw_histories(record.motions[str(worst["id"])], record.inputs),
    )
    caption = f"The trial that fits worst after tuning: {clean(worst['id'])}."
    static = picture(drawings["histories"], "Time histories", caption)
    block = Histories(
        "histories-chart",
        findings.histories(record.results),
        payload,
        tuple(clean(name) for name in names),
        static,
        names.index(str(worst["id"])),
        tuple(notes),
        (tables.errors(record),),
    )
    return Section("histories", "Time histories", (block,))


def _misfit_of(row: Any) -> float:
    """J after tuning, greatest where the simulation diverged."""
    size = number(row.get("J_after"))
    return float("inf") if size is None else size


def _indices(record: RunRecord) -> Section | None:
    table = tables.indices(record)
    if table is None:
        return None
    mean = tables_of_motion.index_errors(record.results)
    if mean is None or len(record.results) < 2:
        return Section("indices", "Manoeuvring indices", (table,))
    every = Details("Every trial: measured, before and after", (table,)) if len(table.rows) > 16 else table
    return Section("indices", "Manoeuvring indices", (mean, every))


def _coefficients(record: RunRecord, drawings: dict[str, Drawn]) -> Section | None:
    rows = record.coefficients
    if not rows:
        return None
    drawings["coefficients"] = Drawn(
        "coefficients", "Each tuned coefficient's place between its bounds", lambda: figures.draw_forest(rows)
    )
    return Section(
        "coefficients",
        "Coefficients",
        (
            picture(drawings["coefficients"], "Coefficients in their box", findings.forest(rows)),
            tables.coefficients(rows),
        ),
    )


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
    return RunRecord(folder, data, history_in(folder), motions_in(folder, inputs), inputs)


KIND = Kind("fit", ("profile", "trials", "options", "J_tune", "coefficients", "trial_results"), _read, build)
