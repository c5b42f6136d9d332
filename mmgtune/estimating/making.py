"""A whole ship profile from main dimensions: every number with its formula, the range of that and its scatter."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..components import ABOVE_WATER, SHIP, Field, find
from ..errors import Problem, ProfileError
from ..options import EstimateOptions
from ..options.choice import must_be
from ..physics.prime import force_unit
from ..physics.regressions import (
    clarke1982,
    fujii1961,
    holtrop,
    inoue1981,
    kijima1990,
    surge_coupling,
    wageningen,
    yoshimura2012,
    zhou1983,
)
from ..physics.regressions.formula import Formula, ratios
from ..profile import Approach, Coefficient, Section, ShipProfile, SteeringGear, with_effects
from ..profile.reading import with_wind_coefficients
from .defaults import Complete
from .particulars import Particulars, read_particulars
from .propulsion import Propulsion, propulsion
from .scatter import LEFT_ALONE, SCATTER, scatter_of

FADING = -4.0
"""C_w of the wake in a turn [1/rad^2]: Kijima et al. 1990."""

BEFORE_RUDDER = 0.02
"""How far the propeller is ahead of the rudder, over L_pp [-]; assumption."""

HEADER = """\
# Made from main dimensions by published formulas: no test of this ship is in these numbers.
# scatter is one standard deviation of ships about a formula; a fit takes it for the box and for what it expects.
# Replace what you know better, with its source, and take the scatter away there.

"""
"""What a profile made from main dimensions begins with."""

AROUND = ("current", "wind", "waves")
"""Effects by which measured surroundings act."""

STALL = 0.6
"""Inflow angle at which a rudder in a slipstream begins to stall [rad]; assumption."""

RACE = 0.6
"""K of Kijima's slipstream times (1 - w_R) / (1 - w_P) [-]."""

FAM = "Mathioudakis et al., eq. 3"

_DERIVATIVES: dict[str, tuple[Formula, Formula]] = {
    "inoue": (inoue1981.FORMULA, zhou1983.DERIVATIVES),
    "clarke": (clarke1982.FORMULA, zhou1983.DERIVATIVES),
    "kijima": (kijima1990.FORMULA, kijima1990.FORMULA),
    "yoshimura": (yoshimura2012.FORMULA, yoshimura2012.FORMULA),
}
"""Formulas of the linear and of the nonlinear hull derivatives."""


def estimate(ship: Particulars | str | Path, options: EstimateOptions = EstimateOptions()) -> ShipProfile:
    """A profile of a ship by published formulas.

    ship  particulars: an object, a path or a bundled name

    Each coefficient says its formula and the range of that, has the scatter of ships about it where one is known, and a
    warning with the numbers where this ship is outside the range.  Targets of a fit are the coefficients with a scatter
    but for the added masses.  The approach is at self-propulsion.  Raises ProfileError where a formula gives an
    impossible number, as it may far outside its range.
    """
    must_be(options, EstimateOptions)
    found = ship if isinstance(ship, Particulars) else read_particulars(ship)
    return _Estimate(found, options).profile()


