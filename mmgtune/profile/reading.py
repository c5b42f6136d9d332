"""Reading a ship profile from TOML; every problem of a file is reported at once."""

from __future__ import annotations

import math
import re
import shlex
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, TypeVar

from .. import limits, units
from ..components import ARRANGEMENTS, KINDS, UNTAGGED, Arrangement, Component, Field, find, find_arrangement, tags
from ..components.speeds import too_fast
from ..effects import Effect, Parameter, effect_tags, find_effect
from ..errors import Problem, ProfileError, among, brief, near_to, reason
from ..inputs import Input
from ..metrics import METRICS
from ..physics.regressions.fujiwara1998 import wind_harmonics
from ..resources import (
    DOCUMENTS,
    folder,
    in_run,
    looked_for,
    must_be_name,
    network_names,
    profile_names,
    ship_in,
    taken,
)
from ..run_files import PROFILE
from ..toml_reading import TomlReader, toml_of
from ..units import KNOT
from .changing import missing_for
from .model import ABSENT, Actuator, Approach, Coefficient, Section, ShipProfile, SteeringGear
from .possible import FASTEST_SHAFT, impossible, may_be_infinite, out_of_proportion

SCHEMA = 1
PLAIN = ("steering_gear", "actuators", "approach", "tuning", "limits", "provenance")
SECTIONS = ("schema", "ship", "arrangement", *KINDS, "above_water", "effects", *PLAIN)
REGRESSION = "Fujiwara, Ueno & Nimura 1998, regression on the geometry"
DEFAULT = "default of the program"
STEERING_GEAR = {"max_angle": Field("", "rad", low=0.0, high=1.6), "rate": Field("", "rad/s", low=0.0)}
APPROACH = {"speed": Field("", "m/s", low=0.0), "n": Field("", "1/s", low=-FASTEST_SHAFT, high=FASTEST_SHAFT)}
IDENTIFIER = re.compile(r"\w[\w. -]{0,79}")
"""What a ship's id may be."""
VALUE_KEYS = ("value", "source", "assumption", "note", "bounds", "pre_determined", "stderr", "scatter", "warning")


def find_profile(name: str | Path) -> Path:
    """The file of a profile given by path or by the name of a bundled one; of a run folder the profile in it.

    Raises ProfileError if there is none.
    """
    must_be_name(name, "ship profile", ProfileError)
    path = Path(name)
    if found := taken(name, path.is_file(), folder("ship_profiles") / f"{name}.toml"):
        return found
    names = profile_names()
    fix = f"give a path to a TOML file, or a bundled name: {', '.join(names)}"
    if inside := in_run(path, PROFILE):
        return inside
    if path.is_dir():
        there = sorted(one.name for one in path.glob("*.toml"))[:3]
        fix = f"name one of its files ({', '.join(there)}), or " * bool(there) + fix
        why = "a ship is one file" if there else "it is no run folder with a model in it"
        if other := ship_in(path):
            why = f"it holds {other.name}, which only simulation, scoring and prediction take"
        raise ProfileError(Problem("the profile is a folder, not a file", str(name), why, fix=fix))
    trained = network_names()
    fix += f"; where trained models do: {', '.join(trained)}" if trained else ""
    why = looked_for(name, "profile")
    if name in trained:
        why = "it is a trained model, which only simulation, scoring and prediction take"
    elif near := near_to(str(name), [*names, *trained]):
        fix = f"{near} Else give a path to a TOML file"
    raise ProfileError(Problem("no such ship profile", str(name), why, fix))


def load_profile(name: str | Path) -> ShipProfile:
    """Read and validate a profile by path, run folder or bundled name.

    Raises ProfileError with everything wrong in it.
    """
    path = find_profile(name)
    if path.suffix == ".parquet":
        what, why = "this is a trial, not a ship profile", "profiles are TOML files, trials are Parquet files"
        raise ProfileError(Problem(what, str(path), why, f"give it with trials={shlex.quote(str(name))}"))
    if path.suffix in DOCUMENTS:
        what, why = "this is a document, not a ship profile", f"profiles are TOML files, and runs write {path.suffix}"
        beside = ship_in(path.parent)
        fix = f"give what lies beside it: {shlex.quote(str(beside))}" if beside else "name the TOML file of the profile"
        raise ProfileError(Problem(what, str(path), why, fix))
    try:
        text = limits.text(path, limits.PROFILE_BYTES, ProfileError)
    except (OSError, ValueError) as error:
        raise ProfileError(
            Problem("cannot read the profile", str(path), reason(error), "check the file; it must be UTF-8 text")
        ) from error
    return parse_profile(text, path)


