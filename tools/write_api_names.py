"""Write the table of public names into ``docs/reference/api/index.md``: each name and the page that describes it.

python tools/write_api_names.py
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

import mmgtune
from mmgtune.files import write_text

PAGES = Path(__file__).parent.parent / "docs" / "reference" / "api"
WHAT = {
    "profile": "ship profiles, the matrix simulators work on, and profiles from main dimensions",
    "trial": "trial files, logs, and trials made of a model",
    "simulation": "motion and forces",
    "predicting": "what a model foretells, with bands, and the trial to sail next",
    "fitting": "calibration, run folders and reports",
    "validation": "scores, models side by side, manoeuvres repeated, voyages, regression",
    "manoeuvres": "indices and measures",
    "diagnose": "what is wrong, and why",
    "bands": "what trials leave open, and particles",
    "learning": "networks trained, alone and beside a model of forces, and controllers judged",
    "fleet": "many ships at many dates",
    "options": "what these can be told",
    "extending": "effects, arrangements and inputs of one's own",
    "errors": "what all errors are",
}
"""What names of each page are about, in the order of the table."""
MODULES = {"extending": ("mmgtune.effects", "mmgtune.components", "mmgtune.inputs")}
"""Modules that stand in the table besides names."""
_HEAD = "| name | what | page |\n|---|---|---|\n"
_DESCRIBED = re.compile(r"^::: (\S+)\n((?:^(?: .*)?\n)*)", re.M)


def described(page: str) -> list[str]:
    """Public names that a page describes, in its order."""
    public = {name: getattr(mmgtune, name) for name in mmgtune.__all__}
    found = []
    for module, settings in _DESCRIBED.findall((PAGES / f"{page}.md").read_text(encoding="utf-8") + "\n"):
        members = re.findall(r"^ +- (\w+)$", settings, re.M)
        there = import_module(module)
        shown = members or [name for name, one in public.items() if one.__module__ == module]
        found += [name for name in shown if name in public and public[name] is getattr(there, name)]
    return list(dict.fromkeys(found))


def table(public: Iterable[str] = mmgtune.__all__) -> str:
    """The table of public names.  Raises ValueError where one has no page."""
    rows, left = [], set(public)
    for page, what in WHAT.items():
        names = [name for name in described(page) if name in left]
        left -= set(names)
        title = (PAGES / f"{page}.md").read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")
        shown = ", ".join(f"`{name}`" for name in (*names, *MODULES.get(page, ())))
        rows.append(f"| {shown} | {what} | [{title}]({page}.md) |\n")
    if left:
        raise ValueError(f"no page of docs/reference/api describes {', '.join(sorted(left))}")
    return _HEAD + "".join(rows)


def page() -> str:
    """The page with the table as it has to be."""
    text = (PAGES / "index.md").read_text(encoding="utf-8")
    before, after = text.split(_HEAD)
    return before + table() + after[re.match(r"(\|.*\n)*", after).end() :]  # type: ignore[union-attr]


if __name__ == "__main__":
    write_text(PAGES / "index.md", page())
