"""The report of a validation on voyages, put together."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...arrays import FloatArray
from ...run_files import DRAWN_WINDOWS, WINDOWS
from ...units import shown_in
from .. import advice, measures, motion_block
from ..band_scores import bands_section
from ..blocks import Card, Cell, Commands, Fold, Page, Prose, Section, Table, cells
from ..common import doubts, generated_banner, picture, provenance_section
from ..figures import motions
from ..figures import voyages_figures as figures
from ..figures.plot import LOOKS, model_look
from ..load import Kind, columns_in
from ..wording import NONE, clean, count, input_channel, number, percent, share, shown

PANELS = 8
"""Features drawn at most; all are in the tables."""

_CVDM = (
    "cVDM, a distance measure of Mathioudakis et al., adds up how far off a simulated window is in the mean: "
    "in position as a share of the path sailed, in heading as a share of a half turn, in velocities and yaw rate "
    "as shares of the ship's own; 0 % is perfect."
)
"""What the headline speaks of, where it is first read."""

PAPER_RUDDER = 10.0
"""Rudder angle [deg] near which Mathioudakis et al. found the largest errors."""

_STATES = ("t", "x", "y", "psi", "u", "v_m", "r", "delta")


@dataclass(frozen=True)
class VoyagesRecord:
    """A validation on voyages as its folder holds it.

    data     voyages.json
    cVDM     (n_windows,) by model, from windows.parquet
    drawn    window -> its motions, "" as measured, else by model: columns by name
    """

    folder: Path
    data: Mapping[str, Any]
    cVDM: Mapping[str, FloatArray]
    drawn: Mapping[str, Mapping[str, Mapping[str, FloatArray]]]

    @property
    def models(self) -> list[dict[str, Any]]:
        """The models, in the order they were given."""
        return list(self.data["models"])

    @property
    def names(self) -> list[str]:
        """What they were called."""
        return [str(one["profile"]) for one in self.models]


def build(record: VoyagesRecord) -> Page:
    """Everything the report of a validation on voyages says."""
    data = record.data
    scored = bool(data["n_windows"])
    sections = [
        _windows(record) if scored else None,
        _classes(record) if scored else None,
        _measures(record) if scored else None,
        bands_section(record.models, "windows evenly among all"),
        _compared(data) if data.get("comparisons") else None,
        _where(record) if scored else None,
        _logs(data),
        Section("next", "What to do next", (Commands(advice.after_voyages(data)),)) if scored else None,
        _how(data),
        _provenance(data),
    ]
    ship = clean((data.get("trials") or {}).get("ship") or record.names[0])
    return Page(
        title=f"{ship}: models on voyages",
        eyebrow=f"{ship} · {count(len(record.names), 'model')} on {count(len(data['logs']), 'voyage')}, "
        f"{count(int(data['n_windows']), 'window')} of {shown(data['window_s'], 4)} s",
        verdict=clean(data["verdict"]),
        lead=(_CVDM,) if scored else (),
        banners=generated_banner(data["trials"]),
        warnings=_warnings(data),
        cards=_cards(record) if scored else (),
        sections=tuple(section for section in sections if section is not None),
    )


def _warnings(data: Mapping[str, Any]) -> tuple[str, ...]:
    found = []
    if data.get("interrupted"):
        done = sum(bool(log.get("complete")) for log in data["logs"])
        found.append(
            f"Stopped by the user after {done} of {data['n_logs']} voyages: this is of the windows scored by then."
        )
    if data.get("shorter"):
        names = ", ".join(clean(name) for name in data["shorter"][:6])
        found.append(f"{count(len(data['shorter']), 'file')} no longer than a trial, cut like the voyages: {names}.")
    found += [f"{clean(one['profile'])}: {clean(note)}." for one in data["models"] for note in one.get("notes", ())]
    found += [f"{clean(one['profile'])}: {words}" for one in data["models"] for words in doubts(one)]
    return tuple(found)


def _cards(record: VoyagesRecord) -> tuple[Card, ...]:
    first = record.models[0]
    name = figures.cut(first["profile"], 28)
    off, whole = first["measures"]["MED"], first["measures"]["cVDM"]
    note = f"median; half of the windows between {shown(off['q25'], 3)} and {shown(off['q75'], 3)} m"
    cards = [Card(f"Off track, {name}", f"{shown(off['median'], 3)} m", note=note)]
    if len(record.models) > 1:
        other = record.models[1]["measures"]["MED"]
        words = f"Off track, {figures.cut(record.models[1]['profile'], 28)}"
        cards.append(Card(words, f"{shown(other['median'], 3)} m", note="median of the windows"))
    names = record.data["classes"]["names"]
    good = sum(first["classes"][one] for one in names[:2])
    total = good / max(1, sum(first["classes"].values()))
    note = f"of the windows, {name}; median cVDM {_percent(whole['median'])}"
    cards.append(Card("Optimal or satisfactory", share(total, counted=True), note=note))
    most = first["where"][0] if first.get("where") else None
    if most is not None:
        note = f"{share(most['explained'])} of the variance of log cVDM"
        cards.append(Card("Tells most of the error", clean(most["words"]), note=note))
    return tuple(cards)


def _classes(record: VoyagesRecord) -> Section:
    data = record.data
    classes, limits = data["classes"]["names"], data["classes"]["cVDM_limits"]
    counts = [[int(one["classes"][name]) for name in classes] for one in record.models]
    drawn = figures.classes_figure(record.names, counts, classes)
    rows = [
        cells(clean(one["profile"]), *(shown(one["classes"][name], 7) for name in classes), shown(one["diverged"], 7))
        for one in record.models
    ]
    table = Table(
        "classes-table",
        "Windows of each class",
        ("model", *classes, "of these diverged"),
        tuple(rows),
        numeric=range(1, 5),
    )
    caption = (
        f"Optimal is a cVDM of up to {shown(limits[0], 3)} %, satisfactory of up to {shown(limits[1], 3)} %; a window "
        "that diverged is sub-optimal."
    )
    return Section("classes", "Classes", (picture(drawn, "Classes", caption, table), *_limits(limits)))


def _limits(limits: Sequence[float]) -> tuple[Prose, ...]:
    if [float(limit) for limit in limits] != [1.3, 4.1]:
        return ()
    said = (
        "The source of these classes (Mathioudakis et al.) names examples, not limits: optimal 0.8 and 0.9, "
        "satisfactory 1.7 and 2.3, sub-optimal 5.9 and 8.7. The limits lie midway between them. Noise of the "
        "sensors is in every cVDM: a window of a perfect model is not at zero."
    )
    return (Prose((said,)),)


def _measures(record: VoyagesRecord) -> Section:
    data = record.data
    classes, limits = data["classes"]["names"], data["classes"]["cVDM_limits"]
    drawn = figures.distributions(record.cVDM, limits, classes)
    rows = []
    for one in record.models:
        for name, row in one["measures"].items():
            numbers = [shown(row[key], 3) for key in ("mean", "q05", "q25", "median", "q75", "q95")]
            rows.append(cells(clean(one["profile"]), measures.with_unit(clean(name)), *numbers))
    table = Table(
        "measures-table",
        "Seven distance measures over all windows: mean, and the values that 5, 25, 50, 75 and 95 % stay below",
        ("model", "measure", "mean", "5 %", "25 %", "median", "75 %", "95 %"),
        tuple(rows),
        numeric=range(2, 8),
        about=measures.about(list(record.models[0]["measures"])),
    )
    scores = Table(
        "scores-table",
        "J and the standardised error over all windows",
        ("model", "simulated by", "J", "L_MSE"),
        tuple(
            cells(clean(one["profile"]), clean(one["method"]), shown(one["J"]), shown(one["L_MSE"]))
            for one in record.models
        ),
        numeric=(2, 3),
        about=(("J [–]", measures.J), ("L_MSE [–]", measures.L_MSE)),
    )
    caption = (
        "A curve further left is the better model; dashed: the limits of the classes, which the strip on top shows."
    )
    return Section(
        "measures",
        "How far off",
        (
            picture(drawn, "Distribution of cVDM", caption),
            Fold("Seven measures: the numbers", (table,)),
            scores,
        ),
    )


def _compared(data: Mapping[str, Any]) -> Section:
    anew = clean(data.get("drawn_anew") or "")
    rows = []
    for one in data["comparisons"]:
        interval = one.get("cVDM_difference_ci95")
        difference = number(one.get("cVDM_difference"))
        tone = "" if not interval or interval[0] <= 0.0 <= interval[1] else "bad" if interval[0] > 0.0 else "good"
        rows.append(
            cells(
                f"{clean(one['second'])} against {clean(one['first'])}",
                share(one.get("share_second_better"), counted=True),
                Cell(_signed(difference), tone),
                f"{_signed(interval[0])} to {_signed(interval[1])}" if interval else NONE,
                shown(one["windows"], 7),
            )
        )
    table = Table(
        "comparison-table",
        "Pairs of models on the same windows, by cVDM",
        ("models", "better in", "mean difference of cVDM", "95 % interval", "windows"),
        tuple(rows),
        numeric=range(1, 5),
    )
    said = (
        f"Intervals by drawing {anew} anew: windows that follow each other are alike. Below zero, the model is better."
    )
    return Section("comparison", "Model against model", (table, Prose((said,))))


def _where(record: VoyagesRecord) -> Section | None:
    first = record.models[0]
    if not first["where"]:
        return Section("where", "Where the error lives", (Prose(("Too few windows to say.",)),))
    panels = [_panel(record, row) for row in first["where"][:PANELS]]
    explained = Table(
        "explained-table",
        "Share of the variance of log cVDM between the bins of each feature, less what chance gives that many bins",
        ("feature", *(clean(name) for name in record.names)),
        tuple(
            cells(clean(row["words"]), *(_explained(one, row["feature"]) for one in record.models))
            for row in first["where"]
        ),
        numeric=range(1, 1 + len(record.names)),
    )
    rudder = next((row for row in first["where"] if row["feature"] == "rudder"), None)
    blocks: list[Any] = [
        picture(figures.where(panels), "Where the error lives", _where_caption(record.data), explained),
    ]
    if rudder is not None:
        unit, factor = shown_in(rudder["unit"])
        labels = [figures.bin_label(one, factor) for one in rudder["bins"]]
        parts = {name: [number(one["parts"].get(name)) or 0.0 for one in rudder["bins"]] for name in figures.PARTS}
        drawn = figures.parts_figure(labels, parts, f"{rudder['words']} [{unit}]")
        caption = f"Parts of cVDM of {figures.cut(first['profile'], 40)}. {_paper(first)}"
        blocks.append(picture(drawn, "Parts of the error by rudder angle", caption))
    tables = tuple(_bins(one) for one in record.models)
    blocks.append(Fold("Every bin: the numbers", tables))
    return Section("where", "Where the error lives", tuple(blocks))


def _where_caption(data: Mapping[str, Any]) -> str:
    anew = clean(data.get("drawn_anew") or "windows")
    moves = number(data["classes"].get("rudder_moves_from_rad"))
    factor = shown_in("rad")[1]
    said = (
        "In each title the share of the variance of log cVDM that the feature tells, to either side alike; below each "
        "bin the number of windows; bars: 95 % intervals, "
        f"{anew} drawn anew. Features go together (a rudder put over slows the ship), so none is a cause by itself."
    )
    return said + (
        f" The rudder moves where its angle ranges over {shown(moves * factor, 2)} deg or more." if moves else ""
    )


def _paper(one: Mapping[str, Any]) -> str:
    """The finding of the paper, seen or not: largest near 10 deg, larger while the rudder moves."""
    factor = shown_in("rad")[1]
    said = []
    by = {row["feature"]: row["bins"] for row in one["where"]}
    known = [row for row in by.get("rudder", ()) if number(row["cVDM_mean"]) is not None]
    if len(known) > 1:
        worst = max(known, key=lambda row: float(row["cVDM_mean"]))
        low, high = (number(worst[end]) for end in ("low", "high"))
        near = (low or 0.0) * factor <= PAPER_RUDDER < (high * factor if high is not None else 1e9)
        where = figures.bin_label(worst, factor)
        said.append(
            f"The mean is largest at {where} deg of rudder ({shown(worst['cVDM_mean'], 3)} %), "
            + ("as Mathioudakis et al. found" if near else f"not near the {PAPER_RUDDER:g} deg of Mathioudakis et al.")
        )
    moving = {row["name"]: number(row["cVDM_mean"]) for row in by.get("rudder_range", ())}
    if moving.get("moving") and moving.get("steady"):
        ratio = moving["moving"] / moving["steady"]  # type: ignore[operator]
        said.append(f"while the rudder moves it is {shown(ratio, 3)} times that of a steady one")
    return "; ".join(said) + "." if said else ""


def _panel(record: VoyagesRecord, row: Mapping[str, Any]) -> dict[str, Any]:
    """One feature as it is drawn: bins of the first model, and what every model has there."""
    unit, factor = shown_in(row["unit"])
    named = bool(row["bins"][0].get("name"))
    models: dict[str, list[tuple[float | None, float | None, float | None]]] = {}
    for one in record.models:
        own = next((other for other in one["where"] if other["feature"] == row["feature"]), None)
        by_ends = {(b["low"], b["high"]): b for b in own["bins"]} if own else {}
        models[str(one["profile"])] = [_point(by_ends.get((b["low"], b["high"]))) for b in row["bins"]]
    title = clean(row["words"]) + ("" if named else f" [{unit}]")
    return {
        "title": f"{_brief(title)}: {share(number(row['explained']) or 0.0)}",
        "labels": [figures.bin_label(one, factor) for one in row["bins"]],
        "counts": [shown(one["windows"], 7) for one in row["bins"]],
        "models": models,
    }


def _brief(title: str) -> str:
    """A feature in the room of a panel's title."""
    return title.replace(" to either side", "")


