"""Text that takes what was logged and measured, and what actuators make of it."""

from __future__ import annotations

from collections.abc import Sequence

from ...effects import ActuatorEffect, Effect, FactorsEffect, FlowEffect, ForceEffect
from ...model import Model
from ...physics.quantities import HELD, Surroundings
from .text import WIDTH, cell, each_lane, indented, name_of, slot, tuple_of, where_present


def shifts_of(model: Model) -> list[str]:
    """For each input how much later in the log what acts stands, as text; "" where nothing shifts it."""
    terms: list[list[str]] = [[] for _ in model.inputs]
    for effect in model.clocks:
        sign = "" if effect.late == "log" else "-"
        for k in range(len(terms)) if effect.of is None else model.arrangement.of_role(effect.of):
            terms[k].append(sign + cell(model.fields(effect)[0][0]))
    return [" + ".join(of) for of in terms]


def sample(model: Model, inputs: str, around: str, shifts: Sequence[str]) -> list[str]:
    """Logged inputs and surroundings at the share f of the step that ends at sample i, into arrays of the stack."""

    def between(array: str, case: str, column: int) -> str:
        return f"between({array}[{case}, i - 1, {column}], {array}[{case}, i, {column}], f)"

    def measured(case: str, column: int, name: str) -> str:
        return f"measured[{case}, i, {column}]" if name in HELD else between("measured", case, column)

    def taken(every: dict[str, str]) -> list[str]:
        lines = ["if mixed:", f"    for l in range({WIDTH}):", "        c = case_of[block, l]"]
        lines += [f"        {slot} = {value.format(case='c')}" for slot, value in every.items()]
        lines += ["else:"]
        lines += [f"    value{k} = {value.format(case='case')}" for k, value in enumerate(every.values())]
        lines += [f"    for l in range({WIDTH}):"]
        return lines + [f"        {slot} = value{k}" for k, slot in enumerate(every)]

    columns = range(len(model.inputs))
    lines = taken({slot(inputs, k): between("controls", "{case}", k) for k in columns})
    if looks_around(model):
        seen = {slot(around, k): measured("{case}", k, name) for k, name in enumerate(Surroundings._fields)}
        lines += ["if looking:", *indented(taken(seen))]
    moved = [k for k in columns if shifts[k]]
    if moved:
        late = "logged_control(controls, t, n_samples, c, i, f, {shift}, {k})"
        own = [f"{slot(inputs, k)} = {late.format(shift=shifts[k], k=k)}" for k in moved]
        lines += ["if shifted:", *indented(each_lane(["c = case_of[block, l]", *own]))]
    return lines


AROUND = "around = around_of(outside, l)"
"""What was measured around lane l at this stage of a step, in blocks where anything asks for it."""


def surround(model: Model) -> list[str]:
    """What was measured around all lanes at this stage, in an array of the stack."""
    if not looks_around(model):
        return []
    lines = []
    for k, name in enumerate(Surroundings._fields):
        here, there = slot("here", k), slot("there", k)
        lines.append(f"{slot('outside', k)} = " + (there if name in HELD else f"between({here}, {there}, at)"))
    return ["if looking:", *indented(each_lane(lines))]


def looking(model: Model) -> list[Effect]:
    """Effects that depend on what was measured around the ship."""
    return [*model.acting(FlowEffect), *model.acting(ForceEffect), *model.acting(FactorsEffect)]


def looks_around(model: Model) -> bool:
    return bool(looking(model))


def acting_slots(model: Model) -> range:
    """Where what acts stands among inputs as logged and as each actuator leaves them: behind the last of these."""
    n_inputs = len(model.inputs)
    first = n_inputs * len(model.acting(ActuatorEffect))
    return range(first, first + n_inputs)


def _rested(effect: ActuatorEffect, reached: str) -> str:
    """What had left an actuator before the first sample."""
    return reached if effect.rested is None else f"{name_of(effect)}_rested({reached}, {tuple_of(effect)})"


def actuate(model: Model, array: str, first: bool) -> list[str]:
    """What each actuator makes of what reaches it; at the first sample it has been at rest there."""
    n_inputs, actuators = len(model.inputs), model.acting(ActuatorEffect)
    lines = []
    for level, effect in enumerate(actuators):
        moved = model.arrangement.of_role(effect.of)
        acts, passes = [], []
        for k in range(n_inputs):
            source, target = level * n_inputs + k, (level + 1) * n_inputs + k
            start, end = slot("now", source), slot(array, source)
            before = _rested(effect, start) if first else slot("now", target)
            value = f"{name_of(effect)}({start}, {end}, {before}, h[l], {tuple_of(effect)})" if k in moved else end
            acts.append(f"{slot(array, target)} = {value}")
            passes.append(f"{slot(array, target)} = {end}")
        lines += [*where_present(effect, acts), "else:", *indented(each_lane(passes))]
    if first or not actuators:
        return lines
    through = [f"{slot(array, acting)} = {slot(array, logged)}" for logged, acting in enumerate(acting_slots(model))]
    return ["if steered:", *indented(lines), "else:", *indented(each_lane(through))]


def carry(model: Model) -> list[str]:
    """What acts at the end of a step acts at the beginning of the next; what is between, in blocks that have any."""
    last = acting_slots(model)
    whole = [f"for k in range({last.stop * WIDTH}):", "    now[k] = then[k]"]
    if not model.acting(ActuatorEffect):
        return whole
    acting = [f"{slot('now', k)} = {slot('then', k)}" for k in last]
    return ["if steered:", *indented(whole), "else:", *indented(each_lane(acting))]
