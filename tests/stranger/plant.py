"""The ship that sails: an MMG ship about her centre of gravity, with what may be hidden in her and around her.

Written from the papers alone.  Equations of motion are about the centre of gravity and through the water; the
steering chain, engine and helmsman work in steps of ``STEP``, the motion by the classical Runge-Kutta rule in
between.  SI units, radians; x north, y east, heading clockwise.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

STEP = 0.05
"""Step of plant and steering chain [s]."""
RHO = 1025.0
RHO_AIR = 1.225
DEG = math.pi / 180.0
MARGIN = 30.0
"""What is kept of the time before the log begins [s], for instruments that are late."""


class Ship(NamedTuple):
    """Particulars and coefficients; ``full`` 1 for the unified hull with its own propeller and rudder, 0 for cubic."""

    full: float
    L: float
    B: float
    d: float
    Cb: float
    xG: float
    kzz: float
    mx: float
    my: float
    Jz: float
    # hull, cubic
    R0: float
    Xvv: float
    Xvr: float
    Xrr: float
    Xvvvr: float
    Xvvvv: float
    Yv: float
    Yr: float
    Yvvv: float
    Yvvr: float
    Yvrr: float
    Yrrr: float
    Nv: float
    Nr: float
    Nvvv: float
    Nvvr: float
    Nvrr: float
    Nrrr: float
    # hull, unified
    XA: float
    CD: float
    CrY: float
    CrN: float
    # propeller and wake
    DP: float
    tP: float
    w0: float
    Cw: float
    tau: float
    CP: float
    lP: float
    k0: float
    k1: float
    k2: float
    # rudder
    AR: float
    HR: float
    tR: float
    aH: float
    xH: float
    eps: float
    kappa: float
    uR0: float
    lR: float
    gp: float
    gn: float
    fa: float
    fa2: float
    cl1: float
    cl3: float
    # above water
    AF: float
    AL: float
    sL: float
    # how she is run
    speed: float
    n: float
    rate: float
    most: float


SUZAKU = Ship(
    full=0.0, L=83.0, B=13.5, d=3.8, Cb=0.737, xG=0.93, kzz=0.25, mx=0.010, my=0.168, Jz=0.010,
    R0=0.017, Xvv=0.009, Xvr=-0.008, Xrr=-0.0164, Xvvvr=-0.824, Xvvvv=-0.114,
    Yv=-0.329, Yr=0.100, Yvvv=-0.787, Yvvr=-0.022, Yvrr=-0.206, Yrrr=0.001,
    Nv=-0.106, Nr=-0.057, Nvvv=-0.037, Nvvr=-0.105, Nvrr=0.012, Nrrr=-0.008,
    XA=0.0, CD=0.0, CrY=1.0, CrN=1.0,
    DP=2.80, tP=0.080, w0=0.422, Cw=-2.0, tau=0.0, CP=0.0, lP=-0.5, k0=0.0, k1=0.0, k2=0.0,
    AR=6.282, HR=3.49, tR=-0.058, aH=0.158, xH=-0.605, eps=1.27, kappa=0.5, uR0=0.14, lR=-0.888,
    gp=0.483, gn=0.172, fa=2.411, fa2=-0.381, cl1=1.164, cl3=-0.381,
    AF=170.0, AL=750.0, sL=0.0, speed=3.5, n=106.0 / 60.0, rate=2.5 * DEG, most=40.0 * DEG,
)  # fmt: skip
ESSO = Ship(
    full=1.0, L=325.0, B=53.0, d=21.79, Cb=0.8302, xG=10.14, kzz=0.25, mx=0.0467, my=0.2579, Jz=0.01168,
    R0=0.02139, Xvv=0.0, Xvr=-0.0081, Xrr=0.0, Xvvvr=0.0, Xvvvv=0.0,
    Yv=-0.3728, Yr=0.1160, Yvvv=0.0, Yvvr=0.0, Yvrr=0.0, Yrrr=0.0,
    Nv=-0.1458, Nr=-0.04849, Nvvv=0.0, Nvvr=0.0, Nvrr=0.0, Nrrr=0.0,
    XA=0.03189, CD=0.9665, CrY=2.217, CrN=0.8097,
    DP=9.1, tP=0.22, w0=0.614, Cw=0.0, tau=0.871, CP=-0.359, lP=-0.517, k0=0.3278, k1=-0.3323, k2=-0.156,
    AR=124.7, HR=13.86, tR=0.19, aH=0.393, xH=-0.45, eps=1.42, kappa=0.2028, uR0=0.0, lR=-1.08,
    gp=0.4406, gn=0.3506, fa=2.490, fa2=0.0, cl1=0.0, cl3=0.0,
    AF=1589.0, AL=6107.0, sL=-1.407, speed=4.1, n=0.9608, rate=2.34 * DEG, most=35.0 * DEG,
)  # fmt: skip


class Hidden(NamedTuple):
    """What the profile knows nothing of; nothing at its defaults.  Time counts from the beginning of the log."""

    # water and air
    north: float = 0.0  # current [m/s]
    east: float = 0.0
    north_rate: float = 0.0  # its change, as of a tide [m/s^2]
    east_rate: float = 0.0
    wind: float = 0.0  # mean speed at the height of the ship [m/s]
    wind_from: float = 0.0
    wind_arm: float = 1.0  # how far off midship it acts, times that of the form
    gust: float = 0.06  # share of the mean
    gust_phase: float = 0.0
    wind_begins: float = -1e9  # a squall has a beginning and an end [s]
    wind_ends: float = 1e9
    depth: float = 0.0  # 0: deep
    drift: float = 0.0  # mean force of waves on the beam [N]
    drift_from: float = 0.0
    # steering
    offset: float = 0.0  # blade less indicator [rad]
    gain: float = 1.0
    lag: float = 0.0  # [s]
    slow: float = 0.0  # rate of the blade where the indicator shows the order [rad/s]; 0: as the indicator
    dead: float = 0.0  # [s]
    play: float = 0.0  # whole play of the linkage [rad]
    # propulsion and rudder
    flap: float = 1.0
    stall: float = 9.0  # inflow angle where it begins [rad]
    turns: float = 1.0  # true over shown revolutions
    side_Y: float = 1.0
    side_N: float = 1.0
    # hull
    fouled: float = 1.0
    draught: float = 1.0
    trim: float = 0.0  # by the stern, over draught
    Yvav: float = 0.0  # v'|v'|
    Nrar: float = 0.0  # r'|r'|
    Nvar: float = 0.0  # v'|r'|
    memory: float = 0.0  # [s]
    # what no program could know
    play_1: float = 0.0  # two linkages in series, each carrying a part of the stroke [rad]
    play_2: float = 0.0
    derate: float = 0.0  # share of thrust lost a second
    shift_at: float = 1e9  # cargo moves [s]
    shift_N: float = 0.0  # yaw moment of the list, prime
    shift_X: float = 0.0
    ice_X: float = 0.0
    ice_N: float = 0.0
    pass_at: float = 0.0  # another ship abeam [s]
    pass_for: float = 1.0
    pass_Y: float = 0.0  # [N]
    pass_N: float = 0.0  # [N m]
    eddy: float = 0.0  # speed at its rim [m/s]
    eddy_x: float = 0.0
    eddy_y: float = 0.0
    eddy_size: float = 1.0
    stuck_at: float = 1e9  # blade stands still while the indicator moves [s]
    stuck_for: float = 0.0


class Helm(NamedTuple):
    """A run as it is ordered, and the man at the wheel.

    ``orders`` are rudder angles [rad], each held for ``hold`` [s]; a zigzag goes to the other side at ``check`` off the
    first course instead (0: by time); ``course`` 1: they are changes of course [rad], steered.
    """

    heading: float
    n: float
    lead: float
    lasts: float
    course: float
    check: float
    kp: float
    kd: float
    every: float
    rounding: float
    late: float
    band: float
    sag: float


@njit(cache=True)
def _flap_angle(delta):
    table = np.array([0.0, 10.0, 18.0, 25.0, 30.0, 34.5, 38.0, 41.0, 43.5, 45.0])
    a = min(abs(delta) / (5.0 * DEG), 9.0)
    i = min(int(a), 8)
    return math.copysign((table[i] + (a - i) * (table[i + 1] - table[i])) * DEG, delta)


@njit(cache=True)
def _strips(v, r, L, C):
    """Cross flow drag along the hull, by Gauss's rule of three on twelve strips."""
    Y, N = 0.0, 0.0
    for k in range(12):
        for j in range(3):
            x = -0.5 + (k + 0.5 + (j - 1) * 0.3872983346207417) / 12.0
            w = (8.0 if j == 1 else 5.0) / 18.0 / 12.0
            a = v + C * r * L * x
            Y += w * a * abs(a)
            N += w * a * abs(a) * x
    return Y, N