def _point(one: Mapping[str, Any] | None) -> tuple[float | None, float | None, float | None]:
    if one is None:
        return None, None, None
    low, high = one.get("cVDM_ci95") or (None, None)
    return number(one["cVDM_mean"]), number(low), number(high)


def _explained(one: Mapping[str, Any], feature: str) -> str:
    row = next((other for other in one["where"] if other["feature"] == feature), None)
    return share(row["explained"]) if row else NONE


def _bins(one: Mapping[str, Any]) -> Table:
    rows = []
    for row in one["where"]:
        unit, factor = shown_in(row["unit"])
        for b in row["bins"]:
            unit_words = "" if b.get("name") else f" {unit}"
            interval = b.get("cVDM_ci95")
            rows.append(
                cells(
                    clean(row["words"]),
                    f"{figures.bin_label(b, factor)}{unit_words}",
                    shown(b["windows"], 7),
                    shown(b["diverged"], 7),
                    shown(b["cVDM_mean"], 3),
                    f"{shown(interval[0], 3)} to {shown(interval[1], 3)}" if interval else NONE,
                    shown(b["cVDM_median"], 3),
                    *(shown(b["parts"].get(part), 2) for part in figures.PARTS),
                )
            )
    return Table(
        f"bins-{abs(hash_of(one['profile']))}",
        f"{clean(one['profile'])}: cVDM [%] and the means of its parts, by bin",
        ("feature", "bin", "windows", "diverged", "mean", "95 % interval", "median", *figures.PARTS),
        tuple(rows),
        numeric=range(2, 7 + len(figures.PARTS)),
    )


