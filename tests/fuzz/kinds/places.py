"""Something else than was asked for, in the place of every file and folder a command takes or writes.

Folders for files, links to nowhere and to themselves, devices, files of another kind, and the right text in another
encoding, with other ends of lines, or with zero bytes in it.
"""

from __future__ import annotations

import contextlib
import functools
import json
import tempfile
from pathlib import Path

import numpy as np

from mmgtune.networks import save_network
from mmgtune.particles import Particles, save_particles
from mmgtune.profile import load_profile
from mmgtune.resources import folder as bundled
from tests.command import typed
from tests.importing.made import MAP
from tests.networks.made import ensemble, network

from ..mutating import pick
from ..small import trials
from . import Files, Kind

X = "@"
"""Stands for the place in a command."""

LINES: dict[str, tuple[tuple[str, ...], ...]] = {
    "profile": (
        ("simulate", "-p", X, "--turn", "35"), ("validate", X, "trials"), ("predict", X, "--turn", "20"),
        ("compare", "suzaku", X, "trials"), ("profile", "show", X), ("profile", "validate", X),
        ("profile", "compare", X, "suzaku"), ("fit", "-p", X, "-t", "trials", "--dry-run"), ("cite", X),
        ("leave-out", "-p", X, "-t", "trials", "--dry-run"), ("posterior", "-p", X, "-t", "trials", "--out", X),
        ("study", "heading-keeping", "suzaku", "--truth", X, "--gain-step", "50", "--duration", "5"),
        ("profile", "copy", "suzaku", X),
    ),
    "model": (
        ("simulate", "-p", X, "--trials", "trials"), ("validate", X, "trials", "--restart", "5"),
        ("predict", X, "-t", "trials"), ("compare", X, "suzaku", "trials"), ("cite", X),
        ("learn", "mixture", "suzaku", X, "trials"), ("check", X, "trials", "-b", "no.json"),
    ),
    "particles": (
        ("plan", X, "-q", "advance, turn 35", "--kind", "straight", "--particles", "20"),
        ("predict", X, "--turn", "20"),
        ("validate", X, "trials"),
    ),
    "trials": (
        ("validate", "suzaku", X), ("trials", "check", X), ("trials", "inspect", X, "-p", "suzaku"),
        ("predict", "suzaku", "-t", X), ("fit", "-p", "suzaku", "-t", X, "--dry-run"),
        ("compare", "suzaku", "suzaku_fam", "trials", "--sigma-from", X), ("compare", "suzaku", "suzaku_fam", X),
        ("simulate", "-p", "suzaku", "--trials", X), ("check", "suzaku", X, "-b", "no.json"),
        ("learn", "rnn", "-p", "suzaku", "-t", X, "--steps", "0"), ("posterior", "-t", X, "--out", "made"),
        ("diagnose", "-p", "suzaku", "-t", X, "--dry-run", "--effects", "speed-scale"),
    ),
    "orders": (("predict", "suzaku", X),),
    "baseline": (
        ("check", "suzaku", "trials", "-b", X), ("check", "suzaku", "trials", "-b", X, "--update-baseline"),
    ),
    "log": (
        ("trials", "map", X), ("trials", "map", X, "-o", X), ("trials", "import", X, "--map", "map.toml", "-o", "made"),
    ),
    "map": (
        ("trials", "import", "log.csv", "--map", X, "-o", "made"),
        ("trials", "import", "log.csv", "--map", X, "-o", X),
    ),
    "folder": (
        ("report", X), ("simulate", "--turn", "35", "--out", X), ("predict", "suzaku", "--turn", "20", "--out", X),
        ("validate", "suzaku", "trials", "--out", X), ("compare", "suzaku", "suzaku_fam", "trials", "--out", X),
        ("simulate", "--turn", "35", "--out", X, "--force"),
        ("predict", "suzaku", "--turn", "20", "--out", X, "--force"),
    ),
}  # fmt: skip

ORDERS = "t [s], n [rpm], delta [deg]\n0, 100, 0\n20, 100, 10\n40, 100, 0\n"
PLACES = ("file", "folder", "full folder", "loop", "nowhere", "link", "/dev/null", "/proc/self/mem", "long", "odd", "")
TEXTS = (
    "as it is",
    "utf-16",
    "utf-16-be",
    "bom",
    "crlf",
    "cr",
    "nul",
    "nuls",
    "latin",
    "spaces",
    "no end",
    "twice",
    "half",
)


