"""Bands beside what other commands say of a ship: of the manoeuvres of a simulation, and of what a fit found."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..arguments import TrialsGiven
from ..displayed import Displayed
from ..errors import OptionError, must_be_a
from ..fitting import FitResult, write_run
from ..hooks import Hooks
from ..options import PredictOptions
from ..phrases import counted
from ..posterior import Posterior, posterior, write_posterior
from ..predictor import Uncertain
from ..run_files import FIT, PARTICLES, POSTERIOR
from ..simulating import Simulated, turns_of
from ..writing_results import place_for, write_record
from .result import Predicted
from .run import predict


def with_bands(result: Simulated) -> Simulated:
    """A simulation of manoeuvres with a band on each index, and with notes on the bands, where its ship has some.

    Unchanged where trials were simulated, and where the predictor is one model.  A ship of which these manoeuvres
    cannot be predicted has a note that says why, and no bands.
    """
    must_be_a(result, Simulated, "result")
    if result.records or not isinstance(result.predictor, Uncertain):
        return result
    asked = {**result.options.shared_with(PredictOptions), "turn": turns_of(result.options)}
    found, notes = _predicted(result.predictor, PredictOptions(**asked))
    bands = None if found is None else found.indices()
    return replace(result, bands=bands, notes=tuple(dict.fromkeys((*result.notes, *notes))))


@dataclass(frozen=True, eq=False)
class FitBands(Displayed):
    """What trials leave open of a ship that was tuned to them, and what comes of that in the usual manoeuvres.

    fit        that tuned her
    posterior  particles of the tuned profile
    predicted  these manoeuvres by all particles; None where the ship cannot be ordered to sail them
    notes      on that prediction
    """

    written_by = "write_fit_bands"

    fit: FitResult
    posterior: Posterior
    predicted: Predicted | None
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        """In a line."""
        return f"FitBands({self.fit.profile.id}, {counted(len(self.posterior.particles), 'particle')})"

    @property
    def interrupted(self) -> bool:
        """Whether the drawing of particles was stopped."""
        return self.posterior.interrupted

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader must know: of the particles, and of the prediction."""
        return (*self.posterior.warnings, *self.notes)

    def to_dict(self) -> dict[str, Any]:
        """For JSON: ``bands`` of ``fit.json``."""
        predicted = None if self.predicted is None else self.predicted.indices()
        return {**self.posterior.to_dict(), "warnings": list(self.warnings), "predicted": predicted}


def fit_bands(result: FitResult, trials: TrialsGiven, *, hooks: Hooks = Hooks(), command: str = "") -> FitBands:
    """Draw particles of what a fit found, and predict the usual manoeuvres with bands: ``mmgtune fit --bands``.

    trials   those of the fit: objects, a path or a bundled name
    hooks    what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    command  what to call this in its provenance
    Integrator, back end and seed are those of the fit.  Raises OptionError as ``posterior`` does.
    """
    must_be_a(result, FitResult, "result")
    options = result.options
    drawn = posterior(result.tuned_profile(), trials, options.posterior_options(), hooks=hooks, command=command)
    found, notes = _predicted(drawn.particles.predictor(options.make_integrator()), PredictOptions())
    return FitBands(result, drawn, found, tuple(notes))


def write_fit_bands(result: FitBands, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write the run folder of a fit with its bands: the particles, their record, and ``bands`` of the result.

    Returns the document of the fit.  Raises OutputError where a result is there already and ``overwrite`` is false, or
    the system refuses to write.
    """
    with place_for(result, FitBands, folder, PARTICLES, POSTERIOR, overwrite=overwrite) as place:
        document = write_run(result.fit, place, overwrite=overwrite)
        made = write_posterior(result.posterior, place, overwrite=overwrite)
        return write_record({**document, "bands": {**made, **result.to_dict()}}, place, FIT)


def _predicted(ship: Uncertain, options: PredictOptions) -> tuple[Predicted | None, list[str]]:
    """The manoeuvres of the options, the usual ones where there are none, and notes on them.

    None, with the reason, for a ship that they cannot be ordered of: what stands beside them is worth as much.
    """
    try:
        found = predict(ship, options=options)
    except OptionError as error:
        return None, [f"No bands: {one.what}{f' ({one.why})' if one.why else ''}." for one in error.problems]
    return found, list(found.notes)
