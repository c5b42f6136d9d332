"""What every ship has: her particulars and, for wind, what stands above the water."""

from __future__ import annotations

from ..physics.quantities import HARMONICS, AboveWater, Ship
from .component import Component, Field
from .sources import SUYAMA, YASUKAWA

SHIP = Component(
    kind="particulars",
    tag="ship",
    title="principal particulars and inertia",
    params=Ship,
    function=None,
    cites=(SUYAMA, YASUKAWA),
    fields={
        "rho": Field("density of water", "kg/m^3", default=1025.0, low=500.0, high=2000.0),
        "L_pp": Field("length between perpendiculars", "m", low=0.01, high=1000.0),
        "B": Field("breadth", "m", low=0.001, high=200.0),
        "d": Field("draught", "m", low=0.0001, high=50.0),
        "C_b": Field("block coefficient", low=0.0, high=1.0),
        "x_G": Field("centre of gravity, forward of midship", "m"),
        "k_zz_": Field("radius of gyration about the centre of gravity, over L_pp", low=0.0, high=1.0),
        "m_x_": Field("added mass in surge", "prime", low=0.0),
        "m_y_": Field("added mass in sway", "prime", low=0.0),
        "J_zz_": Field("added moment of inertia in yaw", "prime", low=0.0),
    },
)

WIND_FORCES = {"X": "surge force", "Y": "sway force", "N": "yaw moment"}

HARMONIC_WORDS = (
    "mean over the angle of the wind",
    "first harmonic",
    "second harmonic",
    "third harmonic",
    "fourth harmonic",
    "fifth harmonic",
)

ABOVE_WATER = Component(
    kind="above_water",
    tag="above_water",
    title="geometry above the water",
    params=AboveWater,
    function=None,
    cites=("Fujiwara, Ueno & Nimura 1998, J. Society of Naval Architects of Japan 183, 77-90",),
    fields={
        "A_T": Field("frontal area", "m^2", low=0.0, high=10000.0),
        "A_L": Field("lateral area", "m^2", low=0.0, high=30000.0),
        "A_OD": Field("lateral area of superstructure and deck cargo", "m^2", low=0.0, high=30000.0),
        "C": Field("centroid of the lateral area, forward of midship", "m"),
        "C_BR": Field("centroid of the superstructure, forward of midship", "m"),
        "H_BR": Field("top of the bridge above the waterline", "m", low=0.0, high=150.0),
        "H_C": Field("centroid of the lateral area above the waterline", "m", low=0.0, high=100.0),
        **{
            name: Field(f"wind {WIND_FORCES[name[0]]}, {HARMONIC_WORDS[int(name[2])]}", derived=True)
            for name in HARMONICS
        },
    },
)