def hash_of(text: Any) -> int:
    """A number for an id, the same in every process."""
    return zlib.crc32(str(text).encode("utf-8", "replace"))


def _windows(record: VoyagesRecord) -> Section | None:
    rows = [row for row in record.data["drawn"] if "" in record.drawn.get(str(row["window"]), {})]
    if not rows:
        return None
    first = record.names[0]
    runs = [motions.Run("", "measured", LOOKS["measured"], True)]
    runs += [motions.Run(name, figures.cut(name, 30), model_look(k)) for k, name in enumerate(record.names)]
    manoeuvres = []
    for row in rows:
        note = ", ".join(f"{figures.cut(name, 30)} {_percent(row['cVDM'].get(name))}" for name in record.names)
        title = f"{clean(row['role'])}: {clean(row['window'])}"
        manoeuvres.append(motions.Manoeuvre(title, record.drawn[str(row["window"])], note=f"cVDM: {note}"))
    table = Table(
        "drawn-table",
        "The windows drawn: id (voyage and second it begins at) and cVDM",
        ("window", "role", *(clean(name) for name in record.names)),
        tuple(
            cells(clean(row["window"]), row["role"], *(_percent(row["cVDM"].get(name)) for name in record.names))
            for row in rows
        ),
        numeric=range(2, 2 + len(record.names)),
    )
    caption = f"Windows with the smallest, the median and the largest cVDM of {figures.cut(first, 40)}."
    inputs = (input_channel("delta", "rudder angle", "rad"),)
    block = motion_block.of_manoeuvres(
        manoeuvres, runs, inputs, caption, L_pp=number(record.models[0].get("L_pp")), data=(table,), title="Windows"
    )
    return Section("windows", "Windows", (block,))


