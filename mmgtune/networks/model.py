"""A trained network: weights of all its members, what it was trained on and for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..inputs import INPUTS
from .motion import mirror
from .recurrent import Scales, Weights

N_ACCELERATIONS = 3
N_WIND = 2
N_VELOCITIES = 3


STEPS = (1e-3, 3600.0)
"""Least and largest step [s] of a network: a run of hours has no more of the least than memory holds."""

LENGTHS = (0.1, 1000.0)
"""Least and largest length [m] of a ship."""


@dataclass(frozen=True, eq=False)
class Network:
    """Recurrent networks that give the accelerations of one ship, one member for each seed they were begun from.

    ship      id of the ship
    L_pp      her length between perpendiculars [m]
    inputs    what drives her, by names of ``inputs.INPUTS``, in the order of the features
    step      [s] between samples, of Euler's method and of the memory
    memory    samples the memory is built from anew at each step (m of eq. 10), None where it runs on from the start
              (eq. 8)
    weights   (n_members, ...) each
    scales    (1, ...) each
    facts     provenance: type, trials, their source and licence, seeds, options, versions, scores; numbers and texts
    mirrored  whether port and starboard are mirror images: a member gives the mean of what it says on both sides
    """

    ship: str
    L_pp: float
    inputs: tuple[str, ...]
    step: float
    memory: int | None
    weights: Weights
    scales: Scales
    facts: dict[str, Any] = field(default_factory=dict)
    mirrored: bool = False

    def __post_init__(self) -> None:
        """Raises ValueError where shapes do not fit together, or a number is not finite."""
        for problem in problems_of(self):
            raise ValueError(problem)

    def __repr__(self) -> str:
        """In a line."""
        kind = "standard memory" if self.memory is None else f"memory of {self.memory} samples"
        return f"Network({self.ship}: {kind}, {self.n_members} x {self.width} units, step {self.step:g} s)"

    @property
    def n_members(self) -> int:
        """Networks that there are."""
        return int(self.weights.W_x.shape[0])

    @property
    def width(self) -> int:
        """Units of a layer."""
        return int(self.weights.W_x.shape[-1])

    @property
    def signs(self) -> FloatArray | None:
        """(n_features,) as of ``mirror``; None where port and starboard differ."""
        return np.asarray(mirror([INPUTS[name].role for name in self.inputs])) if self.mirrored else None

    def member(self, k: int) -> Network:
        """One of the members alone."""
        return self.only(np.array([k]))

    def only(self, members: IntArray) -> Network:
        """These members, in this order; one may be there again and again."""
        own = Weights(*(values[members] for values in self.weights))
        return Network(
            self.ship, self.L_pp, self.inputs, self.step, self.memory, own, self.scales, self.facts, self.mirrored
        )


def sided(inputs: Sequence[str]) -> list[str]:
    """Inputs of one side of the ship, which would change places with those of the other in her mirror image."""
    return [name for name in inputs if name.endswith(("_port", "_stbd"))]


def n_features(inputs: tuple[str, ...]) -> int:
    """Velocities, inputs, and the two components of apparent wind."""
    return N_VELOCITIES + len(inputs) + N_WIND


def shapes(n_members: int, n_inputs: int, width: int) -> tuple[Weights, Scales]:
    """Shapes of all arrays of a network."""
    seen = N_VELOCITIES + n_inputs + N_WIND
    bias, square = (n_members, 1, width), (n_members, width, width)
    weights = Weights(
        W_x=(n_members, seen, width),
        W_r=square,
        b_0=bias,
        W_1=square,
        b_1=bias,
        W_2=square,
        b_2=bias,
        W_3=(n_members, width, N_ACCELERATIONS),
    )
    return weights, Scales(features=(1, 1, seen), accelerations=(1, 1, N_ACCELERATIONS))


def problems_of_ship(inputs: tuple[str, ...], step: float, L_pp: float) -> list[str]:
    """What is wrong with what networks of all kinds say of their ship and step, in words."""
    found = []
    unknown = [name for name in inputs if name not in INPUTS]
    if unknown:
        found.append(f"no input is called {', '.join(unknown)}")
    if not STEPS[0] <= step <= STEPS[1]:
        found.append(f"the step is {step:g} s, not {STEPS[0]:g} to {STEPS[1]:g} s")
    if not LENGTHS[0] <= L_pp <= LENGTHS[1]:
        found.append(f"the length is {L_pp:g} m, not {LENGTHS[0]:g} to {LENGTHS[1]:g} m")
    return found


def problems_of(network: Network) -> list[str]:
    """What is wrong with a network, in words."""
    found = problems_of_ship(network.inputs, network.step, network.L_pp)
    if network.mirrored and sided(network.inputs):
        found.append(f"it is mirrored, and {', '.join(sided(network.inputs))} would change places")
    if network.memory is not None and network.memory < 1:
        found.append(f"the memory has {network.memory} samples")
    first = np.shape(network.weights.W_x)
    if len(first) != 3 or 0 in first:
        return [*found, f"W_x has the shape {first}, not members x features x width"]
    weights, scales = shapes(first[0], len(network.inputs), first[2])
    given = {**network.weights._asdict(), **network.scales._asdict()}
    for name, shape in {**weights._asdict(), **scales._asdict()}.items():
        if np.shape(given[name]) != shape:
            found.append(f"{name} has the shape {np.shape(given[name])}, not {shape}")
        elif not np.isfinite(given[name]).all():
            found.append(f"{name} holds numbers that are not finite")
    if not found and not (np.asarray(network.scales.features) > 0.0).all():
        found.append("a feature is divided by 0")
    return found
