"""``mmgtune doctor``."""

from __future__ import annotations

from dataclasses import asdict

import typer

from ..phrases import counted
from . import common as c
from .exitcodes import ExitCode


def command(json: c.Json = False) -> None:
    """Versions, back ends, cores, compile cache and data: what works here, and what to do about what does not.

    Exit code 1 where something keeps the program from working.

    Examples:

      mmgtune doctor

      mmgtune doctor --json
    """
    from ..doctor import examine

    found = examine()
    good = all(one.ok for one in found)
    if json:
        c.print_json({"schema": 1, "kind": "doctor", "ok": good, "findings": [asdict(one) for one in found]})
    else:
        width = max(len(one.name) for one in found) + 2
        for one in found:
            c.show(f"{'' if one.ok else 'WRONG  '}{one.name:<{width}}{one.value}")
            if one.fix:
                c.show(f"  fix: {one.fix}")
        wrong = sum(not one.ok for one in found)
        c.show("all is well" if good else f"{counted(wrong, 'thing')} {'is' if wrong == 1 else 'are'} wrong")
    if not good:
        raise typer.Exit(ExitCode.NO)
