"""How much of disguised logs ``mmgtune trials map`` finds: ``python -m tools.map_disguises --count 200``.

Trials are written as other loggers would write them: columns renamed (in other languages, by codes, or not named at
all), in another order, in other units and signs, velocities in other axes, with dates for seconds, other separators and
decimal signs, as text, workbooks and MATLAB files.  What the proposed map says of each column is held against what was
done, and the trials that it imports against those of the map that undoes the disguise.

The trials are the bundled ones of SUZAKU and, where ``--data`` or MMGTUNE_DATA names their folder, measured ones.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from mmgtune import units
from mmgtune.arrays import FloatArray
from mmgtune.errors import LogError
from mmgtune.importing import import_logs, load_map, parse_map, propose_map
from mmgtune.importing.importer import _records
from mmgtune.importing.proposing.sampling import sample_of
from mmgtune.physics.frame import to_earth, to_ship
from mmgtune.trial import Trial, load_trials

SETS = {
    "esso-osaka-frt": ("frt-ds-esso", "*/*.csv", 4),
    "kvlcc2-hsva": ("simman-hsva", "*.dat", 4),
    "kvlcc2-marin": ("simman-marin", "*.dat", 2),
}
"""Measured sets: preset, files, and how many logs a disguise takes."""

NAMED = [
    "t",
    "x",
    "y",
    "latitude",
    "longitude",
    "psi",
    "u",
    "v",
    "un",
    "ve",
    "sog",
    "cog",
    "r",
    "n",
    "delta",
    "wind_speed",
    "wind_dir",
    "wind_speed_app",
    "wind_dir_app",
]
WORDS: dict[str, dict[str, str]] = {
    language: dict(zip(NAMED, " ".join(lines).split("; "), strict=True))
    for language, lines in {
        "en": (
            "Time; North; East; Latitude; Longitude; Heading; Surge speed; Sway speed; Speed north; Speed east;",
            "SOG; COG; ROT; Shaft rev; Rudder; True wind speed; True wind direction; Rel wind speed; Rel wind",
            "direction",
        ),
        "de": (
            "Zeit; Nord; Ost; Breite; Länge; Kurs; Fahrt voraus; Geschwindigkeit quer; Geschw. Nord; Geschw. Ost;",
            "Fahrt über Grund; Kurs über Grund; Drehgeschwindigkeit; Drehzahl; Ruderlage; Wind wahr; Windrichtung",
            "wahr; Wind scheinbar; Windrichtung scheinbar",
        ),
        "fr": (
            "Temps; Nord; Est; Latitude; Longitude; Cap; Vitesse; Vitesse latérale; Vx; Vy; Vitesse fond; Route",
            "fond; Vitesse de giration; Tours hélice; Barre; Vent vrai; Direction vent vrai; Vent app; Direction",
            "vent app",
        ),
        "nl": (
            "Tijd; X pos; Y pos; Breedte; Lengte; Koers; Snelheid vooruit; Snelheid dwars; Vx; Vy; Grondsnelheid;",
            "Grondkoers; Draaisnelheid; Toerental; Roerhoek; Wind; Windrichting; Schijnbare wind; Schijnbare",
            "windrichting",
        ),
        "ja": (
            "時刻; X; Y; 緯度; 経度; 船首方位; 前後速度; 左右速度; Vx; Vy; 対地速力; 針路; 旋回角速度;",
            "回転数; 舵角; 真風速; 真風向; 相対風速; 相対風向",
        ),
    }.items()
}
"""Names of columns by language; "un" and "ve" are velocities in earth axes."""
DATES = ("%d/%m/%Y %H:%M:%S.%f", "%m/%d/%Y %H:%M:%S.%f", "%Y-%m-%d %H:%M:%S.%f", "%d.%m.%Y %H:%M:%S.%f", "%H:%M:%S.%f")


@dataclass(frozen=True, eq=False)
class Plain:
    """A log in SI units and the program's conventions: what is disguised; columns (n_rows,) by quantity."""

    name: str
    columns: dict[str, FloatArray]


@dataclass
class Disguise:
    """Logs as somebody else would have written them, and what was done.

    truth    per quantity: column (from 0), unit, positive (where its sign matters)
    axes     of the velocities
    text     a map that undoes it
    paths    of the logs
    shown    in a few words
    """

    truth: dict[str, tuple[int, str, str]] = field(default_factory=dict)
    axes: str = ""
    text: str = ""
    paths: list[Path] = field(default_factory=list)
    shown: str = ""


