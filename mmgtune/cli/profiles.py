"""``mmgtune profile``: show and validate ship profiles."""

from __future__ import annotations

import shlex
import sys
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import OptionError, Problem, ProfileError
from ..options import EstimateOptions
from ..units import DIMENSIONLESS
from . import common as c
from . import completing
from .options import App, takes

if TYPE_CHECKING:
    from ..comparing_profiles import Comparison
    from ..estimating import Particulars

app = App(help="Look at ship profiles, make one from main dimensions, compare two.")

Name = Annotated[str, typer.Argument(help="A TOML file or a bundled name.", autocompletion=completing.profiles)]


@app.command("list")
def list_profiles(json: c.Json = False) -> None:
    """List the bundled profiles, and what was trained beside them.

    Example:

      mmgtune profile list
    """
    from ..networks import load_network
    from ..profile import load_profile
    from ..resources import folder, network_names, profile_names

    profiles = {name: load_profile(name).name for name in profile_names()}
    trained = {name: repr(load_network(folder("ship_profiles") / f"{name}.safetensors")) for name in network_names()}
    if json:
        c.print_json({"schema": 1, "kind": "profile-list", "profiles": profiles, "trained": trained})
        return
    for name, words in {**profiles, **trained}.items():
        c.show(f"{name:<24}{words}")


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
        told |= {"coefficients": finite, "doubts": [one.to_dict() for one in ship.doubts()]}
        c.print_json({"schema": 1, "kind": "profile", **told})
        return
    c.show("\n".join((ship.name, ship.source, *c.terms(ship), "")))
    numbers, texts = [], []
    for row in rows:
        value = row["value"]
        listed = ", ".join(f"{v:.4g}" for v in value) if isinstance(value, list) else ""
        shown = f"{len(value)} numbers" if isinstance(value, list) else f"{value:g}"
        numbers.append((str(row["name"]), shown, str(row["unit"])))
        mark = "  ASSUMPTION" + (f": {row['note']}" if row["note"] else "") if row["assumption"] else ""
        texts.append(f"{row['label']}{f': {listed}' if listed else ''}{mark}")
    lines = c.table(("coefficient", "value", "unit"), numbers, words=(0, 2))
    room = max(map(len, lines)) + 2
    for line, text in zip(lines, ("what it is", *texts), strict=True):
        wrapped = textwrap.wrap(text, max(20, c.width() - room)) or [""]
        c.show(f"\n{'':<{room}}".join([f"{line:<{room}}{wrapped[0]}".rstrip(), *wrapped[1:]]))
    c.say_doubts(ship.doubts())


@app.command("validate")
def validate(profile: Name, json: c.Json = False) -> None:
    """Check a profile; exit 2 with everything that is wrong in it.

    Example:

      mmgtune profile validate my_ship.toml
    """
    from ..profile import load_profile

    ship = load_profile(profile)
    if json:
        c.print_json(
            {
                "schema": 1,
                "kind": "profile-validate",
                "file": str(ship.path),
                "id": ship.id,
                "name": ship.name,
                "sha256": ship.sha256,
                "coefficients": len(ship.names()),
                "assumptions": [name for name, _ in ship.assumptions()],
                "doubts": [one.to_dict() for one in ship.doubts()],
            }
        )
        return
    c.show(f"{ship.path}: {ship.name}, {len(ship.names())} coefficients, {len(ship.assumptions())} of them assumptions")
    c.say_doubts(ship.doubts())


@app.command("copy")
def copy(
    profile: Name,
    file: Annotated[Path, typer.Argument(help="Where to write it: a TOML file, or a folder.")],
    force: Annotated[bool, typer.Option("--force", help="Replace the file.", rich_help_panel=c.OUTPUT)] = False,
) -> None:
    """Copy a profile to a file of your own, to be changed there.

    Example:

      mmgtune profile copy suzaku my_ship.toml
    """
    from ..files import refuse_existing, write_text
    from ..profile import find_profile, load_profile

    source = find_profile(profile)
    load_profile(source)  # what could not be read need not be copied
    target = file / source.name if file.is_dir() else file
    refuse_existing([target], force)
    write_text(target, source.read_text(encoding="utf-8"), overwrite=force)
    c.show(f"wrote {target}")


@app.command("new")
@takes(options=EstimateOptions)
def new(
    file: Annotated[Path, typer.Argument(help="The profile to write, a TOML file.")],
    particulars: Annotated[
        str,
        typer.Option(
            "--from",
            metavar=c.PROFILE,
            autocompletion=completing.particulars,
            help="Particulars: a TOML file or a bundled name. Default: they are asked for.",
            rich_help_panel=c.INPUT,
        ),
    ] = "particulars",
    *,
    options: EstimateOptions,
    force: Annotated[bool, typer.Option("--force", help="Replace the file.", rich_help_panel=c.OUTPUT)] = False,
    json: c.Json = False,
) -> None:
    """Make a whole profile from main dimensions, by published formulas.

    Every number names its formula, the range of that, and the scatter of ships about it, which is the box and the prior
    of a fit. What is not known comes from rules of thumb, marked as assumptions.

    Examples:

      mmgtune profile new my_ship.toml

      mmgtune profile new my_ship.toml --from particulars.toml --form fam
    """
    from ..estimating import estimate, read_particulars
    from ..files import refuse_existing, write_text
    from ..units import KNOT

    _keep_particulars(file)
    refuse_existing([file], force)
    asked = particulars == "particulars" and not Path(particulars).exists()
    ship = estimate(_asked() if asked else read_particulars(particulars), options)
    write_text(file, ship.text, overwrite=force)
    if json:
        facts = {"schema": 1, "kind": "profile-new", "file": str(file), "id": ship.id, "sha256": ship.sha256}
        doubts = [one.to_dict() for one in ship.doubts()]
        amounts = {"coefficients": len(ship.names()), "targets": list(ship.targets)}
        c.print_json({**facts, "options": options.to_dict(), **amounts, "doubts": doubts})
        return
    c.show(f"wrote {file}: {ship.name}, {len(ship.names())} coefficients, {len(ship.targets)} of them free in a fit")
    approach = ship.require_approach()
    speed, n = approach.speed / KNOT, approach.n * 60.0
    c.show(f"approach at {speed:.4g} kn with {n:.4g} rpm")
    c.say_doubts(ship.doubts())