@functools.cache
def contents() -> dict[str, bytes]:
    """A good file for each role."""
    with tempfile.TemporaryDirectory() as name, contextlib.chdir(name):
        base = Path(name)
        for key, content in trials().items():
            (base / key).write_bytes(content)
        assert typed("check", "suzaku", ".", "-b", "check.json", "--update-baseline").code == 0
        found = {
            "profile": (bundled("ship_profiles") / "suzaku.toml").read_bytes(),
            "model": save_network(network(members=2), base / "a.safetensors").read_bytes(),
            "ensemble": save_network(ensemble(), base / "b.safetensors").read_bytes(),
            "trials": next(content for key, content in trials().items() if key.endswith("parquet")),
            "orders": ORDERS.encode(),
            "baseline": (base / "check.json").read_bytes(),
            "log": LOG.encode(),
            "map": MAP.encode(),
            "folder": b"{}",
        }
        drawn = np.random.default_rng(1).normal([[0.017]], [[0.001]], size=(1, 30))
        save_particles(Particles(load_profile("suzaku"), ("hull.R_0",), drawn, {}), base / "p.parquet")
        found["particles"] = (base / "p.parquet").read_bytes()
    return found


LOG = "time,north,east,heading,u,v,r,rudder,rpm\n" + "".join(
    f"{k},{k * 3.1:.3f},0,0,3.1,0,0,{k % 7},100\n" for k in range(60)
)


def recoded(content: bytes, how: str) -> bytes:
    """A text as other programs write it; what is no text is treated as one of latin letters."""
    text = content.decode("latin-1")
    match how:
        case "utf-16":
            return text.encode("utf-16")
        case "utf-16-be":
            return text.encode("utf-16-be")
        case "bom":
            return b"\xef\xbb\xbf" + content
        case "crlf":
            return content.replace(b"\n", b"\r\n")
        case "cr":
            return content.replace(b"\n", b"\r")
        case "nul":
            return content[: len(content) // 2] + b"\x00" + content[len(content) // 2 :]
        case "nuls":
            return b"\x00" * len(content)
        case "latin":
            return content.replace(b"a", b"\xe4")
        case "spaces":
            return b" \t\n" * 50
        case "no end":
            return content.rstrip(b"\n") + b'"' * 3
        case "twice":
            return content + content
        case "half":
            return content[: len(content) // 2]
        case _:
            return content


def make(rng: np.random.Generator) -> Files:
    """A command, what lies in the place of one of its files, and how its text is written."""
    role = pick(rng, list(LINES))
    line = pick(rng, LINES[role])
    holds = role if rng.random() < 0.6 else pick(rng, list(contents()))
    place = pick(rng, PLACES) if rng.random() < 0.6 else "file"
    how = pick(rng, TEXTS)
    end = pick(rng, (".toml", ".parquet", ".csv", ".json", ".safetensors", "", ".txt", ".xlsx", ".mat", ".nmea"))
    case = {"line": line, "place": place, "name": f"thing{end}"}
    return {"case.json": json.dumps(case).encode(), "content": recoded(contents()[holds], how)}


def laid(case: dict[str, str], content: bytes) -> str:
    """The place as a command is given it, made in the folder one is in."""
    name, here = case["name"], Path(case["name"])
    match case["place"]:
        case "file":
            here.write_bytes(content)
        case "folder":
            here.mkdir()
        case "full folder":
            here.mkdir()
            (here / "a.parquet").mkdir()
            (here / "particles.parquet").write_bytes(content)
            (here / "split.toml").mkdir()
            (here / "fit.json").symlink_to("fit.json")
        case "loop":
            here.symlink_to(here)
        case "nowhere":
            here.symlink_to("gone")
        case "link":
            Path("true").write_bytes(content)
            here.symlink_to("true")
        case "long":
            return "x/" * 3000 + name
        case "odd":
            name = f"a\n\x1b[31m{name}"
            Path(name).write_bytes(content)
        case other:
            return other
    return name


def run(folder: Path) -> str:
    """Give the command the place."""
    case = json.loads((folder / "case.json").read_text())
    content = (folder / "content").read_bytes()
    out = folder / "out"
    (out / "trials").mkdir(parents=True)
    for key, one in trials().items():
        (out / "trials" / key).write_bytes(one)
    (out / "map.toml").write_text(MAP)
    (out / "log.csv").write_text(LOG)
    with contextlib.chdir(out):
        name = laid(case, content)
        line = [name if word == X else word for word in case["line"]]
        ended = typed(*line)
    assert ended.code in (0, 1, 2), (line, ended.err)
    assert ended.code != 2 or "error" in ended.err.lower(), (line, ended.err)
    return f"{line[0]}, {case['place'] or 'no name'}: exit {ended.code}"


KIND = Kind("places", make, run, seconds=20.0)
