"""What re-tuning alone changed: coefficients that are far from what the profile has, as those of a fouled hull."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...components import effect_tag, split_name
from ...documents import finite
from ...effects import find_effect
from ...phrases import listed
from ...units import NORMAL_95
from ..bench.workbench import Point, Workbench
from .intervals import covariance

FAR = 0.1
"""Share of its pre-determined value from which a target that moved is spoken of; where that is from a formula no less
than ships scatter about it."""

IN_SERVICE = ("hull.R_0", "hull.X_0F")
"""What fouling changes while a ship sails: these are told of in sentences.  Other targets take up what coefficients
beside them are off by, so that most values that come out surely far off are not the ship's."""

LISTED = 3
"""Of others, those that moved most that are named where nothing else is wrong."""

WEIGHED = ("particulars.",)
"""What has leeway that a user can weigh or work out: mass and inertia, with what moves along of the water."""

IN_SURGE = "particulars.m_x_"
"""Added mass in surge, a few per cent of what accelerates with it: by how much of all that it is off counts, since a
thrust or resistance a little off does the same."""

STEERED_BY = ("hull.Y_v", "hull.Y_r", "hull.N_v", "hull.N_r")
"""What has leeway that trials tell best of a hull: its linear derivatives in sway and yaw."""

IMPLAUSIBLE = 0.25
"""Share of thrust, or of the flow to the propeller, by which one of their coefficients may have moved it: beyond that
the balance with resistance is where no ship's is, and none of its numbers is told as hers."""

TAKEN_OFF = ("propeller.t_P", "wake.w_P0")
"""Fractions that are taken off a whole: a change from 0.06 to 0.08 takes a fiftieth off the thrust."""

IN_DRIFT, OTHER_SHAPE = "wake.", 1.0
"""Coefficients of how the wake changes as the ship drifts, and the share of its pre-determined value by which one may
have moved: straight ahead, where resistance is told, they do not act."""

SURE = 3.0
"""Standard errors by which it must be further than that: a dozen targets are looked at."""


OVER_LENGTH = ", over L_pp"
"""What labels say of the unit: nothing of a change in percent."""

BEYOND_LEEWAY = 2.0
"""Standard deviations of what is believed of mass, inertia and hull from which the trials contradict it."""


@dataclass(frozen=True)
class Retuned:
    """A target as it was re-tuned; or mass, inertia or a hull derivative, no target, as it came out within its leeway.

    label     what it is, in words
    before    pre-determined value, in the profile's unit; after: re-tuned, with its standard error, None at a bound
    believed  standard deviation as a share of it of what has leeway, of added mass in surge as a share of all mass that
              accelerates; None of a target
    scatter   standard deviation of ships about the formula it is from, as a share of it; 0 where that is not known
    """

    name: str
    label: str
    unit: str
    before: float
    after: float
    stderr: float | None
    believed: float | None = None
    scatter: float = 0.0

    @property
    def change(self) -> float | None:
        """By which share of its pre-determined value its size grew; None where that is 0, or the sign is another."""
        return self.after / self.before - 1.0 if self.before and self.after * self.before > 0.0 else None

    @property
    def deviation(self) -> float | None:
        """Standard error of ``change``."""
        return None if self.stderr is None or not self.before else self.stderr / abs(self.before)

    @property
    def far(self) -> bool:
        """Whether it is certainly far from what was pre-determined, if the form of the model is right."""
        if self.change is None or self.deviation is None:
            return False
        if self.believed is not None:
            sure = abs(self.change) - SURE * self.deviation >= self.believed
            return sure and abs(self.change) >= BEYOND_LEEWAY * self.believed
        return abs(self.change) - SURE * self.deviation >= self.spoken_of

    @property
    def spoken_of(self) -> float:
        """Share of its pre-determined value from which its change is spoken of."""
        return max(FAR, self.scatter)

    @property
    def words(self) -> str:
        """In a sentence: "resistance going straight (R_0) 47 ± 4 % above its pre-determined value"."""
        assert self.change is not None
        assert self.deviation is not None
        error = 100.0 * NORMAL_95 * self.deviation
        digits = 0 if error >= 1.0 else 1
        return self._by(f"{100.0 * abs(self.change):.{digits}f} ± {error:.{digits}f} %")

    @property
    def roughly(self) -> str:
        """Likewise without its interval, which holds only where the form of all else is right."""
        assert self.change is not None
        return self._by(f"{100.0 * abs(self.change):.0f} %")

    def _by(self, size: str) -> str:
        symbol, side = self.name.rpartition(".")[2], "above" if (self.change or 0.0) > 0.0 else "below"
        return f"{self.label.removesuffix(OVER_LENGTH)} ({symbol}) {size} {side} its pre-determined value"

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "name": self.name,
            "label": self.label,
            "unit": self.unit,
            "pre_determined": self.before,
            "value": finite(self.after),
            "stderr": self.stderr,
            "far": self.far,
            "target": self.believed is None,
            "scatter": self.scatter or None,
        }


