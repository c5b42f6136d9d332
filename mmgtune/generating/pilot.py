"""A pilot who brings ships to their berths: orders like those of harbour approaches.

The pilot has a plan of speed, heading and crabbing over time, looks every few seconds, and asks a joystick for surge
force and yaw moment; the joystick knows what the rudders give (they are tabulated) and picks a pair of angles in steps
of 5 deg, near those that are.  The thruster comes in bursts once the ship is slow.  No berth is ever the same: plans,
gains and habits are drawn.  This is a design of this program; the source repeats orders logged in ports, which are not
public.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..model import Model
from ..motions import breakdown
from .orders import together

STEP = np.radians(5.0)
"""Between the rudder angles a joystick picks from [rad]."""

SPEEDS = np.array([0.0, 0.15, 0.3, 0.45])
"""Speeds [m/s] for which it is known what rudders give."""

SLOW = 0.15
"""Speed [m/s] below which the thruster is used."""

BURST, QUIET = 5.0, 8.0
"""Steps of the thruster's orders and the least of them [1/s]."""

RELUCTANCE, SPREAD = 0.03, 0.15
"""How much a change of a rudder by 30 deg counts beside a force that is missed by its unit, squared; and, on the
approach, rudders that stand 30 deg apart: there one steers with both together and lets the propeller push."""


class Joystick:
    """Rudder angles for a surge force [N] and a yaw moment [N m], both of propeller and rudders."""

    def __init__(self, model: Model):
        port, stbd = (model.profile.actuators[name] for name in ("delta_port", "delta_stbd"))
        angles = [np.arange(one.low, one.high + 1e-9, STEP) for one in (port, stbd)]
        port_at, stbd_at = (grid.ravel() for grid in np.meshgrid(*angles, indexing="ij"))
        apart = port_at <= stbd_at + 1e-9  # no rudder is turned towards the other
        self.port, self.stbd = port_at[apart], stbd_at[apart]
        n = np.full(len(self.port), model.profile.require_approach().n)
        controls = np.column_stack([n, self.port, self.stbd, 0.0 * n])
        self.X = np.empty((len(SPEEDS), len(n)))
        self.N = np.empty_like(self.X)
        for k, u in enumerate(SPEEDS):
            states = np.zeros((len(n), 6))
            states[:, 3] = u
            found = breakdown(model, states, controls)
            rudders = found.rudder_port.force, found.rudder_stbd.force
            self.X[k] = found.propeller.force.X + rudders[0].X + rudders[1].X
            self.N[k] = rudders[0].N + rudders[1].N
        self.unit_X = float(np.ptp(self.X[0])) / 4.0
        self.unit_N = float(np.ptp(self.N[0])) / 4.0

    def pick(self, u: FloatArray, X: FloatArray, N: FloatArray, free: FloatArray, now: FloatArray) -> FloatArray:
        """Angles (2, n_lanes) near those that are, ``now``, at speeds u [m/s]; X does not matter where ``free``, 1."""
        k = np.abs(np.abs(u)[:, None] - SPEEDS).argmin(axis=1)
        short = (1.0 - free)[:, None] * (self.X[k] - X[:, None]) / self.unit_X
        missed = short**2 + ((self.N[k] - N[:, None]) / self.unit_N) ** 2
        moved = (self.port - now[0][:, None]) ** 2 + (self.stbd - now[1][:, None]) ** 2
        preferred = RELUCTANCE * moved + SPREAD * free[:, None] * (self.stbd - self.port) ** 2
        best = (missed + preferred / np.radians(30.0) ** 2).argmin(axis=1)
        return np.stack([self.port[best], self.stbd[best]])


