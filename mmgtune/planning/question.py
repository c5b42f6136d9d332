"""What somebody wants to know: an index of a standard manoeuvre, as people write it."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ..errors import OptionError, Problem, among, must_be_a
from ..manoeuvres.named import KNOWN, Known
from ..options import PredictOptions
from ..predicting.asked import Approach, Asked, asked
from ..predictor import Predictor
from ..trial.index_trial import INDICES

SUCH_AS = 'write it as "tactical diameter, turn -35", "1st overshoot, zigzag 10/10" or "track reach, stop"'
MANOEUVRES = ("turn", "zigzag", "stop")
_BY_WORDS = {**{one.words.lower(): name for name, one in KNOWN.items()}, **{name: name for name in KNOWN}}
_OTHERS = {"overshoot_4": ("zigzag",), "lateral_deviation": ("stopping",)}
_OF = {"turn": "turning", "zigzag": "zigzag", "stop": "stopping"}


@dataclass(frozen=True)
class Question:
    """An index of a manoeuvre.

    text   as it was asked
    plain  the manoeuvre as options of commands have it: "turn -35"
    index  what is asked, with its unit
    asked  the manoeuvre
    """

    text: str
    plain: str
    index: Known
    asked: Asked


def read_question(text: str, predictor: Predictor, approach: Approach) -> Question:
    """A question as people write it.  Raises OptionError where it is none, with what is near."""
    must_be_a(text, str, "question")
    words, comma, manoeuvre = text.partition(",")
    if not comma:
        raise OptionError(
            Problem(
                f"'{text[:80]}' names no index and manoeuvre", "question", "there is no comma between the two", SUCH_AS
            )
        )
    name = _index(words)
    kind, rest = _manoeuvre(manoeuvre)
    if _OF[kind] not in _shown_by(name):
        fitting = tuple(one.words for other, one in KNOWN.items() if _OF[kind] in _shown_by(other))
        raise OptionError(Problem(f"a {kind} has no {KNOWN[name].words}", "question", **among(words.strip(), fitting)))
    try:
        turns, zigzags = ((rest,) if kind == such else () for such in ("turn", "zigzag"))
        options = PredictOptions(turn=turns, zigzag=zigzags, stop=kind == "stop")
        (one,) = asked(predictor, options, approach)
    except OptionError as error:  # whose fixes speak of options that a question does not have
        why = "; ".join(problem.what + (f": {problem.why}" if problem.why else "") for problem in error.problems)
        raise OptionError(Problem(f"'{manoeuvre.strip()[:60]}' cannot be sailed", "question", why, SUCH_AS)) from error
    return Question(text, f"{kind} {rest}".strip(), KNOWN[name], one)


def _shown_by(name: str) -> tuple[str, ...]:
    """Manoeuvres that show an index."""
    return INDICES[name].of if name in INDICES else _OTHERS[name]


def _index(words: str) -> str:
    plain = " ".join(words.lower().split())
    if plain not in _BY_WORDS:
        known = tuple(dict.fromkeys(one.words.lower() for one in KNOWN.values()))
        raise OptionError(Problem(f"unknown index '{plain[:60]}'", "question", **among(plain, known)))
    return _BY_WORDS[plain]


def _manoeuvre(words: str) -> tuple[str, str]:
    """Kind and angles; "turn 35 deg to port" is "turn", "-35"."""
    kind, _, rest = " ".join(words.lower().split()).partition(" ")
    if kind not in MANOEUVRES:
        raise OptionError(Problem(f"unknown manoeuvre '{kind[:60]}'", "question", **among(kind, MANOEUVRES)))
    side = re.search(r"\s*(?:to )?(port|starboard)(?: first)?$", f" {rest}")
    if side:
        rest = f" {rest}"[: side.start()].strip()
        if rest.startswith("-" if side[1] == "starboard" else "+"):
            what, fix = f"the sign and the side contradict each other: '{words.strip()[:60]}'", "leave out one of them"
            raise OptionError(Problem(what, "question", "angles to starboard are positive", fix))
        rest = rest.lstrip("+-")
        rest = f"-{rest}" if side[1] == "port" else rest
    rest = rest.removesuffix(" deg")
    if (kind == "stop") == bool(rest):
        what = "a stop has no angle" if rest else f"the {kind} has no angle"
        why = "only turns and zigzags are ordered by angles"
        raise OptionError(Problem(f"{what}: '{words.strip()[:60]}'", "question", why, SUCH_AS))
    return kind, rest
