"""The report of a diagnosis, put together: the answer first, then why, then what the data could have told at all."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import findings, tracks
from .advice import shortest
from .common import assumptions, doubts, generated_banner, picture, provenance
from .differences import draw_differences
from .drawing import AFTER, MUTED, Drawn, log_ticks, new_figure
from .load import DiagnosisRecord, Kind, inputs_of, motions_in
from .of_runs import of_runs, parameters_of
from .page import Block, Cell, Commands, Details, Page, Prose, Section, Table, Tile, cells
from .tables import tone
from .wording import CHANNELS, NONE, change, clean, number, percent, shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WORDS = {
    "none": "nothing found",
    "found": "cause found",
    "not-separable": "causes that cannot be told apart",
    "unexplained": "something unknown",
    "interrupted": "stopped before its end",
}
_RUNS = {"measured": "measured", "before": "without a cause", "after": "with the causes"}

_BARS = 12
"""Hypotheses drawn."""

_READ = {"rad": (180.0 / math.pi, "°"), "rad/s": (180.0 / math.pi, "°/s"), "N": (1e-3, "kN")}
"""Factor and unit in which people read a quantity."""

_VARIABLES = {
    "heading": "heading",
    "drift": "drift angle",
    "yaw_rate": "yaw rate",
    "rudder": "rudder angle",
    "ordered": "time since rudder order",
    "speed": "speed",
    "time": "time",
}


def build(record: DiagnosisRecord) -> Page:
    """Everything the report of a diagnosis says."""
    data = record.data
    drawings: dict[str, Drawn] = {}
    sections = [
        _causes(data),
        _voyages(data, drawings),
        _why(data, drawings),
        _gain(record, drawings),
        _evidence(data),
        _left(data),
        _could_tell(data),
        Section("next", "What to do next", (Commands(_advice(data)),)),
        assumptions(data),
        provenance(data),
    ]
    ship = clean(data["profile"].get("name") or data["profile"].get("id") or "the ship")
    return Page(
        title=f"{ship}: diagnosis",
        eyebrow=f"{ship} · {_WORDS.get(data['verdict'], clean(data['verdict']))}",
        verdict=clean(data["sentence"]),
        banners=generated_banner(data["trials"]),
        warnings=(
            *(("The search was interrupted; this is what was known by then.",) if data.get("interrupted") else ()),
            *doubts(data),
        ),
        tiles=_tiles(data),
        sections=tuple(section for section in sections if section is not None),
        figures=drawings,
    )


def _held_out(gain: Mapping[str, Any]) -> str:
    """What J is of, and by which method; records of older versions do not say."""
    return ", ".join(clean(word) for word in (gain["held_out"], gain.get("method")) if word)


def _tiles(data: Mapping[str, Any]) -> tuple[Tile, ...]:
    gain = data["gain"]
    moved = change(gain.get("J_test_before"), gain.get("J_test_after"))
    tiles = [Tile("Verdict", _WORDS.get(data["verdict"], data["verdict"]))]
    if data["causes"]:
        tiles.append(Tile("Causes", ", ".join(clean(cause["effect"]) for cause in data["causes"])))
    before, after = shown(gain.get("J_test_before")), shown(gain.get("J_test_after"))
    if data["causes"]:
        tiles.append(Tile("Misfit J, held out", f"{before} → {after}", percent(moved), _held_out(gain), tone(moved)))
        low, high = gain["share_ci95"]
        tiles.append(
            Tile(
                "Error above noise removed",
                f"{min(100.0 * gain['share_above_noise_removed'], 99.9):.1f} %",
                note=f"95 % interval over trials {min(100.0 * low, 99.9):.1f} to {min(100.0 * high, 99.9):.1f} %",
            )
        )
    else:
        tiles.append(Tile("Misfit J, held out", before, note=f"re-tuned model, {_held_out(gain)}"))
        left = data["unexplained"]["share_of_noise_variance"]
        tiles.append(Tile("Left beyond sensor noise", f"{100.0 * left:.1f} %", note="of the noise's variance"))
    return tuple(tiles)


def _voyages(data: Mapping[str, Any], drawings: dict[str, Drawn]) -> Section | None:
    """What differs from voyage to voyage; records of trials, and of older versions, have nothing of it."""
    told = data.get("voyages")
    if not told:
        return None
    blocks: list[Block] = [Prose((clean(told["sentence"]),))]
    if told["differences"]:
        title = "What differs from voyage to voyage"
        drawn = Drawn("differences", title, lambda: draw_differences(told["differences"]))
        drawings["differences"] = drawn
        caption = "Voyages in their order; of those without a point the windows do not tell. The numbers are below."
        blocks.append(picture(drawn, title, caption))
    for one in told["differences"]:
        blocks.append(Prose((clean(one["sentence"]),)))
        names = [name for name in one["by_voyage"][0] if name != "voyage"]
        rows = [
            cells(
                clean(row["voyage"]),
                shown(told["windows"].get(row["voyage"])),
                *(word for name in names for word in _with_error(row[name])),
            )
            for row in one["by_voyage"]
        ]
        relative = ", over its mean" if one["relative_to_mean"] else ""
        what = f"{clean(one['quantity']).capitalize()} of each voyage{relative}, with its 95 % half width"
        heads = tuple(head for name in names for head in (_head(name, one["unit"]), "±"))
        table_of = f"{clean(one['quantity'])}-by-voyage"
        blocks.append(
            Table(table_of, what, ("voyage", "windows", *heads), tuple(rows), tuple(range(1, 2 + len(heads))))
        )
    return Section("voyages", "From voyage to voyage", tuple(blocks))


def _head(name: str, unit: str) -> str:
    return clean(name) if unit in ("-", "prime") else f"{clean(name)} [{clean(unit)}]"


def _with_error(value: Mapping[str, Any]) -> tuple[str, str]:
    error = number(value["stderr"])
    return (shown(value["value"], 3), NONE if error is None else shown(1.96 * error, 2)) if error else (NONE, NONE)


def _causes(data: Mapping[str, Any]) -> Section | None:
    listed = data["causes"] or data["unexplained"]["best_known"]
    if not listed:
        return None
    blocks: list[Block] = []
    if not data["causes"]:
        blocks.append(
            Prose(("None of these can be relied on while something unknown is at work besides.",), tone="warning")
        )
    rows = []
    for cause in listed:
        for name, value in cause["parameters"].items():
            low, high = value["ci95"]
            factor, unit = _READ.get(value["unit"], (1.0, clean(value["unit"])))
            interval = f"{_end(low, factor)} … {_end(high, factor)}"
            size = shown(factor * value["value"]) if number(value["value"]) is not None else "∞"
            rows.append(cells(clean(cause["effect"]), clean(name), size, interval, unit, _p(cause["p_value"])))
        if not cause["parameters"] and not cause.get("by_run"):
            rows.append(cells(clean(cause["effect"]), NONE, NONE, NONE, NONE, _p(cause["p_value"])))
    if rows:
        blocks.append(
            Table(
                "causes-table",
                "Each parameter with its 95 % interval, and the probability that chance brings as much in any search",
                ("effect", "parameter", "value", "95 % interval", "unit", "by chance"),
                tuple(rows),
                (2, 3),
            )
        )
    for cause in listed:
        blocks += of_runs(cause)
    if data["groups"]:
        for group in data["groups"]:
            blocks.append(Prose((f"These trials do not tell apart: {', '.join(map(clean, group))}.",)))
    suggestion = data["suggested_trial"]
    if suggestion:
        apart = shown(suggestion["largest_position_difference_m"], 3)
        in_all = shown(suggestion["distance_in_noise_deviations"], 3)
        sentence = f"The trial that would: {clean(suggestion['manoeuvre'])}."
        sentence += f" There the explanations differ by up to {apart} m, in all {in_all} deviations of the noise."
        blocks.append(Prose((sentence,)))
    return Section("causes", "Causes", tuple(blocks))


def _why(data: Mapping[str, Any], drawings: dict[str, Drawn]) -> Section:
    fitted = [row for row in data["candidates"] if row["gain"] >= 1.0]
    table = Table(
        "candidates-table",
        "Hypotheses at the first look: what the linear score promised, what the refit gained, and J on the test trials",
        ("effect", "parameters", "score", "gain of chi-squared", "by chance", "J test"),
        tuple(
            cells(
                clean(row["effect"]),
                clean(", ".join(parameters_of(row))),
                shown(row["score"], 3),
                shown(row["gain"], 3) if row["gain"] >= 1.0 else "none",
                _p(row["p_value"]) if row["gain"] >= 1.0 else NONE,
                shown(row["J_test"]),
            )
            for row in data["candidates"]
        ),
        (2, 3, 4, 5),
    )
    blocks: list[Block] = []
    if fitted:
        drawings["candidates"] = Drawn(
            "candidates", "What each hypothesis alone would explain", lambda: _draw_candidates(fitted)
        )
        best = fitted[0]
        blocks.append(
            picture(
                drawings["candidates"],
                "What each hypothesis alone would explain",
                f"{clean(best['effect'])} explains most: chi-squared falls by {shown(best['gain'], 3)}.",
            )
        )
    blocks.append(Details(f"All {len(data['candidates'])} hypotheses", (table,)) if fitted else table)
    return Section("why", "Why this and not another", tuple(blocks))


def _draw_candidates(rows: Sequence[Mapping[str, Any]]) -> Figure:
    rows = rows[:_BARS]
    figure = new_figure(7.6, 0.3 * len(rows) + 0.8)
    ax = figure.subplots()
    gains = [max(float(row["gain"]), 0.1) for row in rows]
    ax.barh(range(len(rows)), gains, height=0.62, color=[AFTER, *[MUTED] * (len(rows) - 1)])
    ax.set_yticks(range(len(rows)), [f"{clean(row['effect'])} ({', '.join(parameters_of(row))})"[:44] for row in rows])
    ax.set_ylim(len(rows) - 0.4, -0.6)
    if max(gains) > 30.0 * min(gains):
        ax.set_xscale("log")
        log_ticks(ax.xaxis)
    ax.set_xlabel("fall of chi-squared when refitted")
    ax.grid(axis="y", visible=False)
    return figure


def _gain(record: DiagnosisRecord, drawings: dict[str, Drawn]) -> Section:
    data, gain = record.data, record.data["gain"]
    rows = [row for row in record.results if str(row["id"]) in record.motions]
    blocks: list[Block] = []
    if rows and data["causes"]:
        chosen = tracks.chosen(rows)
        drawings["tracks"] = Drawn(
            "tracks",
            "Measured and simulated tracks of each held-out trial, north up",
            lambda: tracks.draw_tracks(chosen, record.motions, _RUNS),
        )
        drawings["distances"] = Drawn(
            "distances",
            "Distance of the simulated from the measured position over time",
            lambda: tracks.draw_distances(chosen, record.motions, _RUNS),
        )
        before, after = (shown(findings.mean_off_track(chosen, when), 3) for when in ("before", "after"))
        gap = f"Mean distance off track: {before} m re-tuned without a cause, {after} m with the causes."
        blocks += [
            picture(drawings["tracks"], "Held-out tracks", gap),
            picture(drawings["distances"], "Distance off track", "The same over time."),
        ]
    listed = [
        (words + name, gain[f"{kind}_before"].get(name), gain[f"{kind}_after"].get(name))
        for kind, words in (("measures", ""), ("index_errors", "error of "))
        for name in gain[f"{kind}_before"]
    ]
    blocks.append(
        Table(
            "gain-table",
            f"Held out: {gain['held_out']}. Means over trials of the seven distance measures, and mean absolute errors "
            "of manoeuvring indices",
            ("measure", "before", "after", "change"),
            tuple(
                cells(clean(name), shown(a), shown(b), Cell(percent(change(a, b)), tone(change(a, b))))
                for name, a, b in listed
            ),
            (1, 2, 3),
        )
    )
    blocks.append(
        Table(
            "gain-by-trial",
            "J by trial",
            ("trial", "before", "after"),
            tuple(
                cells(clean(row["trial"]), shown(row["J_before"]), shown(row["J_after"])) for row in gain["by_trial"]
            ),
            (1, 2),
        )
    )
    return Section("gain", "The gain on trials not used", tuple(blocks))


def _evidence(data: Mapping[str, Any]) -> Section | None:
    evidence = data.get("evidence") or {}
    if "excess_before" not in evidence:
        return None
    rows = []
    for name in evidence["excess_before"]:
        words = CHANNELS[name].words if name in CHANNELS else name
        rows.append(
            cells(
                clean(words),
                _share(evidence["excess_before"].get(name)),
                _share(evidence["excess_after"].get(name)),
                shown(evidence["short_horizon_before"].get(name), 3),
                shown(evidence["short_horizon_after"].get(name), 3),
            )
        )
    blocks: list[Block] = [
        Table(
            "residuals-table",
            "Variance of the residuals beyond white noise as a share of it, and root mean square of simulations "
            "restarted every minute in deviations of the noise",
            ("channel", "beyond noise, before", "after", "restarted, before", "after"),
            tuple(rows),
            (1, 2, 3, 4),
        )
    ]
    for which, words in (("before", "without a cause"), ("after", "with the causes")):
        forces = evidence.get(f"forces_{which}")
        if forces:
            blocks.append(_forces(forces, which, words))
    return Section("evidence", "What does not match", tuple(blocks))


def _forces(forces: Mapping[str, Any], which: str, words: str) -> Table:
    variables = list(dict.fromkeys(name for shares in forces["explained"].values() for name in shares))
    return Table(
        f"forces-{which}",
        f"Residual forces by inverse dynamics {words}: share of their variance each quantity alone predicts",
        ("force", *(_VARIABLES.get(name, name) for name in variables), "noise"),
        tuple(
            cells(
                clean(axis),
                *(_bold(shares.get(name), shares.values()) for name in variables),
                _share(forces["noise"].get(axis)),
            )
            for axis, shares in forces["explained"].items()
        ),
        tuple(range(1, len(variables) + 2)),
    )


def _bold(value: Any, others: Iterable[Any]) -> Cell:
    """The largest share of a row stands out."""
    best = max((number(other) or 0.0 for other in others), default=0.0)
    share = number(value)
    return Cell(_share(value), "note" if share is not None and share == best and share > 0.2 else "")


def _left(data: Mapping[str, Any]) -> Section:
    left = data["unexplained"]
    words = "looks like something that happened" if left["structured"] else "looks like noise"
    share = 100.0 * left["share_of_noise_variance"]
    sentences = [f"What is left is {share:.1f} % of the sensors' noise variance beyond that noise, and {words}."]
    for pair, value in left["correlation"].items():
        sentences.append(f"Correlation of what {pair} say of it: {value:.2f}.")
    for channel, best in left["largest_share_by_one_quantity"].items():
        words = CHANNELS[channel].words if channel in CHANNELS else channel
        sentences.append(
            f"Of the residual of {words}, {clean(best['quantity'])} predicts {100.0 * max(best['share'], 0.0):.0f} %."
        )
    return Section("left", "What is left", (Prose(tuple(sentences), listed=True),))


def _could_tell(data: Mapping[str, Any]) -> Section | None:
    rows = data.get("detectability") or []
    if not rows:
        return None
    return Section(
        "detectability",
        "What these trials could tell",
        (
            Table(
                "detectability-table",
                "Share of each effect's signature that re-tuning cannot imitate, the size from which it would be "
                "found, and the effects it is closest to with the angle between their signatures",
                ("effect", "share", "found from", "closest"),
                tuple(
                    cells(
                        clean(f"{row['effect']} ({', '.join(row['parameters'])})"),
                        _share(row["share_surviving"]),
                        clean(_limits(row)),
                        clean(", ".join(f"{twin['effect']} {twin['angle_deg']:.0f}°" for twin in row["twins"])),
                    )
                    for row in sorted(rows, key=lambda row: -row["share_surviving"])
                ),
                (1,),
            ),
        ),
    )


def _advice(data: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    trials = shortest(data["trials"].get("path") or "", "trials")
    extended = f"{data.get('out', 'RUN')}/profile.toml"
    items = []
    if data["causes"]:
        items.append(("See the extended model on every trial", f"mmgtune simulate -p {extended} --trials {trials}"))
        items.append(("Re-tune the extended model", f"mmgtune fit -p {extended} -t {trials} --initial estimated"))
    if data["verdict"] == "unexplained":
        items.append(("Look for faults of the measurement itself", f"mmgtune trials check {trials}"))
    items.append(("Look again from the extended profile", f"mmgtune diagnose -p {extended} -t {trials}"))
    return tuple(items)


def _end(value: Any, factor: float) -> str:
    return "∞" if value is None else shown(factor * value)


def _limits(row: Mapping[str, Any]) -> str:
    """Sizes from which an effect would be found, in units people read."""
    found = []
    for name, limit in row["detection_limit"].items():
        if limit is not None:
            factor, unit = _READ.get(row["units"].get(name), (1.0, row["units"].get(name, "")))
            pure = unit in ("-", "prime")
            found.append(f"{name} {shown(factor * limit, 4 if pure else 2)} {'' if pure else unit}".strip())
    return ", ".join(found) or "not within its range"


def _p(value: Any) -> str:
    found = number(value)
    return NONE if found is None else "< 0.0001" if found < 1e-4 else shown(found, 2)


def _share(value: Any) -> str:
    found = number(value)
    return NONE if found is None else f"{100.0 * found:.1f} %" if abs(found) < 10.0 else f"{100.0 * found:.0f} %"


def _read(folder: Path, data: Mapping[str, Any]) -> DiagnosisRecord:
    return DiagnosisRecord(folder, data, motions_in(folder, inputs_of(folder, data)))


KIND = Kind(
    "diagnosis",
    ("profile", "trials", "verdict", "sentence", "causes", "candidates", "gain", "trial_results"),
    _read,
    build,
)