class _Estimate:
    """One ship being put together."""

    def __init__(self, ship: Particulars, options: EstimateOptions):
        self.ship, self.options = ship, options
        self.of = of = Complete(ship)
        self.L, self.B, self.d, self.C_b = (of("particulars", name) for name in ("L_pp", "B", "d", "C_b"))
        self.rho, self.x_G = of("particulars", "rho"), of("particulars", "x_G")
        self.U = of("approach", "speed")
        self.lines = holtrop.Lines(
            self.L,
            self.B,
            self.d,
            self.C_b,
            C_M=of("particulars", "C_M"),
            C_WP=of("particulars", "C_WP"),
            lcb=of("particulars", "lcb"),
            C_st=of("particulars", "C_st"),
            D_P=of("propeller", "D_P"),
            A_BT=of("particulars", "A_BT"),
            h_B=of("particulars", "h_B"),
            A_T=of("particulars", "A_T"),
        )
        C_P, Fn = float(holtrop.prismatic(self.lines)), self.U / (holtrop.GRAVITY * self.L) ** 0.5
        self.ratios: dict[str, float] = {**ratios(self.L, self.B, self.d, self.C_b), "C_P": C_P, "Fn": Fn}
        size = (self.L, self.B, self.d, self.C_b)
        by_zhou = options.added_mass == "zhou"
        self.masses = zhou1983.added_masses(*size) if by_zhou else clarke1982.added_masses(*size)
        early = options.holtrop == "1982"
        self.holtrop = holtrop.FORMULA_1982 if early else holtrop.FORMULA_1984
        lines = self.lines
        w_P0 = holtrop.wake_1982(lines, self.U) if early else holtrop.wake_1984(lines, self.U)
        t_P = holtrop.thrust_deduction_1982(lines) if early else holtrop.thrust_deduction_1984(lines)
        self.w_P0, self.t_P = float(w_P0), float(t_P)
        self.resistance = float(holtrop.resistance(self.lines, self.U, self.rho))
        self.propulsion: Propulsion = propulsion(
            (1.0 - self.w_P0) * self.U,
            self.resistance / ((1.0 - self.t_P) * self.rho),
            self.lines.D_P,
            ship.get("propeller", "pitch_"),
            ship.get("approach", "n"),
            of("propeller", "area_ratio"),
            of("propeller", "blades"),
            ship.curve,
        )
        self.ratios |= {"P/D": self.propulsion.pitch_}
        self.ratios |= {"A_E/A_0": of("propeller", "area_ratio"), "blades": of("propeller", "blades")}

    def profile(self) -> ShipProfile:
        """All of it."""
        sections = {
            "particulars": self.particulars(),
            "hull": self.hull(),
            "wake": self.wake(),
            "propeller": self.propeller(),
            "rudder": self.rudder(),
        }
        if "above_water" in self.ship.values:
            sections["above_water"] = self.above_water()
            sections["above_water"] = with_wind_coefficients(sections)
        scattered = {
            f"{kind}.{symbol}"
            for kind, section in sections.items()
            for symbol, coefficient in section.coefficients.items()
            if coefficient.scatter is not None
        }
        options = {key: value for key, value in self.options.to_dict().items() if value is not None}
        found = ShipProfile(
            id=self.ship.id,
            name=f"{self.ship.name}, {self.options.form.upper()} from main dimensions",
            source=self.ship.source or "main dimensions, and published formulas named with each number",
            sections=sections,
            steering_gear=self.steering_gear(),
            approach=self.approach(),
            targets=tuple(name for name in SCATTER if name in scattered and name not in LEFT_ALONE),
            provenance={
                "made_by": "mmgtune profile new",
                "particulars": {"sha256": self.ship.sha256, **self.ship.values},
                "options": {**options, "derivatives": self.options.set_of_derivatives},
            },
        )
        problems = [
            Problem(
                f"{kind}.{symbol} would be {coefficient.value:.3g}, which is impossible",
                str(self.ship.path or "particulars"),
                coefficient.warning or f"by {coefficient.source}",
                "check the dimensions, or choose other formulas",
            )
            for kind, section in sections.items()
            for symbol, coefficient in section.coefficients.items()
            if not possible(section.component.fields[symbol], coefficient.value)
        ]
        if problems:
            raise ProfileError(*problems)
        if self.options.surroundings:
            acting = {tag: {"measured": 1.0} for tag in AROUND if tag != "wind" or "above_water" in sections}
            found = with_effects(found, acting, "as measured, where a log has it")
        return replace(found, template=HEADER + found.text)

    def by(self, formula: Formula, kind: str, values: Mapping[str, Any], note: str = "") -> dict[str, Coefficient]:
        """Coefficients that a formula gives."""
        return {
            symbol: Coefficient(
                rounded(value),
                source=formula.source,
                scatter=scatter_of(f"{kind}.{symbol}", float(value)),
                warning=outside(formula, self.ratios),
                note="; ".join(part for part in (note, range_of(formula)) if part),
            )
            for symbol, value in values.items()
        }

    def plain(self, section: str, *names: str) -> dict[str, Coefficient]:
        """Values that were given, or come from a rule of thumb."""
        found = {}
        for name in names:
            rule = self.of.rule(section, name)
            said = self.said_of(section)
            value = self.of(section, name)
            found[name] = Coefficient(rounded(value), rule, True) if rule else Coefficient(value, said)
        return found

    def steering_gear(self) -> SteeringGear:
        """Limits of the rudder."""
        names = ("max_angle", "rate")
        rules = {name: rule for name in names if (rule := self.of.rule("steering_gear", name))}
        source = "; ".join(f"{name}: {rule} (assumption)" for name, rule in rules.items())
        max_angle, rate = (self.of("steering_gear", name) for name in names)
        return SteeringGear(max_angle, rate, source or self.said_of("steering_gear"))

    def approach(self) -> Approach:
        """Speed and revolutions that manoeuvres begin with."""
        given, n = self.said_of("approach"), self.ship.get("approach", "n")
        if n is not None:
            return Approach(self.U, n, given)
        return Approach(self.U, rounded(self.propulsion.n), f"speed: {given}; n: thrust is resistance at that speed")

    def said_of(self, section: str) -> str:
        """Where the particulars say that given values of a section come from."""
        return self.ship.sources.get(section, "") or self.ship.source or "given"

    def assumed(self, kind: str, values: Mapping[str, float], source: str) -> dict[str, Coefficient]:
        """Values that hold for ships at large."""
        return {
            symbol: Coefficient(value, source, True, scatter=scatter_of(f"{kind}.{symbol}", value))
            for symbol, value in values.items()
        }

    def section(self, kind: str, tag: str, source: str, found: Mapping[str, Coefficient]) -> Section:
        """A component with its coefficients in the order of its fields."""
        component = find(kind, tag)
        assert component is not None
        return Section(component, {symbol: found[symbol] for symbol in component.fields if symbol in found}, source)

    def particulars(self) -> Section:
        """Dimensions and inertia."""
        formula = zhou1983.ADDED_MASSES if self.options.added_mass == "zhou" else clarke1982.FORMULA
        given = self.plain("particulars", "rho", "L_pp", "B", "d", "C_b", "x_G", "k_zz_")
        found = {**given, **self.by(formula, "particulars", self.masses._asdict())}
        return Section(SHIP, {symbol: found[symbol] for symbol in SHIP.fields}, self.ship.source or "given")

    def hull(self) -> Section:
        """Resistance and derivatives."""
        of = self.options.set_of_derivatives
        linear, nonlinear = _DERIVATIVES[of]
        R_0 = self.resistance / force_unit(self.rho, self.L, self.d, self.U)
        note = f"Holtrop 1984 at {self.U:.3g} m/s, Fn {self.ratios['Fn']:.3f}"
        found = self.by(holtrop.FORMULA_1984, "hull", {"R_0": R_0}, note)
        size = (self.L, self.B, self.d, self.C_b)
        if of == "yoshimura":
            cubic = yoshimura2012.cubic_derivatives(*size, self.x_G, self.masses.m_x_, self.masses.m_y_)
            found |= self.by(linear, "hull", cubic._asdict())
            found["X_vvvr"] = Coefficient(0.0, "not in this form of the polynomial")
            return self.section("hull", "cubic", linear.source, found)
        found |= self.by(
            surge_coupling.FORMULA, "hull", {"X_vr": surge_coupling.surge_coupling(self.C_b, self.masses.m_y_)}
        )
        if of == "kijima":
            found |= self.by(linear, "hull", kijima1990.hull_derivatives(*size, self.masses.m_x_)._asdict())
        elif of == "clarke":
            found |= self.by(linear, "hull", clarke1982.linear_derivatives(*size)._asdict())
        else:
            trim = self.of("particulars", "trim") / self.d
            found |= self.by(linear, "hull", inoue1981.linear_derivatives(*size, trim)._asdict())
        if of != "kijima":
            found |= self.by(nonlinear, "hull", zhou1983.nonlinear_derivatives(*size)._asdict())
        component = find("hull", "derivatives")
        assert component is not None
        absent = {symbol: Coefficient(0.0, "no such term in these formulas") for symbol in component.fields}
        return self.section("hull", "derivatives", linear.source, {**absent, **found})

    def wake(self) -> Section:
        """Inflow to the propeller."""
        found = self.by(self.holtrop, "wake", {"w_P0": self.w_P0}, f"at {self.U:.3g} m/s")
        found |= self.assumed("wake", {"C_w": FADING}, kijima1990.FORMULA.source)
        found |= self.assumed("wake", {"l_P_": self.of("rudder", "x_R_") + BEFORE_RUDDER}, "just ahead of the rudder")
        return self.section("wake", "exponential", self.holtrop.source, found)

    def propeller(self) -> Section:
        """Thrust."""
        p = self.propulsion
        found = self.plain("propeller", "D_P") | self.by(self.holtrop, "propeller", {"t_P": self.t_P})
        k = dict(zip(("k_0", "k_1", "k_2"), p.k, strict=True))
        if self.ship.curve[0]:
            said = self.ship.sources.get("propeller", "") or "open-water curve given"
            curve = Formula(said, {})
            note = f"parabola through it, off by {p.misfit:.4f} at most"
        else:
            curve = wageningen.FORMULA
            pitch = f"P/D {p.pitch_:.3f}" + (f" ({p.pitch_rule})" if p.pitch_rule else "")
            others = ", ".join(
                f"{words} {self.of('propeller', name):g}" + (" (assumed)" if self.of.rule("propeller", name) else "")
                for words, name in (("A_E/A_0", "area_ratio"), ("blades", "blades"))
            )
            note = f"{pitch}, {others}; parabola through the curve, off by {p.misfit:.4f} at most"
        thrust = self.by(curve, "propeller", k, note)
        if p.warning:
            warnings = {s: "; ".join(part for part in (c.warning, p.warning) if part) for s, c in thrust.items()}
            thrust = {
                s: Coefficient(c.value, c.source, note=c.note, scatter=c.scatter, warning=warnings[s])
                for s, c in thrust.items()
            }
        return self.section("propeller", "open-water", curve.source, found | thrust)

    def rudder(self) -> Section:
        """Rudder, its inflow and what the hull makes of its force."""
        found = self.plain("rudder", "A_R", "H_R", "x_R_")
        kijima = kijima1990.rudder_interaction(self.L, self.B, self.C_b)
        found |= self.by(
            kijima1990.FORMULA,
            "rudder",
            {"eps": kijima.eps, "gamma_Rp": kijima.gamma_R, "gamma_Rn": kijima.gamma_R},
        )
        if self.options.form == "fam":
            found |= self.assumed("rudder", {"a_H": 0.2, "x_H_": self.of("rudder", "x_R_")}, FAM)
            found |= self.by(self.holtrop, "rudder", {"t_R": self.t_P}, f"taken for t_P as in {FAM}")
            found |= self.by(kijima1990.FORMULA, "rudder", {"kappa": RACE}, "0.6 (1 - w_P) / (1 - w_R)")
            found |= self.assumed("rudder", {"l_R_": 2.0 * self.of("rudder", "x_R_")}, kijima1990.FORMULA.source)
            found["pitch_"] = Coefficient(
                rounded(self.propulsion.pitch_), self.propulsion.pitch_rule or "given", bool(self.propulsion.pitch_rule)
            )
            found |= self.assumed("rudder", {"C_port": 1.065, "C_stbd": 0.935}, "Kijima & Nakiri 2002")
            found |= self.assumed("rudder", {"C_Q": 1.0, "C_D0": 0.01}, "Soding in Brix 1993, from memory")
            found |= self.assumed("rudder", {"alpha_stall": STALL, "stall_loss": 0.5}, "usual behind a propeller")
            return self.section("rudder", "slip", FAM, found)
        yoshimura = yoshimura2012.rudder_interaction(self.L, self.B, self.C_b)
        found |= self.by(kijima1990.FORMULA, "rudder", {"a_H": kijima.a_H, "t_R": kijima.t_R})
        found |= self.by(
            kijima1990.FORMULA, "rudder", {"kappa": kijima.kappa / kijima.eps}, "k_x = 0.55 - 0.8 C_b B/L, over eps"
        )
        found |= self.by(yoshimura2012.FORMULA, "rudder", {"x_H_": yoshimura.x_H_, "l_R_": yoshimura.l_R_})
        aspect = self.of("rudder", "H_R") ** 2 / self.of("rudder", "A_R")
        found |= self.by(fujii1961.FORMULA, "rudder", {"f_alpha": fujii1961.normal_force_gradient(aspect)})
        return self.section("rudder", "plain", kijima1990.FORMULA.source, found)

    def above_water(self) -> Section:
        """What wind sees, as given."""
        source = self.ship.sources.get("above_water") or self.ship.source or "given"
        return Section(ABOVE_WATER, self.plain("above_water", *self.ship.values["above_water"]), source)


def outside(formula: Formula, of: Mapping[str, float]) -> str:
    """What to say of a ship outside the range of a formula, "" inside: each ratio with its limits."""
    beyond = [
        f"{name} is {of[name]:.3g}, outside {low:g} to {high:g}"
        for name, (low, high) in formula.valid.items()
        if not low <= of[name] <= high
    ]
    return f"{formula.source.partition(',')[0]}: {'; '.join(beyond)}" if beyond else ""


def range_of(formula: Formula) -> str:
    """The range of a formula in words, "" where it is not known."""
    parts = ", ".join(f"{name} {low:g}-{high:g}" for name, (low, high) in formula.valid.items())
    return f"for {parts} ({formula.said})" if parts else ""


def possible(known: Field, value: Any) -> bool:
    """Whether a number is finite and within the limits of its field."""
    low, high = known.low, known.high
    return math.isfinite(value) and (low is None or value > low) and (high is None or value < high)


def rounded(value: Any) -> float:
    """To six digits, which is more than any formula means."""
    return float(f"{float(value):.6g}")
