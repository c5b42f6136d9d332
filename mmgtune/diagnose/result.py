"""What a diagnosis returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..components import effect_tag
from ..documents import finite_values
from ..effects import find_effect
from ..profile import ShipProfile, tuned, with_effects
from .answering import saying
from .answering.verdict import Answer
from .bench import beliefs, wave_groups, winds

SCHEMA = 1


@dataclass(frozen=True, eq=False)
class Diagnosis(Answer):
    """A finished diagnosis.

    theta     tuned targets, and what had leeway, with all causes in place; retuned: without any
    moved     targets beside their pre-determined values, with all causes in place; none where nothing can be named
    instead   a cause that would do most of what re-tuning did, where no other shows; None else
    traces    what is statistically there besides and changes nothing that a user would notice; in no profile
    contributions  of the causes, by tag in their order, the others in place
    groups    causes that cannot be told apart, each a list of tags
    chi2      of the trials it looked at per residual: before, after
    evidence  residuals, residual forces and what explains them, for the report
    read_off  pivots of effects that these trials say themselves, by full name
    unlike_any what values of each run take of mass and inertia that no ship has, in words; "" for nothing
    coverage  what the trials it looked at visit; warnings: what of that a reader must know
    whereabouts  where the error lives, where nothing explains it; None else
    jumped    largest jump of the position of each run that has any, and that was taken in parts there [m]
    ended     largest value that the log of a channel shows, of those whose sensor is at the end of its range, "u" [m/s]
              or "r" [rad/s]; what it shows there is left out
    misread   logs that are off in a few runs, and are left out: by channel and run how many times the motion they show,
              None where it is no factor; under "delta" runs whose rudder angle has the other sign and was put right,
              under "position" those whose positions are off
    contradicted what the logs say against each other, or what no model of the ship has, in a sentence; told first where
              the answer is unexplained
    swell     that the ship swings in waves, and that nothing is left beside that; "" where it is not so
    doubted      the sum of causes that the one named was found in, where that is not believed; None else
    leading      the first of the causes, where these are not believed together and it removes most alone; None else
    together  what was found without the trials kept for testing, where these had to be looked at too; None else
    choice    windows of voyages that were looked at, None for trials; differing: what differs between the voyages
    of_traces variance beyond noise that traces account for, as a share of it
    ends      targets far off what was believed of them, re-tuned without causes and with them
    more      whether much is left beside as many causes as are believed together
    """

    written_by = "write_diagnosis"

    def __repr__(self) -> str:
        """In a line."""
        causes = ", ".join(cause.tag for cause in self.causes) or "no cause"
        return f"Diagnosis({self.profile.id}, {self.verdict}: {causes})"

    def sentence(self) -> str:
        """The answer in words a captain understands."""
        return saying.said(self).sentence

    def _assumptions(self) -> list[dict[str, Any]]:
        """What the profile assumes, and what the search believed beforehand."""
        of_profile = [
            {"name": name, "value": self.profile.written(name), "note": coefficient.note}
            for name, coefficient in self.profile.assumptions()
        ]
        effects = [cause.effect for cause in self.causes if cause.effect is not None]
        held = 0.0 if self.choice is not None else self.options.leeway
        own = [find_effect(tag) for tag in dict.fromkeys(effect_tag(name) for name in self.theta if effect_tag(name))]
        acting = [one for one in own if one is not None and one not in effects]
        believed = beliefs.in_words(held, [*effects, *acting], self.ends.formulas if self.ends else 0)
        return [*of_profile, *believed, *winds.in_words(effects), *wave_groups.in_words(effects)]

    def _voyages(self) -> dict[str, Any] | None:
        """What was looked at of voyages, and what differs from one to the next."""
        if self.choice is None:
            return None
        chosen = [trial.whole for trial in self.choice.trials.trials.values()]
        return {
            "window_s": self.choice.length,
            "windows": {name: chosen.count(name) for name in self.choice.voyages},
            "windows_there_are": dict(self.choice.of),
            "sentence": self.choice.sentence,
            "differences": [one.to_dict() for one in self.differing],
        }

    def citations(self) -> list[str]:
        """The papers behind the profile's components and the causes."""
        causes = [cite for cause in self.causes if cause.effect for cite in cause.effect.cites]
        return list(dict.fromkeys([*self.profile.cites(), *causes]))

    @property
    def kept(self) -> Mapping[str, float]:
        """Targets beside the named causes: where none is, tuned without any."""
        return self.theta if self.named else self.retuned

    def as_ship(self) -> ShipProfile:
        """The extended profile: what the result stands for where a ship is wanted."""
        return self.extended_profile()

    def extended_profile(self) -> ShipProfile:
        """The profile with re-tuned targets and the named causes, each in its own section.

        What differs between runs belongs to these, not to the ship, and is left out.  Causes of an answer that is not
        believed are named, and not in it: ``best_known`` of the record has their sizes.
        """
        made_by = f"mmgtune {self.provenance['mmgtune']}"
        facts = {
            "made_by": made_by,
            "command": self.provenance["command"],
            "created": self.provenance["created"],
            "profile_sha256": self.profile.sha256,
            "trials": self.provenance["trials"]["sha256"],
            "verdict": self.verdict,
            "causes": [cause.tag for cause in self.named],
            **({"coverage": self.coverage.to_dict()} if self.coverage and self.coverage.to_dict() else {}),
        }
        left_out = [cause.tag for cause in self.named if cause.runs]
        if left_out:
            facts["left_out"] = left_out
        if self.together and self.together.settled:
            facts["tuned_to_test"] = True
        if self.causes and not self.named:
            facts["not_believed"] = [cause.tag for cause in self.causes]
        values: dict[str, dict[str, float]] = {}
        stderr: dict[str, dict[str, float | None]] = {}
        for cause in self.named:
            if cause.effect is not None:
                for full, estimate in cause.estimates.items():
                    name = full.rpartition(".")[2]
                    values.setdefault(cause.tag, {})[name] = estimate.value
                    stderr.setdefault(cause.tag, {})[name] = estimate.stderr
        for full, value in self.read_off.items():
            _, tag, name = full.split(".")
            if tag in values:
                values[tag][name] = value
        told = self.provenance["trials"]
        data = {"licence": told.get("licence", ""), "citation": told.get("citation", "")}
        retuned = tuned(self.profile, self.kept, {}, facts, "extended", **data)
        return with_effects(retuned, values, f"diagnosed by {made_by}", stderr)

    def to_dict(self) -> dict[str, Any]:
        """The document of ``diagnosis.json``, schema 1 (docs/formats.md)."""
        said = saying.said(self)
        return {
            "schema": SCHEMA,
            "kind": "diagnosis",
            **self.provenance,
            "interrupted": self.interrupted,
            "verdict": self.verdict,
            "sentence": said.sentence,
            "headline": said.headline,
            "explained": said.explained,
            "jumped": dict(self.jumped),
            "ended": dict(self.ended),
            "warnings": list(self.warnings),
            "coverage": self.coverage.to_dict() if self.coverage else {},
            "record": self.record.to_dict() if self.record else None,
            "doubts": [one.to_dict() for one in self.profile.doubts()],
            "causes": [cause.to_dict() for cause in self.named],
            "traces": [trace.to_dict() for trace in self.traces],
            "contributions": [{"effect": tag, **one.to_dict()} for tag, one in self.contributions],
            "groups": [list(group) for group in self.groups] if self.verdict == "not-separable" else [],
            "candidates": [candidate.to_dict() for candidate in self.candidates],
            "suggested_trial": self.suggestion.to_dict() if self.suggestion else None,
            "gain": self.gain.to_dict(),
            "unexplained": {
                "structured": self.leftover.structured,
                "unclear": self.unclear,
                "share_of_noise_variance": self.leftover.unknown,
                "slow_noise": self.leftover.slow,
                "left_open_by_inputs": self.leftover.left_open,
                "by_channel": self.leftover.channels,
                "changed_within": {name: list(ids) for name, ids in self.leftover.changed.items()},
                "misread": {name: dict(runs) for name, runs in self.wrong_logs.items()},
                "share_explained_by_causes": self.explained_share,
                "correlation": self.leftover.alike,
                "largest_share_by_one_quantity": {
                    name: {"quantity": what, "share": share} for name, (what, share) in self.leftover.explained.items()
                },
                "best_known": [cause.to_dict() for cause in self.causes]
                if self.verdict in ("unexplained", "interrupted")
                else [],
                "leading": self.leading.to_dict() if self.leading else None,
                "at_ends": self.ends.to_dict() if self.ends else None,
            },
            "whereabouts": self.whereabouts.to_dict() if self.whereabouts else None,
            "doubted": self.doubted.to_dict() if self.doubted else None,
            "together": self.together.to_dict() if self.together else None,
            "detectability": [one.to_dict() for one in self.detectability],
            "noise": {name: dict(values) for name, values in self.noise.items()},
            "chi2_per_residual": {"before": self.chi2[0], "after": self.chi2[1]},
            "theta": finite_values(self.kept),
            "retuned": [one.to_dict() for one in self.moved],
            "instead_of_tuning": self.instead.to_dict() if self.instead else None,
            "inputs": [one.to_dict() for one in self.profile.arrangement.inputs],
            "trial_results": [one.to_dict() for one in self.gain.compared],
            "assumptions": self._assumptions(),
            "citations": self.citations(),
            "options": self.options.to_dict(),
            "evidence": dict(self.evidence),
            "voyages": self._voyages(),
            "wall_s": self.wall_s,
        }
