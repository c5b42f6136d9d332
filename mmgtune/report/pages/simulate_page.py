"""The report of a simulation: manoeuvres by orders, or trials with their own inputs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...how_far_off import mean
from ...manoeuvres.named import in_order
from ...trial.headings import unwrapped
from .. import advice, approaches, codes, measures, motion_block
from ..blocks import Block, Card, Cell, Commands, Fold, Page, Section, Table, cells
from ..common import doubts, made_table
from ..figures import motions
from ..figures.plot import LOOKS
from ..figures.tracks import distance_from
from ..forces import NO_SHIP, Ship, ship_of
from ..load import Kind, inputs_of, motions_in
from ..wording import NONE, Channel, clean, count, index_words, is_index, listing, number, run_words, sentence, shown

if TYPE_CHECKING:
    from ...arrays import FloatArray

    Motion = Mapping[str, FloatArray]

_OVERSHOOTS = ("overshoot_1_deg", "overshoot_2_deg")

_FIRST = ("advance_m", "tactical_diameter_m", *_OVERSHOOTS)
"""Indices that stand open where there are many."""

_MANY = 60
"""Rows of indices from which most are folded away."""


@dataclass(frozen=True)
class SimulationRecord:
    """A simulation as its folder holds it: simulate.json, drawn/motions.parquet."""

    folder: Path
    data: Mapping[str, Any]
    motions: Mapping[str, Mapping[str, Motion]]
    inputs: tuple[Channel, ...]
    ship: Ship = NO_SHIP

    @property
    def runs(self) -> list[dict[str, Any]]:
        """The runs, of several members the first."""
        return [run for run in self.data["runs"] if not run.get("member")]

    @property
    def measured(self) -> bool:
        """Whether there is anything to compare with."""
        return any("measured" in found for found in self.motions.values())


def build(record: SimulationRecord) -> Page:
    """Everything the report of a simulation says."""
    data = record.data
    ship = clean(data.get("ship") or data["profile"])
    sections = [
        _motions(record),
        _indices(record),
        _criteria(record),
        Section("next", "What to do next", (Commands(advice.after_simulation(data, record.measured)),)),
        _made(data),
    ]
    diverged = [clean(run["id"]) for run in record.runs if run["status"] != "ok"]
    lost = (f"Diverged: {listing(diverged)}.",) if diverged else ()
    return Page(
        title=f"{ship}: simulation",
        eyebrow=f"{ship} · {count(len(record.runs), 'run')} simulated",
        verdict=_verdict(record, ship),
        lead=_lead(record),
        warnings=(*lost, *(f"{sentence(note)}." for note in data["notes"]), *doubts(data)),
        cards=_cards(record),
        sections=tuple(section for section in sections if section is not None),
    )


def _lead(record: SimulationRecord) -> tuple[str, ...]:
    """From which approach the numbers are, and that none of them was measured."""
    said = "All numbers are simulated, none is measured."
    if record.measured:
        said = "Numbers are simulated but where they are called measured."
    return tuple(filter(None, (approaches.sentence(record.runs, ordered=not record.measured), said)))


def _off(record: SimulationRecord) -> tuple[float | None, float | None]:
    """Mean over runs of the root mean square distance off track [m] and error of heading [deg]."""
    places: list[float] = []
    headings: list[float] = []
    for found in record.motions.values():
        if "measured" not in found or "simulated" not in found:
            continue
        _, gap = distance_from(found["simulated"], found["measured"])
        if np.isfinite(gap).any():
            with np.errstate(over="ignore"):  # of a run that diverged
                places.append(float(np.sqrt(np.nanmean(gap**2))))
        one, other = (unwrapped(found[which]["psi"]) for which in ("simulated", "measured"))
        if one.shape == other.shape:
            error = one - other - motions.turns(one, other)
            if np.isfinite(error).any():
                headings.append(math.degrees(float(np.sqrt(np.nanmean(error**2)))))
    return mean(places), mean(headings)


def _verdict(record: SimulationRecord, ship: str) -> str:
    if record.measured:
        place, heading = _off(record)
        where = f"{count(len(record.runs), 'trial')}"
        if place is None:
            return f"{ship} diverges on what was measured."
        off = f" and {shown(heading, 2)}° off heading" if heading is not None else ""
        return f"Over whole trials the simulated {ship} is {shown(place, 3)} m off track{off} in the mean of {where}."
    said: list[str] = []
    for run in record.runs:
        found, name = run["indices"], run_words(run["id"])
        diameter, advance = (number(found.get(f"{key}_over_L")) for key in ("tactical_diameter", "advance"))
        if diameter is not None and len(said) < 1:
            lengths = f"advance {shown(advance, 3)} and tactical diameter {shown(diameter, 3)} ship lengths"
            said.append(f"{name}, {lengths}")
        elif number(found.get("overshoot_1_deg")) is not None and len(said) < 2:
            said.append(f"{name}, first overshoot {shown(found['overshoot_1_deg'], 2)}°")
    judged = [one for run in record.runs for one in run["criteria"] if one["passed"] is not None]
    failed = [one for one in judged if not one["passed"]]
    text = f"{ship}: " + "; ".join(said) if said else f"{count(len(record.runs), 'run')} of {ship} simulated"
    if judged:
        text += ". All IMO criteria that apply are met" if not failed else f". {len(failed)} IMO criteria are not met"
    return text + "."


def _cards(record: SimulationRecord) -> tuple[Card, ...]:
    cards = []
    if record.measured:
        place, heading = _off(record)
        note = f"root mean square of each trial, mean of {count(len(record.runs), 'trial')}"
        cards.append(Card("Off track", f"{shown(place, 3)} m" if place is not None else NONE, note=note))
        cards.append(Card("Off heading", f"{shown(heading, 2)}°" if heading is not None else NONE, note=note))
    for run in record.runs:
        found = run["indices"]
        advance = number(found.get("advance_m"))
        if advance is not None and len(cards) < 2:
            lengths = f"{shown(found['advance_over_L'], 3)} ship lengths"
            cards.append(Card(f"Advance, {run_words(run['id'])}", f"{shown(advance, 3)} m", note=lengths))
        for name in _OVERSHOOTS[:1]:
            if number(found.get(name)) is not None and len(cards) < 3:
                cards.append(Card(f"First overshoot, {run_words(run['id'])}", f"{shown(found[name], 3)}°"))
    judged = [one for run in record.runs for one in run["criteria"] if one["passed"] is not None]
    if judged:
        good = sum(bool(one["passed"]) for one in judged)
        tone = "good" if good == len(judged) else "bad"
        cards.append(Card("IMO criteria met", f"{good} of {len(judged)}", note="MSC.137(76)", tone=tone))
    return tuple(cards[:4])


def _motions(record: SimulationRecord) -> Section | None:
    rows = [run for run in record.runs if str(run["id"]) in record.motions]
    if not rows:
        return None
    manoeuvres = []
    for run in rows:
        own = dict(record.motions[str(run["id"])])
        if "simulated" in own:
            own["simulated"] = record.ship.with_forces(own["simulated"])
        note = f"{shown(run['duration_s'], 4)} s{approaches.in_caption(run)}" + (
            "" if run["status"] == "ok" else f", {clean(run['status'])}"
        )
        manoeuvres.append(motions.Manoeuvre(run_words(run["id"]), own, note=note))
    runs = [motions.Run("simulated", "simulated", LOOKS["after"])]
    if record.measured:
        runs.insert(0, motions.Run("measured", "measured", LOOKS["measured"], True))
    caption = "Simulated with the measured inputs." if record.measured else "Simulated by orders to the rudder."
    L_pp = number(record.data.get("L_pp"))
    block = motion_block.of_manoeuvres(manoeuvres, runs, record.inputs, caption, L_pp=L_pp)
    return Section("motions", "Tracks and time histories", (block,))


def _indices(record: SimulationRecord) -> Section | None:
    rows: list[tuple[Cell, ...]] = []
    principal: list[tuple[Cell, ...]] = []
    banded = any(run.get("bands") for run in record.runs)
    for run in record.runs:
        measured = run["measured"] or {}
        for key in in_order(run["indices"]):
            value = run["indices"][key]
            if not is_index(key) or number(value) is None:
                continue
            words, unit = index_words(key)
            length = number(run["indices"].get(key.removesuffix("_m") + "_over_L")) if unit == "m" else None
            line: list[str | Cell] = [run_words(run["id"]), f"{words} [{unit}]" if unit else words, shown(value)]
            line.append(shown(length, 3) if length is not None else NONE)
            if record.measured:
                line.append(shown(measured.get(key)))
            if banded:
                band = (run.get("bands") or {}).get(key)
                line.append(f"{shown(band['low'], 3)} to {shown(band['high'], 3)}" if band else NONE)
            rows.append(cells(*line))
            if key in _FIRST:
                principal.append(rows[-1])
    if not rows:
        return None
    heads = ["run", "index", "simulated", "in ship lengths", *["measured"] * record.measured, *["band"] * banded]

    def table(id: str, caption: str, of: Sequence[tuple[Cell, ...]]) -> Table:
        return Table(id, caption, tuple(heads), tuple(of), range(2, len(heads)))

    blocks: list[Block] = [table("indices-table", "Indices of the manoeuvres", rows)]
    if len(rows) > _MANY and principal:
        every = table("all-indices-table", "All indices of the manoeuvres", rows)
        blocks = [
            table("indices-table", "Principal indices of the manoeuvres", principal),
            Fold(f"All {len(rows)} indices", (every,)),
        ]
    distances = [run for run in record.runs if run["measures"]]
    if distances:
        names = list(distances[0]["measures"])
        lines = tuple(
            cells(clean(run["id"]), *(shown(run["measures"].get(name), 3) for name in names)) for run in distances
        )
        heads = ["trial", *(measures.with_unit(name) for name in names)]
        numeric = range(1, len(heads))
        about = list(measures.about(names))
        about += list(codes.legend({str(run["id"]): run.get("order") or run["measured"] or {} for run in distances}))
        blocks.append(Table("measures-table", "Distances from what was measured", tuple(heads), lines, numeric, about))
    return Section("indices", "Manoeuvring indices", tuple(blocks))


def _criteria(record: SimulationRecord) -> Section | None:
    rows: list[tuple[Cell, ...]] = []
    idle: list[tuple[Cell, ...]] = []
    for run in record.runs:
        for one in run["criteria"]:
            passed = one["passed"]
            verdict = Cell("met", "good") if passed else Cell("not met", "bad")
            if passed is None:
                verdict = Cell(f"not applicable: {clean(one['reason'])}")
            (idle if passed is None else rows).append(
                cells(
                    run_words(run["id"]), clean(one["name"]), shown(one["value"], 3), shown(one["limit"], 3),
                    clean(one["unit"]), verdict, clean(one["source"]),
                )
            )  # fmt: skip
    if not rows and not idle:
        return None
    heads = ("run", "criterion", "value", "limit", "unit", "verdict", "source")
    blocks: list[Block] = []
    if rows:
        blocks.append(Table("criteria-table", "Criteria of the IMO", heads, tuple(rows), (2, 3)))
    if idle:
        table = Table("idle-criteria-table", "Criteria that do not apply", heads, tuple(idle), (2, 3))
        blocks.append(Fold(f"{count(len(idle), 'criterion', 'criteria')} that do not apply", (table,)))
    return Section("criteria", "Criteria", tuple(blocks))


def _made(data: Mapping[str, Any]) -> Section:
    method = next((clean(run["integrator"]) for run in data["runs"]), NONE)
    items = [("model", clean(data["profile"])), ("profile's hash (SHA-256)", clean(data.get("sha256") or NONE)),
             ("simulated by", method)]  # fmt: skip
    return Section("provenance", "Provenance", (made_table(data, items),))


def _read(folder: Path, data: Mapping[str, Any]) -> SimulationRecord:
    inputs = inputs_of(folder, data)
    drawn = folder / "drawn"
    return SimulationRecord(folder, data, motions_in(drawn, inputs), inputs, ship_of(drawn))


KIND = Kind("simulate", ("profile", "runs", "notes"), _read, build)