def _keep_particulars(file: Path) -> None:
    """Raises OptionError where a file of particulars was given as the profile to write, which would take its place."""
    from ..estimating import read_particulars

    try:
        read_particulars(file)
    except ProfileError:
        return
    fix = f"write mmgtune profile new my_ship.toml --from {shlex.quote(str(file))}"
    why = "the profile that is made of them would take their place"
    raise OptionError(Problem(f"{file.name} holds particulars, and is no place for a profile", str(file), why, fix))


@app.command("compare")
def compare(
    a: Name,
    b: Name,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for the comparison and its report.", rich_help_panel=c.OUTPUT),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace the results in --out.", rich_help_panel=c.OUTPUT)
    ] = False,
    json: c.Json = False,
) -> None:
    """Compare two profiles: coefficients, forces over drift, yaw rate and rudder angle, indices of manoeuvres.

    Examples:

      mmgtune profile compare suzaku suzaku_fam

      mmgtune profile compare before.toml after.toml --out compared
    """
    from ..comparing_profiles import compare_profiles, write_comparison
    from ..report import render
    from ..run_files import COMPARISON

    with c.placed(out, force=force, anew=True, reads=(a, b)):
        found = compare_profiles(a, b)
        if out is not None:
            write_comparison(found, out, overwrite=True)
            c.say(f"wrote {out / COMPARISON}")
            for path in render(out):
                c.say(f"wrote {path}")
    if json:
        c.print_json(found.to_dict())
        return
    c.show(_side_by_side(found))
    for name, ship in zip(found.profiles, found.ships, strict=True):
        c.say_doubts(ship.doubts(), f"{name}: ")


def _asked() -> Particulars:
    """Particulars from somebody at a terminal; what is answered with nothing is left to formulas."""
    from ..components import Field
    from ..estimating import QUESTIONS, parse_particulars
    from ..estimating.particulars import FIELDS, NEEDED
    from ..units import Unreadable, example, parse, with_known_unit, with_point

    if not sys.stdin.isatty():
        raise OptionError(
            Problem(
                "there is nobody to ask for particulars",
                "--from",
                "standard input is no terminal",
                "write them to a TOML file and name it with --from FILE; the guide 'A profile' shows one",
            )
        )

    def answer(section: str, name: str, known: Field) -> str:
        needed = name in NEEDED.get(section, ())
        unit = "" if known.unit == "-" else f", such as {example(known.unit)}"
        words = {("approach", "speed"): "approach speed", ("approach", "n"): "revolutions at that speed"}
        label = known.label or words.get((section, name), name)
        while True:
            typed: str = typer.prompt(
                f"{label}{unit}" + ("" if needed else " (Enter where not known)"),
                default=None if needed else "",
                show_default=False,
            )
            if not typed.strip():
                return ""
            text = with_known_unit(typed.strip())
            try:
                if pointed := with_point(text):
                    raise Unreadable(f"numbers have a decimal point here, as {pointed}", pointed)
                value, *more = parse(text, known.unit)
                if more:
                    raise Unreadable(f"'{text}' is {1 + len(more)} numbers, not one", example(known.unit))
            except Unreadable as error:
                c.say(f"{error}; once more")
            else:
                return repr(value) if known.unit == "-" else f'"{text}"'

    name = typer.prompt("name of the ship").replace('"', "'").replace("\\", "/")
    id = "".join(sign if sign.isalnum() else "_" for sign in name.lower()).strip("_") or "ship"
    text = f'schema = 1\n[ship]\nname = "{name}"\nid = "{id}"\n'
    before = ""
    for section, key in QUESTIONS:
        written = answer(section, key, FIELDS[section][key])
        if written:
            text += ("" if section == before else f"[{section}]\n") + f"{key} = {written}\n"
            before = section
    return parse_particulars(text)


def _side_by_side(found: Comparison) -> str:
    """Coefficients and indices of two profiles in columns."""
    from ..report.pages.comparison_page import words_of
    from ..report.wording import run_words

    def number(value: float | None) -> str:
        return "-" if value is None else f"{value:.4g}"

    rows = []
    for row in found.data["coefficients"]:
        if row["a"] != row["b"]:
            unit = "" if row["unit"] in DIMENSIONLESS else f" [{row['unit']}]"
            rows.append((row["name"] + unit, number(row["a"]), number(row["b"])))
    rows.append(("", "", ""))
    for row in found.data["manoeuvres"]["indices"]:
        words = f"{run_words(row['manoeuvre'])}, {words_of(row['index'])}"
        rows.append((words, number(row["a"]), number(row["b"])))
    return "\n".join(c.table(("", *(name[-22:] for name in found.profiles)), rows))