def plain_logs(path: Path, preset: str, pattern: str) -> list[Plain]:
    """Measured logs of a set as they stand."""
    log_map = load_map(preset, preset=True)
    found = []
    for log in sorted(path.glob(pattern)):
        (record, *_), _ = _records(log, log_map.of(log))
        series = record.series
        columns = {
            "t": series["x"].t,
            **{name: one.printed if one.printed is not None else one.values for name, one in series.items()},
        }
        columns["psi"] = series["psi"].printed if series["psi"].printed is not None else series["psi"].values
        if log_map.axes == "earth":
            columns["u"], columns["v"] = to_ship(columns["psi"], columns["u"], columns["v"])
        found.append(Plain(log.stem, columns))
    return found


def bundled_logs() -> list[Plain]:
    """The bundled trials of SUZAKU."""
    data = load_trials("suzaku")
    names = ("x", "y", "psi", "u", "v", "r", "n", "delta")
    return [Plain(one.id, {"t": one.t, **{name: one.columns[name] for name in names}}) for one in data.trials.values()]


def disguised(rng: np.random.Generator, logs: Sequence[Plain], folder: Path) -> Disguise:
    """Logs of one kind, disguised in one way."""
    out = Disguise()

    def pick(*among: Any) -> Any:
        return among[int(rng.integers(len(among)))]

    language = pick(*WORDS, "codes", "none")
    form = pick("csv", "csv", "csv", "xlsx", "mat")
    if form == "mat" and language in ("none", "ja", "de", "fr"):
        language = "codes"
    geographic = bool(rng.random() < 0.3)
    velocity = pick("ship", "ship", "earth", "sog", "no")
    dates = pick("", "", *DATES) if form == "csv" else ""
    speed_unit = pick("m/s", "kn", "km/h")
    headings = pick("360", "180", "rad")
    chosen: dict[str, tuple[str, bool]] = {
        "psi": ("rad" if headings == "rad" else "deg", False),
        "u": (speed_unit, False), "v": (speed_unit, bool(velocity == "ship" and rng.random() < 0.5)),
        "sog": (speed_unit, False), "cog": (pick("deg", "rad"), False),
        "r": (pick("deg/s", "rad/s", "deg/min"), bool(rng.random() < 0.3)), "n": (pick("rpm", "rps"), False),
        "delta": (pick("deg", "deg", "rad"), bool(rng.random() < 0.5)),
    }  # fmt: skip
    for tail in ("", "_app"):
        chosen |= {f"wind_speed{tail}": (speed_unit, False), f"wind_dir{tail}": (pick("deg", "rad"), False)}
    blow = pick("from", "from", "to")
    told = bool(rng.random() < 0.5) and language not in ("none", "codes")
    no_rate = bool(rng.random() < 0.15)
    mixed: list[str] = []
    for number, log in enumerate(logs):
        raw = log.columns
        north, east = to_earth(raw["psi"], raw["u"], raw["v"])
        held: dict[str, FloatArray] = {"psi": raw["psi"], "r": raw["r"], "n": raw["n"], "delta": raw["delta"]}
        if no_rate:
            del held["r"]
        if geographic:
            held["latitude"], held["longitude"] = _geographic(raw["x"], raw["y"])
        else:
            held["x"], held["y"] = raw["x"] + 1234.5, raw["y"] - 321.25
        if velocity == "ship":
            held["u"], held["v"] = raw["u"], raw["v"]
        elif velocity == "earth":
            held["u"], held["v"] = north, east
        elif velocity == "sog":
            held["sog"], held["cog"] = np.hypot(north, east), np.mod(np.arctan2(east, north), 2.0 * np.pi)
        for name in ("wind_speed", "wind_dir", "wind_speed_app", "wind_dir_app"):
            if name in raw:
                held[name] = (
                    np.mod(raw[name] + (np.pi if blow == "to" else 0.0), 2 * np.pi) if "dir" in name else raw[name]
                )
        if number == 0:
            mixed = [str(one) for one in rng.permutation([*held])]
            mixed.insert(0 if rng.random() < 0.8 else int(rng.integers(len(mixed))), "t")
        columns: dict[str, Any] = {}
        for place, name in enumerate(mixed):
            unit, minus = chosen.get(name, ("", False))
            if name == "t":
                values: Any = np.round(raw["t"] - raw["t"][0], 6)
                if dates:
                    start = pd.Timestamp("2024-05-13 23:59:00")
                    values = [(start + pd.Timedelta(seconds=float(one))).strftime(dates) for one in values]
            else:
                values = held[name] / (units.factors(_kind(name))[unit] if unit else 1.0) * (-1.0 if minus else 1.0)
                if name == "psi" and headings != "rad":
                    values = np.mod(values, 360.0)
                    values = np.where(values > 180.0, values - 360.0, values) if headings == "180" else values
            word = {"u": "un", "v": "ve"}.get(name, name) if velocity == "earth" else name
            header = {"codes": f"CH{place + 1:02d}", "none": f"c{place}"}.get(language) or WORDS[language][word]
            if told and unit:
                header += f" [{unit}]"
            if header in columns:
                header += " 2"
            columns[header] = values
        out.paths.append(_written(rng, folder / log.name, columns, form, language, number == 0, out))
    for place, name in enumerate(mixed):
        unit, minus = chosen.get(name, ("", False))
        positive = {"delta": "port", "r": "port", "v": "port"}.get(name, "") if minus else ""
        out.truth[name] = (place, unit, positive)
    out.axes = "earth" if velocity == "earth" else "ship" if velocity == "ship" else ""
    out.text = _undoing(out, dates, blow)
    out.shown = (
        f"{language}{' with units' if told else ''}, {form} {out.shown}, {velocity} velocities, "
        f"{'geographic' if geographic else 'metres'}, {speed_unit}, heading {headings}, {dates or 'seconds'}"
    )
    return out


