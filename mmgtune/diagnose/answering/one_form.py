"""Values of an effect that differ from run to run, where what is the same in all runs tells as much.

A blade that falls behind its indicator the more, the larger the angle, is a gain of the rudder that differs between
turns of 35° and zigzags of 10°: values of each run bend to it, and say nothing of the next run.  An engine that loses
revolutions in turns is a loading that does, and what that bends to hides what else there is.
"""

from __future__ import annotations

from ..result import Diagnosis

AS_UNSEEN = 0.95
"""Share of what values of each run remove of the error on test trials, estimated on a part of these, from which what is
the same in all runs, and sees none of them, tells these as well."""


def of_one_form(result: Diagnosis) -> str:
    """Tag of the effect of a single cause with values of each run, where a richer form of it, with one value for all,
    tells the test trials as well; "" where not."""
    if not result.names_causes or len(result.causes) != 1:
        return ""
    (cause,) = result.causes
    if cause.runs is None:
        return ""
    own = set(cause.runs.variant)
    forms = [one for one in result.candidates if one.effect == cause.tag and not one.by and own < set(one.parameters)]
    told = max((told_on_test(result, one.J_test) for one in forms), default=0.0)
    return cause.tag if told > 0.0 and told >= AS_UNSEEN * told_on_test(result, result.gain.J[1]) else ""


def misleading(result: Diagnosis) -> str:
    """Tag of an effect with values of each run that is among the causes named, or was set aside, and tells what is held
    out worse; "" where there is none."""
    if not result.names_causes:
        return ""
    causes = [one.tag for one in result.causes if one.runs and one.gain_test is not None and one.gain_test < 0.0]
    traces = [one.cause.tag for one in result.traces if one.cause.runs and one.contribution.harmful]
    return next(iter([*causes, *traces]), "")


def tells_as_well(other: Diagnosis, result: Diagnosis) -> bool:
    """Whether causes are named and tell the test trials as well, once values of each run were not looked for."""
    return other.names_causes and told_on_test(other, other.gain.J[1]) >= AS_UNSEEN * told_on_test(
        result, result.gain.J[1]
    )


def told_on_test(result: Diagnosis, J: float | None) -> float:
    """Share of J on test trials that what leaves this much removes; 0 where it was not measured."""
    before = result.gain.J[0]
    return 1.0 - J / before if before and J is not None else 0.0