def parse_profile(text: str, path: Path | None = None) -> ShipProfile:
    """The profile written in ``text``; ``path`` is for messages.  Raises ProfileError."""
    where = str(path) if path else "profile"
    reader = _Reader(toml_of(text, "the profile", where, ProfileError, profile=True), text, where)
    profile = reader.read(path)
    if reader.problems:
        raise ProfileError(*reader.problems)
    return profile


Fact = TypeVar("Fact", str, bool)


class _Reader(TomlReader):
    """One pass over a parsed profile."""

    def read(self, path: Path | None) -> ShipProfile:
        for name in self.data:
            if name not in SECTIONS:
                self.problem(f"unknown section [{name}]", name, **among(name, SECTIONS))
        self.schema(SCHEMA)
        ship = self.table("ship")
        self.unknown("ship", ship, ("name", "id", "source", "licence", "citation"))
        arrangement = self.arrangement()
        for name in (name for name in KINDS if name in self.data and name not in arrangement.kinds):
            self.problem(f"[{name}] is no part of this ship", name, why=f"she is arranged as {arrangement.title}")
        present = (*arrangement.kinds, *(["above_water"] if "above_water" in self.data else []), *self.effects())
        found = {kind: self.component(kind) for kind in present}
        sections = {kind: section for kind, section in found.items() if section is not None}
        complete = len(sections) == len(present) and not self.problems
        if complete and "above_water" in sections:
            try:
                sections["above_water"] = with_wind_coefficients(sections)
            except ArithmeticError:
                why, fix = "its numbers are not those of a ship", "check the units of areas, lengths and heights"
                self.problem("the coefficients of the wind cannot be worked out", "above_water", why=why, fix=fix)
                complete = False
        gear, approach = self.plain("steering_gear", STEERING_GEAR), self.plain("approach", APPROACH)
        profile = ShipProfile(
            id=self.identifier(ship),
            name=self.word("ship", ship, "name"),
            source=self.word("ship", ship, "source"),
            sections=sections,
            steering_gear=SteeringGear(**gear, source=self.source_of("steering_gear")) if gear else None,
            approach=Approach(**approach, source=self.source_of("approach")) if approach else None,
            targets=self.targets(sections) if complete else (),
            limits=self.limits(),
            provenance=self.provenance(),
            licence=self.word("ship", ship, "licence") if "licence" in ship else "",
            citation=self.word("ship", ship, "citation") if "citation" in ship else "",
            path=path,
            template=self.text,
            arrangement=arrangement,
            actuators=self.actuators(arrangement),
        )
        if complete:
            self.together(profile)
        return profile

    def arrangement(self) -> Arrangement:
        """How the components are put together; the first of all where the profile does not say."""
        if "arrangement" not in self.data:
            return ARRANGEMENTS[0]
        table = self.table("arrangement")
        self.unknown("arrangement", table, ("model", "source"))
        model = table.get("model")
        found = find_arrangement(model) if isinstance(model, str) else None
        if found is None:
            known = tuple(one.tag for one in ARRANGEMENTS)
            self.problem(f"unknown arrangement {brief(model)}", "arrangement", "model", **among(str(model), known))
        return found or ARRANGEMENTS[0]

    def actuators(self, arrangement: Arrangement) -> dict[str, Actuator]:
        """Limits of what moves the inputs, by input."""
        tables = self.data.get("actuators", {})
        if not isinstance(tables, dict):
            self.problem("'actuators' is not a table", "", "actuators", fix="write [actuators.delta], for example")
            return {}
        inputs = {one.name: one for one in arrangement.inputs}
        found = {}
        for name in tables:
            section = f"actuators.{name}"
            if name not in inputs:
                self.problem(f"nothing drives this ship that is called '{name}'", section, **among(name, [*inputs]))
                continue
            limits = self.plain(section, actuator_fields(inputs[name]))
            if limits and limits["low"] >= limits["high"]:
                self.problem(f"'{section}.low' is not below high", section, "low", fix="check numbers and units")
            elif limits:
                found[name] = Actuator(**limits)
        return found

    def effects(self) -> list[str]:
        """Sections "effects.<tag>" of the profile, in the order in which they act."""
        tables = self.data.get("effects", {})
        if not isinstance(tables, dict):
            self.problem("'effects' is not a table", "", "effects", fix="write [effects.current], for example")
            return []
        for tag in tables:
            if find_effect(tag) is None:
                self.problem(f"unknown effect '{tag}'", f"effects.{tag}", **among(tag, effect_tags()))
        return [f"effects.{tag}" for tag in effect_tags() if tag in tables]

    def table(self, name: str) -> dict[str, Any]:
        parent, _, tag = name.partition(".")
        value = self.data[parent].get(tag) if tag else self.data.get(name)
        if isinstance(value, dict):
            return value
        self.problem(f"section [{name}] is missing", fix=f"add [{name}]; see the bundled profiles for an example")
        return {}

    def word(self, section: str, table: dict[str, Any], key: str) -> str:
        value = table.get(key)
        if isinstance(value, str) and value.strip():
            return value
        if table:
            self.problem(f"'{key}' of [{section}] is missing or not text", section, key, fix=f'write {key} = "..."')
        return ""

    def identifier(self, ship: dict[str, Any]) -> str:
        """The ship's id: results lie in folders named after it."""
        found = self.word("ship", ship, "id")
        if found and not IDENTIFIER.fullmatch(found):
            what = f"'id' of [ship] is {brief(found)}"
            self.problem(what, "ship", "id", "folders are named after it", 'write letters, digits, ".", "_" and "-"')
        return found

    def component(self, kind: str) -> Section | None:
        if kind.partition(".")[0] not in self.data:
            self.table(kind)
            return None
        table = self.table(kind)
        tag = kind.partition(".")[2]
        component: Component | None = find_effect(tag) if tag else UNTAGGED.get(kind)
        tagged = component is None
        if component is None:
            model = table.get("model")
            component = find(kind, model) if isinstance(model, str) else None
            if component is None:
                what = f"unknown {kind} model {brief(model)}" if model else f"[{kind}] names no model"
                near = near_to(model, tags(kind)) if isinstance(model, str) else ""
                self.problem(
                    what, kind, "model", f"{kind} models are {', '.join(tags(kind))}", near or "write one of these"
                )
                return None
        # Effects are often tried out by hand, so a source is welcome there but not asked for.
        source = (
            self.text_of(kind, table, "source") or "not stated" if "." in kind else self.word(kind, table, "source")
        )
        known = ("source", *(("model",) if tagged else ()), *component.fields)
        self.unknown(kind, table, known)
        coefficients: dict[str, Coefficient] = {}
        missing: dict[str, Field] = {}
        for symbol, field in component.fields.items():
            if symbol in table:
                coefficient = self.coefficient(kind, symbol, field, table[symbol], source)
            else:
                coefficient = default_of(field)
                if coefficient is None and not field.derived:
                    missing[symbol] = field
            if coefficient is not None:
                coefficients[symbol] = coefficient
        self.missing(component, missing)
        return Section(component, coefficients, source)

    def missing(self, component: Component, fields: dict[str, Field]) -> None:
        """Say all that a section leaves out, in one problem."""
        if not fields:
            return
        names = [f"'{component.kind}.{symbol}'" for symbol in fields]
        meanings = [f"({field.label} [{field.unit}])" for field in fields.values()]
        told = ", ".join(f"{name} {meaning}" for name, meaning in zip(names, meanings, strict=True))
        self.problem(
            f"{told} are missing" if len(fields) > 1 else f"{names[0]} is missing {meanings[0]}",
            component.kind,
            why=f"{component.kind} model '{component.tag}' needs {'it' if len(fields) == 1 else 'them'}, and a number "
            "that is left out is not taken for 0",
            fix=f"add {', '.join(f'{symbol} = ...' for symbol in fields)} to [{component.kind}]"
            + "; write 0.0 for a term that the source of your numbers does not have"
            * any(impossible(symbol, field, 0.0) is None for symbol, field in fields.items()),
        )

    def coefficient(self, kind: str, symbol: str, field: Field, written: Any, source: str) -> Coefficient | None:
        facts: dict[str, Any] = {"source": source}
        if isinstance(written, dict):
            self.unknown_value_keys(kind, symbol, written)
            for key in ("source", "note", "warning"):
                if key in written:
                    facts[key] = self.fact(kind, symbol, written, key, str)
            facts["assumption"] = bool("assumption" in written and self.fact(kind, symbol, written, "assumption", bool))
            for key in ("pre_determined", "stderr", "scatter"):
                if key in written:
                    plain = replace(field, low=None, high=None, choices={}, table=0)
                    numbers = self.numbers(kind, symbol, plain, written[key])
                    facts[key] = numbers[0] if numbers else None
            if facts.get("scatter") is not None and facts["scatter"] <= 0.0:
                self.problem(
                    f"scatter of '{kind}.{symbol}' is {facts['scatter']:g}",
                    kind,
                    symbol,
                    why="it is a standard deviation, above 0",
                    fix="correct it, or leave it out",
                )
            if "bounds" in written:
                facts["bounds"] = self.bounds(kind, symbol, field, written["bounds"])
            if "value" not in written:
                self.problem(f"'{kind}.{symbol}' has no value", kind, symbol, fix="write { value = ..., ... }")
                return None
            written = written["value"]
        numbers = self.numbers(kind, symbol, field, written)
        if numbers is None:
            return None
        value = numbers if field.table else numbers[0]
        bounds = facts.get("bounds")
        if bounds and not isinstance(value, tuple) and not bounds[0] <= value <= bounds[1]:
            self.problem(f"'{kind}.{symbol}' = {value} lies outside its own bounds {list(bounds)}", kind, symbol)
        return Coefficient(value, **facts)

    def fact(self, kind: str, symbol: str, written: dict[str, Any], key: str, of: type[Fact]) -> Fact:
        """What is said of a coefficient, of its type; nothing after reporting another."""
        value = written[key]
        if isinstance(value, of):
            return value
        what, fix = ("text", '"..."') if of is str else ("true or false", "true")
        self.problem(
            f"{key} of '{kind}.{symbol}' is {brief(value)}, not {what}", kind, symbol, fix=f"write {key} = {fix}"
        )
        return of()

    def unknown_value_keys(self, kind: str, symbol: str, written: dict[str, Any]) -> None:
        for key in written:
            if key not in VALUE_KEYS:
                self.problem(f"unknown key '{key}' of '{kind}.{symbol}'", kind, symbol, **among(key, VALUE_KEYS))

    def bounds(self, kind: str, symbol: str, field: Field, written: Any) -> tuple[float, float] | None:
        if isinstance(written, list) and len(written) == 2:
            ends = [self.numbers(kind, symbol, Field("", field.unit), end) for end in written]
            if ends[0] and ends[1] and ends[0][0] < ends[1][0]:
                return ends[0][0], ends[1][0]
        self.problem(
            f"bounds of '{kind}.{symbol}' are not two rising numbers", kind, symbol, fix="write bounds = [low, high]"
        )
        return None

    def numbers(self, kind: str, symbol: str, field: Field, written: Any) -> tuple[float, ...] | None:
        """The value(s) in the field's unit, None after reporting what is wrong."""
        name = f"{kind}.{symbol}"
        if field.choices:
            if isinstance(written, str) and written in field.choices:
                return (field.choices[written],)
            self.problem(f"'{name}' is {brief(written)}", kind, symbol, fix=f"one of: {', '.join(field.choices)}")
            return None
        numbers = self.quantities(kind, symbol, written, field.unit, may_be_infinite(field), field.low, field.high)
        if numbers is None:
            return None
        point = units.with_point(written) if isinstance(written, str) and not field.table else None
        if point is not None:
            why = "a comma stands between numbers, and this is one number"
            self.problem(f"'{name}' = {brief(written)} has a decimal comma", kind, symbol, why, f'write "{point}"')
            return None
        return numbers if self.possible(kind, symbol, field, numbers) else None

    def possible(self, kind: str, symbol: str, field: Field, numbers: tuple[float, ...]) -> bool:
        name = f"{kind}.{symbol}"
        expected = field.table or 1
        if len(numbers) != expected:
            self.problem(f"'{name}' has {len(numbers)} values, not {expected}", kind, symbol, fix=f"give {expected}")
            return False
        for number in numbers:
            if wrong := impossible(name, field, number):
                self.problem(wrong.pop("what"), kind, symbol, **wrong)
                return False
        return True

    def plain(self, section: str, fields: dict[str, Field]) -> dict[str, float] | None:
        """A section of plain numbers that may be absent as a whole."""
        if section.partition(".")[0] not in self.data:
            return None
        table = self.table(section)
        self.unknown(section, table, ("source", *fields))
        values: dict[str, float] = {}
        for key, field in fields.items():
            if key not in table:
                example = units.example_in_toml(field.unit, field.low, field.high)
                self.problem(f"'{section}.{key}' is missing", section, fix=f"write {key} = {example}")
                continue
            coefficient = self.coefficient(section, key, field, table[key], str(table.get("source", "")))
            if coefficient is not None and not isinstance(coefficient.value, tuple):
                values[key] = coefficient.value
        return values if len(values) == len(fields) else None

    def source_of(self, section: str) -> str:
        """Where a section of plain numbers comes from, "" where it does not say."""
        return self.text_of(section, self.data[section], "source")

    def targets(self, sections: dict[str, Section]) -> tuple[str, ...]:
        table = self.data.get("tuning", {})
        if not isinstance(table, dict):
            self.problem("'tuning' is not a table", "", "tuning", fix='write [tuning] and targets = ["hull.R_0"]')
            return ()
        self.unknown("tuning", table, ("targets", "source"))
        known = [f"{kind}.{symbol}" for kind, section in sections.items() for symbol in section.component.fields]
        targets = table.get("targets", [])
        if not isinstance(targets, list) or not all(isinstance(name, str) for name in targets):
            fix = 'write targets = ["hull.R_0"]'
            self.problem(f"'tuning.targets' is {brief(targets)}, not a list of names", "tuning", "targets", fix=fix)
            return ()
        for name in targets:
            if name not in known:
                self.problem(f"unknown target '{name}'", "tuning", "targets", **among(name, known))
        return tuple(targets)

    def provenance(self) -> dict[str, Any]:
        """What whoever tuned it says of that."""
        table = self.data.get("provenance", {})
        if not isinstance(table, dict):
            self.problem("'provenance' is not a table", "", "provenance", fix="write [provenance] and keys below it")
            return {}
        return table

    def limits(self) -> dict[str, float]:
        """What metrics of a trial may be at most, each in its own unit."""
        table = self.data.get("limits", {})
        if not isinstance(table, dict):
            self.problem("'limits' is not a table", "", "limits", fix='write [limits] and rms_psi = "5 deg" below it')
            return {}
        self.unknown("limits", table, ("source", *METRICS))
        found: dict[str, float] = {}
        for name in (name for name in table if name in METRICS):
            numbers = self.numbers("limits", name, limit_field(name), table[name])
            if numbers:
                found[name] = numbers[0]
        return found

    def together(self, profile: ShipProfile) -> None:
        """What is impossible about numbers that are possible one by one."""
        L_pp = profile.L_pp
        numbers = {name: value for section in profile.sections.values() for name, value in section.numbers.items()}
        for wrong in out_of_proportion(numbers):
            self.problem(wrong.what, wrong.section, wrong.key, wrong.why, "check number and unit")
        for kind, section in profile.sections.items():
            missing = missing_for(section.component, profile) if isinstance(section.component, Effect) else []
            if missing:
                self.problem(
                    f"the effect '{section.component.tag}' does not apply to this ship",
                    kind,
                    why=f"it needs {', '.join(missing)}, which this profile does not have",
                    fix="remove the table, or add what is missing",
                )
        froude = None if profile.approach is None else too_fast(profile.approach.speed, L_pp)
        if profile.approach is not None and froude is not None:
            self.problem(
                f"'approach.speed' is {profile.approach.speed / KNOT:.4g} kn",
                "approach",
                "speed",
                f"a Froude number of {froude:.3g}; ships stay below 0.5",
                "check its unit, and that of L_pp",
            )
        propeller = profile.sections["propeller"].coefficients if "propeller" in profile.sections else {}
        if "phi_min" in propeller and profile.value("propeller.phi_min") >= profile.value("propeller.phi_max"):
            self.problem("'propeller.phi_min' is not below phi_max", "propeller", "phi_min", fix="check both")


