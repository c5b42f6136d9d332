"""What a fit returns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..circumstances import notes_on
from ..components import split_name
from ..displayed import Plotted
from ..documents import finite, finite_values
from ..errors import OptionError, Problem, among, brief
from ..first_states import MUCH
from ..first_states import in_words as noise_in_words
from ..model import Model, Tie
from ..options import FitOptions
from ..phrases import capital
from ..predictor import words_of
from ..profile import ShipProfile, tuned
from ..profile.doubts import in_words
from ..stated_indices import IndexComparison
from ..trial import Coverage, another_ship
from .box import Box, width_words
from .certificate import Certificate
from .cmaes import Generation, Restart
from .comparison import ROLES, WHICH, ComparedTrials, TrialComparison, counted_trials, off_in_words, total
from .extending import held_words
from .identifiability import Identifiability
from .least_squares import LeastSquaresResult
from .one_sided import coverage_notes, followers
from .weighing import Weight

SCHEMA = 1

STOPPED = "The fit was stopped before its end: this is of its best so far, not of an optimum."
"""What the verdict of one begins with."""

MISSED = 3.0
"""J of a sample on trials not used for tuning, over that on those that were, from which a fit misses them."""


class Warned(NamedTuple):
    """Something to know before trusting a fit: a code for programs, which stays, and a sentence for readers."""

    code: str
    words: str


@dataclass(frozen=True)
class Beside:
    """Terms of the objective beside J.

    squares    of the rows of each term before and after, by its name: in variances, so times ``weight.s2`` beside J
    sentences  of each term, see ``Term``, by its name
    """

    weight: Weight
    squares: Mapping[str, tuple[float, float]]
    sentences: Mapping[str, str]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        terms = {name: {"before": finite(old), "after": finite(new)} for name, (old, new) in self.squares.items()}
        return {"weight": self.weight.to_dict(), "squares": terms, "sentences": self.words()}

    def words(self) -> list[str]:
        """The terms and their weight in sentences."""
        weight = f"weight {self.weight.s2:.3g} in units of J"
        independent = sum(self.weight.independent.values())
        found = [
            self.sentences[name].format(weight=weight, old=old, new=new) for name, (old, new) in self.squares.items()
        ]
        if self.weight.independent:
            settled = "" if self.weight.settled else "; the weight had not settled"
            found.append(
                f"J counts as {independent:.3g} independent differences, which determine "
                f"{sum(self.weight.learnt.values()):.2g} combinations of coefficients against it{settled}."
            )
        return found


@dataclass(frozen=True, eq=False)
class FitResult(Plotted):
    """A finished (or interrupted) fit, complete enough to write every output from it.

    unit         (n_targets,) position of the tuned values in the box
    provenance   what it was made from: profile, trials with their hashes, command, versions, time
    beside       terms of the objective beside J; None where there are none
    compared     every trial before and after; ``compared.to_frame()`` has a row a trial
    J_free_start  J of the tuned values if each tune trial started from an estimated state; None where it does
    J_of_noise    J that the noise of first samples alone would bring a faultless model to, by role of the trials;
                  empty where initial states are estimated
    ties         coefficients that follow targets, see ``one_sided``
    stated       every stated index beside what the model makes of it
    interrupted  stopped by the user; the values are the best so far
    """

    written_by = "write_run"

    profile: ShipProfile
    options: FitOptions
    box: Box
    unit: FloatArray
    J: float
    J_before: float
    J_free_start: float | None
    J_of_noise: Mapping[str, float]
    beside: Beside | None
    compared: ComparedTrials
    stated: tuple[IndexComparison, ...]
    restarts: tuple[Restart, ...]
    starts: tuple[LeastSquaresResult, ...]
    history: tuple[Generation, ...]
    certificate: Certificate
    identifiability: Identifiability
    evaluations: int
    diverged: int
    wall_s: float
    held: tuple[str, ...]
    ties: tuple[Tie, ...]
    scales: Mapping[str, float]
    channels: tuple[str, ...]
    provenance: Mapping[str, Any]
    interrupted: bool = False
    oddities: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """In a line."""
        stopped = ", interrupted" if self.interrupted else ""
        J = f"J {self.J_before:.4g} -> {self.J:.4g}"
        return f"FitResult({self.profile.id}, {len(self.box)} targets, {self.box_words()}, {J}{stopped})"

    def box_words(self) -> str:
        """How wide the box is."""
        return width_words(self.options.a_r, "a_r ")

    @property
    def theta(self) -> dict[str, float]:
        """Tuned values by name, in profile units."""
        return dict(zip(self.box.names, self.box.from_unit(self.unit).tolist(), strict=True))

    @property
    def tuned_values(self) -> dict[str, float]:
        """Tuned values, with those of coefficients that are tied to targets."""
        return self.theta | followers(self.ties, self.theta)

    @property
    def misses(self) -> bool:
        """Whether it misses trials not used for tuning: one is worse than before, or J a sample far larger."""
        tests, tunes = ([one for one in self.compared if one.role == role] for role in ("test", "tune"))
        if not tests or not tunes:
            return False
        each = [sum(one.J["after"] for one in of) / sum(one.trial.n_samples for one in of) for of in (tests, tunes)]
        return any(one.worse for one in tests) or each[0] > MISSED * each[1]

    @property
    def bends_to_noise(self) -> str:
        """How much the noise of first samples has to do with J, in words; "" where it is little."""
        if self.J_free_start is not None and self.J_free_start < MUCH * self.J:
            return (
                f"of J = {self.J:.4g} on the tune trials {self.J - self.J_free_start:.4g} comes from starting "
                "each trial at its noisy first sample; initial=estimated removes that"
            )
        for role, of_noise in self.J_of_noise.items():
            J = total(self.compared, role, "after")
            if J is not None and (words := noise_in_words(J, of_noise, f"on the {role} trials")):
                return f"{words}: coefficients bend to that noise, which initial=estimated takes out"
        return ""

    @property
    def coverage(self) -> Coverage:
        """What the trials it was tuned to visit."""
        return Coverage.of([one.trial for one in self.compared if one.role == "tune"], self.profile.L_pp)

    @property
    def at_bound(self) -> list[str]:
        """Targets on a bound of their box."""
        return [n for n, z in zip(self.box.names, self.unit, strict=True) if z <= 0.0 or z >= 1.0]

    @property
    def converged(self) -> bool:
        """Whether the searches agree: CMA-ES (where used) and at least half of the starts end on the same J."""
        c = self.certificate
        return (
            not self.interrupted and 2 * c.starts_agreeing >= c.starts and (c.restarts == 0 or c.restarts_agreeing > 0)
        )

    def J_of(self, role: str, which: str) -> float | None:
        """J over the "tune" or "test" trials, "before" or "after"; None without such trials, and if it is not finite.

        Trials that do neither are "other".  Raises OptionError for words that there are not.
        """
        for word, name, known in ((role, "role", ROLES), (which, "which", WHICH)):
            if word not in known:
                raise OptionError(Problem(f"there is no J of {brief(word)}", name, **among(word, known)))
        return finite(total(self.compared, role, which))

    @property
    def method(self) -> str:
        """How trials were simulated, to be named beside J."""
        return words_of(self.options.make_integrator())

    def sentence(self) -> str:
        """The result in one sentence, after one that says so where the fit was stopped."""
        return f"{STOPPED} {self._verdict()}" if self.interrupted else self._verdict()

    def _verdict(self) -> str:
        tests = [c for c in self.compared if c.role == "test"]
        chosen = tests or [c for c in self.compared if c.role == "tune"]
        if not chosen:
            return self.sentence_of_stated()
        trials = counted_trials(chosen)
        said = [f"On {trials} not used for tuning" if tests else f"On the {trials} it was tuned to"]
        said[0] += f", the tuned {self.profile.name}"
        after, before = (off_in_words(chosen, which) for which in ("after", "before"))
        if after:
            sizes = " and ".join(f"{size} off {of}" for of, size in after.items())
            instead = f" instead of {' and '.join(before.values())}" if list(before) == list(after) else ""
            said[0] += f" is {sizes}{instead} (root mean square)"
        lost = sum(c.motions["after"].diverged for c in chosen)
        if lost:
            said.append(f"it diverges on {lost} of {trials}")
        else:
            said.append(f"J ({self.method}) {self._J_words('test' if tests else 'tune')}")
        if tests:
            said.append(self._improved(tests))
        else:
            said.append("there are no test trials to confirm it")
        return f"{'; '.join(said)}."

    def _improved(self, tests: Sequence[TrialComparison]) -> str:
        """How many of the test trials improve, by J; where J rises on one whose track comes closer, both counts."""
        better = sum(one.J["after"] < one.J["before"] for one in tests)
        each = "windows" if any(one.trial.part_of for one in tests) else "trials"
        said = f"{better} of {len(tests)} of these {each}"
        if not any(one.mixed for one in tests):
            return f"{said} improve"
        return f"J falls on {said}, the track comes closer on {sum(one.closer for one in tests)}"

    def _J_words(self, role: str) -> str:
        """Change of J over the trials of a role, in words."""
        before, after = self.J_of(role, "before"), self.J_of(role, "after")
        if not before or after is None:  # diverged before, or is without error
            return f"is {after:.4g}" if after is not None else "has no value"
        change = 100.0 * (after / before - 1.0)
        size = f"falls by {min(-change, 99.9):.1f} %" if change < 0 else f"rises by {change:.1f} %"
        return f"{size}, from {before:.4g} to {after:.4g}"

    def sentence_of_stated(self) -> str:
        """Change of the errors of stated indices, in one sentence."""
        tests = [one for one in self.stated if one.role != "tune"]
        chosen = tests or self.stated
        before, after = (float(np.sqrt(np.mean([one.off(k) ** 2 for one in chosen]))) for k in ("before", "after"))
        which = "not used for tuning" if tests else "it was tuned to"
        last = "." if tests else "; there are no test trials to confirm it."
        return (
            f"On {len(chosen)} stated indices {which}, the tuned {self.profile.name} is {after:.2f} tolerances off, "
            f"root mean square, instead of {before:.2f}{last}"
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader must know before trusting the numbers."""
        return tuple(one.words for one in self.warned())

    def warned(self) -> list[Warned]:
        """What a reader must know before trusting the numbers, each with its code."""
        found = []
        if self.interrupted:
            said = "The fit was interrupted; these are the best values so far, not an optimum."
            found.append(Warned("interrupted", said))
        if self.diverged:
            said = f"{self.diverged} candidates diverged during the search and were given up."
            found.append(Warned("diverged", said))
        found += [Warned("odd", words) for words in self.oddities]
        found += [Warned("doubtful", f"{words}.") for words in in_words(self.profile.doubts())]
        found += self._of_trials()
        found += self._of_stated()
        found += self._of_comparison()
        return found

    def _of_trials(self) -> list[Warned]:
        """What is to be known of the trials."""
        of, model = self.provenance["trials"]["ship"], self.profile.id
        found = [Warned("another-ship", f"{capital(words)}.") for words in another_ship(of, model)]
        trials = [c.trial for c in self.compared]
        generated = {trial.whole for trial in trials if trial.source == "generated"}
        if generated:
            said = f"{len(generated)} of {len({trial.whole for trial in trials})} trials are generated, not measured."
            found.append(Warned("generated", said))
        if self.bends_to_noise:
            found.append(Warned("initial", f"{capital(self.bends_to_noise)}."))
        around = notes_on(Model(self.profile), trials, self.theta, self.box.names)
        found += [Warned("surroundings", f"{capital(note)}.") for note in around]
        visited = coverage_notes(Model(self.profile, self.ties), self.box.names, self.coverage)
        found += [Warned("coverage", words) for words in visited]
        tuned_on = [c.trial for c in self.compared if c.role == "tune"]
        found += [Warned("held", words) for words in held_words(self.profile, self.options, tuned_on)]
        return found

    def _of_stated(self) -> list[Warned]:
        """What is to be known of stated indices."""
        found = []
        never = sorted({f"{one.name} of {one.trial}" for one in self.stated if one.simulated["after"] is None})
        if never:
            found.append(Warned("never-reached", f"The tuned model never reaches: {', '.join(never)}."))
        assumed = sum(one.assumed for one in self.stated)
        if assumed:
            said = f"{assumed} of {len(self.stated)} stated indices have the tolerance that mmgtune assumes."
            found.append(Warned("assumed", said))
        if self.stated and self.compared:
            found.append(Warned("stated", self.sentence_of_stated()))
        return found

    def _of_comparison(self) -> list[Warned]:
        """What is to be known of how simulations of the trials were compared, and came out."""
        found = []
        gaps = dict.fromkeys(c.trial.whole for c in self.compared if np.isnan(c.trial.motion).any())
        if gaps:
            found.append(Warned("gaps", f"Gaps in these trials do not count: {', '.join(gaps)}."))
        lost = [c.trial.id for c in self.compared if c.motions["after"].diverged]
        if lost:
            found.append(Warned("lost", f"The tuned model diverges on: {', '.join(lost)}."))
        tests = [c for c in self.compared if c.role == "test"]
        on = "windows of test trials" if any(c.trial.part_of for c in tests) else "test trials"
        worse = ", ".join(c.trial.id for c in tests if c.worse)
        if worse:
            said = f"Worse than before on {on}: {worse}: the tuning does not carry over to them."
            found.append(Warned("worse", said))
        mixed = ", ".join(c.trial.id for c in tests if c.mixed)
        if mixed:
            said = f"J rises on {on} that come closer in metres: {mixed}: what else J counts is further off there."
            found.append(Warned("mixed", said))
        return found

    def coefficients(self) -> list[dict[str, Any]]:
        """Each target with its box, value and what is known of it."""
        rows = []
        low, high = self.box.limits
        stderr, undetermined = self.identifiability.stderr, self.identifiability.undetermined
        for i, (name, value) in enumerate(self.theta.items()):
            section, symbol = split_name(name)
            field = self.profile.sections[section].component.fields[symbol]
            z = float(self.unit[i])
            formula = self.box.prior_of(i) if self.beside else None
            rows.append(
                {
                    "name": name,
                    "label": field.label,
                    "unit": field.unit,
                    "pre_determined": finite(float(self.box.pre[i])),
                    "low": finite(float(low[i])),
                    "high": finite(float(high[i])),
                    "value": finite(value),
                    "position": 1.0 - z if i in self.box.reciprocal else z,  # in the order of the values
                    "stderr": stderr.get(name),
                    "at_bound": self.box.bound_at(i, z),
                    "determined": name not in undetermined,
                    **({"formula": formula[0], "scatter": formula[1]} if formula else {}),
                }
            )
        return rows

    def as_ship(self) -> ShipProfile:
        """The tuned profile: what the result stands for where a ship is wanted."""
        return self.tuned_profile()

    def tuned_profile(self) -> ShipProfile:
        """The tuned profile, ready to simulate; in its provenance windows stand as the trials they were cut from."""
        whole = {one.trial.id: one.trial.whole for one in self.compared}
        whole |= {one.trial: one.trial for one in self.stated}
        told = self.provenance["trials"]
        return tuned(
            self.profile,
            self.tuned_values,
            self.identifiability.stderr,
            {
                "made_by": f"mmgtune {self.provenance['mmgtune']}",
                "command": self.provenance["command"],
                "created": self.provenance["created"],
                "profile": self.profile.id,
                "profile_sha256": self.profile.sha256,
                "trials": {whole.get(name, name): sha256 for name, sha256 in told["sha256"].items()},
                **({"coverage": told["coverage"]} if told.get("coverage") else {}),
                "tuned_on": list(dict.fromkeys(whole.get(name, name) for name in told["tune"])),
                "source_of_trials": {whole.get(name, name): source for name, source in told["source"].items()},
                **({"box": self.box_words()} if self.options.a_r is None else {"a_r": self.options.a_r}),
                "seed": self.options.seed,
                "method": self.options.method,
                "integrator": self.method,
                "J_tune": self.J,
                "at_bound": self.at_bound,
                "undetermined": list(self.identifiability.undetermined),
            },
            licence=told.get("licence", ""),
            citation=told.get("citation", ""),
        )

    def tuned_text(self) -> str:
        """TOML of the tuned profile."""
        return self.tuned_profile().text

    def to_dict(self) -> dict[str, Any]:
        """The document of ``fit.json``, schema 1 (docs/formats.md)."""
        warned = self.warned()
        return {
            "schema": SCHEMA,
            "kind": "fit",
            **self.provenance,
            "interrupted": self.interrupted,
            "verdict": self.sentence(),
            "warnings": [one.words for one in warned],
            "warning_codes": [one.code for one in warned],
            "doubts": [one.to_dict() for one in self.profile.doubts()],
            "integrator": self.method,
            "J_tune": self.J_of("tune", "after"),
            "J_test": self.J_of("test", "after"),
            "J_tune_before": self.J_of("tune", "before"),
            "J_test_before": self.J_of("test", "before"),
            "misses": self.misses,
            "theta": finite_values(self.theta),
            "stderr": self.identifiability.stderr,
            "at_bound": self.at_bound,
            "undetermined": list(self.identifiability.undetermined),
            "held": list(self.held),
            "tied": {tie.name: {"to": tie.to, "ratio": tie.ratio} for tie in self.ties},
            "coverage": self.coverage.to_dict(),
            "options": {
                **self.options.to_dict(),
                "targets": list(self.box.names),
                "channels": list(self.channels),
                "scales": dict(self.scales),
            },
            "coefficients": self.coefficients(),
            "beside": self.beside.to_dict() if self.beside else None,
            "inputs": [one.to_dict() for one in self.profile.arrangement.inputs],
            "trial_results": [c.to_dict() for c in self.compared],
            "stated": [one.to_dict(self.profile.L_pp) for one in self.stated],
            "J_tune_free_start": finite(self.J_free_start),
            "J_of_noise": finite_values(self.J_of_noise),
            "evaluations": self.evaluations,
            "diverged": self.diverged,
            "restarts": [
                {
                    "lambda": r.population,
                    "J": finite(r.J),
                    "generations": r.generations,
                    "evaluations": r.evaluations,
                    "stop": r.stop,
                }
                for r in self.restarts
            ],
            "starts": [{"J": finite(s.J), "iterations": s.iterations, "converged": s.converged} for s in self.starts],
            "agreement": self.certificate.agreement(),
            "certificate": self.certificate.to_dict(),
            "identifiability": self.identifiability.to_dict(),
            "assumptions": [
                {"name": name, "value": self.profile.written(name), "note": coefficient.note}
                for name, coefficient in self.profile.assumptions()
            ],
            "citations": self.profile.cites(),
            "wall_s": self.wall_s,
        }
