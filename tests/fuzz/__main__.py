"""``python -m tests.fuzz``: many cases of a kind; exit 1 where one failed."""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
from pathlib import Path

from .kinds import kinds
from .running import campaign, run_folder


def main() -> int:
    """Run what the command line asks for and say how it ended."""
    there = kinds()
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz")
    parser.add_argument("--kind", choices=[*there, "all"], default="all")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for the files of cases that fail")
    parser.add_argument("--case", type=Path, help="run the files of this folder instead")
    asked = parser.parse_args()
    if asked.case is not None:
        outcome = run_folder(there[asked.kind], asked.case)
        print(f"{outcome.end} in {outcome.seconds:.2f} s\n{outcome.said}")
        return int(outcome.failed)
    keep = asked.keep or Path(tempfile.mkdtemp(prefix="mmgtune-fuzz-failed-"))
    bad = 0
    for name in there if asked.kind == "all" else [asked.kind]:
        found = campaign(there[name], asked.count, asked.seed, keep)
        ends = ", ".join(f"{count} {end}" for end, count in sorted(found.ends.items()))
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
        print(f"{name}: {ends}; the longest took {found.longest:.2f} s; the process had {peak} MB at most", flush=True)
        for number, outcome in found.failures.items():
            print(f"  case {number}: {outcome.end}: {outcome.said.strip().splitlines()[-1][:200]}")
        bad += len(found.failures)
    if bad:
        print(f"{bad} cases failed; their files are in {keep}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
