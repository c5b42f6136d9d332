"""Facts in trial files and splits of data sets: odd numbers, wrong types, deep nesting, and bytes that are no JSON."""

from __future__ import annotations

import io
import json

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ..mutating import encoded, mutated_bytes, odd_number, odd_text, pick
from . import Files, Kind
from .trials import FACTS, columns_of, run

KEYS = (*FACTS, "manoeuvre", "note", "cut_from", "unknown")
SPLIT = 'ship = "ketch"\ntune = ["run"]\ntest = []\n'


def odd_json(rng: np.random.Generator) -> str:
    """A JSON value, or what looks like one."""
    deep = int(pick(rng, (3, 900, 5000, 100_000)))
    return pick(
        rng,
        (
            lambda: odd_number(rng),
            lambda: json.dumps(odd_text(rng)),
            lambda: "[" * deep + "]" * deep,
            lambda: '{"a":' * deep + "1" + "}" * deep,
            lambda: pick(rng, ("null", "true", "[]", "{}", '{"x": NaN}', '{"x": 1e999}', '{"u": true}', "-Infinity")),
            lambda: '{"x": ' + odd_number(rng) + "}",
            lambda: '"\\ud800"',
            lambda: "9" * 5000,
            lambda: '{"' + "k" * 5000 + '": 1}',
        ),
    )()


def odd_toml(rng: np.random.Generator) -> str:
    """A TOML value, or what looks like one."""
    deep = int(pick(rng, (3, 900, 5000, 100_000)))
    return pick(
        rng,
        (
            lambda: odd_number(rng),
            lambda: json.dumps(odd_text(rng)),
            lambda: "[" * deep + "]" * deep,
            lambda: "{ a = " * deep + "1" + " }" * deep,
            lambda: pick(rng, ("true", "[]", "{}", "nan", "-inf", "1979-05-27", "07:32:00", "0x7fffffff", "[1, 2]")),
            lambda: '"' + odd_number(rng) + " " + pick(rng, ("m", "s", "rad", "kn", "°", "x")) + '"',
            lambda: "[" + ", ".join([odd_number(rng)] * 3) + "]",
            lambda: "9" * 5000,
            lambda: '"""' + "x" * 5000 + '"""',
        ),
    )()


def make(rng: np.random.Generator) -> Files:
    """A good trial with odd facts, or with an odd split beside it."""
    facts = {key: json.dumps(value) for key, value in FACTS.items()}
    split = SPLIT
    if rng.random() < 0.7:
        facts[pick(rng, KEYS)] = odd_json(rng)
    else:
        lines = [line for line in split.splitlines() if rng.random() < 0.7]
        split = "\n".join([*lines, f"{pick(rng, ('ship', 'tune', 'test', 'licence', 'odd'))} = {odd_toml(rng)}"])
    raw = encoded("{" + ", ".join(f'"{key}": {value}' for key, value in facts.items()) + "}")
    if rng.random() < 0.2:
        raw = mutated_bytes(rng, raw)
    if rng.random() < 0.1:
        raw = b"\xef\xbb\xbf" + raw
    file = io.BytesIO()
    pq.write_table(pa.table(columns_of()).replace_schema_metadata({b"mmgtune": raw}), file)
    text = encoded(split)
    if rng.random() < 0.1:
        text = b"\xef\xbb\xbf" + text
    return {"run.parquet": file.getvalue(), "split.toml": text}


KIND = Kind("metadata", make, run)
