"""The numbers of M.V. SUZAKU and what an effect does to them before the ship moves.

Suyama et al. 2023 (arXiv:2312.04224), Tables 1 and 3-6, with X_vr and Y_r freed of the added masses; SI units, the
polynomials of the propeller in degrees.  Superstructure, radius of gyration and flap angle are assumptions.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .unknown import UNKNOWN

Parameters = Mapping[str, Mapping[str, float]]
"""Effects by tag, each with its parameters by name."""

PROFILE: dict[str, float] = {
    "particulars.rho": 1025.0,
    "particulars.L_pp": 83.0,
    "particulars.B": 13.5,
    "particulars.d": 3.8,
    "particulars.C_b": 0.737,
    "particulars.x_G": 0.93,
    "particulars.k_zz_": 0.25,
    "particulars.m_x_": 0.010,
    "particulars.m_y_": 0.168,
    "particulars.J_zz_": 0.010,
    "hull.R_0": 0.017,
    "hull.X_vv": 0.009,
    "hull.X_vr": -0.008,
    "hull.X_rr": -0.0164,
    "hull.X_vvvr": -0.824,
    "hull.X_vvvv": -0.114,
    "hull.Y_v": -0.329,
    "hull.Y_r": 0.100,
    "hull.Y_vvv": -0.787,
    "hull.Y_vvr": -0.022,
    "hull.Y_vrr": -0.206,
    "hull.Y_rrr": 0.001,
    "hull.N_v": -0.106,
    "hull.N_r": -0.057,
    "hull.N_vvv": -0.037,
    "hull.N_vvr": -0.105,
    "hull.N_vrr": 0.012,
    "hull.N_rrr": -0.008,
    "wake.w_P0": 0.422,
    "wake.C_w": -2.0,
    "wake.l_P_": -0.5,
    "propeller.D_P": 2.80,
    "propeller.t_P": 0.080,
    "rudder.A_R": 6.282,
    "rudder.H_R": 3.49,
    "rudder.x_R_": -0.5,
    "rudder.t_R": -0.058,
    "rudder.a_H": 0.158,
    "rudder.x_H_": -0.605,
    "rudder.eps": 1.27,
    "rudder.kappa": 0.5,
    "rudder.u_R0": 0.14,
    "rudder.l_R_": -0.888,
    "rudder.gamma_Rp": 0.483,
    "rudder.gamma_Rn": 0.172,
    "rudder.f_a0": 2.411,
    "rudder.f_a2": -0.381,
    "rudder.c_l01": 1.164,
    "rudder.c_l03": -0.381,
    "above_water.A_T": 170.0,
    "above_water.A_L": 750.0,
    "above_water.A_OD": 250.0,
    "above_water.C": 0.0,
    "above_water.C_BR": -30.0,
    "above_water.H_BR": 16.0,
    "above_water.H_C": 5.0,
}

TARGETS = (
    "hull.R_0",
    "propeller.t_P",
    "wake.w_P0",
    "wake.C_w",
    "rudder.t_R",
    "rudder.a_H",
    "rudder.x_H_",
    "rudder.eps",
    "rudder.kappa",
    "rudder.l_R_",
    "rudder.gamma_Rp",
    "rudder.gamma_Rn",
)
"""The coefficients that are tuned: Suyama et al. 2023, section 4.1."""

HULL_TERMS = (
    "N_rabsr",
    "Y_vabsv",
    "Y_rabsr",
    "N_vabsv",
    "N_vvv",
    "N_rrr",
    "Y_vvv",
    "Y_vvr",
    "X_vv",
    "X_rr",
    "N_rrabsr",
)

NULL: dict[str, dict[str, float]] = {
    "rudder-offset": {"angle": 0.0},
    "dead-time": {"seconds": 0.0},
    "backlash": {"play": 0.0, "begins": 0.0, "pushed": 0.0},
    "rudder-gain": {"factor": 1.0, "starboard": 1.0, "port": 1.0, "curve": 0.0},
    "steering-lag": {"time_constant": 0.0, "rate_limit": np.inf, "to_starboard": np.inf, "to_port": np.inf},
    "governor-lag": {"time_constant": 0.0},
    "engine-droop": {"share": 0.0},
    "rpm-scale": {"factor": 1.0},
    "thrust": {"factor": 1.0},
    "flap": {"factor": 1.0},
    "clock-offset": {"seconds": 0.0},
    "current": {"north": 0.0, "east": 0.0, "north_rate": 0.0, "east_rate": 0.0},
    "resistance": {"factor": 1.0, "slope": 0.0},
    "shallow-water": {"depth": np.inf},
    "loading": {"draught": 1.0, "trim": 0.0, "displacement": 1.0},
    "wind": {"speed": 0.0, "direction": 0.0},
    "wave-drift": {"force": 0.0, "direction": 0.0},
    "steady-force": {"ahead": 0.0, "side": 0.0, "moment": 0.0},
    "hull-asymmetry": {"Y_0": 0.0, "N_0": 0.0},
    "propeller-side-force": {"force": 1.0, "moment": 1.0},
    "memory": {"time_constant": 0.0, "sway": 0.0, "yaw": 0.0},
    "rudder-stall": {"angle": np.inf},
    "rudder-limit": {"angle": np.inf},
    "hull-term": dict.fromkeys(HULL_TERMS, 0.0),
    "antenna": {"x": 0.0, "y": 0.0, "x_alone": 0.0, "y_alone": 0.0},
    "heading-bias": {"angle": 0.0, "alone": 0.0},
    "compass-deviation": {"sine": 0.0, "cosine": 0.0, "sine_alone": 0.0, "cosine_alone": 0.0},
    "position-latency": {"seconds": 0.0, "with_velocity": 0.0},
    "velocity-filter": {"over_ground": 0.0, "along_axes": 0.0, "yaw_rate": 0.0, "ahead": 0.0},
    "heading-filter": {"time_constant": 0.0, "alone": 0.0},
    "gyro-drift": {"heading": 0.0, "heading_alone": 0.0, "yaw_rate": 0.0},
    "gyro-scale": {"factor": 1.0, "curve": 0.0},
    "gyro-bias": {"rate": 0.0},
    "log-misalignment": {"angle": 0.0},
    "speed-scale": {"factor": 1.0, "both": 1.0, "grows": 0.0},
    "log-zero": {"ahead": 0.0, "abeam": 0.0},
    "water-log": {"north": 0.0, "east": 0.0},
    **{name: {"magnitude": 0.0} for name in UNKNOWN},
}
"""Every effect with its parameters where they do nothing; SI units, angles in radians."""

GEAR_RATE = np.radians(2.32)
"""Rate of the steering gear [rad/s]: 35 deg to 30 deg on the other side within 28 s, SOLAS II-1/29."""


def complete(effects: Parameters) -> dict[str, dict[str, float]]:
    """Every effect with every parameter: those given, the others at their nulls; KeyError for a name that is none."""
    for tag, parameters in effects.items():
        unknown = set(parameters) - set(NULL[tag])
        if unknown:
            raise KeyError(f"{tag} has no {sorted(unknown)}")
    return {tag: {**null, **effects.get(tag, {})} for tag, null in NULL.items()}


def coefficients(ship: Mapping[str, float], effects: Parameters) -> np.void:
    """One record with all the equations of motion need: the ship's numbers overriding the profile's, the effects in."""
    if set(ship) - set(PROFILE):
        raise KeyError(f"the ship has no {sorted(set(ship) - set(PROFILE))}")
    p = {name.split(".")[1]: float(value) for name, value in {**PROFILE, **ship}.items()}
    e = complete(effects)
    p.update(dict.fromkeys(("N_rabsr", "Y_vabsv", "Y_rabsr", "N_vabsv", "N_rrabsr"), 0.0))
    for term, value in e["hull-term"].items():
        p[term] += value
    _load(p, **e["loading"])
    _shallow(p, **e["shallow-water"])
    p.update(_fujiwara(p))
    p["resistance_factor"], p["resistance_slope"] = e["resistance"]["factor"], e["resistance"]["slope"]
    p["rudder_offset"], p["rudder_gain"] = e["rudder-offset"]["angle"], e["rudder-gain"]["factor"]
    gear = e["steering-lag"]
    rates = [min(gear["rate_limit"], gear[way]) for way in ("to_starboard", "to_port")]
    p["logs_order"] = float(np.isfinite(rates).any())
    p["rate_to_stbd"], p["rate_to_port"] = (rate if np.isfinite(rate) else GEAR_RATE for rate in rates)
    p["steering_lag"] = gear["time_constant"]
    p["dead_time"], p["half_play"] = e["dead-time"]["seconds"], 0.5 * e["backlash"]["play"]
    p["play_begins"], p["half_pushed"] = e["backlash"]["begins"], 0.5 * e["backlash"]["pushed"]
    p["gain_stbd"], p["gain_port"] = e["rudder-gain"]["starboard"], e["rudder-gain"]["port"]
    p["gain_curve"] = e["rudder-gain"]["curve"]
    p["governor_lag"] = e["governor-lag"]["time_constant"]
    p["engine_droop"] = e["engine-droop"]["share"]
    p["rpm_scale"], p["flap_scale"] = e["rpm-scale"]["factor"], e["flap"]["factor"]
    p["thrust"] = e["thrust"]["factor"]
    p.update({f"current_{name}": value for name, value in e["current"].items()})
    p["wind_speed"], p["wind_direction"] = e["wind"]["speed"], e["wind"]["direction"]
    p["wave_force"], p["wave_direction"] = e["wave-drift"]["force"], e["wave-drift"]["direction"]
    p.update(e["hull-asymmetry"])
    p.update({f"steady_{name}": value for name, value in e["steady-force"].items()})
    p["side_force"], p["side_moment"] = e["propeller-side-force"]["force"], e["propeller-side-force"]["moment"]
    p["memory_Y"] = e["memory"]["time_constant"] + e["memory"]["sway"]
    p["memory_N"] = e["memory"]["time_constant"] + e["memory"]["yaw"]
    p["stall_angle"] = e["rudder-stall"]["angle"]
    p["rudder_limit"] = e["rudder-limit"]["angle"]
    p.update({name.replace("-", "_"): e[name]["magnitude"] for name in UNKNOWN})
    half = 0.5 * p["rho"] * p["L_pp"] * p["d"]
    p["force"], p["moment"] = half, half * p["L_pp"]
    p["mass"] = p["rho"] * p["L_pp"] * p["B"] * p["d"] * p["C_b"]
    p["m_x"], p["m_y"] = half * p["L_pp"] * p["m_x_"], half * p["L_pp"] * p["m_y_"]
    p["I_zz"] = p["mass"] * ((p["k_zz_"] * p["L_pp"]) ** 2 + p["x_G"] ** 2) + half * p["L_pp"] ** 3 * p["J_zz_"]
    p["I_zz"] *= 1.0 + e["unknown-inertia-yaw"]["magnitude"]
    record = np.zeros(1, dtype=[(name, np.float64) for name in p])
    for name, value in p.items():
        record[name] = value
    return record[0]


def _load(p: dict[str, float], draught: float, trim: float, displacement: float) -> None:
    """Another draught, block coefficient and stern trim over draught; Inoue, Hirano & Kijima 1981, linear terms."""
    new, old = (_inoue(2.0 * d / p["L_pp"], p["C_b"] * p["B"] / p["L_pp"], t) for d, t in _states(p, draught, trim))
    for name in new:
        p[name] *= new[name] / old[name]
    p["d"] *= draught
    p["C_b"] *= displacement


def _states(p: dict[str, float], draught: float, trim: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Draught [m] and trim over draught, loaded and as in the profile."""
    return (p["d"] * draught, trim), (p["d"], 0.0)