def _kind(name: str) -> str:
    kinds = {"psi": "rad", "cog": "rad", "delta": "rad", "r": "rad/s", "n": "1/s"}
    return kinds.get(name, "rad" if "dir" in name else "m/s")


def _geographic(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    import pyproj

    crs = "+proj=tmerc +lat_0=52.1 +lon_0=4.2 +ellps=WGS84 +k_0=1"
    lon, lat = pyproj.Transformer.from_crs(crs, "EPSG:4326", always_xy=True).transform(y, x)
    return np.asarray(lat), np.asarray(lon)


def _written(
    rng: np.random.Generator,
    path: Path,
    columns: Mapping[str, Any],
    form: str,
    language: str,
    first: bool,
    out: Disguise,
) -> Path:
    frame = pd.DataFrame(dict(columns))
    path = path.with_name(path.name + f".{form}")
    if form == "xlsx":
        frame.to_excel(path, index=False, header=language != "none")
    elif form == "mat":
        import scipy.io

        scipy.io.savemat(path, {name.replace(" ", "_"): np.asarray(values) for name, values in columns.items()})
    else:
        if first:
            mark, decimal = [(",", "."), (";", ","), ("\t", "."), ("\t", ","), (";", ".")][int(rng.integers(5))]
            out.shown = f"'{mark}' '{decimal}'" + (" after 2 lines" if rng.random() < 0.3 else "")
        mark, decimal = out.shown[1], out.shown[5]
        above = "Sea trial\nrun 1\n" if "after" in out.shown else ""
        text = frame.to_csv(sep=mark, decimal=decimal, index=False, header=language != "none", lineterminator="\n")
        path.write_text(above + text, encoding="cp932" if language == "ja" and len(above) else "utf-8")
    return path


def _undoing(out: Disguise, dates: str, blow: str) -> str:
    """The map that undoes a disguise."""
    sample = sample_of(out.paths[0])
    log = "\n".join(
        f"{key} = {value!r}".replace("'", '"').replace("True", "true").replace("False", "false")
        for key, value in sample.layout.items()
    ).replace('"\\t"', '"tab"')
    order = {"%d": "dmy", "%m": "mdy"}.get(dates[:2], "")
    lines = ["schema = 1", "[log]", log, "[time]", f"column = {out.truth['t'][0] + 1}"]
    lines += [] if dates else ['unit = "s"']
    lines += [f'format = "{order}"'] if order else []
    if out.axes:
        lines += ["[velocity]", f'axes = "{out.axes}"']
    lines.append("[columns]")
    for name, (place, unit, positive) in out.truth.items():
        if name == "t":
            continue
        keys = [f"column = {place + 1}"]
        keys += [f'unit = "{unit or ("deg" if name in ("latitude", "longitude") else "m")}"']
        usual = {"delta": "starboard", "r": "starboard"} | ({"v": "starboard"} if out.axes == "ship" else {})
        if name in usual:
            keys.append(f'positive = "{positive or usual[name]}"')
        if "dir" in name:
            keys.append(f'direction = "{blow}"')
        lines.append(f"{name} = {{ {', '.join(keys)} }}")
    return "\n".join(lines) + "\n"


@dataclass
class Score:
    """Of columns: how many were right, asked for, not found, wrong; and what was wrong."""

    ends: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)


def judged(out: Disguise) -> tuple[Score, bool | None]:
    """The columns of a disguise, and whether the trials are those of the map that undoes it (None where it asks)."""
    score = Score()
    proposal = propose_map(out.paths)
    by_column = {one.column: one for one in proposal.guesses.values() if one.column is not None}
    for name, (place, unit, positive) in out.truth.items():
        guess = by_column.get(place)
        if guess is None:
            score.ends["not found"] += 1
            score.wrong.append(f"{name} not found")
            continue
        asked = [key for key, value in guess.keys.items() if str(value).startswith("?")]
        found, axes_right = guess.quantity, True
        if name in ("u", "v"):
            axes_right = f'axes = "{out.axes}"' in proposal.text or found != name
        said = guess.keys.get("unit", "")
        right = found == name and axes_right and ("unit" in asked or not unit or said.replace("1/s", "rps") == unit)
        signed = name in ("delta", "r") or (name == "v" and out.axes == "ship")
        if right and signed and "positive" not in asked:
            right = guess.keys.get("positive") == (positive or "starboard")
        if not right:
            score.ends["wrong"] += 1
            score.wrong.append(f"{name} taken as {found} {dict(guess.keys)}")
        else:
            score.ends["asked" if asked else "right"] += 1
    if proposal.asks or proposal.problems:
        score.wrong += [f"asks {one}" for one in proposal.asks] + [f"refused: {one.what}" for one in proposal.problems]
        return score, None if proposal.asks else False
    return score, same_trials(out, proposal.text)


