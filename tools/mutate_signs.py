"""Turn round every sign in the equations, one at a time: do tests notice?  Writes ``docs/wrong-signs.md``.

    python tools/mutate_signs.py [--only TEXT] [--results docs/wrong-signs.jsonl]

A copy of the checkout is changed, never the checkout. Each change runs the quick suites that ``make test`` runs as
well, those of the equations first, until one fails. Results are kept line by line, so a run that was stopped goes on;
a file that was edited since is done again.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmgtune.files import write_text

ROOT = Path(__file__).parent.parent
FOLDERS = ("mmgtune/physics", "mmgtune/effects")
SUITES = (
    "tests/physics",
    "tests/effects/test_equations.py",
    "tests/checking/test_check.py::test_the_committed_baseline_is_what_the_program_does",
    "tests/papers",
    "tests/properties",
    "tests/effects",
)
EXPLAINED = {
    "table[0] + 0.0 * size": "adds nothing with either sign",
    "-1.0": "the end of a range of search, no equation",
}
"""Why a sign that nobody notices is harmless, by its expression."""

PATIENCE = 600.0
"""Seconds after which a suite that does not end counts as failed."""


@dataclass(frozen=True)
class Sign:
    """One plus or minus in a function.

    path   of the file, relative to the checkout
    at     place of the character in the file
    line   its number, from 1
    code   the expression it stands in
    """

    path: str
    at: int
    line: int
    code: str

    def turned(self, text: str) -> str:
        """The file with this sign turned round."""
        return text[: self.at] + {"+": "-", "-": "+"}[text[self.at]] + text[self.at + 1 :]


def signs(path: Path) -> Iterator[Sign]:
    """Every sign in the functions of a file."""
    text = path.read_text(encoding="utf-8")
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    name = path.relative_to(ROOT).as_posix()

    def place(line: int, column: int) -> int:
        return starts[line - 1] + column

    found: dict[int, Sign] = {}
    functions = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
    for node in (inner for function in functions for inner in ast.walk(function)):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            begin = place(node.left.end_lineno or 0, node.left.end_col_offset or 0)
            end = place(node.right.lineno, node.right.col_offset)
            at = begin + next(k for k, letter in enumerate(text[begin:end]) if letter in "+-")
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            at = place(node.lineno, node.col_offset)
        else:
            continue
        code = " ".join((ast.get_source_segment(text, node) or "").split())
        found.setdefault(at, Sign(name, at, text[:at].count("\n") + 1, code))
    yield from (found[at] for at in sorted(found))


def passes(copy: Path, suite: str, **environment: str) -> bool:
    """Whether a suite of the copy passes; subprocess.TimeoutExpired after PATIENCE."""
    # Bytecode is told apart by time and size only, and a turned sign has neither of its own.
    own = {"PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1", **environment}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", suite]
    ended = subprocess.run(command, cwd=copy, env={**os.environ, **own}, capture_output=True, timeout=PATIENCE)
    return ended.returncode == 0


def caught_by(copy: Path, sign: Sign) -> str:
    """The suite that fails with this sign turned round, "" where none does."""
    target = copy / sign.path
    right = (ROOT / sign.path).read_text(encoding="utf-8")
    target.write_text(sign.turned(right), encoding="utf-8")
    cache = Path(tempfile.mkdtemp(prefix="signs-"))
    try:
        for suite in SUITES:
            try:
                if not passes(copy, suite, MMGTUNE_CACHE=str(cache)):
                    return suite.partition("::")[0]
            except subprocess.TimeoutExpired:
                return f"{suite} (does not end)"
    finally:
        target.write_text(right, encoding="utf-8")
        shutil.rmtree(cache, ignore_errors=True)
    return ""


def page(rows: list[dict[str, Any]]) -> str:
    """The results for people."""
    files = list(dict.fromkeys(row["path"] for row in rows))
    left = [row for row in rows if not row["caught_by"]]
    lines = [
        "# Wrong signs",
        "",
        "Written by `tools/mutate_signs.py` (`make signs`). Every plus and minus in the functions of the equations and",
        f"of the effects was turned round, one at a time: {len(rows)} in all. Quick suites of `make test`",
        f"notice {len(rows) - len(left)}. A component, or an effect, is its file.",
        "",
        "| file | signs | noticed | first noticed by |",
        "|---|---:|---:|---|",
    ]
    for name in files:
        of = [row for row in rows if row["path"] == name]
        by = list(dict.fromkeys(row["caught_by"] for row in of if row["caught_by"]))
        lines.append(f"| `{name}` | {len(of)} | {sum(bool(row['caught_by']) for row in of)} | {', '.join(by)} |")
    if left:
        lines += ["", "Not noticed:", "", "| where | expression | |", "|---|---|---|"]
        lines += [
            f"| `{row['path']}`, line {row['line']} | `{row['code']}` | {EXPLAINED.get(row['code'], '')} |"
            for row in left
        ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Do what is missing, then write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="only files whose path holds this")
    parser.add_argument("--results", type=Path, default=ROOT / "docs" / "wrong-signs.jsonl")
    options = parser.parse_args()
    path: Path = options.results
    files = [file for folder in FOLDERS for file in sorted((ROOT / folder).rglob("*.py")) if options.only in str(file)]
    hashes = {
        file.relative_to(ROOT).as_posix(): hashlib.sha256(file.read_bytes()).hexdigest()[:16]
        for folder in FOLDERS
        for file in (ROOT / folder).rglob("*.py")
    }
    kept = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []
    kept = [row for row in kept if hashes.get(row["path"]) == row["sha256"]]
    done = {(row["path"], row["at"]) for row in kept}
    write_text(path, "".join(json.dumps(row) + "\n" for row in kept))
    with tempfile.TemporaryDirectory(prefix="signs-") as folder:
        copy = Path(folder) / "copy"
        shutil.copytree(
            ROOT, copy, ignore=shutil.ignore_patterns(".venv", ".git", ".cache", "__pycache__", "runs", "site")
        )
        broken = caught_by_nothing_wrong(copy)
        if broken:
            raise SystemExit(f"{broken} fails with no sign turned round")
        for file in files:
            for sign in signs(file):
                if (sign.path, sign.at) in done:
                    continue
                row = {
                    "path": sign.path,
                    "sha256": hashes[sign.path],
                    "at": sign.at,
                    "line": sign.line,
                    "code": sign.code,
                    "caught_by": caught_by(copy, sign),
                }
                kept.append(row)
                with path.open("a", encoding="utf-8") as out:
                    out.write(json.dumps(row) + "\n")
                print(f"{sign.path}:{sign.line} {sign.code[:60]}: {row['caught_by'] or 'NOT NOTICED'}", flush=True)
    kept.sort(key=lambda row: (row["path"], row["at"]))
    write_text(ROOT / "docs" / "wrong-signs.md", page(kept))


def caught_by_nothing_wrong(copy: Path) -> str:
    """The suite that fails as it is, "" where all pass: then a failure means the sign."""
    return next((suite for suite in SUITES if not passes(copy, suite)), "")


if __name__ == "__main__":
    main()
