"""The report of models scored on trials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...how_far_off import rms_errors
from .. import advice, codes, measures, motion_block, repeated, tables
from ..band_scores import bands_section
from ..blocks import Block, Card, Commands, Fold, Page, Section, Table, cells
from ..common import doubts, generated_banner, made_table, options_fold, picture
from ..figures import motions
from ..figures.plot import LOOKS, Axis, Dots, Figure, Look, Mark, Panel, model_look
from ..load import Kind, inputs_of, motions_in
from ..wording import NONE, Channel, clean, count, model_names, number, sentence, share, shown

if TYPE_CHECKING:
    from ...arrays import FloatArray

    Motion = Mapping[str, FloatArray]


@dataclass(frozen=True)
class ValidationRecord:
    """A validation as its folder holds it: validate.json, motions.parquet."""

    folder: Path
    data: Mapping[str, Any]
    motions: Mapping[str, Mapping[str, Motion]]
    inputs: tuple[Channel, ...]

    @property
    def models(self) -> list[dict[str, Any]]:
        """The models, in the order they were given, with what the page calls them."""
        profiles = self.data["profiles"]
        called = model_names([one["profile"] for one in profiles])
        return [{**one, "called": name} for one, name in zip(profiles, called, strict=True)]

    @property
    def scored(self) -> bool:
        """Whether there were time series."""
        return all("L_MSE" in one for one in self.models)


def build(record: ValidationRecord) -> Page:
    """Everything the report of a validation says."""
    data = record.data
    ship = clean(data.get("ship") or "the ship")
    sections = [
        _motions(record),
        _scores(record) if record.scored else None,
        bands_section(record.models, "these trials"),
        _stated(record),
        repeated.section({one["called"]: one.get("manoeuvres") for one in record.models}),
        Section("next", "What to do next", (Commands(advice.after_validation(data)),)),
        _made(data),
    ]
    names = ", ".join(one["called"] for one in record.models)
    notes = [f"{one['called']}: {sentence(note)}." for one in record.models for note in one["notes"]]
    return Page(
        title=f"{ship}: models on trials",
        eyebrow=f"{names} on {clean(data['trials'])}",
        verdict=verdict(record),
        lead=(f"The misfit J: {measures.J}.",) if record.scored else (),
        banners=generated_banner({"source": data.get("sources") or {}}),
        warnings=(
            *map(clean, data.get("warnings", ())),
            *notes,
            *(f"{one['called']}: {text}" for one in record.models for text in doubts(one)),
        ),
        cards=_cards(record),
        sections=tuple(section for section in sections if section is not None),
    )


def _errors(record: ValidationRecord, row: Mapping[str, Any]) -> tuple[float | None, float | None]:
    return rms_errors(record.data, row) if "L_MSE_by_state" in row else (None, None)


def _best(record: ValidationRecord) -> Mapping[str, Any] | None:
    known = [one for one in record.models if number(one.get("L_MSE")) is not None]
    return min(known, key=lambda one: float(one["L_MSE"])) if known else None


def verdict(record: ValidationRecord) -> str:
    """Which model does best, and how far off it is."""
    best = _best(record)
    if best is None:
        return "Every model diverged on some trial." if record.scored else "Models against what is stated."
    place, heading = _errors(record, best)
    window = number(record.data["window_s"])
    begun = "an estimated state" if _estimated(record.data) else "a measured state"
    over = f"Over {shown(window, 3)} s from {begun}" if window else "Over whole trials"
    off = f"{shown(place, 3)} m and {shown(heading, 2)}° off (root mean square over all samples)"
    if len(record.models) == 1:
        return f"{over} {best['called']} is {off}."
    others = [
        one for one in record.models if one["profile"] != best["profile"] and number(one.get("L_MSE")) is not None
    ]
    beside = ""
    if others:
        next_best = min(others, key=lambda one: float(one["L_MSE"]))
        less = share(1.0 - float(best["L_MSE"]) / float(next_best["L_MSE"])) if next_best["L_MSE"] else "0 %"
        beside = f"; its error L_MSE is {less} lower than that of {next_best['called']}"
    return f"{over} {best['called']} does best, {off}{beside}."


def _cards(record: ValidationRecord) -> tuple[Card, ...]:
    cards = []
    if len(record.models) == 1 and record.scored:
        one = record.models[0]
        place, heading = _errors(record, one)
        note = f"root mean square over all samples of {count(len(one['trials']), 'trial')} together"
        return (
            Card("Off track", f"{shown(place, 3)} m", note=note),
            Card("Off heading", f"{shown(heading, 2)}°", note=note),
            Card("L_MSE", shown(one["L_MSE"]), note="0 is perfect, about 6 knows only the mean"),
            Card("Misfit J", shown(one["J"]), note="sum over all samples; 0 is a perfect fit"),
        )
    for one in record.models[:4] if record.scored else ():
        place, heading = _errors(record, one)
        note = f"L_MSE {shown(one['L_MSE'], 3)}, J {shown(one['J'])}"
        lost = "diverged" if place is None else f"{shown(place, 3)} m, {shown(heading, 2)}°"
        cards.append(Card(f"Off, {one['called']}", lost, note=note))
    return tuple(cards)


def _motions(record: ValidationRecord) -> Section | None:
    if not record.motions:
        return None
    runs = [motions.Run("measured", "measured", LOOKS["measured"], True)]
    for k, one in enumerate(record.models):
        runs.append(motions.Run(str(one["profile"]), one["called"], replace(model_look(k), marker="o")))
    first = record.models[0]
    by_id = {str(row["id"]): row for row in first.get("trials") or ()}
    manoeuvres = [
        motions.Manoeuvre(clean(id), found, note=_note(record, by_id.get(id))) for id, found in record.motions.items()
    ]
    worst = sorted(range(len(manoeuvres)), key=lambda k: -_size(by_id.get(list(record.motions)[k])))
    drawn = [manoeuvres[k] for k in sorted(worst[:12])]
    block = motion_block.of_manoeuvres(
        manoeuvres, runs, record.inputs, f"Simulated from {_beginning(record.data)} with the measured inputs.",
        said="Tracks as measured and simulated.", drawn=drawn, selected=worst[0], L_pp=number(record.data.get("L_pp")),
        notes=(motion_block.FULL,),
        why=f", on which {first['called']} does worst",
    )  # fmt: skip
    return Section("motions", "Tracks and time histories", (block,))


def _estimated(data: Mapping[str, Any]) -> bool:
    """Whether simulations begin with estimated states."""
    return data.get("initial") == "estimated"


def _beginning(data: Mapping[str, Any]) -> str:
    """What each simulation begins with."""
    if _estimated(data):
        return "a state within the noise of the first measured one, from which it follows best,"
    return "the first measured state"


def _size(row: Mapping[str, Any] | None) -> float:
    size = number((row or {}).get("L_MSE"))
    return size if size is not None else float("inf") if row else -1.0


def _note(record: ValidationRecord, row: Mapping[str, Any] | None) -> str:
    if row is None:
        return ""
    place, heading = _errors(record, row)
    off = f"{record.models[0]['called']} {shown(place, 3)} m and {shown(heading, 2)}° off"
    return " · ".join(part for part in (clean(row.get("manoeuvre") or ""), off if place is not None else "") if part)


def _scores(record: ValidationRecord) -> Section:
    kinds = list(dict.fromkeys(kind for one in record.models for kind in one["by_manoeuvre"]))
    rows, lines = [], []
    for one in record.models:
        groups = {**{kind: one["by_manoeuvre"][kind] for kind in kinds if kind in one["by_manoeuvre"]}, None: one}
        for kind, row in groups.items():
            words = "all" if kind is None else clean(kind) or "not stated"
            runs = row.get("runs", len(one["trials"]))
            rows.append(cells(one["called"], words, str(runs), *_numbers(record, row)))
        for row in one["trials"]:
            lines.append(cells(clean(row["id"]), one["called"], clean(row["manoeuvre"]), *_numbers(record, row)))
    heads = ("off track [m]", "off heading [°]", "L_MSE [–]", "J [–]")
    about = (
        ("off …", "root mean square over all samples"), ("L_MSE", measures.L_MSE), ("J", measures.J),
        *codes.legend(record.data.get("orders") or {}),
    )  # fmt: skip
    table = Table("scores-table", "Scores by kind of manoeuvre", ("model", "manoeuvre", "runs", *heads), tuple(rows),
                  range(2, 7), about)  # fmt: skip
    every = Table("trials-table", "Scores of every trial", ("trial", "model", "manoeuvre", *heads), tuple(lines),
                  range(3, 7), raw=True)  # fmt: skip
    blocks: list[Block] = [picture(_figure(record, kinds), "Errors", "L_MSE by kind of manoeuvre: lower is better.")]
    return Section("scores", "Scores", (*blocks, table, Fold(f"Every trial: {len(lines)} rows", (every,))))


def _numbers(record: ValidationRecord, row: Mapping[str, Any]) -> list[str]:
    place, heading = _errors(record, row)
    if number(row.get("L_MSE")) is None:
        return ["diverged", NONE, NONE, NONE]
    return [shown(place, 3), shown(heading, 2), shown(row["L_MSE"]), shown(row["J"])]


def _figure(record: ValidationRecord, kinds: list[str]) -> Figure:
    marks: list[Mark] = []
    width = 0.6 / max(len(record.models), 1)
    looks: list[Look] = []
    for j, one in enumerate(record.models):
        look = replace(model_look(j), width=0.0, size=8.0)
        looks.append(look)
        for i, kind in enumerate([*kinds, None]):
            row = one if kind is None else one["by_manoeuvre"].get(kind)
            value = number(row.get("L_MSE")) if row else None
            if value is not None and value > 0.0:
                x = i + (j - 0.5 * (len(record.models) - 1)) * width
                marks.append(Dots((x,), (value,), look))
    names = [*(clean(kind)[:14] or "not stated" for kind in kinds), "all"]
    ticks = tuple((float(k), name) for k, name in enumerate(names))
    x_axis = Axis(low=-0.5, high=len(names) - 0.5, ticks=ticks, grid=False)
    panel = Panel(tuple(marks), x_axis, Axis("L_MSE [–]", log=bool(marks), room=0.1), shape=0.4)
    legend = tuple((one["called"], look) for one, look in zip(record.models, looks, strict=True))
    return Figure("errors", "L_MSE by kind of manoeuvre", (panel,), legend)


def _stated(record: ValidationRecord) -> Section | None:
    blocks = []
    for k, one in enumerate(record.models):
        table = tables.stated_rows(one.get("stated") or (), ("simulated",), ("simulated",), f"stated-{k}")
        if table is not None:
            blocks.append(replace(table, caption=f"{one['called']}: {table.caption}"))
    return Section("stated", "Stated indices", tuple(blocks)) if blocks else None


def _made(data: Mapping[str, Any]) -> Section:
    items = [(f"hash of {clean(one['profile'])}", clean(one.get("sha256") or NONE)) for one in data["profiles"]]
    items += [(f"{clean(one['profile'])} simulated by", clean(one.get("method") or NONE)) for one in data["profiles"]]
    items.append(("spread counted in", clean(data["sigma_from"])))
    return Section("provenance", "Provenance", (made_table(data, items), *options_fold(data.get("options"))))


def _read(folder: Path, data: Mapping[str, Any]) -> ValidationRecord:
    inputs = inputs_of(folder, data)
    return ValidationRecord(folder, data, motions_in(folder, inputs), inputs)


KIND = Kind("validate", ("trials", "profiles", "sigma", "window_s", "sigma_from"), _read, build)
