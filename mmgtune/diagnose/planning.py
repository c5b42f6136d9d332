"""What a diagnosis would do, before it does it, and about how long that takes here."""

from __future__ import annotations

from ..arguments import ShipGiven, TrialsGiven, ship_of
from ..fitting.box import width_words
from ..fitting.extending import with_width
from ..fitting.planning import Plan, can_be_tried, evaluation_seconds, whole
from ..fitting.setting import in_pieces
from ..options import DiagnoseOptions
from ..run_files import DIAGNOSIS, DRAWN_UP, MOTIONS, PROFILE
from ..trial import VoyageSet
from .bench.beliefs import FURTHEST
from .bench.hypotheses import known_causes
from .bench.workbench import make_workbench
from .voyages.windows import looked_at, with_hull_held

EVALUATIONS = (15, 200)
"""Evaluations a hypothesis costs per parameter fitted, over screening and refits, from few to many."""


def plan_diagnosis(profile: ShipGiven, trials: TrialsGiven | VoyageSet, options: DiagnoseOptions) -> Plan:
    """What a diagnosis would do.  Raises OptionError for what it would refuse."""
    ship = ship_of(profile)
    options = with_width(ship, options)
    own = options.fit_options()
    data, choice = looked_at(ship, trials, options)
    pieces = in_pieces(data, own)
    seen = [trial for name, trial in pieces.trials.items() if name not in pieces.test]
    known = known_causes(ship, seen, options)
    bench = make_workbench(ship, seen, with_hull_held(options) if choice else options)
    tags = list(dict.fromkeys(h.tag for h in known))
    search = (
        f"{len(known)} hypotheses, {options.most} causes at most, false alarm {options.level:g}, seed {options.seed}"
    )
    lines = (
        *((f"voyages   {choice.sentence}",) if choice else ()),
        *whole(ship, pieces, search, own),
        f"effects   {', '.join(tags)}",
        f"compares  {bench.problem.n_residuals} differences of {', '.join(bench.channels)}; back end {options.backend}",
        f"targets   within {width_words(options.a_r, scatters=FURTHEST)} of their values: {', '.join(bench.targets)}",
        *(
            (f"leeway    up to {100.0 * options.leeway:.3g} % of their values: {', '.join(bench.believed.leeway)}",)
            if bench.believed.leeway
            else ()
        ),
    )
    each = evaluation_seconds(bench.problem)
    free = len(bench.tuned_alone) + 7
    low, high = (len(known) * n * free * each for n in EVALUATIONS)
    files = (DIAGNOSIS, PROFILE, MOTIONS, *DRAWN_UP)
    return Plan(lines, (low, high), files, can_be_tried(bench.problem))