def _inoue(k: float, c: float, trim: float) -> dict[str, float]:
    """Linear derivatives from k = 2d/L, c = C_b B/L and stern trim over draught, up to constant factors."""
    sway = np.pi * k / 2.0 + 1.4 * c
    return {
        "Y_v": sway * (1.0 + 0.67 * trim),
        "Y_r": k * (1.0 + 0.80 * trim),
        "N_v": k * (1.0 - 0.27 * trim * sway / k),
        "N_r": (0.54 * k - k**2) * (1.0 + 0.30 * trim),
    }


def _shallow(p: dict[str, float], depth: float) -> None:
    """Linear derivatives in water of a depth [m]; Kijima et al. 1990."""
    h = p["d"] / depth
    y = p["C_b"] * p["B"] / p["d"]
    exponents = {"Y_v": 0.40 * y, "N_v": 0.425 * y, "N_r": -14.28 * p["d"] / p["L_pp"] + 1.5}
    for name, n in exponents.items():
        p[name] *= (1.0 - h) ** -n - h
    a1, a2, a3 = (
        -5.5 * y**2 + 26.0 * y - 31.5,
        37.0 * y**2 - 185.0 * y + 230.0,
        -38.0 * y**2 + 197.0 * y - 250.0,
    )
    p["Y_r"] *= 1.0 + a1 * h + a2 * h**2 + a3 * h**3


