"""The report of models of any kind on the same trials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import advice, motion_block
from ..band_scores import MEANING, SCORE_HEADS, known_scores, score_cells
from ..blocks import Block, Card, Cell, Commands, Fold, Page, Prose, Section, Table, cells
from ..common import banner_of_sources, made_rows, picture, sources_rows
from ..figures import fans, motions
from ..figures.plot import LOOKS, Axis, Dots, Figure, Line, Look, Mark, Panel, model_look
from ..load import Kind, inputs_of, motions_in
from ..tables import pairs
from ..wording import CHANNELS, Channel, clean, count, listing, model_names, number, shown

if TYPE_CHECKING:
    from ...arrays import FloatArray

    Motion = Mapping[str, FloatArray]

_ERROR = (
    "L_MSE is the mean over time of the sum over all six states of squared differences over their variance (Wakita et "
    "al. 2022, eq. 26): 0 is perfect."
)
_OF_NETWORKS = (
    " Mean and standard deviation over the networks of a model, each begun from a seed of its own. A model of which a "
    "network diverged has no mean there: the others alone would flatter it."
)
_BESIDE = " In brackets the ratio to the first model. The best of a column is marked."


@dataclass(frozen=True)
class ModelsRecord:
    """A comparison of models as its folder holds it: model_comparison.json, motions.parquet."""

    folder: Path
    data: Mapping[str, Any]
    motions: Mapping[str, Mapping[str, Motion]]
    inputs: Sequence[Channel]

    @property
    def names(self) -> list[str]:
        """What the models were called."""
        return model_names([one["name"] for one in self.data["models"]])

    @property
    def models(self) -> list[dict[str, Any]]:
        """The models, in the order they were given, with what the page calls them."""
        return [{**one, "called": name} for one, name in zip(self.data["models"], self.names, strict=True)]

    @property
    def conventions(self) -> dict[str, str]:
        """Both ways of restarting in words."""
        return {
            "windows": f"begun anew every {shown(self.data['window_s'], 3)} s",
            "whole": "begun once in each whole run",
        }

    @property
    def several(self) -> bool:
        """Whether one of the models is several networks, each begun from a seed of its own."""
        return any(one["members"] > 1 for one in self.models)

    def columns(self, runs: bool) -> list[tuple[int, Mapping[str, Any]]]:
        """Places and facts of the columns: those of single runs, or the others."""
        return [(k, one) for k, one in enumerate(self.data["columns"]) if (one["run"] is not None) == runs]


def build(record: ModelsRecord) -> Page:
    """Everything the report of a comparison of models says."""
    data = record.data
    sections = [
        Section(f"{key}-scores", f"Models {words}", tuple(_tables(record, key)))
        for key, words in record.conventions.items()
    ]
    over = "mean and standard deviation over the networks; " if record.several else ""
    caption = f"L_MSE by kind of manoeuvre: {over}the number of runs below."
    meaning = _ERROR + (_OF_NETWORKS if record.several else "") + _BESIDE
    sections.insert(0, Section("errors", "Errors", (picture(_figure(record), "Errors", caption), Prose((meaning,)))))
    if record.motions:
        sections.insert(0, _motions(record))
    if "bands" in data["models"][0]["windows"][0]:  # records of older versions have none
        sections.append(_bands(record))
    lost = _lost(record)
    if lost:
        sections.insert(
            1 + bool(record.motions),
            Section("diverged", "What diverged", (Prose(tuple(lost), listed=True, tone="warning"),)),
        )
    return Page(
        title="Models compared",
        eyebrow=f"{clean(data['trials']['ship']) or 'ship not stated'} · models on {clean(data['trials']['name'])}",
        verdict=verdict(record),
        banners=banner_of_sources(data["trials"]["sources"]),
        warnings=tuple(clean(text) for text in data.get("notes") or ()),
        cards=_cards(record),
        sections=(*sections, Section("next", "What to do next", (Commands(advice.after_models(data)),)), _made(record)),
    )


def verdict(record: ModelsRecord) -> str:
    """The best model begun anew, and begun once; of the same model its name once."""
    said, named = [], ""
    for key, words in record.conventions.items():
        best = next((one for one in record.models if one["name"] == record.data["columns"][0]["best"][key]), None)
        if best is None:
            said.append(f"{words}, every model diverged somewhere")
            continue
        place, heading = (number(best[key][0].get(name)) for name in ("position_rms_m", "heading_rms_deg"))
        off = f"L_MSE {shown(best[key][0]['mean'], 3)}"
        if place is not None:  # records of older versions do not say
            off = f"{shown(place, 3)} m and {shown(heading, 2)}° off"
        again = named == best["called"]
        said.append(f"{words} too: {off}" if again else f"{words}, {best['called']} errs least: {off}")
        named = best["called"]
    return f"Over all runs, {'; '.join(said)}."


def _cards(record: ModelsRecord) -> tuple[Card, ...]:
    """The models that do best on all runs, begun anew."""
    known = [one for one in record.models if number(one["windows"][0]["mean"]) is not None]
    cards = []
    for model in sorted(known, key=lambda one: float(one["windows"][0]["mean"]))[:4]:
        found = model["windows"][0]
        place, heading = number(found.get("position_rms_m")), number(found.get("heading_rms_deg"))
        score = f"L_MSE {_mean(found, model['members'])}"
        window = f"all runs, anew every {shown(record.data['window_s'], 3)} s"
        if place is None:  # records of older versions do not say
            cards.append(Card(f"Off, {model['called']}", score, note=window))
        else:
            off = f"{shown(place, 3)} m, {shown(heading, 2)}°"
            cards.append(Card(f"Off, {model['called']}", off, note=f"{score}; {window}"))
    return tuple(cards)


def _tables(record: ModelsRecord, convention: str) -> list[Table]:
    found = []
    for runs, id, words in ((False, "kinds", "by kind of manoeuvre"), (True, "runs", "run by run")):
        columns = record.columns(runs)
        if not columns:
            continue
        rows = []
        for model in record.models:
            row: list[str | Cell] = [model["called"], *([str(model["members"])] if record.several else [])]
            for k, column in columns:
                text = _mean(model[convention][k], model["members"])
                if number(model[convention][k]["ratio"]) is not None:
                    text += f" ({shown(model[convention][k]['ratio'], 3)})"
                best = column["best"][convention] == model["name"]
                bad = "bad" if model[convention][k]["diverged"] else ""
                row.append(Cell(f"{text} *" if best else text, "good" if best else bad))
            rows.append(cells(*row))
        heads = [f"{clean(one['name'])}, {count(one['runs'], 'run')}" for _, one in columns]
        caption = f"L_MSE {words}, {record.conventions[convention]}; * the best of a column"
        first = ("model", "networks") if record.several else ("model",)
        numeric = range(1, len(first) + len(columns))
        found.append(Table(f"{convention}-{id}-table", caption, (*first, *heads), tuple(rows), numeric=numeric))
    return found


def _bands(record: ModelsRecord) -> Section:
    """Whether the bands of the models held what was measured."""
    blocks: list[Block] = []
    several = [one for one in record.models if one["particles"] > 1]
    if several:
        nominal = several[0]["windows"][0]["bands"]["calibration"]["nominal"]
        covered = {one["name"]: one["windows"][0]["bands"]["calibration"]["covered"] for one in several}
        caption = f"All runs, {record.conventions['windows']}: below the diagonal bands are too narrow."
        blocks.append(picture(fans.calibration(nominal, covered), "Calibration", caption))
    for key, words in record.conventions.items():
        rows = []
        for k, column in record.columns(False):
            for model in record.models:
                of = model[key][k]["bands"]
                best = column["best_CRPS"][key] == model["name"]
                texts: list[str | Cell] = [clean(column["name"]), str(of["particles"]), *score_cells(of)]
                at = 2 + SCORE_HEADS.index("CRPS")
                texts[at] = Cell(f"{texts[at]} *", "good") if best else texts[at]
                rows.append([model["called"], *texts])
        scores, kept = known_scores(rows, 3)
        heads = ("model", "manoeuvre", "particles", *scores)
        caption = f"Bands, {words}; * the least CRPS"
        numeric = range(2, len(heads))
        blocks.append(Table(f"{key}-bands-table", caption, heads, tuple(cells(*row) for row in kept), numeric=numeric))
    blocks.append(Prose((MEANING,)))
    return Section("bands", "Bands", tuple(blocks))


def spread_words(name: str, value: Any) -> tuple[str, str]:
    """What errors of a state are counted in, as people read it."""
    of, size = CHANNELS.get(name), number(value)
    if of is None or size is None:
        return f"spread of {name}", f"{shown(value, 4)} (SI)"
    return f"spread of {of.words}", f"{shown(size * of.factor, 4)} {of.unit}"


def _mean(cell: Mapping[str, Any], members: int) -> str:
    if cell["diverged"]:
        return "diverged" if members == 1 else f"{cell['diverged']} of {members} diverged"
    deviation = number(cell["deviation"])
    return shown(cell["mean"], 3) + (f" ± {shown(deviation, 2)}" if deviation is not None else "")


def _lost(record: ModelsRecord) -> list[str]:
    found = []
    for model in record.models:
        for key, words in record.conventions.items():
            columns = [(k, one) for k, one in enumerate(record.data["columns"]) if k and model[key][k]["diverged"]]
            if columns:
                where = listing(
                    [f"{clean(one['name'])} ({model[key][k]['diverged']} of {model['members']})" for k, one in columns],
                    8,
                )
                found.append(f"{model['called']}, {words}: {where}.")
    return found


def _motions(record: ModelsRecord) -> Section:
    """Whole trials as measured, and as each model makes them from the first state."""
    runs = [motions.Run("measured", "measured", LOOKS["measured"], True)]
    runs += [
        motions.Run(str(one["name"]), one["called"], replace(model_look(k), marker="o"))
        for k, one in enumerate(record.models)
    ]
    caption = "Whole trials from the first measured state, with the measured inputs" + (
        "; of several networks the first." if record.several else "."
    )
    block = motion_block.of_manoeuvres(
        [motions.Manoeuvre(clean(id), found) for id, found in record.motions.items()],
        runs, record.inputs, caption, said="Tracks as measured and as the models make them.",
        L_pp=number(record.data.get("L_pp")), notes=(motion_block.FULL,),
    )  # fmt: skip
    return Section("motions", "Tracks and time histories", (block,))


def _figure(record: ModelsRecord) -> Figure:
    columns = record.columns(False)
    width = 0.7 / max(len(record.names), 1)
    panels = []
    several = any(number(cell["mean"]) for model in record.models for key in record.conventions for cell in model[key])
    for key, words in record.conventions.items():
        marks: list[Mark] = []
        for j, model in enumerate(record.models):
            for i, (k, _) in enumerate(columns):
                cell = model[key][k]
                if number(cell["mean"]) is None:
                    continue
                x, half = i + (j - 0.5 * (len(record.names) - 1)) * width, _below(cell)
                marks.append(Line((x, x), (cell["mean"] - half, cell["mean"] + half), Look(_looks(j).color, 1.4)))
                marks.append(Dots((x,), (cell["mean"],), _looks(j)))
        ticks = tuple((float(i), f"{clean(one['name'])[:12]}\n{one['runs']}") for i, (_, one) in enumerate(columns))
        x_axis = Axis(low=-0.5, high=len(columns) - 0.5, ticks=ticks, grid=False)
        panels.append(Panel(tuple(marks), x_axis, Axis("L_MSE [–]", log=several), words, 0.75))
    legend = tuple((model["called"][-40:], _looks(j)) for j, model in enumerate(record.models))
    return Figure("errors", "L_MSE of the models by kind of manoeuvre", tuple(panels), legend)


def _looks(place: int) -> Look:
    """Points of the model at that place."""
    return replace(model_look(place), width=0.0, size=6.0)


def _below(cell: Mapping[str, Any]) -> float:
    """Half the length of a bar, which must not reach 0 on a logarithmic axis."""
    return min(number(cell["deviation"]) or 0.0, 0.95 * float(cell["mean"]))


def _made(record: ModelsRecord) -> Section:
    data = record.data
    trials = data["trials"]
    models = pairs(
        "models-table",
        "Models",
        ("model", "what it is"),
        [
            (clean(one["name"]), f"{clean(one['id'])}; {clean(one['method'])}; {count(one['members'], 'member')}")
            for one in data["models"]
        ],
    )
    items = [
        ("trials", clean(trials["name"])),
        *sources_rows(trials),
        ("spread counted in", clean(data["sigma_from"])),
        *(spread_words(clean(name), value) for name, value in data["sigma"].items()),
        *made_rows(data),
    ]
    hashes: Sequence[tuple[str, str]] = [(clean(name), clean(text)) for name, text in trials["sha256"].items()]
    return Section(
        "made",
        "How it was made",
        (
            models,
            pairs("made-table", "What it was made from", ("what", "value"), items),
            Fold("Hashes of the trials", (pairs("hashes-table", "Hashes", ("trial", "SHA-256"), hashes),)),
        ),
    )


def _read(folder: Path, data: Mapping[str, Any]) -> ModelsRecord:
    """The record, and the motions beside it, which folders of older versions have not."""
    inputs = inputs_of(folder, data) if "inputs" in data else []
    return ModelsRecord(folder, data, motions_in(folder, inputs) if inputs else {}, inputs)


KIND = Kind("model-comparison", ("trials", "columns", "models", "sigma", "window_s", "provenance"), _read, build)