def actuator_fields(one: Input) -> dict[str, Field]:
    """What the limits of an input are written in."""
    return {"low": Field("", one.unit), "high": Field("", one.unit), "rate": Field("", one.rate_unit, low=0.0)}


def limit_field(metric: str) -> Field:
    """What a limit of that metric is written in."""
    unit = METRICS[metric].unit
    return Field("", "-" if unit == "mixed" else unit, low=0.0)


def default_of(field: Field) -> Coefficient | None:
    """What a profile that leaves a coefficient out means, None where it must not."""
    if field.default is None:
        return None
    absent = isinstance(field, Parameter) and field.default == field.null
    return Coefficient(field.default, source=ABSENT if absent else DEFAULT)


def with_wind_coefficients(sections: dict[str, Section]) -> Section:
    """The section above_water with the harmonics of the wind force that it leaves out, by regression.

    Raises ArithmeticError for numbers that give none.
    """
    section, ship = sections["above_water"], sections["particulars"].numbers
    given = {symbol: section.coefficients[symbol].value for symbol in section.coefficients}
    geometry = SimpleNamespace(**given)
    by_regression = wind_harmonics(ship["particulars.L_pp"], ship["particulars.B"], geometry)._asdict()
    if not all(math.isfinite(value) for value in by_regression.values()):
        raise OverflowError
    coefficients = {
        symbol: section.coefficients.get(symbol) or Coefficient(by_regression[symbol], source=REGRESSION)
        for symbol in section.component.fields
    }
    return replace(section, coefficients=coefficients)
