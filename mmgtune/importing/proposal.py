"""A map proposed for logs, tried on them."""

from __future__ import annotations

import re
import textwrap
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from shlex import quote
from typing import Any

import numpy as np

from ..errors import LogError, Problem
from ..phrases import counted
from .doubts import shifted_lever
from .formats.forms import form_of
from .formats.kept import opened_once
from .formats.sentences import chosen, stand_ins
from .importer import Imported, import_logs, paths_of
from .maps.mapping import ALL, ASKS, PARTS, LogMap
from .maps.reading_map import parse_map
from .proposing.finder import MOST_LOGS, Finder
from .proposing.finding import found_in
from .proposing.guess import Guess
from .proposing.sampling import Sample, samples_of
from .proposing.writing import guess_dict, table_of_guesses, toml_of_map
from .yaw import WANDERS, NotFollowed


@dataclass(frozen=True, eq=False)
class Proposal:
    """A map and what speaks for it.

    text       of the map, TOML
    logs       it was made from
    guesses    by quantity, time under "t"
    asks       keys of the map that are questions, such as "columns.delta.positive"
    notes      what else is to be said
    problems   what the import of these logs by this map would be refused with, () where it asks, or where none is
    imported   number of trials that the logs would make, None where the map asks
    cuts       why there are more trials than logs: logs that the import cuts, and where
    """

    text: str
    logs: tuple[Path, ...]
    guesses: dict[str, Guess]
    asks: tuple[str, ...]
    notes: tuple[str, ...]
    left: tuple[str, ...]
    problems: tuple[Problem, ...]
    imported: int | None
    sample: Sample | None
    cuts: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """In a line."""
        told = f"asks for {', '.join(self.asks[:4])}" if self.asks else counted(self.imported or 0, "trial")
        told = f"{counted(len(self.problems), 'problem')}" if self.problems else told
        found = counted(len(self.guesses), "quantity", "quantities")
        return f"Proposal(of {counted(len(self.logs), 'log')}, {found}: {told})"

    def to_dict(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "schema": 1,
            "kind": "map",
            "logs": [str(one) for one in self.logs],
            "columns": [guess_dict(one, self.sample) for one in self.guesses.values()] if self.sample else [],
            "asks": list(self.asks),
            "left": list(self.left),
            "notes": list(self.notes),
            "problems": [one.to_dict() for one in self.problems],
            "trials": self.imported,
            "cuts": list(self.cuts),
            "map": self.text,
        }

    def table(self) -> list[tuple[str, str, str, str, str]]:
        """Rows for people: quantity, column, how it counts, confidence, evidence."""
        return table_of_guesses(self.guesses, self.sample) if self.sample else []

    def lines(self, path: str = "") -> list[str]:
        """What was found, for people: a table, what is asked, and what to do next with the map at ``path``."""
        rows = self.table()
        widths = [max((len(row[k]) for row in rows), default=0) for k in range(4)]
        lines = []
        for row in rows:
            start = "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=False))
            indent = " " * (len(start) + 2)
            lines += textwrap.wrap(f"{start}  {row[4]}", max(100, len(indent) + 40), subsequent_indent=indent) or [
                start
            ]
        if self.left:
            lines.append(f"not used: {', '.join(self.left)}")
        lines += [f"note: {note}" for note in self.notes]
        for key in self.asks:
            name, _, last = key.rpartition(".")
            guess = self.guesses.get(name.removeprefix("columns.")) or self.guesses.get("t" if name == "time" else "")
            keys = guess.keys if guess is not None else self.sample.layout if name == "log" and self.sample else {}
            question = str(keys.get(last, "")).removeprefix(ASKS).strip()
            lines.append(f"asked: {key}{f': {question}' if question else ''}")
        lines += [f"the import would be refused: {one}" for one in self.problems]
        name = path or "MAP.toml"
        if self.asks:
            lines.append(f"answer {'it' if len(self.asks) == 1 else f'these {len(self.asks)}'} in {name}, then import")
        elif not self.problems:
            logs = "the log" if len(self.logs) == 1 else f"all {len(self.logs)} logs"
            lines.append(f"the map imports {logs}, as {counted(self.imported or 0, 'trial')}")
            lines += [f"  {one}" for one in self.cuts[:4]]
            if len(self.cuts) > 4:
                lines.append(f"  and {counted(len(self.cuts) - 4, 'more log is', 'more logs are')} cut")
        lead = f"next: mend what is refused, in {name} or in the logs; then " if self.problems else "next: "
        lines.append(f"{lead}mmgtune trials import {_given(self.logs)} --map {quote(name)} -o trials --dry-run")
        return lines

    def map(self, path: Path = Path("map")) -> LogMap:
        """The map, read.  Raises LogError where it asks."""
        return parse_map(self.text, path)


