"""``mmgtune profile``: show and validate ship profiles."""

from __future__ import annotations

from typing import Annotated

import typer

from . import common as c

app = typer.Typer(help="Look at ship profiles.", no_args_is_help=True)

Name = Annotated[str, typer.Argument(help="A TOML file or a bundled name.", autocompletion=c.complete_profile)]


@app.command("list")
def list_profiles() -> None:
    """List the bundled profiles."""
    from ..profile import load_profile
    from ..resources import profile_names

    for name in profile_names():
        c.show(f"{name:<24}{load_profile(name).name}")


@app.command("show")
def show(profile: Name, json: c.Json = False) -> None:
    """Show every coefficient with its unit, source and whether it is an assumption.

    Example:

      mmgtune profile show suzaku
    """
    from ..profile import load_profile

    ship = load_profile(profile)
    rows = [
        {
            "name": f"{kind}.{symbol}",
            "value": list(number.value) if isinstance(number.value, tuple) else number.value,
            "unit": section.component.fields[symbol].unit,
            "label": section.component.fields[symbol].label,
            "source": number.source,
            "assumption": number.assumption,
            "note": number.note,
        }
        for kind, section in ship.sections.items()
        for symbol, number in section.coefficients.items()
    ]
    if json:
        finite: list[dict[str, object]] = [
            {**row, "value": None if row["value"] == float("inf") else row["value"]} for row in rows
        ]
        told = {key: getattr(ship, key) for key in ("id", "name", "source", "licence", "citation")}
        c.print_json({"schema": 1, **told, "coefficients": finite})
        return
    c.show("\n".join((ship.name, ship.source, *c.terms(ship), "")))
    for row in rows:
        value = row["value"]
        text = ", ".join(f"{v:.4g}" for v in value) if isinstance(value, list) else f"{value:g}"
        mark = "  ASSUMPTION" + (f": {row['note']}" if row["note"] else "") if row["assumption"] else ""
        c.show(f"{row['name']:<24}{text:>12} {row['unit']:<8} {row['label']}{mark}")


@app.command("validate")
def validate(profile: Name) -> None:
    """Check a profile; exit 2 with everything that is wrong in it."""
    from ..profile import load_profile

    ship = load_profile(profile)
    c.show(f"{ship.path}: {ship.name}, {len(ship.names())} coefficients, {len(ship.assumptions())} of them assumptions")
