"""What to do next: commands, each with the reason this run gives for it."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .. import resources
from ..effects import find_effect
from .wording import clean, count, number, shown

Advice = tuple[tuple[str, str], ...]

_TOLD_APART = re.compile(r" \(\d+\)$")
"""What stands behind the name of a model that was given twice."""

_NUMBER = re.compile(r"-[\d.]")
"""What begins with a dash and is no option."""


def _inputs(data: Mapping[str, Any]) -> tuple[str, str]:
    """The profile and the trials as options of a shell command."""
    profile = shortest(data["profile"].get("path") or data["profile"].get("id") or "PROFILE", "ship_profiles")
    trials = shortest(data["trials"].get("path") or "TRIALS", "trials")
    return f"-p {shlex.quote(profile)}", f"-t {shlex.quote(trials)}"


def shortest(path: str, kind: str) -> str:
    """A path as it may be given on the command line: what comes with the program by its name alone."""
    place = Path(path)
    return clean(place.stem if place.parent == resources.folder(kind) else path)


def _several(data: Mapping[str, Any]) -> bool:
    """Whether more than one run was tuned to."""
    results, stated = data.get("trial_results") or (), data.get("stated") or ()
    runs = {row.get("run") or row["id"] for row in results if row.get("role") == "tune"}
    return len(runs | {row["trial"] for row in stated if row.get("role") == "tune"}) > 1


def after_fit(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from a fit."""
    profile, trials = _inputs(data)
    a_r = number(data["options"].get("a_r"))
    width = f" --ar {a_r:g}" if a_r is not None else ""
    command = data.get("command") or ""

    def same(name: str) -> str:
        """What was chosen for this fit, as another command takes it."""
        if chosen := chosen_in(command, "fit", _OF_A_FIT[name]):
            return chosen
        return " --method least-squares" if data.get("stated") and name in ("fit", "sweep") else ""

    items = []
    if data.get("at_bound"):
        bound = count(len(data["at_bound"]), "coefficient")
        this = f" (this run: a_r = {shown(a_r)})" if a_r is not None else ""
        reason = f"{bound} at a bound: see what other ranges do on trials that were not tuned on{this}"
        items.append((reason, f"mmgtune sweep {profile} {trials}{same('sweep')}"))
    elif data.get("stated") and _several(data) and data.get("J_test") is None:
        reason = "Leave each trial out in turn, to see how the fit does on trials it was not tuned on"
        items.append((reason, f"mmgtune leave-out {profile} {trials}{same('leave-out')}"))
    elif data.get("J_test") is None and _several(data):
        reason = "No test set: leave each trial out in turn, to see how the fit does on trials it was not tuned on"
        items.append((reason, f"mmgtune leave-out {profile} {trials}{width}{same('leave-out')}"))
    if data.get("misses"):
        reason = "It misses trials that it was not tuned to: what is wrong, and how much of it the cause explains"
        items.append((reason, f"mmgtune diagnose {profile} {trials}{width}{same('diagnose')}"))
    loose = len(data.get("undetermined") or ())
    if loose:
        reason = (
            f"{count(loose, 'coefficient')} not determined: hold what no trial can tell at its pre-determined value"
        )
        items.append((reason, f"mmgtune fit {profile} {trials}{width}{same('fit')} --identifiable"))
    tuned = shlex.quote(clean(data.get("out") or "RUN").rstrip("/") + "/profile.toml")
    reason = "Take the tuned ship through manoeuvres that were not measured, against the IMO criteria"
    items.append((reason, f"mmgtune simulate -p {tuned} --turn 35 --turn -35 --zigzag 10/10 --zigzag 20/20"))
    if data.get("command"):
        items.append(("Repeat this run", again(data["command"])))
    return tuple(items)


