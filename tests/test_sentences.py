"""Sentences are for people: no code of the program reads them to know what to do."""

import ast
import copy
import json
from pathlib import Path

import mmgtune
from mmgtune.hooks import Phase
from mmgtune.trial.checks.finding import Rescale

TEXTS = {"what", "why", "where", "fix"}
"""Attributes of problems and findings that hold sentences."""

SEARCHES = {
    "count", "endswith", "find", "index", "lower", "partition", "removeprefix", "removesuffix", "replace", "rfind",
    "rpartition", "split", "splitlines", "startswith", "strip",
}  # fmt: skip
"""Methods by which a text is taken apart."""

PATTERNS = {"findall", "fullmatch", "match", "search", "split", "sub"}
"""Functions of ``re`` and methods of its patterns."""


def _functions(tree: ast.AST) -> set[int]:
    """What is called, such as ``np.where``, which is no text."""
    return {id(one.func) for one in ast.walk(tree) if isinstance(one, ast.Call)}


def _holds_text(node: ast.AST, called: set[int]) -> bool:
    return any(isinstance(one, ast.Attribute) and one.attr in TEXTS and id(one) not in called for one in ast.walk(node))


def _is_phase(node: ast.AST) -> bool:
    name = node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""
    return name.strip("_") == "phase"


def readings(source: str) -> list[int]:
    """Lines that compare or search the sentences of problems and findings, or what a phase of the work is called."""
    tree = ast.parse(source)
    called = _functions(tree)
    lines = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare):
            read = any(_holds_text(side, called) for side in (node.left, *node.comparators))
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            of = node.func.value
            read = node.func.attr in SEARCHES and (_holds_text(of, called) or _is_phase(of))
            read |= node.func.attr in PATTERNS and any(_holds_text(one, called) for one in node.args)
        else:
            continue
        if read:
            lines.append(node.lineno)
    return lines


def test_no_code_reads_sentences():
    package = Path(mmgtune.__file__).parent
    found = [
        f"{path.relative_to(package)}:{line}" for path in package.rglob("*.py") for line in readings(path.read_text())
    ]
    assert found == []


def test_what_counts_as_reading_them():
    assert readings("if 'recovered' in problem.what: pass") == [1]
    assert readings("x\nif re.match('multiply', finding.fix): pass") == [2]
    assert readings("problem.where.partition('=')") == [1]
    assert readings("if (one.what, one.why) not in seen: pass") == [1]
    assert readings("if phase.startswith('looking for'): pass") == [1]
    assert readings("np.where(a > b, a, b) > 0.0") == []
    assert readings("replace(problem, fix=other)") == []


def test_words_keep_what_they_carry_and_are_written_as_words():
    for words, key in ((Rescale("divide 'r' by 60", "r"), "column"), (Phase("looking for cause 2", look=2), "look")):
        again = copy.deepcopy(words)
        assert (again, getattr(again, key)) == (words, getattr(words, key))
        assert json.dumps(words) == json.dumps(str(words))