@njit(cache=True)
def _wind_force(s, speed, angle):
    """Blendermann's form: force ahead, to starboard, moment; wind from ``angle`` off the bow."""
    q = 0.5 * RHO_AIR * speed * speed
    head = 0.60 if math.cos(angle) > 0.0 else 0.50
    along = head * s.AF / s.AL
    across = 0.85
    bow = 1.0 - 0.25 * (1.0 - along / across) * math.sin(2.0 * angle) ** 2
    X = -q * s.AL * along * math.cos(angle) / bow
    Y = -q * s.AL * across * math.sin(angle) / bow
    arm = s.sL - 0.18 * s.L * (abs(math.atan2(math.sin(angle), math.cos(angle))) - 0.5 * math.pi)
    return X, Y, Y * arm


@njit(cache=True)
def _water(h, t, x, y):
    """Velocity of the water over ground, north and east; x and y from where the log begins."""
    now = max(t, 0.0)
    north, east = h.north + h.north_rate * now, h.east + h.east_rate * now
    if h.eddy != 0.0:
        a, b = (x - h.eddy_x) / h.eddy_size, (y - h.eddy_y) / h.eddy_size
        turn = h.eddy * math.exp(0.5 * (1.0 - a * a - b * b)) * (1.0 - math.exp(-now / 10.0))
        north, east = north - turn * b, east + turn * a
    return north, east


