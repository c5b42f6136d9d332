"""``pytest --mmgtune check.toml``: a test item per trial and metric of the checks named there.

Loaded by pytest itself, in every project where this package is installed, so nothing heavy is imported before the
option is given.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from .checking import CheckReport, Item

KEYS = ("profile", "trials", "baseline", "metrics", "backend")
LIST = "a list of names"


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option."""
    parser.getgroup("mmgtune").addoption(
        "--mmgtune",
        action="append",
        default=[],
        metavar="FILE",
        help="check ship profiles against trials as this TOML file says: [[check]] with profile, trials, baseline",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Collect the files of the option besides whatever else is collected.  Raises UsageError where one is missing."""
    for name in config.getoption("--mmgtune"):
        path = Path(config.invocation_params.dir, name)
        if not path.is_file():
            raise pytest.UsageError(f"--mmgtune: there is no file {name}")
        config.args.append(str(path))


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> CheckFile | None:
    """The collector of a file that the option names."""
    named = {Path(parent.config.invocation_params.dir, name).resolve() for name in parent.config.getoption("--mmgtune")}
    return CheckFile.from_parent(parent, path=file_path) if file_path.resolve() in named else None


class CheckFile(pytest.File):
    """A TOML file of checks."""

    def collect(self) -> Iterator[CheckNode]:
        """One node per [[check]]."""
        from . import limits
        from .errors import OptionError, brief
        from .toml_reading import toml_of

        try:
            text = limits.text(self.path, limits.CHECKS_BYTES, OptionError)
            data = toml_of(text, "the file of checks", str(self.path), OptionError)
        except OptionError as error:
            raise self.CollectError("\n".join(map(str, error.problems))) from None
        except (OSError, ValueError) as error:
            raise self.CollectError(f"{self.path} cannot be read: {error}") from None
        checks = data.get("check")
        if not isinstance(checks, list) or not checks or not all(isinstance(one, dict) for one in checks):
            raise self.CollectError(f"{self.path} has no [[check]] with profile, trials and baseline")
        for k, one in enumerate(checks, 1):
            unknown = [key for key in one if key not in KEYS]
            missing = [key for key in ("profile", "trials") if key not in one]
            wrong = [key for key, value in one.items() if key in KEYS and not _is(key, value)]
            if unknown or missing or wrong:
                told = [f"unknown key '{key}'" for key in unknown] + [f"'{key}' is missing" for key in missing]
                told += [f"'{key}' is {brief(one[key])}, not {LIST if key == 'metrics' else 'text'}" for key in wrong]
                raise self.CollectError(f"{self.path}, [[check]] {k}: {', '.join(told)}; keys: {', '.join(KEYS)}")
            yield CheckNode.from_parent(self, name=f"{Path(one['profile']).stem}-{Path(one['trials']).name}", asked=one)


def _is(key: str, value: Any) -> bool:
    """Whether a value is of the kind its key takes."""
    if key == "metrics":
        return isinstance(value, list) and all(isinstance(one, str) for one in value)
    return isinstance(value, str)


class CheckNode(pytest.Collector):
    """One check: run when its items are collected."""

    def __init__(self, *, asked: dict[str, Any], **given: Any):
        super().__init__(**given)
        self.asked = asked

    def collect(self) -> Iterator[CheckItem]:
        """One item per trial and metric."""
        from .errors import MmgtuneError

        try:
            report = self.report()
        except MmgtuneError as error:
            raise self.CollectError("\n".join(str(problem) for problem in error.problems)) from None
        for item in report.items:
            name = f"{item.trial}[{item.metric}]" if item.metric else item.trial
            yield CheckItem.from_parent(self, name=name, found=item, report=report)

    def report(self) -> CheckReport:
        """The outcome; paths are relative to the file."""
        from .checking import check, read_baseline
        from .profile import load_profile
        from .trial import load_trials

        profile, trials = (self.place(self.asked[key]) for key in ("profile", "trials"))
        name = self.asked.get("baseline")
        baseline = None if name is None else self.path.parent / name
        return check(
            load_profile(profile),
            load_trials(trials),
            None if baseline is None else read_baseline(baseline),
            names=(profile, trials, None if baseline is None else str(baseline)),
            metrics=tuple(self.asked.get("metrics", ())),
            backend=self.asked.get("backend", "compiled"),
        )

    def place(self, name: str) -> str:
        """A path beside the file where there is one; else the name, which may be a bundled one."""
        beside = self.path.parent / name
        return str(beside) if beside.exists() else name


class NotGood(Exception):
    """A metric that regressed or cannot be compared."""


class CheckItem(pytest.Item):
    """A metric of a trial."""

    def __init__(self, *, found: Item, report: CheckReport, **given: Any):
        super().__init__(**given)
        self.found = found
        self.report = report

    def runtest(self) -> None:
        """Fail, skip or pass."""
        from .checking.renderers.numbers import told

        if self.found.status == "not shown":
            pytest.skip(self.found.reason)
        if self.found.status in ("regressed", "not comparable"):
            lines = [f"{self.found.status}: {self.found.trial}: {self.found.words}: {told(self.found)}"]
            lines += [f"changed: {one}" for one in self.report.changed]
            raise NotGood("\n".join(lines + ([f"next: {self.report.next}"] if self.report.next else [])))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """What is wrong, without a traceback of this program."""
        if isinstance(excinfo.value, NotGood):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Where the item comes from."""
        return self.path, None, self.name