class Berthing:
    """Approach, slow down, swing, crab to the berth, hold: one plan a ship.

    seconds  (n_lanes,) time each ship takes [s]
    """

    def __init__(self, model: Model, rng: np.random.Generator, seconds: FloatArray, heading: FloatArray):
        n = len(seconds)
        self.stick = Joystick(model)
        uniform = rng.uniform
        self.u_0 = uniform(0.35, 0.52, n)
        slow_down, slowed = uniform(0.20, 0.35, n), uniform(0.50, 0.62, n)
        swung, berthed = slowed + uniform(0.15, 0.22, n), uniform(0.90, 0.96, n)
        crawl = uniform(0.0, 0.08, n)
        one = np.ones(n)
        turn = uniform(0.03, 0.10, n)  # a new course, at once
        shares = np.stack([0.0 * one, turn, turn + 0.02, slow_down, slowed, swung, berthed, one])
        self.times, self.slow_down = shares * seconds, slow_down * seconds
        none = 0.0 * one
        self.u_plan = np.stack([self.u_0, self.u_0, self.u_0, self.u_0, crawl, 0.5 * crawl, none, none])
        side = np.where(uniform(size=n) < 0.5, -1.0, 1.0)
        course = np.radians(uniform(-50.0, 50.0, n))
        berth = course + side * np.radians(uniform(15.0, 90.0, n))
        self.psi_plan = heading + np.stack([none, none, course, course, course, berth, berth, berth])
        crab = np.where(uniform(size=n) < 0.5, -1.0, 1.0) * uniform(0.01, 0.045, n)
        self.v_plan = np.stack([none, none, none, none, none, crab, crab, none])
        self.every = uniform(2.0, 6.0, n)
        self.next = uniform(0.0, 2.0, n)
        self.k_u, self.k_psi = uniform(0.05, 0.12, n), uniform(0.015, 0.040, n)
        self.k_r, self.k_v = uniform(0.15, 0.30, n), uniform(0.03, 0.08, n)
        self.given = together(np.zeros(n))
        value = model.profile.value
        rho, L, d = (value(f"particulars.{name}") for name in ("rho", "L_pp", "d"))
        area = 0.5 * rho * L * d
        mass_ = 2.0 * value("particulars.C_b") * value("particulars.B") / L
        self.mass, self.mass_y = (area * L * (mass_ + value(f"particulars.{m}")) for m in ("m_x_", "m_y_"))
        self.inertia = area * L**3 * (mass_ * value("particulars.k_zz_") ** 2 + value("particulars.J_zz_"))
        self.drag, self.drag_y = -area * value("hull.X_0F"), area * value("hull.C_D")
        self.thrust = rho * value("thruster.D") ** 4 * value("thruster.K_Tp") * (1.0 + value("thruster.a_1"))
        self.arm = value("thruster.x")

    def start(self, heading: FloatArray) -> FloatArray:
        """States (6, n_lanes) at the begin of the approach."""
        still = np.zeros(len(heading))
        return np.stack([still, still, heading, self.u_0, still, still])

    def planned(self, t: float) -> FloatArray:
        """Speed ahead [m/s], heading [rad] and speed of crabbing [m/s] at a time [s], (3, n_lanes)."""
        lanes = range(self.times.shape[1])
        plans = (self.u_plan, self.psi_plan, self.v_plan)
        return np.array([[np.interp(t, self.times[:, k], plan[:, k]) for k in lanes] for plan in plans])

    def orders(self, t: float, states: FloatArray) -> FloatArray:
        """See ``Commander``."""
        due = t >= self.next
        if due.any():
            self.next = np.where(due, t + self.every, self.next)
            self.given = np.where(due, self._wanted(t, states), self.given)
        return self.given

    def _wanted(self, t: float, states: FloatArray) -> FloatArray:
        psi, u, v, r = states[2:]
        u_plan, psi_plan, v_plan = self.planned(t)
        X = self.mass * self.k_u * (u_plan - u) + self.drag * u_plan * np.abs(u_plan)
        N = self.inertia * (self.k_psi * (psi_plan - psi) - self.k_r * r)
        Y = self.mass_y * self.k_v * (v_plan - v) + self.drag_y * v_plan * np.abs(v_plan)
        bow = np.where(np.abs(u) < SLOW, 0.5 * Y + 0.4 * N / self.arm, 0.0)
        n = np.sign(bow) * BURST * np.round(np.sqrt(np.abs(bow) / self.thrust) / BURST)
        n = np.where(np.abs(n) < QUIET, 0.0, np.clip(n, -30.0, 30.0))
        left = N - self.arm * self.thrust * n * np.abs(n)
        approaching = (t < self.slow_down).astype(np.float64)
        return np.vstack([self.stick.pick(u, X, left, approaching, self.given[:2]), n])
