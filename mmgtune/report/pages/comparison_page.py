"""The report of two profiles side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...manoeuvres.named import KNOWN
from .. import advice, motion_block
from ..blocks import Block, Card, Cell, Commands, Fold, Page, Prose, Section, Table, cells
from ..common import doubts, picture
from ..figures import motions
from ..figures.plot import Axis, Figure, Line, Look, Mark, Panel
from ..load import Kind
from ..wording import NONE, clean, coefficient_text, index_words, number, percent, run_words, shown

LONG = 20
"""Coefficients that differ, more than which are folded away."""

_LOOKS = {"a": Look("before", 1.6), "b": Look("after", 1.6, "dash")}
_FORCES = (
    ("over_drift", "beta_deg", "drift angle [°]", "hull, not turning", ("X", "Y", "N")),
    ("over_yaw_rate", "r_prime", "yaw rate r′ [–]", "hull, no drift", ("X", "Y", "N")),
    (
        "over_rudder",
        "delta_deg",
        "rudder angle [°]",
        "rudder with hull, straight on",
        ("X", "Y", "N"),
    ),
)


def words_of(key: str) -> str:
    """An index of a comparison with its unit, lengths in those of the ship."""
    if key.endswith("_over_L"):
        return f"{KNOWN[key.removesuffix('_over_L')].words} [L_pp]"
    words, unit = index_words(key)
    return f"{words} [{unit or '–'}]"


@dataclass(frozen=True)
class ComparisonRecord:
    """A comparison as its folder holds it: comparison.json."""

    folder: Path
    data: Mapping[str, Any]

    @property
    def names(self) -> tuple[str, str]:
        """What the profiles were called."""
        a, b = self.data["profiles"]
        return clean(a["name"]), clean(b["name"])


def build(record: ComparisonRecord) -> Page:
    """Everything the report of a comparison says."""
    data, names = record.data, record.names
    manoeuvres = data["manoeuvres"]
    sections: list[Section] = []
    if manoeuvres.get("motions"):  # records of older versions have none
        sections.append(_motions(names, manoeuvres))
    if manoeuvres["indices"]:
        blocks = (
            picture(_turns(names, manoeuvres["tracks"]), "Turning circles", _circles(names, manoeuvres["indices"])),
            _indices(names, manoeuvres),
        )
        sections.append(Section("manoeuvres", "Standard manoeuvres", blocks))
    caption = f"Prime system, at {shown(data['speed_mps'], 3)} m/s. X forward, Y and N to starboard."
    sections.append(Section("forces", "Forces", (picture(_forces(names, data["forces"]), "Forces", caption),)))
    differ: Block = _coefficients(names, data["coefficients"])
    if isinstance(differ, Table) and len(differ.rows) > LONG:
        differ = Fold(f"All {len(differ.rows)} coefficients that differ", (differ,))
    sections.append(Section("coefficients", "Coefficients", (differ,)))
    sections.append(Section("next", "What to do next", (Commands(advice.after_comparison(data)),)))
    sections.append(_made(data["profiles"]))
    titles = [clean(one["title"]) for one in data["profiles"]]
    return Page(
        title=f"{names[0]} and {names[1]} side by side",
        eyebrow=" · ".join(dict.fromkeys(titles)),
        verdict=verdict(record),
        warnings=tuple(f"{clean(one['name'])}: {words}" for one in data["profiles"] for words in doubts(one)),
        cards=_cards(names, manoeuvres["indices"]),
        sections=tuple(sections),
    )


def _find(rows: Sequence[Mapping[str, Any]], manoeuvre: str, index: str) -> tuple[float, float] | None:
    for row in rows:
        if (row["manoeuvre"], row["index"]) == (manoeuvre, index):
            a, b = number(row["a"]), number(row["b"])
            return None if a is None or b is None else (a, b)
    return None


def verdict(record: ComparisonRecord) -> str:
    """Which ship turns tighter, and by how much."""
    names, rows = record.names, record.data["manoeuvres"]["indices"]
    found = _find(rows, "turn_p35", "tactical_diameter_over_L")
    if found is None:
        return "The profiles say no approach or steering gear, so that no manoeuvres are compared."
    a, b = found
    size = f"{shown(abs(b - a), 2)} L_pp {'wider' if b > a else 'tighter'}"
    return (
        f"At 35° to starboard {names[1]} turns {size} than {names[0]}: tactical diameter {shown(b, 3)} against "
        f"{shown(a, 3)} L_pp."
    )


def _cards(names: tuple[str, str], rows: Sequence[Mapping[str, Any]]) -> tuple[Card, ...]:
    wanted = (
        ("Advance, 35° to starboard", "turn_p35", "advance_over_L", " L_pp"),
        ("Tactical diameter, 35° to starboard", "turn_p35", "tactical_diameter_over_L", " L_pp"),
        ("Tactical diameter, 35° to port", "turn_m35", "tactical_diameter_over_L", " L_pp"),
        ("First overshoot, zigzag 10/10", "zigzag_p10_10", "overshoot_1_deg", "°"),
    )
    shown_cards = []
    for label, manoeuvre, index, unit in wanted:
        found = _find(rows, manoeuvre, index)
        if found is not None:
            a, b = found
            change = percent(100.0 * (b - a) / a) if a else ""
            shown_cards.append(Card(label, f"{shown(a, 3)} → {shown(b, 3)}{unit}", change, f"{names[0]} → {names[1]}"))
    return tuple(shown_cards)


def _circles(names: tuple[str, str], rows: Sequence[Mapping[str, Any]]) -> str:
    parts = []
    for k, name in enumerate(names):
        both = [_find(rows, id, "tactical_diameter_over_L") for id in ("turn_p35", "turn_m35")]
        if both[0] and both[1]:
            stbd, port = both[0][k], both[1][k]
            wider = "as wide to port as to starboard"
            if abs(stbd - port) > 0.005 * port:
                side = "starboard" if stbd > port else "port"
                wider = f"{percent(100.0 * abs(stbd - port) / min(stbd, port)).lstrip('+')} wider to {side}"
            parts.append(f"{name} turns {wider}")
    return "; ".join(parts) + "." if parts else "Tracks in lengths of each ship."


def _motions(names: tuple[str, str], manoeuvres: Mapping[str, Any]) -> Section:
    """Standard manoeuvres of both, each from her own approach."""
    runs = [motions.Run(key, name[-30:], _LOOKS[key]) for key, name in zip("ab", names, strict=True)]
    found = [
        motions.Manoeuvre(
            run_words(id),
            {key: {name: np.array(values, dtype=float) for name, values in of[key].items()} for key in of},
        )
        for id, of in manoeuvres["motions"].items()
    ]
    caption = "Standard manoeuvres of both, each from the approach her profile states."
    block = motion_block.of_manoeuvres(
        found, runs, (), caption, said="Tracks of standard manoeuvres.", L_pp=number(manoeuvres.get("L_pp"))
    )
    return Section("motions", "Tracks and time histories", (block,))


def _turns(names: tuple[str, str], tracks: Mapping[str, Any]) -> Figure:
    panels = []
    for angle in ("35", "10"):
        marks: list[Mark] = []
        for key in "ab":
            for id in (one for one in tracks if one.endswith(angle)):
                if key in tracks[id]:
                    marks.append(Line(tracks[id][key]["east"], tracks[id][key]["north"], _LOOKS[key]))
        x, y = Axis("east [L_pp]"), Axis("north [L_pp]")
        panels.append(Panel(tuple(marks), x, y, f"rudder ±{angle}°", 0.9, equal=True))
    return Figure("turns", "Turning circles of both profiles", tuple(panels), _legend(names))


def _forces(names: tuple[str, str], forces: Mapping[str, Any]) -> Figure:
    panels = []
    for name, key, words, of, parts in _FORCES:
        found = forces[name]
        for part in parts if found["a"] is not None else ():
            marks = tuple(Line(found[key], found[which][part], _LOOKS[which]) for which in "ab")
            panels.append(Panel(marks, Axis(words), Axis(), f"{part}′ [–], {of}"))
    return Figure("forces", "Hull and rudder forces of both profiles", tuple(panels), _legend(names), 3)


def _legend(names: tuple[str, str]) -> tuple[tuple[str, Look], ...]:
    return tuple((name, _LOOKS[key]) for key, name in zip("ab", names, strict=True))


def _indices(names: tuple[str, str], manoeuvres: Mapping[str, Any]) -> Table:
    rows = []
    for row in manoeuvres["indices"]:
        a, b = number(row["a"]), number(row["b"])
        moved = percent(100.0 * (b - a) / a) if a and b is not None else NONE
        rows.append(
            cells(
                run_words(row["manoeuvre"]),
                words_of(row["index"]),
                shown(a, 4),
                shown(b, 4),
                moved,
            )
        )
    return Table(
        "indices-table",
        "Indices of standard manoeuvres",
        ("manoeuvre", "index", *names, "change"),
        tuple(rows),
        numeric=(2, 3, 4),
    )


def _coefficients(names: tuple[str, str], rows: Sequence[Mapping[str, Any]]) -> Table | Prose:
    lines = []
    for row in rows:
        a, b, scatter = number(row["a"]), number(row["b"]), number(row["scatter"])
        if a == b:
            continue
        both = a is not None and b is not None and row["same_model"]
        away = f"{abs(b - a) / scatter:.1f}" if both and scatter and a is not None and b is not None else NONE
        lines.append(
            cells(
                clean(row["name"]),
                f"{clean(row['label'])} [{clean(row['unit'])}]",
                Cell(NONE if a is None else coefficient_text(a)),
                Cell(NONE if b is None else coefficient_text(b)),
                away,
            )
        )
    if not lines:
        return Prose(("All coefficients are the same.",))
    return Table(
        "coefficients-table",
        "Coefficients that differ; a dash where a profile has none such. Distance in scatters of the formula that "
        "one of them comes from, where its model is the same",
        ("name", "meaning", *names, "distance"),
        tuple(lines),
        numeric=(2, 3, 4),
    )


def _made(profiles: Sequence[Mapping[str, Any]]) -> Section:
    kinds = list(dict.fromkeys(kind for one in profiles for kind in one["models"]))
    rows = [
        cells("id", *(clean(one["id"]) for one in profiles)),
        *(cells(clean(kind), *(clean(one["models"].get(kind, NONE)) for one in profiles)) for kind in kinds),
        cells("assumptions", *(str(one["assumptions"]) for one in profiles)),
        cells("SHA-256", *(f"{clean(one['sha256'])[:16]}…" for one in profiles)),
    ]
    title = "What was compared"
    table = Table("profiles-table", title, ("what", *(clean(one["name"]) for one in profiles)), tuple(rows))
    return Section("profiles", "Profiles", (table,))


KIND = Kind("comparison", ("profiles", "coefficients", "forces", "manoeuvres"), ComparisonRecord, build)
