"""Commands killed and interrupted at random moments: ``python -m tests.fuzz.interruptions --count 50 --seed 1``.

Each command is run to its end once.  Then it is started again and again, gets SIGKILL, SIGINT or SIGTERM at a moment
between its start and a little after its end, finds the disk full at one of its writes, or two of them at once begin on
one folder; then it is continued, or begun again where it says that there is nothing to continue, and must come to the
same numbers, bit for bit.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.files import is_left_over
from mmgtune.resources import folder
from tests.command import Ended, run, start
from tests.fitting.test_resume import same

FEW = ("--targets", "R_0,w_P0", "--quiet", "--no-report")
OUT = "run"


@dataclass(frozen=True)
class Command:
    """A command to disturb.

    line     as it is typed, without its folder
    result   the file in its folder that says what it found
    resumes  whether it can be continued
    """

    name: str
    line: tuple[str, ...]
    result: str
    resumes: bool = True


COMMANDS = (
    Command("fit", ("fit", *FEW, "--method", "least-squares", "--starts", "8"), "fit.json"),
    Command("fit cma-es", ("fit", "--targets", "R_0", "--quiet", "--no-report", "--starts", "1"), "fit.json"),
    Command("sweep", ("sweep", *FEW, "--method", "least-squares", "--starts", "4", "--ar", "0.2,0.4"), "sweep.json"),
    Command("leave-out", ("leave-out", "--targets", "R_0,w_P0", "--quiet", "--starts", "2"), "leave_out.json"),
    Command("diagnose", ("diagnose", *FEW, "--effects", "speed-scale"), "diagnosis.json"),
    Command("trials import", ("trials", "import", "a.csv", "b.csv", "--map", "map.toml"), "b.parquet", resumes=False),
    Command(
        "check", ("check", "suzaku", "suzaku", "-b", "check.json", "--junit", f"{OUT}/junit.xml"), "junit.xml", False
    ),
)
DEATHS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)

FULL = """
import errno, os
from pathlib import Path
whole, at, count = os.fsync, int(os.environ["FULL_AT"]), Path(os.environ["FULL_COUNT"])
done = 0
def fsync(handle):
    global done
    done += 1
    count.write_text(str(done))
    if done == at:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    whole(handle)