@njit(cache=True)
def _rates(state, t, blade, n, s, h, out):
    """Time derivatives of (x, y, psi, u, v of the centre of gravity, r, four memories); x and y of that centre."""
    psi, u, vg, r = state[2], state[3], state[4], state[5]
    v = vg - s.xG * r
    d = s.d * h.draught
    U = max(math.hypot(u, v), 0.02)
    force = 0.5 * RHO * s.L * d
    vp, rp = v / U, r * s.L / U
    beta = math.atan2(-v, u)
    # how depth, draught and trim change the hull, by rules of thumb
    up, tr = h.draught, h.trim
    fYv, fNv = up**0.9 * (1.0 + 0.6 * tr), up**0.9 * (1.0 - 0.7 * tr)
    fYr, fNr = up * (1.0 + 0.75 * tr), up**0.8 * (1.0 + 0.35 * tr)
    fR, fmy, fJ, cross, wake = 1.0 + 0.3 * (1.0 / up - 1.0), up, up**0.5, 1.0, 1.0
    if h.depth > 0.0:
        q = d / max(h.depth - d, 0.1 * d)
        fYv, fNv = fYv * (1.0 + 0.50 * q**1.1), fNv * (1.0 + 0.42 * q**1.1)
        fYr, fNr = fYr * (1.0 + 0.10 * q), fNr * (1.0 + 0.25 * q**1.1)
        fR, fmy, fJ = fR * (1.0 + 0.08 * q), fmy * (1.0 + 0.20 * q), fJ * (1.0 + 0.15 * q)
        cross, wake = 1.0 + 0.30 * q, 1.0 + 0.03 * q
    R0 = s.R0 * h.fouled * fR
    my, Jz = s.my * fmy, s.Jz * fJ
    # hull
    if s.full > 0.5:
        slope = (s.XA - s.R0) * abs(beta) / math.pi
        XH = force * (-(R0 + slope) * u * U + s.Xvr * v * r * s.L)
        IY, _ = _strips(v, r, s.L, s.CrY)
        _, IN = _strips(v, r, s.L, s.CrN)
        YH = force * (fYv * s.Yv * v * abs(u) + fYr * s.Yr * r * s.L * u - cross * s.CD * IY)
        NH = force * s.L * (fNv * s.Nv * v * u + fNr * s.Nr * r * s.L * abs(u) - cross * s.CD * IN)
    else:
        XH = s.Xvv * vp**2 + s.Xvr * vp * rp + s.Xrr * rp**2 + s.Xvvvr * vp**3 * rp + s.Xvvvv * vp**4 - R0
        YH = fYv * s.Yv * vp + fYr * s.Yr * rp
        YH += cross * (s.Yvvv * vp**3 + s.Yvvr * vp**2 * rp + s.Yvrr * vp * rp**2 + s.Yrrr * rp**3)
        NH = fNv * s.Nv * vp + fNr * s.Nr * rp
        NH += cross * (s.Nvvv * vp**3 + s.Nvvr * vp**2 * rp + s.Nvrr * vp * rp**2 + s.Nrrr * rp**3)
        XH, YH, NH = XH * force * U * U, YH * force * U * U, NH * force * s.L * U * U
    YH += force * U * U * h.Yvav * vp * abs(vp)
    NH += force * s.L * U * U * (h.Nrar * rp * abs(rp) + h.Nvar * vp * abs(rp))
    for k in range(6, 10):
        out[k] = 0.0
    if h.memory > 0.0:
        # half of the force follows in the time constant, half in a third of it
        for k in range(2):
            T = h.memory * (1.35 if k == 0 else 0.45)
            out[6 + 2 * k] = (YH - state[6 + 2 * k]) / T
            out[7 + 2 * k] = (NH - state[7 + 2 * k]) / T
        YH, NH = 0.6 * state[6] + 0.4 * state[8], 0.6 * state[7] + 0.4 * state[9]
    # propeller
    turns = n * h.turns * (1.0 - h.derate * max(t, 0.0))
    bP = beta - s.lP * rp
    if s.full > 0.5:
        side = vp + s.lP * rp
        inflow = (1.0 - s.w0 * wake) + s.tau * abs(side) + s.CP * side * side
        uP = min(max(inflow, 1e-3), 1.0) * u
        J = uP / (turns * s.DP)
        KT = s.k0 + s.k1 * J + s.k2 * J * J
        XP, YP, NP = RHO * turns**2 * s.DP**4 * (1.0 - s.tP) * KT, 0.0, 0.0
        race = math.sqrt(max(uP * uP + 8.0 * KT * (turns * s.DP) ** 2 / math.pi, 0.0))
        eta = s.DP / s.HR
        uR = s.eps * math.sqrt(eta * (uP + s.kappa * (race - uP)) ** 2 + (1.0 - eta) * uP * uP)
    else:
        uP = (1.0 - s.w0 * wake * math.exp(s.Cw * bP * bP)) * u
        tip = 0.7 * math.pi * turns * s.DP
        Vr2 = uP * uP + tip * tip
        phi = min(max(math.atan2(uP, tip) / DEG, -10.0), 40.0)
        CT = 3.31e-6 * phi**3 - 3.72e-4 * phi**2 - 2.60e-3 * phi + 0.167
        CPY = -2.83e-5 * phi**2 + 6.04e-4 * phi - 1.28e-2
        CPN = -2.48e-4 * phi - 1.70e-3 if phi < 20.0 else -1.86e-4 * phi + 4.03e-3
        q = 0.5 * RHO * math.pi / 4.0 * s.DP**2 * Vr2
        XP, YP, NP = q * (1.0 - s.tP) * CT, q * h.side_Y * CPY, q * s.L * h.side_N * CPN
        race = math.sqrt(max(uP * uP + CT * Vr2, 0.0))
        uR = max(s.eps * (s.DP / s.HR * s.kappa * (race - uP) + uP), tip * s.uR0)
    # rudder
    vR = -(s.gp if beta - s.lR * rp > 0.0 else s.gn) * (v + s.lR * s.L * r)
    alpha = blade - math.atan2(vR, uR)
    flap = h.flap * _flap_angle(blade) if s.cl1 != 0.0 else 0.0
    lift = (s.fa + s.fa2 * flap**2) * math.sin(alpha) + s.cl1 * flap + s.cl3 * flap**3
    if abs(alpha) > h.stall:
        # the lift rounds off softly and then sags
        over = abs(alpha) - h.stall
        kept = math.sin(h.stall) * (1.0 + 0.12 * math.tanh(over / 0.1) - 0.3 * (1.0 - math.exp(-over / 0.3)))
        lift *= kept / math.sin(abs(alpha))
    FN = 0.5 * RHO * s.AR * (uR * uR + vR * vR) * lift
    X = XH + XP - (1.0 - s.tR) * FN * math.sin(blade)
    Y = YH + YP - (1.0 + s.aH) * FN * math.cos(blade)
    N = NH + NP - (-0.5 + s.aH * s.xH) * s.L * FN * math.cos(blade)
    # air: the drag of still air belongs to the resistance
    north, east = _water(h, t, state[0], state[1])
    c, w = math.cos(psi), math.sin(psi)
    on, oe = u * c - v * w + north, u * w + v * c + east
    if h.wind > 0.0 and h.wind_begins < t < h.wind_ends:
        g = h.gust_phase
        gust = math.sin(0.11 * t + g) + math.sin(0.047 * t + 2.3 * g + 1.0) + math.sin(0.23 * t + 5.1 * g)
        speed = h.wind * (1.0 + h.gust * gust)
        of = h.wind_from + 0.5 * h.gust * math.sin(0.071 * t + 3.7 * g)
        an, ae = speed * math.cos(of) + on, speed * math.sin(of) + oe
        WX, WY, WN = _wind_force(s, math.hypot(an, ae), math.atan2(ae, an) - psi)
        X0, Y0, N0 = _wind_force(s, math.hypot(on, oe), math.atan2(oe, on) - psi)
        X, Y, N = X + WX - X0, Y + WY - Y0, N + h.wind_arm * (WN - N0)
    if h.drift != 0.0:
        # mean second-order force: strongest on the beam, weaker ahead, with some moment on the quarters
        m = h.drift_from - psi
        X -= h.drift * 0.55 * math.cos(m)
        Y -= h.drift * math.sin(m) * (0.8 + 0.2 * abs(math.sin(m)))
        N -= h.drift * 0.02 * s.L * math.sin(2.0 * m)
    # the rest is nobody's business
    q = force * U * U
    X -= q * h.ice_X
    N += q * s.L * h.ice_N
    if t > h.shift_at:
        settled = 1.0 - math.exp(-(t - h.shift_at) / 8.0)
        X -= q * h.shift_X * settled
        N += q * s.L * h.shift_N * settled
    if h.pass_Y != 0.0:
        a = (t - h.pass_at) / h.pass_for
        bell = math.exp(-0.5 * a * a)
        Y += h.pass_Y * bell
        N += h.pass_N * a * bell
    # about the centre of gravity
    m = RHO * s.L * s.B * d * s.Cb
    mX, mY, J = s.mx * force * s.L, my * force * s.L, Jz * force * s.L**3
    IG = m * (s.kzz * s.L) ** 2
    out[3] = (X + m * vg * r + mY * v * r) / (m + mX)
    side = Y - (m + mX) * u * r
    turn = N - s.xG * Y + s.xG * mX * u * r
    a11, a12, a22 = m + mY, -s.xG * mY, IG + J + s.xG**2 * mY
    det = a11 * a22 - a12 * a12
    out[4] = (side * a22 - a12 * turn) / det
    out[5] = (a11 * turn - a12 * side) / det
    out[0] = u * c - vg * w + north
    out[1] = u * w + vg * c + east
    out[2] = r


