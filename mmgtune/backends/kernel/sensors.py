"""Text that makes what is logged of the motion: sensors, then filters."""

from __future__ import annotations

from ...effects import FilterEffect, SensorEffect
from ...model import Model
from ...physics.quantities import STATES
from .text import N_STATES, WIDTH, each_lane, indented, name_of, slot, tuple_of


def _sense(model: Model) -> list[str]:
    """What sensors show of lane l."""
    lines = ["state = state_of(s, l)"]
    return lines + [f"state = {name_of(e)}(state, {tuple_of(e)})" for e in model.acting(SensorEffect)]


def log_rows(model: Model) -> int:
    """Numbers kept of a lane where there are filters: what sensors show, and of each what it logs and holds."""
    filters = model.acting(FilterEffect)
    return N_STATES * (1 + len(filters)) + sum(len(one.states) for one in filters)


def _store(at: int, states: int) -> list[str]:
    """What a filter, or the sensors, log and hold of lane l."""
    lines = [f"{slot('logs', at + k)} = state.{name}" for k, name in enumerate(STATES)]
    return lines + [f"{slot('logs', at + N_STATES + j)} = own[{j}]" for j in range(states)]


def settled(model: Model) -> list[str]:
    """What sensors show of lane l, and what filters log and hold, of a motion that has lasted."""
    filters = model.acting(FilterEffect)
    if not filters:
        return []
    lines = [*_sense(model), *_store(0, 0)]
    at = N_STATES
    for one in filters:
        lines += [f"state, own = {name_of(one)}_settled(state, {tuple_of(one)})", *_store(at, len(one.states))]
        at += N_STATES + len(one.states)
    return lines


def filtered(model: Model) -> list[str]:
    """What sensors show of lane l and filters log a step later: each was reached by what the one before it logged."""
    filters = model.acting(FilterEffect)
    if not filters:
        return []
    lines = [*_sense(model), "start = state_of(logs, l)", *_store(0, 0)]
    at = N_STATES
    for k, one in enumerate(filters):
        held = "".join(f"{slot('logs', at + N_STATES + j)}, " for j in range(len(one.states)))
        lines += [f"state, own = {name_of(one)}(start, state, ({held}), h[l], {tuple_of(one)})"]
        if k + 1 < len(filters):
            lines += [f"start = State({', '.join(slot('logs', at + j) for j in range(N_STATES))})"]
        lines += _store(at, len(one.states))
        at += N_STATES + len(one.states)
    return lines


def log_of(model: Model) -> list[str]:
    """What is logged at a sample: by the last filter, by the sensors, or the motion itself."""
    seen = [f"{slot('seen', k)} = state.{name}" for k, name in enumerate(STATES)]
    ways = []
    if filters := model.acting(FilterEffect):
        at = log_rows(model) - N_STATES - len(filters[-1].states)
        logged = f"state = State({', '.join(slot('logs', at + j) for j in range(N_STATES))})"
        ways.append(("filtering", [logged, *seen]))
    if model.acting(SensorEffect):
        ways.append(("sensing", [*_sense(model), *seen]))
    motion = [f"for k in range({N_STATES * WIDTH}):", "    seen[k] = s[k]"]
    if not ways:
        return motion
    lines = []
    for k, (asked, way) in enumerate(ways):
        lines += [f"{'elif' if k else 'if'} {asked}:", *indented(each_lane(way))]
    return [*lines, "else:", *indented(motion)]
