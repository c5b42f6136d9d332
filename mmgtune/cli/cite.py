"""``mmgtune cite``."""

from __future__ import annotations

from typing import Annotated

import typer

from . import common as c
from . import completing

METHODS = {
    "calibration within a box around captive-test values, J (fit, sweep)": ("Suyama et al. 2023, arXiv:2312.04224",),
    "restart CMA-ES (fit, sweep)": (
        "Hansen & Ostermeier 2001, Evolutionary Computation 9(2), 159-195",
        "Auger & Hansen 2005, IEEE Congress on Evolutionary Computation, 1769-1776",
    ),
    "distance measures MMD to cVDM (simulate, diagnose, check)": (
        "Mathioudakis et al., Towards real-world validation of a physics-based ship motion prediction model",
    ),
    "standardised error L_MSE (validate, leave-out)": (
        "Wakita et al. 2022, J. Marine Science and Technology, doi 10.1007/s00773-021-00867-1",
    ),
    "recurrent networks of a low-speed model (learn rnn, compare)": (
        "Wakita et al. 2022, J. Marine Science and Technology, doi 10.1007/s00773-021-00867-1",
    ),
    "ensembles of networks and their bands (learn ensemble, predict, study)": (
        "Wakita, Akimoto & Maki, Probabilistic prediction of ship maneuvering motion using ensemble learning",
    ),
    "manoeuvring indices and criteria": ("IMO MSC.137(76), Standards for ship manoeuvrability",),
}
"""What was computed with a profile has its papers too; diagnosis and posterior are this program's own."""


def command(
    profile: Annotated[
        str, typer.Argument(help="A TOML file or a bundled name.", autocompletion=completing.profiles)
    ] = "suzaku",
    json: c.Json = False,
) -> None:
    """The papers behind the components and effects a profile uses, and behind the published methods.

    Examples:

      mmgtune cite esso_osaka_3m

      mmgtune cite my_ship.toml --json
    """
    from ..profile import load_profile

    ship = load_profile(profile)
    parts = {
        f"[{kind}] {section.component.tag}: {section.component.title}": section.component.cites
        for kind, section in ship.sections.items()
        if section.component.cites
    }
    if json:
        c.print_json(
            {
                "schema": 1,
                "kind": "cite",
                "profile": ship.id,
                "source": ship.source,
                "licence": ship.licence,
                "citation": ship.citation,
                "components": [{"component": name, "papers": list(of)} for name, of in parts.items()],
                "methods": [{"method": name, "papers": list(of)} for name, of in METHODS.items()],
            }
        )
        return
    c.show("\n    ".join((ship.name, ship.source, *c.terms(ship))))
    for heading, of in (("Components", parts), ("Methods, where you used them", METHODS)):
        c.show(f"\n{heading}")
        for name, papers in of.items():
            c.show(f"  {name}")
            for paper in papers:
                c.show(f"    {paper}")
