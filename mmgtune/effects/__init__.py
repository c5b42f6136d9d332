"""Effects: what can differ between a ship and her model, one small file each.

The list is explicit.  A new effect is one file like its neighbours and one line here; a package of one's own names its
effects through entry points of the group "mmgtune.effects", each an ``Effect``.
"""

from __future__ import annotations

from functools import lru_cache
from importlib.metadata import entry_points

from . import (
    antenna,
    backlash,
    clock_offset,
    compass_deviation,
    current,
    dead_time,
    discrepancy,
    engine_droop,
    flap,
    governor_lag,
    gyro_bias,
    gyro_drift,
    gyro_scale,
    heading_bias,
    heading_filter,
    hull_asymmetry,
    hull_term,
    loading,
    log_misalignment,
    log_zero,
    memory,
    position_latency,
    propeller_side_force,
    propeller_walk,
    resistance,
    rpm_scale,
    rudder_gain,
    rudder_limit,
    rudder_offset,
    rudder_stall,
    shallow_water,
    speed_scale,
    steady_force,
    steering_lag,
    thrust,
    velocity_filter,
    water_log,
    wave_drift,
    waves,
    wind,
    wind_drift,
)
from .effect import (
    PLACES,
    ActuatorEffect,
    ClockEffect,
    CoefficientsEffect,
    Effect,
    FactorsEffect,
    FilterEffect,
    FlowEffect,
    ForceEffect,
    LagEffect,
    Parameter,
    Scale,
    SensorEffect,
)
from .visited import Visited

__all__ = [
    "PLACES",
    "ActuatorEffect",
    "ClockEffect",
    "CoefficientsEffect",
    "Effect",
    "FactorsEffect",
    "FilterEffect",
    "FlowEffect",
    "ForceEffect",
    "LagEffect",
    "Parameter",
    "Scale",
    "SensorEffect",
    "Visited",
    "effect_tags",
    "effects",
    "find_effect",
]

BUILT_IN: tuple[Effect, ...] = tuple(
    module.EFFECT
    for module in (
        clock_offset,
        dead_time,
        steering_lag,
        backlash,
        rudder_gain,
        rudder_offset,
        rudder_limit,
        governor_lag,
        rpm_scale,
        current,
        wind_drift,
        flap,
        thrust,
        propeller_side_force,
        propeller_walk,
        shallow_water,
        loading,
        resistance,
        wind,
        waves,
        wave_drift,
        steady_force,
        rudder_stall,
        engine_droop,
        hull_asymmetry,
        hull_term,
        discrepancy,
        memory,
        antenna,
        heading_bias,
        compass_deviation,
        water_log,
        log_misalignment,
        speed_scale,
        log_zero,
        gyro_scale,
        gyro_bias,
        position_latency,
        velocity_filter,
        heading_filter,
        gyro_drift,
    )
)
"""Every effect of this program, in the order of the data flow; those of one place act in this order."""


@lru_cache(maxsize=1)
def effects() -> tuple[Effect, ...]:
    """Every effect there is: the program's own, then those of installed packages by name.

    Raises TypeError where an entry point is not an ``Effect`` or takes a tag that is in use.
    """
    found = list(BUILT_IN)
    for entry in sorted(entry_points(group="mmgtune.effects"), key=lambda entry: entry.name):
        effect = entry.load()
        if not isinstance(effect, Effect):
            raise TypeError(f"entry point '{entry.name}' of group mmgtune.effects is {effect!r}, not an Effect")
        if effect.tag in {other.tag for other in found}:
            raise TypeError(f"entry point '{entry.name}' of group mmgtune.effects: tag '{effect.tag}' is in use")
        found.append(effect)
    return tuple(found)


def effect_tags() -> tuple[str, ...]:
    """The tags a profile may name as [effects.<tag>]."""
    return tuple(effect.tag for effect in effects())


def find_effect(tag: str) -> Effect | None:
    """The effect of that tag, None if there is none."""
    return next((effect for effect in effects() if effect.tag == tag), None)
