"""NMEA 0183 logs: sentences with odd fields, whose checksums are mostly right."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np

from tests.importing.made import nmea, sentence, turn

from ..mutating import encoded, mutated_bytes, mutated_cells, mutated_lines, odd_text, pick, several
from . import Files, Kind
from .csv_logs import imports

MAP = b'schema = 1\n[log]\nformat = "nmea"\n'
SENTENCES = ("GGA", "VTG", "HDT", "ROT", "RSA", "RPM", "MWV")
MORE = (
    "GPRMC,120000,A,3500.0,N,13900.0,E,6.0,045.0,010524,,", "GPGLL,3500.0,N,13900.0,E,120000,A", "HETHS,45.0,A",
    "GPZDA,120000,01,05,2024,00,00", "WIMWD,45.0,T,,M,10.0,N,5.1,M", "WIMWV,45.0,R,10.0,S,A", "IIRSA,5.0,A,5.0,A",
    "GPVTG,45.0,T,,M,6.0,N,,K,A", "IIRPM,E,0,100.0,,A", "GPGGA,250000,3500.0,N,13900.0,E,1,9,,,M,,M,,",
    "GNGNS,120000,3500.0,N,13900.0,E,AAN,9,,,,,", "HCHDG,45.0,,,7.5,W", "HCHDM,45.0,M", "AGROR,5.0,A,,,B",
    "AGHTD,A,5.0,L,M,N,35.0", "VDVBW,6.0,0.1,A,6.0,0.1,A", "SDDPT,20.0,4.5,", "SDDBS,60.0,f,18.3,M,10.0,F",
)  # fmt: skip


@functools.cache
def whole() -> tuple[str, ...]:
    """A log that can be imported: 120 fixes of a turn."""
    lines = nmea(turn())
    return tuple(lines[: 120 * len(lines) // 400])


def _signed(line: str) -> str:
    return sentence(encoded(line[1:].split("*")[0]).decode("ascii", "ignore"))


def _fields(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """A field of all sentences of a kind, or of some, replaced, exchanged or left out."""
    kind = pick(rng, SENTENCES)
    rows = [k for k, line in enumerate(lines) if line[3:6] == kind]
    some = rows[int(rng.integers(len(rows))) :][: int(pick(rng, (1, 3, len(rows))))] if rows else []
    changed = mutated_cells(rng, [lines[k].split("*")[0] for k in some], ",")
    out = list(lines)
    for k, line in zip(some, changed, strict=True):
        out[k] = _signed(line)
    return out


def _one_field(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """One field of every sentence of a kind, by its place."""
    kind, place, written = pick(rng, SENTENCES), int(rng.integers(1, 9)), odd_text(rng)
    out = []
    for line in lines:
        cells = line.split("*")[0].split(",")
        if line[3:6] == kind and place < len(cells):
            cells[place] = written
            line = _signed(",".join(cells))
        out.append(line)
    return out


def _another(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """A sentence of another kind here and there."""
    added, every = sentence(pick(rng, MORE)), int(rng.integers(1, 100))
    return [one for k, line in enumerate(lines) for one in ((line, added) if k % every == 0 else (line,))]


def make(rng: np.random.Generator) -> Files:
    """A log with something wrong in its fields, sentences or bytes."""
    lines = list(whole())
    content = encoded("\r\n".join(several(rng, lines, [_fields, _fields, _one_field, _another, mutated_lines])))
    if rng.random() < 0.2:
        content = mutated_bytes(rng, content)
    return {"log.nmea": content, "map.toml": MAP}


def run(folder: Path) -> str:
    """Import it."""
    return imports(folder, "log.nmea")


KIND = Kind("nmea", make, run)
