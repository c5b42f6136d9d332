"""Wakes at the propeller."""

from __future__ import annotations

from ..physics.wake.asymmetric import AsymmetricWake, asymmetric_wake
from ..physics.wake.exponential import ExponentialWake, exponential_wake
from ..physics.wake.quadratic import QuadraticWake, quadratic_wake
from .component import AT_LEAST_0, AT_MOST_0, Component, Field
from .sources import MIYAUCHI, OKUDA, SUYAMA, YASUKAWA

EXPONENTIAL_WAKE = Component(
    kind="wake",
    tag="exponential",
    title="wake fading with the inflow angle squared",
    params=ExponentialWake,
    function=exponential_wake,
    cites=(SUYAMA, OKUDA),
    fields={
        "w_P0": Field("wake fraction at zero inflow angle", low=-1.0, high=1.0),
        "C_w": Field("fading of the wake with the inflow angle squared", "1/rad^2", high=AT_MOST_0),
        "l_P_": Field("longitudinal position of the propeller, over L_pp", low=-1.0, high=1.0),
    },
)

ASYMMETRIC_WAKE = Component(
    kind="wake",
    tag="asymmetric",
    title="wake with different values for inflow from either side",
    params=AsymmetricWake,
    function=asymmetric_wake,
    cites=(YASUKAWA,),
    fields={
        "w_P0": Field("wake fraction at zero inflow angle", low=-1.0, high=1.0),
        "C_1": Field("rate of change of the wake with the inflow angle", "1/rad", low=AT_LEAST_0),
        "C_2p": Field("end value of (1-w_P)/(1-w_P0), inflow angle positive", low=0.0),
        "C_2n": Field("end value of (1-w_P)/(1-w_P0), inflow angle negative", low=0.0),
        "x_P_": Field("longitudinal position of the propeller, over L_pp", low=-1.0, high=1.0),
    },
)

QUADRATIC_WAKE = Component(
    kind="wake",
    tag="quadratic",
    title="wake of the lateral velocity and its square, none astern",
    params=QuadraticWake,
    function=quadratic_wake,
    cites=(MIYAUCHI,),
    fields={
        "w_P0": Field("wake fraction at zero lateral velocity", low=-1.0, high=1.0),
        "tau": Field("change of 1 - w_P with the size of the lateral velocity at the propeller"),
        "C_P": Field("change of 1 - w_P with the square of the lateral velocity at the propeller"),
        "x_P_": Field("longitudinal position of the propeller, over L_pp", low=-1.0, high=1.0),
    },
)

WAKES = (EXPONENTIAL_WAKE, ASYMMETRIC_WAKE, QUADRATIC_WAKE)
