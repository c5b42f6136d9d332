"""The report of a prediction with bands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...how_far_off import mean
from ...run_files import BANDS, TRACKS
from .. import approaches, motion_block
from ..band_indices import banded, indices_table
from ..band_scores import MEANING, MEANING_OF_ONE, known_scores, score_cells
from ..blocks import Block, Card, Fold, Page, Prose, Section, Table, cells
from ..common import banner_of_sources, doubts, made_rows, picture
from ..figures import fans, motions
from ..figures.plot import LOOKS, Look
from ..load import Kind, columns_in
from ..tables import pairs
from ..wording import NONE, PRINCIPAL, clean, count, number, run_words, share, shown

if TYPE_CHECKING:
    from ...arrays import FloatArray

    Columns = Mapping[str, FloatArray]

DRAWN = 12
"""Runs that are drawn; of more trials those whose bands hold least."""

BAND = ("mean", "low", "q25", "q75", "high", "measured")


@dataclass(frozen=True)
class PredictRecord:
    """A prediction as its folder holds it: predict.json, bands.parquet, tracks.parquet.

    bands   run -> state -> column -> values in SI
    tracks  run -> of some particles x and y
    """

    folder: Path
    data: Mapping[str, Any]
    bands: Mapping[str, Mapping[str, Columns]]
    tracks: Mapping[str, Sequence[Columns]]

    @property
    def several(self) -> bool:
        """Whether there is a band."""
        return bool(self.data["has_band"])

    @property
    def level(self) -> float:
        """Percent that bands hold."""
        return float(self.data["level"])

    @property
    def runs(self) -> list[dict[str, Any]]:
        """Its runs."""
        return list(self.data["runs"])

    def drawn(self) -> list[dict[str, Any]]:
        """Those that are drawn."""
        runs = [run for run in self.runs if str(run["id"]) in self.bands]
        if len(runs) <= DRAWN:
            return runs
        held = {run["id"]: number((run["scores"] or {}).get("coverage_90")) or 0.0 for run in runs}
        worst = sorted(runs, key=lambda run: held[run["id"]])[:DRAWN]
        return [run for run in runs if run in worst]


def read(folder: Path, data: Mapping[str, Any]) -> PredictRecord:
    """The run with its bands and tracks."""
    bands = columns_in(folder / BANDS, ("run", "variable", "t", *BAND), ("run", "variable"))
    tracks = columns_in(folder / TRACKS, ("run", "particle", "x", "y"), ("run",))
    by_run: dict[str, dict[str, Columns]] = {}
    for (run, variable), rows in _grouped(bands, ("run", "variable")):
        by_run.setdefault(str(run), {})[str(variable)] = {name: bands[name][rows] for name in ("t", *BAND)}
    threads: dict[str, list[Columns]] = {}
    for (run, _), rows in _grouped(tracks, ("run", "particle")):
        threads.setdefault(str(run), []).append({name: tracks[name][rows] for name in ("x", "y")})
    return PredictRecord(folder, data, by_run, threads)


def _grouped(columns: Mapping[str, Any], by: tuple[str, str]) -> list[tuple[tuple[Any, Any], slice]]:
    """Neighbouring rows that agree in two columns."""
    first, second = (columns[name] for name in by)
    edges = [k for k in range(1, len(first)) if first[k] != first[k - 1] or second[k] != second[k - 1]]
    ends = [0, *edges, len(first)] if len(first) else [0]
    return [((first[a], second[a]), slice(a, b)) for a, b in pairwise(ends)]


def build(record: PredictRecord) -> Page:
    """Everything the report of a prediction says."""
    data = record.data
    sections = [_motions(record)] if record.drawn() else []
    whiskers = _whisker_rows(record)
    if whiskers:
        caption = f"Mean and band of {shown(record.level, 3)} % of each index." if record.several else "Each index."
        if any(row["measured"] is not None for of in whiskers.values() for row in of):
            caption += " Diamonds: as measured."
        drawn = picture(fans.indices(whiskers, record.level, record.several), "Indices", caption)
        sections.append(Section("indices", "Indices", (drawn,)))
    if data["scores"]:
        sections.append(_scores(record))
    for k, run in enumerate(record.drawn(), 1):
        sections.append(_run(record, run, k))
    rest = [run for run in record.runs if run not in record.drawn()]
    if rest:
        blocks = tuple(table for run in rest if (table := indices_table(run, record.level, record.several)))
        why = "those whose bands hold more, or that diverged" if record.several else "the last, or those that diverged"
        said = Prose((f"{count(len(rest), 'run')} are not drawn: {why}.",))
        sections.append(Section("rest", "Other runs", (said, *(blocks and (Fold("Indices", blocks),)))))
    sources = list({run["trial"]["source"] for run in record.runs if run["trial"]})
    members = count(data["particles"], "particle") if record.several else "one model, no band"
    return Page(
        title="Prediction",
        eyebrow=f"{clean(data['model']['id'])} · {members}",
        verdict=verdict(record),
        lead=_lead(record),
        banners=banner_of_sources(sources),
        warnings=(*(f"{clean(note)}." for note in data["notes"]), *doubts(data)),
        cards=_cards(record),
        sections=(*sections, _made(record)),
    )


def _lead(record: PredictRecord) -> tuple[str, ...]:
    """From which approach the numbers are, that none of them was measured, and what stands behind a ±."""
    ordered = all(run["trial"] is None for run in record.runs)
    simulated = "All numbers are simulated, none is measured."
    if not ordered:
        simulated = "Numbers are simulated but where they are called measured."
    band = ""
    if record.several:
        band = (
            f"± is half of the band that holds {shown(record.level, 3)} % of {record.data['particles']} particles, "
            "each of them one set of coefficients or one network that the ship may be like."
        )
    return tuple(filter(None, (approaches.sentence(record.runs, ordered), simulated, band)))


def verdict(record: PredictRecord) -> str:
    """How well bands hold what was measured; without trials, what is foretold of the first manoeuvres."""
    scores = record.data["scores"]
    if scores and number(scores["coverage_90"]) is not None:
        held, meant = scores["coverage_90"], min(0.9, scores["widest"])
        word = "too narrow" if held < meant - 0.05 else "wider than needed" if held > meant + 0.05 else "about right"
        return (
            f"The bands that are to hold {share(meant)} hold {share(held, counted=True)} of what was measured: "
            f"they are {word}. "
            f"Half of it is to lie in the inner ones, and {share(scores['coverage_50'], counted=True)} does."
        )
    said: list[str] = []
    for run in record.runs:
        for row in run["indices"]:
            if row["index"] in ("advance_m", "overshoot_1_deg") and len(said) < 3:
                values = row["over_L"] or row
                unit = "ship lengths" if row["over_L"] else row["unit"]
                name = "the advance" if row["over_L"] else "the first overshoot"
                which = clean(run["id"] if run["trial"] else run["order"])
                said.append(f"{which}: {name} is {banded(values)} {unit}")
    if not said and record.runs[0]["diverged"] < record.data["particles"]:
        run = record.runs[0]
        where = ", ".join(f"{row['words']} {banded(row)} {row['unit']}" for row in run["end"][:3])
        said.append(f"after {shown(run['duration_s'], 3)} s of {clean(run['order'])}: {where}")
    text = "; ".join(said) + "." if said else f"{count(len(record.runs), 'run')} foretold."
    return text[:1].upper() + text[1:]


def _cards(record: PredictRecord) -> tuple[Card, ...]:
    scores = record.data["scores"]
    cards = _off(record)
    if scores:
        for level in (50, 90):
            if number(scores[f"coverage_{level}"]) is not None:
                held = share(scores[f"coverage_{level}"], counted=True)
                note = f"of the measured samples; {level}\u00a0% is right"
                cards.append(Card(f"Held by bands of {level}\u00a0%", held, note=note))
        return tuple(cards[:4])
    for run in record.runs:
        for row in run["indices"]:
            if row["index"] in ("advance_m", "tactical_diameter_m", "overshoot_1_deg", "track_reach_m"):
                label = f"{row['words'].capitalize()}, {run_words(run['id'])}"
                lengths = f"{banded(row['over_L'])} ship lengths" if row["over_L"] else ""
                cards.append(Card(label, f"{banded(row)} {row['unit']}", note=lengths))
    return tuple(cards[:4])


def _off(record: PredictRecord) -> list[Card]:
    """How far the mean is off what was measured, over the runs that are drawn; none where nothing was."""
    squares: dict[str, list[float]] = {"place": [], "heading": []}
    for bands in record.bands.values():
        gaps = {name: of["mean"] - of["measured"] for name, of in bands.items() if name in ("x", "y", "psi")}
        place = gaps["x"] ** 2 + gaps["y"] ** 2
        if np.isfinite(place).any():
            squares["place"].append(float(np.sqrt(np.nanmean(place))))
            squares["heading"].append(float(np.degrees(np.sqrt(np.nanmean(gaps["psi"] ** 2)))))
    if not squares["place"]:
        return []
    place_off, heading_off = (mean(values) for values in squares.values())
    note = f"root mean square of each trial, mean of {count(len(squares['place']), 'trial')}"
    return [
        Card("The mean is off track by" if record.several else "Off track by", f"{shown(place_off, 3)} m", note=note),
        Card("Off heading by", f"{shown(heading_off, 2)}°", note=note),
    ]


def _whisker_rows(record: PredictRecord) -> dict[tuple[str, str], list[dict[str, Any]]]:
    """The principal indices of the runs that are drawn, by run and unit."""
    found: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for run in record.drawn():
        for row in run["indices"]:
            if row["index"] not in (*PRINCIPAL, "track_reach_m", "head_reach_m") or row["unit"] not in ("m", "deg"):
                continue
            values = row["over_L"] or row
            unit = "ship lengths" if row["over_L"] else row["unit"]
            several = (
                {"low": values["low"], "high": values["high"]} if record.several else dict.fromkeys(("low", "high"))
            )
            found.setdefault((clean(run["id"])[-36:], unit), []).append(
                {"label": row["words"], "mean": values["mean"], "measured": values["measured"], **several}
            )
    return found


def _motions(record: PredictRecord) -> Section:
    """Tracks and histories of the runs that are drawn, with their bands."""
    words = "mean" if record.several else "foretold"
    runs = [motions.Run("mean", words, Look("after", 1.9))]
    if any(run["trial"] is not None for run in record.drawn()):
        runs.insert(0, motions.Run("measured", "measured", LOOKS["measured"], True))
    manoeuvres = []
    for run in record.drawn():
        bands = record.bands[str(run["id"])]
        columns = ("mean", "measured") if run["trial"] is not None else ("mean",)
        own = {which: {"t": bands["x"]["t"], **{name: of[which] for name, of in bands.items()}} for which in columns}
        ends = {name: (of["low"], of["high"]) for name, of in bands.items()} if record.several else {}
        regions = run["marks"] if record.several else ()
        note = f"{clean(run['order'])}, {shown(run['duration_s'], 3)} s"
        manoeuvres.append(motions.Manoeuvre(clean(run["id"]), own, {"mean": ends}, regions, note))
    caption = "What is foretold."
    if record.several:
        caption = f"Bands and, along tracks, regions hold {shown(record.level, 3)} % of the particles."
    block = motion_block.of_manoeuvres(
        manoeuvres, runs, (), caption, L_pp=float(record.data["model"]["L_pp"]), title="Tracks and time histories"
    )
    return Section("motions", "Tracks and time histories", (block,))


def _run(record: PredictRecord, run: Mapping[str, Any], k: int) -> Section:
    bands, name = record.bands[str(run["id"])], clean(run["id"])
    trial = run["trial"] is not None
    mean = {axis: bands[axis]["mean"] for axis in ("x", "y")}
    measured = {axis: bands[axis]["measured"] for axis in ("x", "y")} if trial else None
    threads = record.tracks.get(str(run["id"]), ())
    L_pp = float(record.data["model"]["L_pp"])
    track = fans.track(f"track_{k}", f"Track of {name}", run["marks"], threads, mean, measured, L_pp, record.level)
    over_time = fans.motions(
        f"motions_{k}", f"Heading and velocities of {name} over time", bands, record.level, record.several
    )
    lost = f" {run['diverged']} of {record.data['particles']} particles diverged." if run["diverged"] else ""
    first = f"{clean(run['order'])}{approaches.in_caption(run)}, {shown(run['duration_s'], 3)} s.{lost}"
    if record.several:
        first += (
            f" Regions hold half and {shown(record.level, 3)} % of the positions at a time, "
            "as mean and covariance of the particles have it."
        )
    blocks: list[Block] = [
        picture(track, "Track", first),
        picture(over_time, "Motions", "Heading, velocities and yaw rate over time."),
    ]
    table = indices_table(run, record.level, record.several)
    if table:
        blocks.append(table)
    return Section(f"run-{k}", name, tuple(blocks))


def _scores(record: PredictRecord) -> Section:
    scores = record.data["scores"]
    blocks: list[Block] = []
    if record.several:
        calibration = scores["calibration"]
        drawn = fans.calibration(calibration["nominal"], {record.data["model"]["name"]: calibration["covered"]})
        caption = (
            "Below the diagonal bands are too narrow, above it wider than needed; all states and samples together."
        )
        blocks.append(picture(drawn, "Calibration", caption))
    blocks.append(_scores_table(record, scores))
    blocks.append(Prose((MEANING if record.several else MEANING_OF_ONE,)))
    return Section("scores", "Scores", tuple(blocks))


def _scores_table(record: PredictRecord, whole: Mapping[str, Any]) -> Table:
    """Scores of each run and of all, those that there are."""
    rows = [[clean(run["id"]), *score_cells(run["scores"])] for run in record.runs if run["scores"]]
    rows.append(["all", *score_cells(whole)])
    heads, kept = known_scores(rows, 1)
    caption = "Whether the bands held what was measured" if record.several else "How far off what was measured"
    lines = tuple(cells(*row) for row in kept)
    return Table("scores-table", caption, ("run", *heads), lines, numeric=range(1, 1 + len(heads)))


def _made(record: PredictRecord) -> Section:
    data = record.data
    model = data["model"]
    drawn = "drawn" if data["drawn"] else "the members the model has"
    items = [
        ("model", f"{clean(model['name'])}; {clean(model['method'])}"),
        ("profile's hash (SHA-256)", clean(model["sha256"] or NONE)),
        *([("particles", f"{data['particles']}, {drawn}")] if record.several else []),
        *made_rows(data),
    ]
    hashes = [(clean(run["id"]), clean(run["trial"]["sha256"])) for run in record.runs if run["trial"]]
    folded = (Fold("Hashes of the trials", (pairs("hashes-table", "Hashes", ("trial", "SHA-256"), hashes),)),)
    return Section(
        "made",
        "How it was made",
        (pairs("made-table", "What it was made from", ("what", "value"), items), *(hashes and folded)),
    )


KIND = Kind("predict", ("model", "runs", "particles", "has_band", "level", "scores", "provenance"), read, build)
