"""Profiles, trials and simulated runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..inputs import INPUTS
from ..phrases import capital, counted
from ..physics.quantities import STATES
from ..report.wording import PRINCIPAL, index_words
from ..trial.schema import FILE_CHANNELS, REQUIRED
from .view import Line, Row, View

if TYPE_CHECKING:
    from ..evaluation import TrialRecord
    from ..generating import Made
    from ..inspecting import Inspected
    from ..motions import Motion
    from ..profile import ShipProfile
    from ..simulating import Simulated
    from ..trial import IndexTrial, Trial, TrialSet

FIRST = ("advance_m", "tactical_diameter_m", "overshoot_1_deg")
"""Indices that text shows where there is no room for more."""


def profile(ship: ShipProfile) -> View:
    """Every coefficient with its unit, source and whether it is an assumption."""
    rows = [
        {
            "coefficient": f"{kind}.{symbol}",
            "value": list(number.value) if isinstance(number.value, tuple) else number.value,
            "unit": section.component.fields[symbol].unit,
            "what": section.component.fields[symbol].label,
            "source": number.source,
            "assumption": "yes" if number.assumption else "",
        }
        for kind, section in ship.sections.items()
        for symbol, number in section.coefficients.items()
    ]
    says = [f"{ship.name}: {len(rows)} coefficients, {len(ship.assumptions())} of them assumptions.", ship.source]
    return View(repr(ship), [one for one in says if one], rows, spare=("source", "assumption", "what"))


def trial(one: Trial) -> View:
    """Its channels; as a frame its samples."""
    rows = []
    for name, values in one.columns.items():
        known = values[np.isfinite(values)]
        rows.append(
            {
                "channel": name,
                "least": float(known.min()) if len(known) else None,
                "greatest": float(known.max()) if len(known) else None,
                "unit": _unit(name),
                "gaps [samples]": len(values) - len(known),
                "noise": one.noise.get(name),
            }
        )
    says = [
        f"{one.label}: {counted(one.n_samples, 'sample')} in {one.duration:.6g} s, {one.source or 'source not stated'}."
    ]
    columns = {named(name): values for name, values in one.columns.items() if name != "t"}
    return View(
        repr(one), says, rows, frame={"t [s]": one.t, **columns}, along="t [s]",
        motions=lambda: {one.id: [measured(one)]},
    )  # fmt: skip


def named(name: str) -> str:
    """A column of a file with its unit, where that is known."""
    unit = _unit(name)
    return f"{name} [{unit}]" if unit else name


def _unit(name: str) -> str:
    if name in REQUIRED:
        return REQUIRED[name].unit
    return INPUTS[name].unit if name in INPUTS else ""


def trials(data: TrialSet) -> View:
    """A row a trial."""
    rows = [_about(one, data.role(name)) for name, one in data.trials.items()]
    rows += [_stated(one, data.role(name)) for name, one in data.stated.items()]
    terms = [f"Licence of the measurements: {data.licence}."] if data.licence else []
    return View(
        repr(data), [], rows, terms, spare=("approach speed [m/s]", "manoeuvre", "source"),
        motions=lambda: {name: [measured(one)] for name, one in data.trials.items()},
    )  # fmt: skip


def inspected(result: Inspected) -> View:
    """A row a trial: what it is, and the indices that are read from it, or stated of it."""
    rows: list[Row] = []
    for row in (*result.rows, *result.stated):
        indices = row.get("indices") or {}
        numbers = {_index(key): value for key, value in indices.items() if key in PRINCIPAL}
        numbers |= {f"{index_words(key)[0]}, stated [{of['unit']}]": of["value"] for key, of in _with_units(indices)}
        rows.append(
            {
                "trial": row["id"],
                "role": row["role"],
                "manoeuvre": row["manoeuvre"],
                "duration [s]": row.get("duration_s"),
                "approach speed [m/s]": indices.get("approach_speed_m_per_s"),
                **numbers,
            }
        )
    less = [_index(key) for key in reversed(PRINCIPAL) if key not in FIRST]
    notes = [f"{capital(words)}." for words in result.notes]
    return View(
        repr(result), [], alike(rows), notes, spare=("approach speed [m/s]", *less, "duration [s]", "manoeuvre")
    )


def _with_units(indices: Mapping[str, Any]) -> list[tuple[str, Mapping[str, Any]]]:
    """Indices that are stated; those that are read from a record are numbers alone."""
    return [(key, of) for key, of in indices.items() if isinstance(of, Mapping)]


def made(result: Made) -> View:
    """A row a set: what it is, where it lies and how much is in it."""
    rows: list[Row] = [
        {
            "set": one["set"],
            "about": one["about"],
            "trials": one["trials"],
            "duration [s]": one["seconds"],
            "samples": one["samples"],
            "folder": one["folder"],
        }
        for one in result.sets
    ]
    ship = f"The profile of the ship is {result.profile}." if result.profile else ""
    return View(repr(result), [ship] if ship else [], rows, spare=("folder",))


def _about(one: Trial, role: str) -> Row:
    return {
        "trial": one.id,
        "role": role,
        "manoeuvre": one.manoeuvre,
        "source": one.source,
        "duration [s]": one.duration,
        "samples": one.n_samples,
        "approach speed [m/s]": float(one.u[0]) if one.n_samples and np.isfinite(one.u[0]) else None,
    }


def _stated(one: IndexTrial, role: str) -> Row:
    empty = {"duration [s]": None, "samples": None, "approach speed [m/s]": None}
    return {"trial": one.id, "role": role, "manoeuvre": one.manoeuvre, "source": "stated indices", **empty}


def motion(run: Motion) -> View:
    """Its last state; as a frame all samples."""
    says = [] if not run.diverged else ["The simulation left the world of ships; its states mean nothing."]
    states = dict(zip(FILE_CHANNELS, run.states.T, strict=True))
    rows = [
        {"channel": name, "first": float(of[0]), "last": float(of[-1]), "unit": _unit(name)}
        for name, of in states.items()
    ]
    columns = {named(name): of for name, of in states.items()}
    columns |= {named(name): run.controls[:, k] for k, name in enumerate(run.inputs)}
    return View(
        repr(run), says, rows, frame={"t [s]": run.t, **columns}, along="t [s]",
        motions=lambda: {run.id: [simulated(run, "simulated")]},
    )  # fmt: skip


def simulation(result: Simulated) -> View:
    """A row a run, with the indices it is first judged by."""
    rows: list[Row] = []
    for run in result.rows():
        indices = {_index(key): value for key, value in run["indices"].items() if key in PRINCIPAL}
        member = {"member": run["member"]} if "member" in run else {}
        rows.append({"run": run["id"], **member, "status": run["status"], **indices})
    less = [_index(key) for key in reversed(PRINCIPAL) if key not in FIRST]
    return View(repr(result), [], alike(rows), result.notes, spare=less, motions=lambda: _simulated(result))


def _index(key: str) -> str:
    """An index with its unit."""
    text, unit = index_words(key)
    return f"{text} [{unit}]" if unit else text


def alike(rows: list[Row]) -> list[Row]:
    """Rows with the columns of all of them, None where one has no such."""
    heads = list(dict.fromkeys(head for row in rows for head in row))
    return [{head: row.get(head) for head in heads} for row in rows]


def record(one: TrialRecord) -> View:
    """One trial beside one simulation of it."""
    called = dict(zip(STATES, FILE_CHANNELS, strict=True))
    rows = [{"error, rms": called[key], "value": value, "unit": _unit(called[key])} for key, value in one.rms.items()]
    return View(repr(one), [f"J ({one.method}) {one.J:.4g}."], rows, motions=lambda: {one.trial.id: of_record(one)})


def of_record(one: TrialRecord) -> list[Line]:
    """A trial as measured and as simulated."""
    return [measured(one.trial), *([] if one.diverged else [simulated(one.motion, "simulated")])]


def measured(one: Trial) -> Line:
    """A trial as it was logged."""
    states = {name: one.motion[:, k] for k, name in enumerate(STATES)}
    inputs = {name: values for name, values in one.columns.items() if name in INPUTS}
    return Line("measured", "measured", one.t, {**states, **inputs})


def simulated(run: Motion, words: str, kind: str = "model") -> Line:
    """A simulated run."""
    states = dict(zip(STATES, run.states.T, strict=True))
    return Line(words, kind, run.t, {**states, **{name: run.controls[:, k] for k, name in enumerate(run.inputs)}})


def _simulated(result: Simulated) -> Mapping[str, list[Line]]:
    by_trial: dict[str, Any] = {one.trial.id: one.trial for one in result.records}
    found: dict[str, list[Line]] = {}
    for run in result.motions:
        lines = found.setdefault(run.id, [measured(by_trial[run.id])] if run.id in by_trial else [])
        if not run.diverged:
            several = result.predictor.n_members > 1
            words = f"{result.predictor.name} {run.member + 1}" if several else result.predictor.name
            lines.append(simulated(run, words))
    return found