@njit(cache=True)
def _play(blade, shown, width):
    return min(max(blade, shown - 0.5 * width), shown + 0.5 * width)


@njit(cache=True)
def _sail(s, h, helm, orders, hold, before, first_speed):
    """Sail ``before`` s on a straight course, then the log: rows (t, x, y, psi, u, v, r, indicator, n) of midship."""
    dt = STEP
    total = int((before + helm.lasts) / dt + 0.5)
    begin = int((before - MARGIN) / dt + 0.5)
    start = int(before / dt + 0.5)
    rows = np.empty((total - begin + 1, 9))
    state = np.zeros(10)
    k1, k2, k3, k4 = np.zeros(10), np.zeros(10), np.zeros(10), np.zeros(10)
    state[2], state[3] = helm.heading, first_speed
    late = int(h.dead / dt + 0.5)
    past = np.zeros(late + 1)
    shown, order, lagged, lagged_2, slow, loose, part_1, part_2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    blade, n = h.offset, helm.n
    at, since, heard, called = 0, 1e9, -1e9, 0.0
    sign = 1.0
    for i in range(total + 1):
        t = i * dt - before
        if i == start:
            # the place a log begins at is its origin, of what is where as well
            x0, y0 = state[0], state[1]
            state[0], state[1] = 0.0, 0.0
            for k in range(i - begin):
                rows[k, 1] -= x0
                rows[k, 2] -= y0
        psi, u, r = state[2], state[3], state[5]
        if i >= begin:
            v = state[4] - s.xG * r
            x, y = state[0] - s.xG * math.cos(psi), state[1] - s.xG * math.sin(psi)
            north, east = _water(h, t, state[0], state[1])
            c, w = math.cos(psi), math.sin(psi)
            row = rows[i - begin]
            row[0], row[1], row[2], row[3] = t, x, y, psi
            row[4], row[5], row[6] = u + north * c + east * w, v + east * c - north * w, r
            row[7], row[8] = shown, n
        # the helmsman, who looks up every few seconds, or holds the angle he was told
        since += dt
        steering = t < helm.lead or helm.course > 0.5
        course = helm.heading
        if t >= helm.lead:
            if helm.course > 0.5:
                at = 0
                left = t - helm.lead
                while at < len(hold) - 1 and left > hold[at]:
                    left -= hold[at]
                    at += 1
                course += orders[at]
            elif helm.check > 0.0:
                wanted = orders[0] * sign
                if math.copysign(1.0, wanted) * (psi - helm.heading) > helm.check:
                    sign = -sign
                    wanted = -wanted
                if wanted != called:
                    called, heard = wanted, t
            else:
                at = 0
                left = t - helm.lead
                while at < len(hold) - 1 and left > hold[at]:
                    left -= hold[at]
                    at += 1
                if orders[at] != called:
                    called, heard = orders[at], t
            if not steering and t >= heard + helm.late:
                order = called
        if steering and since >= helm.every:
            since = 0.0
            most = 20.0 * DEG if helm.course > 0.5 and t >= helm.lead else 10.0 * DEG
            wanted = -helm.kp * (psi - course) - helm.kd * r
            order = min(max(round(wanted / helm.rounding) * helm.rounding, -most), most)
        # a gear that is on or off, and slows down as it comes near
        error = order - shown
        if abs(error) > helm.band or (abs(error) > 0.3 * helm.band and abs(error) > 0.0 and not steering):
            shown += math.copysign(min(s.rate * min(1.0, abs(error) / (1.5 * DEG) + 0.15) * dt, abs(error)), error)
        # from the indicator to the blade
        past[i % (late + 1)] = shown
        heard_now = past[(i + 1) % (late + 1)] if i >= late else past[0]
        slow = heard_now
        if h.slow > 0.0:
            slow = lagged + min(max(heard_now - lagged, -h.slow * dt), h.slow * dt)
        if h.lag > 0.0:
            lagged_2 += dt * (slow - lagged_2) / (0.75 * h.lag)
            lagged += dt * (lagged_2 - lagged) / (0.25 * h.lag)
        else:
            lagged = slow
        moved = h.gain * lagged
        if h.play > 0.0:
            loose = _play(loose, moved, h.play)
            moved = loose
        if h.play_1 > 0.0:
            part_1, part_2 = _play(part_1, moved, h.play_1), _play(part_2, moved, h.play_2)
            moved = 0.6 * part_1 + 0.4 * part_2
        was = blade
        if not h.stuck_at < t < h.stuck_at + h.stuck_for:
            blade = moved + h.offset
        # an engine that gives way a little as the load grows
        n += dt * (helm.n * (1.0 - helm.sag * (1.0 - u / first_speed)) - n) / 6.0
        _rates(state, t, was, n, s, h, k1)
        _rates(state + 0.5 * dt * k1, t + 0.5 * dt, 0.5 * (was + blade), n, s, h, k2)
        _rates(state + 0.5 * dt * k2, t + 0.5 * dt, 0.5 * (was + blade), n, s, h, k3)
        _rates(state + dt * k3, t + dt, blade, n, s, h, k4)
        for j in range(10):
            state[j] += dt / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j])
    return rows


def sail(
    ship: Ship, hidden: Hidden, helm: Helm, orders: np.ndarray, hold: np.ndarray, before: float = 240.0
) -> np.ndarray:
    """Rows (n, 9) of t, x, y, psi, u, v, r, indicated rudder, shown revolutions every ``STEP`` from ``-MARGIN`` on.

    Midship, over ground.
    """
    first = ship.speed * helm.n / ship.n
    return np.asarray(_sail(ship, hidden, helm, orders, hold, before, first))
