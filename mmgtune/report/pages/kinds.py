"""The kinds of runs that there are reports of.

The list is explicit.  A further kind is one file with its page, and one line here.
"""

from __future__ import annotations

from ..load import Kind
from . import (
    check_page,
    comparison_page,
    diagnosis_page,
    ensemble_page,
    fit_page,
    fleet_page,
    heading_page,
    hybrid_page,
    learning_page,
    leave_out_page,
    models_page,
    plan_page,
    predict_page,
    simulate_page,
    sweep_page,
    validate_page,
    voyages_page,
)

KINDS: tuple[Kind, ...] = tuple(
    page.KIND
    for page in (
        diagnosis_page,
        sweep_page,
        fit_page,
        voyages_page,
        comparison_page,
        learning_page,
        ensemble_page,
        hybrid_page,
        models_page,
        heading_page,
        predict_page,
        plan_page,
        leave_out_page,
        validate_page,
        check_page,
        simulate_page,
        fleet_page,
    )
)
"""Every kind, in the order in which their files are looked for."""