def _given(logs: Sequence[Path]) -> str:
    """Logs as they may be given on the command line: many of one folder by the pattern that names just these."""
    if len(logs) > 3 and len({(log.parent, log.suffix) for log in logs}) == 1:
        folder, suffix = logs[0].parent, logs[0].suffix
        there = {one for one in folder.glob(f"*{suffix}") if not one.name.startswith(".")} if suffix else set()
        if there == set(logs):
            return f"{quote(str(folder))}/*{quote(suffix)}" if folder != Path() else f"*{quote(suffix)}"
    return " ".join(quote(str(log)) for log in logs)


@opened_once()
def propose_map(logs: Path | str | Sequence[Path | str]) -> Proposal:
    """Find out what the columns of logs, or of one, are and write a map that imports them.

    Raises LogError where a log cannot be read, is no table, or where the logs are of different kinds.
    """
    paths = paths_of(logs)
    forms = {path: form_of(path) for path in paths}
    if set(forms.values()) == {"nmea"}:
        return _of_sentences(paths)
    looked = paths[:: max(1, -(-len(paths) // MOST_LOGS))]
    # Damaged numbers overflow on their way to where they are found out.
    with np.errstate(all="ignore"):
        samples = [one for path in looked for one in samples_of(path)]
        finder = found_in(_of_all(samples[:: max(1, -(-len(samples) // MOST_LOGS))]))
    left = [
        finder.shown(k)
        for k in range(len(finder.first.names))
        if k not in finder.used and finder.first.names[k].strip()
    ]
    proposal = _made(finder, paths, tuple(left[:40]))
    if proposal.asks:
        return proposal
    with np.errstate(all="ignore"):
        return _tried(proposal, finder)


def _of_all(samples: list[Sample]) -> list[Sample]:
    """The same, the first of them with a layout that names no sheets or variables which other logs lack."""
    first = samples[0]
    others = {key for key in PARTS if any(one.layout.get(key) != first.layout.get(key) for one in samples)}
    if not others:
        return samples
    what = " and ".join(f"{key}s" for key in PARTS if key in others)
    note = f"the logs differ in their {what}: each that holds a log becomes a trial"
    layout = first.layout | dict.fromkeys(others, ALL)
    return [replace(first, layout=layout, notes=[note]), *(replace(one, notes=[]) for one in samples[1:])]


def _made(finder: Finder, paths: tuple[Path, ...], left: tuple[str, ...]) -> Proposal:
    guesses = finder.guesses
    tables = {name: dict(keys) for name, keys in finder.tables.items()}
    if finder.axes and "u" in guesses and "v" in guesses:
        tables["velocity"] = {"axes": finder.axes, **tables.get("velocity", {})}
    text = toml_of_map(guesses, finder.first, len(paths), tables, finder.comments, left, finder.notes)
    asks = tuple(
        f"log.{key}" for key, value in finder.first.layout.items() if isinstance(value, str) and value.startswith(ASKS)
    )
    asks += tuple(
        f"columns.{name}.{key}" if name != "t" else f"time.{key}"
        for name, guess in guesses.items()
        for key, value in guess.keys.items()
        if isinstance(value, str) and value.startswith(ASKS)
    )
    return Proposal(text, paths, dict(guesses), asks, tuple(finder.notes), left, (), None, finder.first)


def _tried(proposal: Proposal, finder: Finder) -> Proposal:
    """The proposal with what the import says of it; digits that cannot be recovered are left as they are."""
    found, problems = _imported(proposal)
    recovering = [name for name, guess in finder.guesses.items() if "recover" in guess.keys]
    if problems and recovering and any(isinstance(one, NotFollowed) for one in problems):
        for name in recovering:
            _leave_printed(finder, name, "no curve through its steps follows the rest of the log")
        proposal = _made(finder, proposal.logs, proposal.left)
        found, problems = _imported(proposal)
    if found is not None and "psi" in recovering and (by := _wander(found)) > 0.0:
        _leave_printed(finder, "psi", f"the noise of the yaw rate would add up to {by:.2g} deg rms")
        proposal = _made(finder, proposal.logs, proposal.left)
        found, problems = _imported(proposal)
    if found is not None:
        proposal, found = _with_findings(proposal, finder, found)
    return _told(proposal, found, problems)


def _leave_printed(finder: Finder, name: str, why: str) -> None:
    """Take back that a column printed with few digits is recovered."""
    guess, printed = finder.as_printed[name]
    finder.guesses[name] = replace(guess, evidence=(*guess.evidence, f"{printed}, and left so: {why}"))


def _wander(found: Imported) -> float:
    """What the noise of yaw rates adds up to in headings recovered from them, rms over all trials [deg]; 0 where it is
    little beside what rounding made of those printed, or none was recovered."""
    recovered = [one for quality in found.quality if (one := quality["yaw"]["recovered"]) is not None]
    if not recovered:
        return 0.0
    wander, rounding = (
        float(np.sqrt(np.mean([one[key] ** 2 for one in recovered]))) for key in ("wander_deg", "rounding_deg")
    )
    return wander if wander > WANDERS * rounding else 0.0


def _told(proposal: Proposal, found: Imported | None, problems: tuple[Problem, ...]) -> Proposal:
    """The proposal with what its import makes, or is refused with."""
    if found is None:
        return replace(proposal, problems=problems)
    where: dict[str, list[str]] = {}
    for quality in found.quality:
        if quality["cut"]:
            where.setdefault(quality["log"], []).append(quality["cut"])
    cuts = tuple(
        f"{Path(log).name} is cut where {said[0]}"
        + (f", and {counted(len(said) - 1, 'time')} more" if said[1:] else "")
        for log, said in where.items()
    )
    return replace(proposal, problems=problems, imported=len(found.trials), cuts=cuts)


def _with_findings(proposal: Proposal, finder: Finder, found: Imported) -> tuple[Proposal, Imported]:
    """The proposal with what only the trials show: a lever undone the wrong way, and a ship handled by people."""
    warnings = [one for quality in found.quality for one in quality["findings"] if one["severity"] == "warning"]
    codes = [one["code"] for one in warnings]
    before = found
    for key, value in (("from", "first-order"), ("to", "last-order")):
        if (many := codes.count(f"handled-{key}")) > 0:
            finder.tables.setdefault("cut", {})[key] = value
            finder.comments["cut"] = f"likely: in {many} of {len(found.trials)} trials people handle the ship meanwhile"
    levers = [one for one in map(shifted_lever, found.trials) if one is not None]
    if levers and len(levers) > 0.2 * len(found.trials) and "shifted" in codes:
        best = min(levers, key=lambda one: one.left)
        point = {"x": f"{best.ahead:.3g} m", "y": f"{best.across:.3g} m"}
        finder.tables.setdefault("velocity", {}).update({"point": point, "shifted": "earth-axes"})
        finder.comments["velocity"] = (
            f"likely: velocities were moved to midship from there along earth axes, not the ship's, which explains "
            f"{100.0 * (1.0 - best.left):.0f} % of what they miss the positions by"
        )
    if not finder.tables:
        return proposal, found
    other = _made(finder, proposal.logs, proposal.left)
    after, problems = _imported(other)
    return (proposal, before) if after is None or problems else (other, after)


def _imported(proposal: Proposal) -> tuple[Imported | None, tuple[Problem, ...]]:
    try:
        return import_logs(proposal.logs, proposal.map(), ".", dry_run=True), ()
    except LogError as error:
        return None, error.problems


_NMEA = """# Proposed by mmgtune trials map: sentences of NMEA 0183 say themselves what they hold.
{said}
schema = 1

[log]
format = "nmea"

[trial]
# ship = "her profile's id"
{columns}"""


def _of_sentences(paths: tuple[Path, ...]) -> Proposal:
    """The map of NMEA 0183 logs: what no sentence holds is asked for."""
    kinds: Counter[str] = Counter()
    for path in paths[:MOST_LOGS]:
        with path.open("rb") as file:
            start = file.read(1 << 20)
        kinds.update(one.decode() for one in re.findall(rb"[$!][A-Z]{2}([A-Z]{3}),", start))
    taken = chosen(kinds)
    said = ", ".join(f"{count} {kind}" for kind, count in kinds.most_common(20))
    asked, asks = [], []
    holders = (("n", "RPM", "1.5 rps", "RPM" in kinds), ("delta", "RSA", "0 deg", "rudder angle" in taken))
    for name, wanted, example, there in holders:
        if not there:
            asks.append(f"columns.{name}.value")
            asked.append(
                f'{name} = {{ value = "{ASKS} \\"{example}\\": no {wanted} sentence says it; which constant?" }}'
            )
    columns = "\n[columns]\n" + "\n".join(asked) + "\n" if asked else ""
    text = _NMEA.format(said=f"# Seen in their beginnings: {said}.", columns=columns)
    notes = (f"sentences seen: {said}", *stand_ins(taken))
    proposal = Proposal(text, paths, {}, tuple(asks), notes, (), (), None, None)
    if asks:
        return proposal
    found, problems = _imported(proposal)
    return _told(proposal, found, problems)