def _fujiwara(p: dict[str, float]) -> dict[str, float]:
    """Coefficients of wind force in cosines and sines of the apparent direction; Fujiwara, Ueno & Nimura 1998."""
    L, B, A_T, A_L, A_OD = p["L_pp"], p["B"], p["A_T"], p["A_L"], p["A_OD"]
    C, C_BR, H_BR, H_C = p["C"], p["C_BR"], p["H_BR"], p["H_C"]
    return {
        "wind_X0": -0.330 + 0.293 * B * H_BR / A_T + 0.0193 * C / H_C + 0.6820 * A_OD / L**2,
        "wind_X1": -1.353
        + 1.700 * A_L / (L * B)
        + 2.8700 * L * H_C / A_L
        - 0.4630 * L * H_BR / A_L
        - 0.570 * A_OD / A_L
        - 6.640 * A_T / (L * B)
        - 0.0123 * L**2 / A_T
        + 0.0202 * L / H_C,
        "wind_X3": 0.830
        - 0.413 * A_L / (L * H_BR)
        - 0.0827 * A_L / A_T
        - 0.5630 * L * H_C / A_L
        + 0.804 * A_OD / A_L
        - 5.670 * A_OD / L**2
        + 0.0401 * C / H_C
        - 0.1320 * C_BR / L,
        "wind_X5": 0.0372 - 0.0075 * A_L / A_OD - 0.1030 * C_BR / L + 0.0921 * A_L / (L * B),
        "wind_Y1": 0.684
        + 0.717 * C_BR / L
        - 3.2200 * C / L
        + 0.0281 * A_L / A_OD
        + 0.0661 * C / H_C
        + 0.2980 * A_T / (B * H_BR),
        "wind_Y3": -0.400
        + 0.282 * A_L / (L * B)
        + 0.3070 * L * H_C / A_L
        + 0.0519 * C_BR / L
        + 0.0526 * B / H_BR
        - 0.0814 * A_OD / A_L
        + 0.0582 * A_T / (B * H_BR),
        "wind_Y5": 0.122
        - 0.166 * A_L / (L * B)
        - 0.0054 * L / H_BR
        - 0.0481 * C_BR / L
        - 0.0136 * B**2 / A_T
        + 0.0864 * C / L
        - 0.0297 * C * H_C / A_L,
        "wind_N1": 0.2990
        + 1.710 * C / L
        + 0.183 * L * H_C / A_L
        - 1.09 * A_T / A_L
        - 0.0442 * C / H_C
        - 0.289 * A_L / (L * B)
        + 4.24 * A_T / L**2
        - 0.0646 * B**2 / A_T
        + 0.0306 * C_BR / L,
        "wind_N2": 0.1170
        + 0.123 * C_BR / L
        - 0.323 * C / L
        + 0.0041 * A_L / A_OD
        - 0.166 * A_T / B**2
        - 0.0109 * L / H_BR
        + 0.174 * A_T / (B * H_BR)
        + 0.214 * A_L / (L * B)
        - 1.06 * A_L / L**2,
        "wind_N3": 0.0230 + 0.0385 * C_BR / L - 0.0339 * A_T / (B * H_BR) + 0.0023 * A_L / A_T,
    }