os.fsync = fsync
"""
"""A disk that is full at write FULL_AT: all that the program keeps is synchronised before it has its name."""


@dataclass
class Found:
    """What came of it all: how often what happened, and what must not have."""

    counts: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)


def disturb(count: int, seed: int, names: tuple[str, ...] = ()) -> Found:
    """Disturb commands ``count`` times, each in turn."""
    rng = np.random.default_rng(seed)
    found = Found()
    chosen = [one for one in COMMANDS if not names or one.name in names]
    with tempfile.TemporaryDirectory(prefix="mmgtune-interruptions-") as place:
        wholes = {one.name: _whole(one, Path(place)) for one in chosen}
        for number in range(count):
            command = chosen[number % len(chosen)]
            wanted, seconds = wholes[command.name]
            here = Path(place) / str(number)
            _lay(here)
            kind = rng.random()
            if command.resumes and kind < 0.1:
                _two_at_once(command, here, wanted, found)
            elif kind < 0.25:
                _disk_full(command, here, wanted, rng, found)
            else:
                death = DEATHS[int(rng.integers(len(DEATHS)))]
                # As often at start-up and at the end as in the middle.
                share = float(rng.choice([0.15 * rng.random(), rng.random(), 0.9 + 0.15 * rng.random()]))
                _one(command, here, wanted, death, share * seconds, found)
            shutil.rmtree(here)
    return found


def _lay(here: Path) -> None:
    """A folder with what the commands need besides bundled data."""
    from tests.importing.made import MAP, logged, turn

    here.mkdir()
    rows = {name: values[:200] for name, values in logged(turn()).items()}
    text = "\n".join(
        [",".join(rows), *(",".join(f"{value:.5g}" for value in row) for row in zip(*rows.values(), strict=True))]
    )
    for name in ("a.csv", "b.csv"):
        (here / name).write_text(text + "\n")
    (here / "map.toml").write_text(MAP)
    shutil.copy(folder("trials") / "suzaku" / "check.json", here)


def _line(command: Command) -> tuple[str, ...]:
    return command.line if command.name == "check" else (*command.line, "--out", OUT)


def _whole(command: Command, place: Path) -> tuple[Any, float]:
    """What an undisturbed run finds, and how long it takes with everything compiled."""
    for _ in range(2):
        here = place / "whole"
        shutil.rmtree(here, ignore_errors=True)
        _lay(here)
        began = time.monotonic()
        ended = run(*_line(command), cwd=here)
        assert ended.code == 0, ended.err
    return _read(here, command), time.monotonic() - began


def _read(here: Path, command: Command) -> Any:
    path = here / OUT / command.result
    if path.suffix == ".json":
        return same(json.loads(path.read_text()))
    return re.sub(rb' time(stamp)?="[^"]*"', b"", path.read_bytes())


def _one(command: Command, here: Path, wanted: Any, death: signal.Signals, after: float, found: Found) -> None:
    process = start(*_line(command), cwd=here)
    time.sleep(after)
    if process.poll() is None:
        process.send_signal(death)
    out, err = process.communicate(timeout=120)
    ended = Ended(process.returncode, out, err)
    label = f"{command.name}, {death.name} after {after:.2f} s"
    _judge(command, here, wanted, death, ended, label, found)
    if command.resumes:
        _continue(command, here, wanted, label, found)
    elif ended.code != 0:
        again = run(*_line(command), *(("--force",) if command.name != "check" else ()), cwd=here)
        _expect(again.code == 0, f"{label}: not done again: {again.err}", found)
        _expect(_read(here, command) == wanted, f"{label}: done again differs", found)
    _expect(
        not _halves(here) or (command.name == "trials import" and death == signal.SIGKILL),
        f"{label}: leaves {_halves(here)}",
        found,
    )


def _disk_full(command: Command, here: Path, wanted: Any, rng: np.random.Generator, found: Found) -> None:
    """The disk is full at one write; there is room again when the command is continued."""
    (here / "hook").mkdir()
    (here / "hook" / "sitecustomize.py").write_text(FULL)
    count = here / "count"
    paths = os.pathsep.join([str(here / "hook"), *filter(None, [os.environ.get("PYTHONPATH")])])
    env = {"PYTHONPATH": paths, "FULL_COUNT": str(count)}
    whole = run(*_line(command), cwd=here, env={**env, "FULL_AT": "0"})
    writes = int(count.read_text())
    _expect(whole.code == 0 and writes > 0, f"{command.name}: {writes} writes: {whole.err}", found)
    shutil.rmtree(here / OUT)
    at = int(rng.integers(1, writes + 1))
    label = f"{command.name}, disk full at write {at} of {writes}"
    ended = run(*_line(command), cwd=here, env={**env, "FULL_AT": str(at)})
    found.counts[f"disk full: exit {ended.code}"] += 1
    _expect(ended.code == 2, f"{label}: exit {ended.code}: {ended.err}", found)
    _expect("Traceback" not in ended.err and "o space left" in ended.err, f"{label}: {ended.err}", found)
    _expect(not _halves(here), f"{label}: halves of files stay: {_halves(here)}", found)
    if command.resumes:
        _continue(command, here, wanted, label, found)
    else:
        again = run(*_line(command), *(("--force",) if command.name != "check" else ()), cwd=here)
        _expect(again.code == 0, f"{label}: not done again: {again.err}", found)
        _expect(_read(here, command) == wanted, f"{label}: done again differs", found)


def _judge(
    command: Command, here: Path, wanted: Any, death: signal.Signals, ended: Ended, label: str, found: Found
) -> None:
    """How a disturbed command ended: its exit code, what it said and what it left."""
    found.counts[f"{death.name}: exit {ended.code}"] += 1
    if ended.code == 0:
        _expect(ended.err == "" or command.name == "check", f"{label}: exit 0 and {ended.err}", found)
        _expect(_read(here, command) == wanted, f"{label}: exit 0 with another result", found)
        return
    if death == signal.SIGKILL:
        _expect(ended.code == -death, f"{label}: exit {ended.code}: {ended.err}", found)
        return
    # Before the program's first instruction the interpreter ends as it always does.
    early = ended.code == -death and "mmgtune/" not in ended.err.replace("python -m mmgtune", "")
    early = early or (
        death == signal.SIGINT and ended.code == 1 and "mmgtune/cli" not in ended.err and "site" in ended.err
    )
    if early:
        found.counts["before the program began"] += 1
        return
    _expect(ended.code == 128 + death, f"{label}: exit {ended.code}: {ended.err}", found)
    _expect("Traceback" not in ended.err and "Exception ignored" not in ended.err, f"{label}: {ended.err}", found)
    lines = [line for line in ended.err.splitlines() if not line.startswith("finishing this step")]
    _expect(len(lines) == 1, f"{label}: not one line: {ended.err}", found)
    _expect(not _halves(here), f"{label}: halves of files stay: {_halves(here)}", found)


def _continue(command: Command, here: Path, wanted: Any, label: str, found: Found) -> None:
    """Continue a run, or begin it again; it comes to the same numbers."""
    path = here / OUT / command.result
    finished = path.exists() and not json.loads(path.read_text()).get("interrupted")
    if not finished:
        resumed = run(*_line(command), "--resume", cwd=here)
        if resumed.code == 2 and "nothing to resume" in resumed.err:
            found.counts["nothing to resume"] += 1
            resumed = run(*_line(command), cwd=here)
        else:
            found.counts["resumed"] += 1
        _expect(resumed.code == 0, f"{label}: not continued: exit {resumed.code}: {resumed.err}", found)
    else:
        found.counts["was finished"] += 1
    if path.exists():
        _expect(_read(here, command) == wanted, f"{label}: continued differs", found)


def _two_at_once(command: Command, here: Path, wanted: Any, found: Found) -> None:
    started = [start(*_line(command), cwd=here) for _ in range(2)]
    ended = [Ended(process.wait(), "", process.communicate()[1]) for process in started]
    codes = sorted(one.code for one in ended)
    found.counts[f"two at once: exits {codes}"] += 1
    _expect(codes == [0, 2], f"{command.name}, two at once: {ended}", found)
    refused = next((one for one in ended if one.code == 2), None)
    said = refused is not None and ("another run is writing there" in refused.err or "exists already" in refused.err)
    _expect(said, f"{command.name}, two at once: {ended}", found)
    _expect(_read(here, command) == wanted, f"{command.name}, two at once: the result differs", found)


def _halves(here: Path) -> list[str]:
    return [path.name for path in here.rglob("*") if is_left_over(path)]


def _expect(good: bool, words: str, found: Found) -> None:
    if not good:
        found.wrong.append(words)


def main() -> int:
    """Run what the command line asks for and say how it ended."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz.interruptions")
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", default=[], choices=[one.name for one in COMMANDS])
    asked = parser.parse_args()
    os.environ.setdefault("MMGTUNE_THREADS", "1")
    found = disturb(asked.count, asked.seed, tuple(asked.only))
    for what, count in sorted(found.counts.items()):
        print(f"{count:>5} {what}")
    for words in found.wrong:
        print(f"WRONG {words.strip()}")
    print(f"{len(found.wrong)} wrong")
    return int(bool(found.wrong))


if __name__ == "__main__":
    sys.exit(main())