def for_bands(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that give the tuned ship bands."""
    _, trials = _inputs(data)
    folder = clean(data.get("out") or "RUN").rstrip("/")
    made = f"mmgtune posterior -p {shlex.quote(folder + '/profile.toml')} {trials} --out {shlex.quote(folder)}"
    reason = "This fit says nothing of how sure its predictions are: draw particles, then predict with bands"
    return ((reason, f"{made} && mmgtune predict {shlex.quote(folder)}"),)


def after_sweep(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from a sweep."""
    profile, trials = _inputs(data)
    chosen = number((data.get("recommended") or {}).get("a_r"))
    items = []
    run = next((run for run in data["runs"] if chosen is not None and number(run.get("a_r")) == chosen), None)
    if run is not None and run.get("out"):
        folder = f"{clean(data.get('out') or 'SWEEP').rstrip('/')}/{clean(run['out'])}"
        reason = "Take the ship tuned with the recommended range through manoeuvres that were not measured"
        tuned = shlex.quote(folder + "/profile.toml")
        items.append((reason, f"mmgtune simulate -p {tuned} --turn 35 --turn -35 --zigzag 10/10 --zigzag 20/20"))
    elif chosen is not None:
        items.append(("Fit with the recommended range", f"mmgtune fit {profile} {trials} --ar {chosen:g}"))
    widest = max((number(run.get("a_r")) or 0.0 for run in data["runs"]), default=0.0)
    if chosen is not None and chosen == widest:
        wider = ",".join(f"{chosen + step:.2g}" for step in (0.0, 0.1, 0.2))
        same = chosen_in(data.get("command") or "", "sweep", ("--ar",))
        reason = "The widest range did best: try wider ones"
        items.append((reason, f"mmgtune sweep {profile} {trials} --ar {wider}{same}"))
    if data.get("command"):
        items.append(("Repeat this sweep", again(data["command"])))
    return tuple(items)


def after_diagnosis(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from a diagnosis."""
    profile, trials = _inputs(data)
    where = clean(data.get("out") or "RUN").rstrip("/")
    extended = shlex.quote(f"{where}/profile.toml")
    items = []
    kept = [cause for cause in data["causes"] if not cause.get("by_run")]  # the others are in no profile
    if kept:
        causes = " and ".join(clean(cause["effect"]) for cause in kept)
        day = [clean(cause["effect"]) for cause in kept if of_the_day(cause["effect"])]
        items.append(
            (f"See the model with {causes} on every trial", f"mmgtune simulate -p {extended} --trials {trials[3:]}")
        )
        if day:
            calm = shlex.quote(f"{where}/calm.toml")
            reason = (
                f"Before predicting calm water take out the {' and the '.join(day)}, which "
                f"{'belongs' if len(day) == 1 else 'belong'} to these trials and not to the ship: calm.toml is the "
                f"profile without {'it' if len(day) == 1 else 'them'}"
            )
            items.append((reason, f"mmgtune simulate -p {calm} --turn 35 --turn -35 --zigzag 10/10 --zigzag 20/20"))
        a_r = number((data.get("options") or {}).get("a_r"))
        width = f" --ar {a_r:g}" if a_r is not None else ""
        reason = "Re-tune the coefficients with what was found in the model, within the same range of their values"
        items.append((reason, f"mmgtune fit -p {extended} {trials}{width} --initial estimated"))
    if data["verdict"] in ("unexplained", "interrupted"):
        items.append(("Look for faults of the measurement itself", f"mmgtune trials check {trials[3:]}"))
    if data["verdict"] == "none":
        reason = "Nothing is missing from the model that these trials show: fit its coefficients to them"
        items.append((reason, f"mmgtune fit {profile} {trials}"))
    elif kept:
        items.append(
            ("Look for more, from the profile with what was found", f"mmgtune diagnose -p {extended} {trials}")
        )
    if data.get("interrupted") and data.get("command"):
        items.append(("Go on where the search was stopped", gone_on(data["command"], where)))
    return tuple(items)


def again(command: str) -> str:
    """A command that was given before, as it can be given again: a folder it wrote to is there by now."""
    try:
        words = [word for word in shlex.split(clean(command)) if word not in ("--resume", "--force")]
    except ValueError:  # no command of a shell
        return clean(command)
    named = any(word in ("--out", "-o") or word.startswith("--out=") for word in words)
    return shlex.join([*words, "--force"] if named else words)


_SAID_ANEW = ("-p", "--profile", "-t", "--trials", "-o", "--out")
"""Options with a value that a command which varies another says itself."""

_OF_THE_RUN = ("--force", "--resume", "--json", "-q", "--quiet", "--dry-run", "--no-report")
"""Flags that were about that run alone."""

_OF_A_FIT = {
    "fit": ("--ar",),
    "sweep": ("--ar", "--bands", "--prior", "--strict"),
    "leave-out": ("--ar", "--method", "--prior", "--strict"),
    "diagnose": (
        *("--ar", "--bands", "--every", "--identifiable", "--initial", "--loss", "--method", "--objective", "--prior"),
        *("--regularise", "--starts", "--strict", "--window", "--with-effects"),
    ),
}
"""Options of a fit that a command after it does not have, or says itself."""


def _groups(command: str) -> list[list[str]]:
    """The words of a command: its name, then each option with its values.  Nothing of what no shell reads."""
    try:
        words = shlex.split(clean(command))
    except ValueError:
        return []
    groups: list[list[str]] = [[]]
    for word in words:
        if word.startswith("-") and not _NUMBER.match(word):
            groups.append([])
        groups[-1].append(word)
    return groups


def _without(options: list[list[str]], left_out: tuple[str, ...]) -> list[str]:
    """The words of options but for some."""
    return [word for option in options if option[0].partition("=")[0] not in left_out for word in option]


def chosen_in(command: str, name: str, but: tuple[str, ...] = ()) -> str:
    """What was chosen in a command that was given before, each with a space before it, for one that differs from it.

    but  options that are left out besides those of the run itself
    "" of anything but the command ``name``: a run of the library or of a fleet.
    """
    first, *options = _groups(command) or [[]]
    if first != ["mmgtune", name]:
        return ""
    return "".join(f" {shlex.quote(word)}" for word in _without(options, (*_SAID_ANEW, *_OF_THE_RUN, *but)))


def gone_on(command: str, folder: str) -> str:
    """A command that was stopped, as it goes on in its folder."""
    first, *options = _groups(command) or [[]]
    kept = _without(options, ("-o", "--out", "--force", "--resume"))
    return shlex.join([*first, *kept, "--out", folder, "--resume"])


def of_the_day(tag: str) -> bool:
    """Whether an effect is of the trials rather than of the ship: current, wind, errors of sensors."""
    effect = find_effect(tag)
    return effect is not None and effect.of_the_day


def after_leave_out(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from leaving trials out."""
    profile, trials = _inputs(data)
    a_r = number((data.get("options") or {}).get("a_r"))
    width = f" --ar {a_r:g}" if a_r is not None else ""
    same = chosen_in(data.get("command") or "", "leave-out", ("--ar", "--folds", "--manoeuvres"))
    whole: Mapping[str, Any] = next((row for row in data["scores"] if row["manoeuvre"] == "all"), {})
    items = []
    if (number(whole.get("share_removed")) or 0.0) > 0.0:
        items.append(
            ("Tuning helps on unseen trials: tune to all of them", f"mmgtune fit {profile} {trials}{width}{same}")
        )
    else:
        reason = "Tuning does not help on unseen trials: look for what the model lacks"
        items.append((reason, f"mmgtune diagnose {profile} {trials}"))
    items.append(("See whether a narrower or a wider range does better", f"mmgtune sweep {profile} {trials}{same}"))
    return tuple(items)


def after_simulation(data: Mapping[str, Any], measured: bool) -> Advice:
    """(reason, command) pairs that follow from a simulation."""
    out = shlex.quote(clean(data.get("out") or "RUN"))
    items = []
    if not measured:
        items.append(("The runs are trial files: their indices by the same code as of measured ones",
                      f"mmgtune trials inspect {out}"))  # fmt: skip
    if data.get("command"):
        items.append(("Repeat this simulation", again(data["command"])))
    return tuple(items)


def after_validation(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from a validation."""
    trials = shlex.quote(clean(data["trials"]))
    first = shlex.quote(clean(data["profiles"][0]["profile"]))
    items = []
    if data["profiles"][0].get("sha256"):
        reason = "See what the first model gets wrong on these trials, and why"
        items.append((reason, f"mmgtune diagnose -p {first} -t {trials}"))
    names = " ".join(shlex.quote(clean(one["profile"])) for one in data["profiles"])
    if not data.get("window_s"):
        reason = "Score short windows instead, in which errors do not add up along a run"
        items.append((reason, f"mmgtune validate {names} {trials} --restart 60"))
    return tuple(items)


def after_voyages(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from a validation on voyages."""
    voyages = shortest(data["trials"].get("path") or "VOYAGES", "trials")
    named = {name: one.get("path") for name, one in data["profiles"].items()}
    paths = [shortest(named.get(one["profile"]) or one["profile"], "ship_profiles") for one in data["models"]]
    models = " ".join(map(shlex.quote, paths))
    longer = 2.0 * (number(data.get("window_s")) or 120.0)
    items = [
        (
            "See windows of twice the length, in which errors of forces have longer to add up",
            f"mmgtune validate {models} {shlex.quote(voyages)} --restart {longer:g}",
        )
    ]
    first = data["models"][0]
    if first.get("sha256"):
        reason = "See how the first model turns and stops in calm water, against the IMO criteria"
        items.append((reason, f"mmgtune simulate -p {shlex.quote(paths[0])} --turn 35 --turn -35 --zigzag 10/10"))
    return tuple(items)


def after_comparison(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from two profiles side by side."""
    profiles = data["profiles"]
    paths = [shlex.quote(shortest(one.get("path") or one["name"], "ship_profiles")) for one in profiles]
    items = []
    trials = next((id for one in profiles if (id := clean(one["id"])) in resources.trial_set_names()), "")
    if trials:
        reason = "Which of them is nearer to trials: score both on those that come with the program"
        items.append((reason, f"mmgtune validate {' '.join(paths)} {shlex.quote(trials)} --manoeuvres"))
    for one, path in zip(profiles, paths, strict=True):
        if data["manoeuvres"]["indices"]:
            reason = f"See whether {clean(one['name'])} meets the IMO criteria of turning and of course keeping"
            items.append((reason, f"mmgtune simulate -p {path} --turn 35 --turn -35 --zigzag 10/10 --zigzag 20/20"))
        if one.get("doubts"):
            reason = f"See which numbers of {clean(one['name'])} may be wrong, and why"
            items.append((reason, f"mmgtune profile validate {path}"))
    return tuple(items)


def after_models(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from models held against each other."""
    trials = shlex.quote(shortest(data["trials"]["name"], "trials"))
    called = {
        one["name"]: shlex.quote(shortest(_TOLD_APART.sub("", one["name"]), "ship_profiles")) for one in data["models"]
    }
    every = " ".join(called.values())
    items = []
    best = next((one for one in data["models"] if one["name"] == data["columns"][0]["best"]["windows"]), None)
    if best is not None and best.get("sha256"):
        reason = f"{clean(best['name'])} errs least: see what it still gets wrong on these trials, and why"
        items.append((reason, f"mmgtune diagnose -p {called[best['name']]} -t {trials}"))
    elif best is not None:
        reason = f"{clean(best['name'])} errs least: see each trial as it makes it, beside what was measured"
        items.append((reason, f"mmgtune simulate -p {called[best['name']]} --trials {trials}"))
    reason = "Compare advance, diameters and overshoots of all models with those measured"
    items.append((reason, f"mmgtune validate {every} {trials} --manoeuvres"))
    longer = 2.0 * (number(data["window_s"]) or 100.0)
    only = "".join(f" --only {shlex.quote(clean(word))}" for word in (data.get("options") or {}).get("only") or ())
    reason = "See whether the order of the models is the same over windows of twice the length"
    items.append((reason, f"mmgtune compare {every} {trials} --restart {longer:g}{only}"))
    if (data.get("provenance") or {}).get("command"):
        items.append(("Repeat this comparison", again(data["provenance"]["command"])))
    return tuple(items)


def after_heading_study(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from a study of gains."""
    if not data.get("command"):
        return ()
    same = again(data["command"])
    step = number(data["options"].get("gain_step")) or 5.0
    finer = f"{re.sub(r' --gain-step[ =][^ ]+', '', same)} --gain-step {0.5 * step:g}"
    return (
        ("Look closer: gains half as far apart, in the place of this study and about four times as long", finer),
        ("Repeat this study", same),
    )


def after_fleet(data: Mapping[str, Any]) -> Advice:
    """What failed, the latest change, the largest gain, and sisters."""
    out = clean(data["out"])
    items: list[tuple[str, str]] = []
    if data["failures"] or data["jobs"]["missing"]:
        retry = " --retry" if data["failures"] else ""
        table = shlex.quote(clean(data["table"]) or "fleet.toml")
        items.append(
            ("Run what failed or is missing", f"mmgtune fleet run {table} --out {shlex.quote(out)} --resume{retry}")
        )
    cells = {(one["ship"], one["date"], one["name"]): one for one in data["cells"] if "://" not in one["trials"]}
    for change in data["changes"][-1:]:
        if cell := cells.get((change["ship"], change["month"], change["job"])):
            ship, trials = (shlex.quote(clean(cell[key])) for key in ("profile", "trials"))
            reason = f"Ask why {clean(change['ship'])} changed in {clean(change['month'])}"
            items.append((reason, f"mmgtune diagnose -p {ship} -t {trials}"))
    for best in [one for one in data["ranking"] if one["gain"] > 0.0][:1]:
        if cell := cells.get((best["ship"], best["date"], best["name"])):
            ship, trials = (shlex.quote(clean(cell[key])) for key in ("profile", "trials"))
            tuned = shlex.quote(f"{out}/{clean(best['run'])}/profile.toml")
            reason = f"See what the recalibrated {clean(best['ship'])} does better"
            items.append((reason, f"mmgtune validate {ship} {tuned} {trials} --manoeuvres"))
    for cell in [one for one in data["cells"] if one["run"] and not one.get("report", True)][-1:]:
        reason = f"Make the report of a job, here of {clean(cell['ship'])} at {clean(cell['date'])}"
        folder = shlex.quote(f"{out}/{clean(cell['run'])}")
        items.append((reason, f"mmgtune report {folder}"))
    if data["classes"]:
        reason = "Calibrate a ship with few trials by what her sisters say"
        items.append((reason, f"mmgtune fit -p SHIP.toml -t TRIALS --prior {shlex.quote(out)}"))
    items.append(("Put the results together anew", f"mmgtune fleet report {shlex.quote(out)}"))
    return tuple(items)


def after_check(data: Mapping[str, Any]) -> Advice:
    """(reason, command) pairs that follow from a check."""
    if data["verdict"] == "regressed":
        return (("See what the profile now gets wrong, and why", clean(data["next"])),)
    return (("Take what it does now as the baseline from here on", clean(data["next"])),)