def same_trials(out: Disguise, text: str) -> bool:
    """Whether a map makes of disguised logs what the map that undoes the disguise makes, value for value."""
    # What the map finds out about sensors besides, the map that undoes the disguise does not do.
    text = re.sub(r"\[cut\]\n(\w+ = .*\n)*|^(point|shifted) = .*\n", "", text, flags=re.MULTILINE)
    text = "\n".join(_without_recovery(line) for line in text.splitlines())
    try:
        ours = import_logs(out.paths, parse_map(text), ".", dry_run=True).trials
        theirs = import_logs(out.paths, parse_map(out.text), ".", dry_run=True).trials
    except LogError:
        return False
    return len(ours) == len(theirs) and all(equal(a, b) for a, b in zip(ours, theirs, strict=True))


def _without_recovery(line: str) -> str:
    for word in (', recover = "print-resolution"', ', recover = "yaw-rate"'):
        line = line.replace(word, "")
    return line


def equal(a: Trial, b: Trial) -> bool:
    """Whether two trials have the same values, to 1e-6 of each channel's size; positions but for a shift of all."""
    if a.n_samples != b.n_samples or set(a.columns) - set(b.columns):
        return False
    for name in a.columns:
        ours, theirs = np.asarray(a.columns[name]), np.asarray(b.columns[name])
        if name in ("x", "y"):
            ours, theirs = ours - np.nanmean(ours), theirs - np.nanmean(theirs)
        off = ours - theirs
        if name == "psi" or "dir" in name:
            off = np.angle(np.exp(1j * off))
        if not np.array_equal(np.isnan(ours), np.isnan(theirs)):
            return False
        if np.nanmax(np.abs(off), initial=0.0) > 1e-6 * max(1.0, float(np.nanmax(np.abs(theirs), initial=0.0))):
            return False
    return True


def main() -> int:
    """Run what the command line asks for and say how it went."""
    parser = argparse.ArgumentParser(prog="python -m tools.map_disguises", description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--data", type=Path, default=os.environ.get("MMGTUNE_DATA"), help="folder of measured sets")
    parser.add_argument("--show", action="store_true", help="say what was wrong")
    asked = parser.parse_args()
    sets: dict[str, tuple[list[Plain], int]] = {"suzaku": (bundled_logs(), 4)}
    for name, (preset, pattern, many) in SETS.items():
        if asked.data is not None and (Path(asked.data) / name).is_dir():
            sets[name] = plain_logs(Path(asked.data) / name, preset, pattern), many
    ends: dict[str, Counter[str]] = {name: Counter() for name in sets}
    trials: dict[str, Counter[str]] = {name: Counter() for name in sets}
    for number in range(asked.count):
        rng = np.random.default_rng([asked.seed, number])
        name = [*sets][int(rng.integers(len(sets)))]
        logs, many = sets[name]
        chosen = [logs[k] for k in rng.permutation(len(logs))[:many]]
        began = time.process_time()
        with tempfile.TemporaryDirectory() as folder:
            out = disguised(rng, chosen, Path(folder))
            try:
                score, same = judged(out)
            except LogError as error:
                score, same = Score(Counter({"not found": len(out.truth)}), [f"refused: {error}"]), False
        ends[name] += score.ends
        trials[name][{True: "same", False: "differ", None: "asks"}[same]] += 1
        if asked.show and (score.wrong or same is not True):
            wrong = "; ".join(score.wrong)
            print(
                f"{number} {name}: {out.shown}; {time.process_time() - began:.1f} s; trials {same}: {wrong}",
                flush=True,
            )
    for name in sets:
        total = sum(ends[name].values())
        shares = ", ".join(f"{100.0 * count / max(1, total):.1f} % {end}" for end, count in ends[name].most_common())
        print(
            f"{name}: {total} columns: {shares}; trials of {sum(trials[name].values())} disguises: {dict(trials[name])}"
        )
    total = sum((one for one in ends.values()), Counter())
    count = sum(total.values())
    print(
        f"all: {count} columns: "
        + ", ".join(f"{100.0 * one / max(1, count):.1f} % {end}" for end, one in total.most_common())
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