def retuned(bench: Workbench, point: Point) -> list[Retuned]:
    """Targets of the ship herself at a point, those most surely far from their pre-determined values first, and values
    of mass, inertia, the hull and the forms of effects that act anyway, that the trials contradict."""
    known = [name for name in point.names if name in bench.believed.leeway]
    loose = [name for name in known if name.startswith(WEIGHED) or name in STEERED_BY]
    loose += [name for name in bench.believed.of_acting if name in point.names]
    names = [name for name in point.names if name in bench.targets and not effect_tag(name)] + loose
    if not names:
        return []
    inside, spread = covariance(bench, point, at_bounds=True)
    box, profile = bench.sub_box(names), bench.model.profile
    unit = np.array([point.unit[point.names.index(name)] for name in names])
    found = []
    for k, (name, value) in enumerate(zip(names, box.from_unit(unit[:, None])[:, 0], strict=True)):
        at = inside.index(name) if name in inside and 0.0 < unit[k] < 1.0 else None
        stderr = None if at is None else float(np.sqrt(spread[at, at]) * box.width[k])
        section, symbol = split_name(name)
        field = profile.sections[section].component.fields[symbol]
        pre, about = float(box.pre[k]), profile.coefficient(name).scatter
        believed = bench.options.leeway if name in loose else None
        if name == IN_SURGE:
            B, L, C_b = (profile.value(f"particulars.{one}") for one in ("B", "L_pp", "C_b"))
            believed = bench.options.leeway * (1.0 + 2.0 * C_b * B / L / pre)
        if name in bench.believed.forms:
            believed = bench.believed.forms[name] * float(box.width[k]) / abs(pre) if pre else math.inf
        scatter = about / abs(pre) if about and pre else 0.0
        found.append(Retuned(name, field.label, field.unit, pre, float(value), stderr, believed, scatter))
    told = [one for one in found if one.believed is None or one.far]
    return sorted(told, key=_distance, reverse=True)


def weighed(moved: Sequence[Retuned], of_hull: bool = True, beside: bool = False) -> str:
    """What the trials contradict of mass, inertia, hull and forms of effects, in sentences; "" for nothing.

    of_hull  whether of hull and forms too: where the trials are told, and by more than a few
    beside   whether causes were found, whose formulas may leave what mass and inertia take up
    """
    far = [one for one in moved if one.believed is not None and one.far]
    forms = [one for one in far if effect_tag(one.name) and of_hull]
    heavy = [one for one in far if one.name.startswith(WEIGHED)]
    hull = [one for one in far if one.name in STEERED_BY and of_hull]
    told = []
    if heavy:
        they = "It is no target" if len(heavy) == 1 else "They are no targets"
        sizes = listed([one.roughly if beside else one.words for one in heavy])
        takes = f", or {'it takes' if len(heavy) == 1 else 'they take'} up what the formula of a cause leaves"
        told.append(
            f"The trials ask for {sizes}. {they}: the ship may be loaded otherwise than the profile says, or it was "
            f"worked out otherwise{takes if beside else ''}."
        )
    if hull:
        takes = "it takes" if len(hull) == 1 else "they take"
        told.append(
            f"They are fitted best with {listed([one.roughly for one in hull])}, though no target: her hull may steer "
            f"otherwise than that of the profile, or {takes} up what other coefficients are off by."
        )
    if heavy and hull and all((one.change or 0.0) > 0.0 for one in (*heavy, *hull)):
        told.append("All of these are larger in shallow water.")
    if hull and not heavy:
        told[0] = told[0].replace("They are", "The trials are", 1)
    told += [_of_form(tag, [one for one in forms if effect_tag(one.name) == tag]) for tag in _tags(forms)]
    return " ".join(told)


def _tags(moved: Sequence[Retuned]) -> list[str]:
    return list(dict.fromkeys(effect_tag(one.name) for one in moved))


