"""``mmgtune compare``, also ``mmgtune learn compare``: models of any kind on the same trials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from ..errors import OptionError, Problem
from ..options import CompareModelsOptions, Options, again, choice
from ..options.choice import OUTPUT
from . import common as c
from . import completing
from .options import RunOptions, takes


@dataclass(frozen=True)
class FolderOptions(Options):
    """What is left behind."""

    out: Path | None = choice(
        None, "Folder for the record and a report; without it they are not written.", short="-o", panel=OUTPUT
    )
    force: bool = again(RunOptions, "force")

    def problems(self) -> list[Problem]:
        """Only a folder can be replaced."""
        lost = self.force and self.out is None
        what, why = "force=True has nothing to replace", "results are only written with out=FOLDER"
        return super().problems() + ([Problem(what, "force", why, "add out=FOLDER")] if lost else [])


@takes(options=CompareModelsOptions, run=FolderOptions)
def command(
    names: Annotated[
        list[str],
        typer.Argument(
            metavar="MODEL... TRIALS",
            help="Profiles and model files, then the trials; ratios to the first.",
            autocompletion=completing.models_and_trials,
        ),
    ],
    *,
    options: CompareModelsOptions,
    run: FolderOptions,
    json: c.Json = False,
) -> None:
    """Hold profiles, networks, hybrids and ensembles against each other on the same trials, with their bands.

    A row a model, a column a kind of manoeuvre: L_MSE, mean and deviation over the networks of a model, its ratio to
    the first model, in both conventions: begun anew in every window, and once in each whole run (Wakita et al. 2022,
    Table 9). Berthing runs also stand one by one. Then whether the bands held what was measured: L_Eucl, L_Maha and
    their correlation, CRPS, coverage at 50 and 90 %, and width. With --out the record and a report are written.

    Examples:

      mmgtune compare esso_osaka_3m esso_osaka_3m_tuned runs/type1/model.safetensors esso --only test

      mmgtune compare suzaku suzaku_fam suzaku --out runs/compared
    """
    from ..comparing_models import compare_models, write_model_comparison
    from ..report import render
    from ..run_folders import claimed

    if len(names) < 2:
        why = f"only '{names[0]}' was given, and trials stand last"
        fix = "write mmgtune compare MODEL... TRIALS, such as mmgtune compare suzaku suzaku_fam suzaku"
        raise OptionError(Problem("a model or the trials are missing", "MODEL... TRIALS", why, fix))
    if run.out is None:
        document = compare_models(names[:-1], names[-1], options).to_dict(c.command_line())
    else:
        with claimed(run.out, force=run.force):
            result = compare_models(names[:-1], names[-1], options)
            document = write_model_comparison(result, run.out, c.command_line(), overwrite=True)
            render(run.out)
    if json:
        c.print_json(document)
    else:
        c.show(summary(document))
        for note in document["notes"]:
            c.say(f"note: {note}")


def summary(document: Mapping[str, Any]) -> str:
    """The tables as a person wants to read them in a terminal."""
    columns = document["columns"]
    kinds = [k for k, one in enumerate(columns) if one["run"] is None]
    runs = [k for k, one in enumerate(columns) if one["run"] is not None]
    words = {"windows": f"begun anew every {document['window_s']:g} s", "whole": "begun once in each whole run"}
    over = ": mean ± deviation over networks" if any(one["members"] > 1 for one in document["models"]) else ""
    lines: list[str] = []
    for convention, said in words.items():
        lines += ["", f"L_MSE, {said}{over} (ratio to the first model)"]
        for of in filter(None, (kinds, runs)):
            lines += _table(document["models"], columns, of, convention)
    for convention, said in words.items():
        lines += ["", f"Bands, {said}: CRPS and width over the spread of the states"]
        lines += _bands(document, kinds, convention)
    lines += ["", f"* the best of a column. {document['wall_s']:.1f} s."]
    if "out" in document:
        lines.append(f"Report: {document['out']}/report.html")
    return "\n".join(lines[1:])


def _table(models: Sequence[Any], columns: Sequence[Any], of: Sequence[int], convention: str) -> list[str]:
    heads = [f"{columns[k]['name'][-40:]} ({columns[k]['runs']})" for k in of]
    rows = []
    for model in models:
        cells = [
            _cell(model[convention][k], model["members"]) + "* "[columns[k]["best"][convention] != model["name"]]
            for k in of
        ]
        rows.append((model["name"][-32:], *cells))
    return [f"  {line}" for line in c.table(("", *heads), rows, less=2)]


_HEADS = ("particles", "L_fit", "L_Eucl", "L_Maha", "correlation", "CRPS", "50 % holds", "90 % holds", "width", "lost")
_SPARE = (5, 4, 3, 2, 7, 1)
"""Columns that a narrow terminal does without, the first of them first."""


def _bands(document: Mapping[str, Any], of: Sequence[int], convention: str) -> list[str]:
    rows: list[tuple[str, ...]] = []
    for k in of:
        column = document["columns"][k]
        rows.append((f"{column['name'][-40:]} ({column['runs']})", *("" for _ in _HEADS)))
        for model in document["models"]:
            row = model[convention][k]["bands"]
            best = column["best_CRPS"][convention] == model["name"]
            cells = [
                str(row["particles"]),
                *(_number(row[name]) for name in ("L_fit", "L_Eucl", "L_Maha", "correlation")),
                _number(row["CRPS"]) + "*" * best,
                *("-" if row[f"coverage_{n}"] is None else f"{100.0 * row[f'coverage_{n}']:.0f} %" for n in (50, 90)),
                _number(row["sharpness"]),
                f"{row['windows_lost']} of {row['windows']}" if row["windows_lost"] else "",
            ]
            rows.append((f"  {model['name'][-30:]}", *cells))
    some = len(_HEADS) + any(row[-1] for row in rows)  # nothing is lost, mostly
    return [f"  {line}" for line in c.table(("", *_HEADS)[:some], [row[:some] for row in rows], less=2, spare=_SPARE)]


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"


def _cell(cell: Mapping[str, Any], members: int) -> str:
    if cell["diverged"]:
        return "diverged" if members == 1 else f"{cell['diverged']} of {members} diverged"
    deviation = "" if cell["deviation"] is None else f" ± {cell['deviation']:.2g}"
    ratio = "" if cell["ratio"] is None else f" ({cell['ratio']:.2f})"
    return f"{cell['mean']:.3g}{deviation}{ratio}"
