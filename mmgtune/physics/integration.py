"""One step of a fixed-step method in which each stage needs only the one before: the only copy of its arithmetic.

All of it works on one number of the state or on arrays of any shape.
"""


def between(before, after, f):
    """A quantity at the share f of a step over which it changes linearly."""
    return before + f * (after - before)


def at_stage(s, ahead, h, rate):
    """The state a stage looks at: ``ahead`` of the step h [s] along the rate of the stage before."""
    return s + ahead * h * rate


def with_stage(total, share, rate):
    """Mean rate of the stages so far, this one with its share in the step."""
    return total + share * rate


def after_step(s, h, total):
    """The state after a step of h [s] at the mean rate of its stages."""
    return s + h * total