def _of_form(tag: str, moved: Sequence[Retuned]) -> str:
    """That the formulas of an effect which acts anyway are off, in a sentence."""
    effect = find_effect(tag)
    assert effect is not None
    return (
        f"The {effect.title} of the profile fits best with {listed([one.roughly for one in moved])}: its "
        "formulas may be off by that for this ship."
    )


def in_words(moved: Sequence[Retuned]) -> str:
    """Targets that change in service and are far off, the surest first: "A ... and B ..."; "" for none."""
    if _astray(moved):
        return ""
    told = [one.words for one in _targets(moved) if one.far and one.name in IN_SERVICE]
    return listed(told)


def unlike_any(moved: Sequence[Retuned]) -> str:
    """Mass and inertia where no ship's are, the surest: in a sentence; "" for none."""
    heavy = [one for one in moved if one.believed is not None and one.name.startswith(WEIGHED)]
    far = [one for one in heavy if one.far and abs(one.change or 0.0) > IMPLAUSIBLE]
    return far[0].words if far else ""


def _targets(moved: Sequence[Retuned]) -> list[Retuned]:
    return [one for one in moved if one.believed is None]


def _astray(moved: Sequence[Retuned]) -> bool:
    """Whether thrust, or the flow to the propeller, moved so far that resistance may only have followed."""
    return any(_off_drive(one) for one in moved)


def _off_drive(one: Retuned) -> bool:
    """Whether a coefficient moved thrust, or the flow to the propeller, to where no ship's is."""
    change = abs(one.after - one.before)
    if one.name in TAKEN_OFF:
        return change > IMPLAUSIBLE * abs(1.0 - one.before)
    if one.name.startswith(IN_DRIFT):
        return change > OTHER_SHAPE * abs(one.before)
    return one.name.startswith("propeller.") and change > IMPLAUSIBLE * abs(one.before)


def besides(moved: Sequence[Retuned]) -> str:
    """Why the other targets are not reported, where some moved as far: in a sentence; "" for none."""
    if told := _together(moved):
        return told
    others = [one for one in _targets(moved) if one.name not in IN_SERVICE]
    off = [one for one in others if abs(one.after - one.before) >= one.spoken_of * abs(one.before) > 0.0]
    if not off:
        return ""
    they = "Another coefficient is" if len(off) == 1 else f"{len(off)} other coefficients are"
    beyond = " and further than ships scatter about the formulas" if any(one.scatter for one in off) else ""
    return (
        f"{they} a tenth or more off too{beyond}, which may only stand for what others are off by: of all that is "
        "re-tuned together, what fouling changes alone is told apart."
    )


def _together(moved: Sequence[Retuned]) -> str:
    """That resistance is far off and thrust with it, in a sentence; "" where they are not."""
    followed = [one for one in moved if one.far and one.name in IN_SERVICE]
    if not followed or not _astray(moved):
        return ""
    return (
        f"Re-tuning moved {_changes(followed)}, and with that the thrust, or the flow to the propeller, to what no "
        "ship's is: these trials do not tell one from the other, so neither is named."
    )


def far_off(moved: Sequence[Retuned]) -> str:
    """Note on targets that are far off where nothing is wrong: in a sentence; "" for none."""
    if told := _together(moved):
        return told
    far = [one for one in _targets(moved) if one.far]
    ends = [one for one in _targets(moved) if one.stderr is None and one.after != one.before]
    if not far:
        return ""
    most = _changes(sorted(far, key=lambda one: -abs(one.change or 0.0))[:LISTED])
    so_many = f"{len(far)} coefficients" if len(far) > 1 else "a coefficient"
    at_ends = f", and {len(ends)} more to the end of {'their' if len(ends) > 1 else 'its'} range" if ends else ""
    return (
        f"For that it moved {so_many} by well over a tenth{', most of all ' if len(far) > 1 else ': '}{most}"
        f"{at_ends}: the ship may be unlike her profile in these, or they take up what others are off by."
    )


def _changes(moved: Sequence[Retuned]) -> str:
    """Targets that moved and by how much: "A (a) by +3 % and B (b) by -4 %"."""
    return listed(
        [
            f"{one.label.removesuffix(OVER_LENGTH)} ({one.name.rpartition('.')[2]}) by {100.0 * one.change:+.0f} %"
            for one in moved
            if one.change is not None
        ]
    )


def _distance(one: Retuned) -> float:
    """Sort key: distance from the pre-determined value in standard errors; unknown ones last."""
    return abs(one.after - one.before) / one.stderr if one.stderr else -1.0