def _logs(data: Mapping[str, Any]) -> Section:
    rows = []
    for log in data["logs"]:
        left = log["rows_left_out"]
        rows.append(
            cells(
                clean(log["id"]),
                clean(log["source"] or "not stated"),
                shown(log["hours"], 4),
                shown(log["rows"], 9),
                shown(log["windows"], 7),
                shown(log["windows_at_rest"], 7),
                *(shown(value, 9) for value in left.values()),
                shown(log["rows_with_gaps"], 9),
            )
        )
    reasons = list(data["logs"][0]["rows_left_out"]) if data["logs"] else []
    table = Table(
        "voyages-table",
        "The voyages, their windows, and rows left out by reason",
        (
            "voyage", "data", "hours", "rows", "windows", "at rest",
            *(f"rows: {reason}" for reason in reasons), "rows in windows with a gap",
        ),
        tuple(rows),
        numeric=range(2, 7 + len(reasons)),
    )  # fmt: skip
    return Section("voyages", "Voyages", (table,))


def _how(data: Mapping[str, Any]) -> Section:
    r_max = data["r_max"]
    unit, factor = shown_in("rad/s")
    rate = number(r_max["rad_per_s"])
    windows = (
        f"Windows of {shown(data['window_s'], 4)} s, each begun anew from its measured state. One begins where the one "
        f"before it ends; a gap of more than {shown(data['gap_s'], 3)} s, or an input that is not known, ends it."
    )
    origin = (
        "PMD and PED divide by the measured coordinates as they are in the log, so they depend on where its origin "
        "is: compare them only between models on the same log."
    )
    said = [
        windows,
        f"cVDM is relative to a yaw rate of {shown(rate * factor, 3)} {unit} ({clean(r_max['from'])})."
        if rate is not None
        else "No largest yaw rate is known, so there is no cVDM.",
        origin,
        f"L_MSE divides by the spread of each state in {clean(data['sigma_from'])}.",
    ]
    return Section("how", "How this was counted", (Prose(tuple(said), listed=True),))


