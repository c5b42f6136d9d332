"""Roll-outs of networks on JAX: the equations of ``networks.recurrent`` under a compiled scan, with derivatives."""

from __future__ import annotations

from typing import Any

from ..backends.twins import jax_module, twin
from ..networks import motion, recurrent
from ..networks.recurrent import Scales, Weights


def roll(
    w: Weights,
    scales: Scales,
    initial: Any,
    controls: Any,
    wind: Any,
    h: float,
    memory: int | None,
    signs: Any = None,
) -> Any:
    """States (T + 1, n, 6) from ``initial`` (n, 6) over T steps of Euler's method of h [s]: eq. 19-23.

    w         one member, without the axis of members
    controls  (T, n, n_inputs)
    wind      (T, n, 2) over ground
    memory    samples that truncated memory reaches back, None for standard memory
    signs     (n_features,) as of ``motion.mirror`` where port and starboard are mirror images, else None
    """
    jax = jax_module()
    jnp = jax.numpy
    see, move = twin(recurrent.features), twin(motion.moved)

    def step(carry: Any, given: Any) -> Any:
        states, held = carry
        control, air = given
        part = twin(recurrent.projected)(_sides(see(states, control, air, scales), signs), w)
        first, held = _recall(part, held, w, memory)
        states = move(states, _given(first, w, scales, signs), h)
        return (states, held), states

    begin = (initial, _nothing(jnp, initial, w, memory, signs))
    _, found = jax.lax.scan(jax.checkpoint(step, policy=_of_tanh), begin, (controls, wind))
    return jnp.concatenate([initial[None], found])


def follow(
    w: Weights, scales: Scales, states: Any, controls: Any, wind: Any, memory: int | None, signs: Any = None
) -> Any:
    """Accelerations (T, n, 3) along measured states (T, n, 6): eq. 13-16."""
    jax = jax_module()
    jnp = jax.numpy
    seen = twin(recurrent.features)(states, controls, wind, scales)
    parts = twin(recurrent.projected)(_sides(seen, signs), w)

    def step(held: Any, part: Any) -> Any:
        first, held = _recall(part, held, w, memory)
        return held, _given(first, w, scales, signs)

    _, found = jax.lax.scan(step, _nothing(jnp, states[0], w, memory, signs), parts)
    return found


def _of_tanh(primitive: Any, *_: Any, **__: Any) -> bool:
    """What of a step is kept for its derivatives: layers, so that no product is computed again."""
    return bool(primitive.name == "tanh")


def _sides(seen: Any, signs: Any) -> Any:
    """What is seen, (..., n, n_features), and behind it its mirror image where that counts."""
    return seen if signs is None else twin(recurrent.both_sides)(seen, signs)


def _given(first: Any, w: Weights, scales: Scales, signs: Any) -> Any:
    """Accelerations from the first layer."""
    rates = twin(recurrent.accelerations)(first, w, scales)
    return rates if signs is None else twin(recurrent.alike)(rates)


def _nothing(jnp: Any, like: Any, w: Weights, memory: int | None, signs: Any) -> Any:
    """What is remembered before the first sample."""
    n, width = like.shape[0] * (1 if signs is None else 2), w.W_r.shape[-1]
    return jnp.zeros((n if memory is None else (memory - 1) * n, width), dtype=w.W_r.dtype)


def _recall(part: Any, held: Any, w: Weights, memory: int | None) -> tuple[Any, Any]:
    """The first layer now, and what is held for the next sample."""
    if memory is None:
        first = twin(recurrent.remembered)(part, held, w)
        return first, first
    return twin(recurrent.truncated)(part, held, w)
