"""``mmgtune trials``: check and inspect trial files."""

from __future__ import annotations

from typing import Annotated

import typer

from . import common as c
from .exitcodes import ExitCode

app = typer.Typer(help="Check and inspect trial files.", no_args_is_help=True)

Name = Annotated[
    str, typer.Argument(help="Folder of trial files, one file, or a bundled name.", autocompletion=c.complete_trials)
]


@app.command("check")
def check(
    trials: Name,
    json: c.Json = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit 1 on warnings.")] = False,
) -> None:
    """Check trial files; exit 2 where they cannot be used, 1 on warnings with --strict.

    Example:

      mmgtune trials check my_trials/
    """
    from ..trial import check_trial, load_trials

    data = load_trials(trials)
    found = {name: check_trial(trial) for name, trial in data.trials.items()}
    if json:
        c.print_json({"schema": 1, "trials": {name: [vars(f) for f in findings] for name, findings in found.items()}})
    else:
        for findings in found.values():
            for f in findings:
                print(
                    f"{f.severity}: {f.what} ({f.where})"
                    + (f"\n  why: {f.why}" if f.why else "")
                    + (f"\n  fix: {f.fix}" if f.fix else "")
                )
        warnings = sum(f.severity == "warning" for findings in found.values() for f in findings)
        print(f"{len(found)} trials can be used, {warnings} warnings; tune {len(data.tune)}, test {len(data.test)}")
    if strict and any(f.severity == "warning" for findings in found.values() for f in findings):
        raise typer.Exit(ExitCode.NO)


@app.command("inspect")
def inspect(trials: Name, profile: c.Profile = "suzaku", json: c.Json = False) -> None:
    """Show what each trial holds: length, ranges, metadata, and its manoeuvring indices.

    Example:

      mmgtune trials inspect suzaku
    """
    from ..profile import load_profile
    from ..simulation import trial_indices
    from ..trial import load_trials
    from ..trial.describe import describe

    L_pp = load_profile(profile).L_pp
    data = load_trials(trials)
    rows = []
    for name, trial in data.trials.items():
        rows.append({**describe(trial), "role": data.role(name), "indices": trial_indices(trial, L_pp)})
    if json:
        c.print_json({"schema": 1, "L_pp_m": L_pp, "trials": rows})
        return
    for row in rows:
        print(
            f"{row['id']}  {row['ship']} {row['manoeuvre']} ({row['source'] or 'source not stated'}), "
            f"{row['role']}, {row['n_samples']} samples, {row['duration_s']:g} s"
        )
        for channel, span in row["ranges"].items():
            print(f"  {channel:<8}{span['min']:>12.4g} .. {span['max']:<12.4g} {span['unit']}")
        for index, value in row["indices"].items():
            if isinstance(value, float):
                print(f"  {index:<34}{value:.4g}")
        if row["note"]:
            print(f"  {row['note']}")