def _provenance(data: Mapping[str, Any]) -> Section:
    trials = data["trials"]
    items = [
        ("voyages", trials.get("path")),
        ("licence of the voyages", trials.get("licence")),
        ("to be cited for the voyages", trials.get("citation")),
    ]
    for name, facts in (data.get("profiles") or {}).items():
        items.append((f"profile {clean(name)}", facts.get("source")))
        items.append((f"profile {clean(name)}, hash (SHA-256)", facts.get("sha256")))
        items.append((f"profile {clean(name)}, licence of the data it was tuned to", facts.get("licence")))
    return provenance_section(data, items, "voyage")


def _percent(value: Any) -> str:
    size = number(value)
    return NONE if size is None else f"{shown(size, 3)}\u00a0%"


def _signed(value: Any) -> str:
    size = number(value)
    return NONE if size is None else percent(size)


def _read(folder: Path, data: Mapping[str, Any]) -> VoyagesRecord:
    if not data["n_windows"]:
        return VoyagesRecord(folder, data, {}, {})
    rows = columns_in(folder / WINDOWS, ("model", "cVDM"), texts=("model",))
    names = [str(one["profile"]) for one in data["models"]]
    cVDM = {name: rows["cVDM"][rows["model"] == name] for name in names}
    drawn: dict[str, dict[str, dict[str, FloatArray]]] = {}
    found = columns_in(folder / DRAWN_WINDOWS, ("window", "model", *_STATES), texts=("window", "model"))
    for window in dict.fromkeys(found["window"].tolist()):
        of = found["window"] == window
        for model in dict.fromkeys(found["model"][of].tolist()):
            both = of & (found["model"] == model)
            drawn.setdefault(str(window), {})[str(model)] = {name: found[name][both] for name in _STATES}
    return VoyagesRecord(folder, data, cVDM, drawn)


KIND = Kind(
    "voyages",
    (
        "trials",
        "models",
        "logs",
        "n_windows",
        "verdict",
        "classes",
        "r_max",
        "window_s",
        "gap_s",
        "drawn",
        "sigma_from",
    ),
    _read,
    build,
)
