"""Text of a stage of a step: velocity of the water, forces of components and effects, and where they lead."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ...effects import FactorsEffect, FlowEffect, ForceEffect, LagEffect
from ...model import Model
from ...physics.quantities import STATES, Force
from ..tuples import leaves
from .inputs import AROUND, acting_slots, surround
from .text import N_STATES, WIDTH, any_of, each_lane, indented, name_of, slot, tuple_of, where_present


def stage(model: Model) -> list[str]:
    """A stage of a step: velocity of the water, forces of the components, those of effects, and where that leads."""
    lines = [*surround(model), *_flows(model), *_factors(model)]
    control = ", ".join(f"between({slot('now', k)}, {slot('then', k)}, at)" for k in acting_slots(model))
    own = [f"control = Control({control})", "state = state_of(z, l)", *_water(model), *_coefficients(model)]
    own.append("found = forces(through_water(state, u_c, v_c), control, components, coefficients)")
    if not sees_forces(model):
        return lines + each_lane([*own, "acting_force = found.total", *_on(model)])
    breakdown = model.arrangement.breakdown
    own += [f"{slot('kept', k)} = found.{leaf}" for k, leaf in enumerate(leaves(breakdown))]
    own += [f"{slot('acting', k)} = found.total.{axis}" for k, axis in enumerate(Force._fields)]
    lines += each_lane(own)
    more = [f"{slot('acting', k)} += more.{axis}" for k, axis in enumerate(Force._fields)]
    for effect in model.acting(ForceEffect):
        force = f"more = {name_of(effect)}(state, around, found, components, coefficients, {tuple_of(effect)})"
        seen = ["state = state_of(z, l)", AROUND, "found = found_of(kept, l)", *_coefficients(model), force]
        lines += where_present(effect, [*seen, *more])
    lines += _lagging(model, more)
    acting = f"acting_force = Force({', '.join(slot('acting', k) for k in range(len(Force._fields)))})"
    return lines + each_lane(["state = state_of(z, l)", *_water(model), *_coefficients(model), acting, *_on(model)])


def sees_forces(model: Model) -> bool:
    """Whether any effect works on the forces of the components."""
    return bool(model.acting(ForceEffect) or model.acting(LagEffect))


def gaining(model: Model) -> list[FlowEffect]:
    """Effects by which the water gains velocity."""
    return [effect for effect in model.acting(FlowEffect) if effect.rate is not None]


def _water(model: Model) -> list[str]:
    """Velocity of the water about lane l."""
    if not model.acting(FlowEffect):
        return ["u_c, v_c = 0.0, 0.0"]
    return [f"u_c, v_c = {slot('water', 0)}, {slot('water', 1)}"]


def _flows(model: Model) -> list[str]:
    """Velocity of the water, and how it changes, in arrays of the stack."""
    lines = []
    for name, effects, suffix in (("water", model.acting(FlowEffect), ""), ("gains", gaining(model), "_rate")):
        if not effects:
            continue
        lines += [f"for k in range({2 * WIDTH}):", f"    {name}[k] = 0.0"]
        for effect in effects:
            more = f"u_w, v_w = {name_of(effect)}{suffix}(state, around, {tuple_of(effect)})"
            added = [f"{slot(name, 0)} += u_w", f"{slot(name, 1)} += v_w"]
            lines += where_present(effect, ["state = state_of(z, l)", AROUND, more, *added])
    return lines


def _changes(model: Model) -> list[tuple[FactorsEffect, int, int]]:
    """Coefficients of components that change with the surroundings: effect, number of its factor, row."""
    rows = {
        f"{part.kind}.{symbol}": row
        for part in model.parts
        for symbol, (row, *_) in zip(part.params._fields, model.fields(part), strict=True)
    }
    return [
        (effect, j, rows[name])
        for effect in model.acting(FactorsEffect)
        for j, name in enumerate(effect.changes)
        if name in rows
    ]


def _factors(model: Model) -> list[str]:
    """Coefficients in these surroundings, in an array of the stack that holds the others as they are."""
    changes = _changes(model)
    of_row = Counter(row for *_, row in changes)
    lines = [f"{slot('changed', row)} = {slot('p', row)}" for row, effects in of_row.items() if effects > 1]
    lines = each_lane(lines) if lines else []
    for effect in model.acting(FactorsEffect):
        found = [AROUND, f"found = {name_of(effect)}(around, {tuple_of(effect)})"]
        for of, j, row in changes:
            if of is effect:
                before = "changed" if of_row[row] > 1 else "p"
                found.append(f"{slot('changed', row)} = {slot(before, row)} * found[{j}]")
        lines += where_present(effect, found)
    return lines


def _coefficients(model: Model) -> list[str]:
    """Functions and coefficients of the components of lane l."""
    array = "changed" if model.acting(FactorsEffect) else "p"
    functions = ", ".join(name_of(part) for part in model.parts if part.function is not None)
    tuples = ", ".join(tuple_of(part, array) for part in model.parts)
    return [f"components = Components({functions})", f"coefficients = Coefficients({tuples})"]


def _lagging(model: Model, more: Sequence[str]) -> list[str]:
    """The forces of lags, which see those of all other effects, and the rates of what they remember."""
    lags = model.acting(LagEffect)
    if not lags:
        return []
    names = leaves(model.arrangement.breakdown)
    total = [(names.index(f"total.{axis}"), k) for k, axis in enumerate(Force._fields)]
    whole = [f"{slot('kept', kept)} = {slot('acting', k)}" for kept, k in total]
    lines = [f"if {any_of(lags)}:", *indented(each_lane(whole))]
    at = 0
    for lag in lags:
        own = range(at, at + len(lag.states))
        behind = "".join(f"{slot('z', N_STATES + k)}, " for k in own)
        lags_by = [
            "found = found_of(kept, l)",
            f"more, rate = {name_of(lag)}(found, ({behind}), h[l], {tuple_of(lag)})",
            *more,
            *(f"{slot('slopes', k)} = rate[{j}]" for j, k in enumerate(own)),
        ]
        still = [f"{slot('slopes', k)} = 0.0" for k in own]
        lines += [*where_present(lag, lags_by), "else:", *indented(each_lane(still))]
        at += len(lag.states)
    return lines


def _on(model: Model) -> list[str]:
    """The rates of lane l, their share in the step, and the state the next stage looks at."""
    lines = ["rate = rates(state, u_c, v_c, acting_force, coefficients.ship)"]
    if gaining(model):
        lines.append(f"rate = carried(rate, {slot('gains', 0)}, {slot('gains', 1)})")
    slopes = [f"rate.{name}" for name in STATES]
    slopes += [slot("slopes", k) for k in range(sum(len(lag.states) for lag in model.acting(LagEffect)))]
    for k, slope in enumerate(slopes):
        s, z, total = (slot(array, k) for array in ("s", "z", "total"))
        lines += [f"{total} = with_stage({total}, part, {slope})", f"{z} = at_stage({s}, ahead, h[l], {slope})"]
    return lines
