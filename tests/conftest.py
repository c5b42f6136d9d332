"""Shared fixtures, and what lets several workers share the machine.

Kernels compiled by tests go to a cache of the checkout, for all workers and for the next run.
"""

from __future__ import annotations

import gc
import os
from pathlib import Path

import pytest

os.environ.setdefault("MMGTUNE_CACHE", str(Path(__file__).parent.parent / ".cache"))
os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(Path(os.environ["MMGTUNE_CACHE"]) / "jax"))
os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.2")
if "PYTEST_XDIST_WORKER" in os.environ:  # a core each, for the commands that a worker starts too
    for name in ("MMGTUNE_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
os.environ.setdefault("NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING", "1")  # of messages that numba keeps to itself

from mmgtune.backends import get_backend
from mmgtune.backends.twins import FUSE
from mmgtune.model import Model
from mmgtune.profile import load_profile, with_all_effects
from mmgtune.resources import profile_names
from tests import times
from tests.runs import turn

os.environ.setdefault("XLA_FLAGS", f"--{FUSE}")  # as the program has it, for tests that import JAX themselves


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--write-times", action="store_true", help="write tests/times.json; of a run of all tests")


def pytest_configure(config: pytest.Config) -> None:
    gc.set_threshold(50_000, 20, 20)  # collecting among all that was imported is one second in twenty
    if config.getoption("--write-times") and not hasattr(config, "workerinput"):
        config.pluginmanager.register(times.Writer())


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """One more than there are cores: some tests wait for what they have started."""
    return 1 + (len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1)


LONGEST_NAME = 100
"""Characters of a text that a case is called by."""


def pytest_make_parametrize_id(val: object, argname: str) -> str | None:
    """Short names for cases of long texts, as some hostile files are."""
    return f"{argname} of {len(val)}" if isinstance(val, str | bytes) and len(val) > LONGEST_NAME else None


@pytest.hookimpl(tryfirst=True)  # before the plugin of the workers reads the groups
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tests that share what took long stay together, in one worker; what takes longest comes first, so that no worker
    is left with it at the end.  What takes long, or begins with what does, is marked slow; cases of a test that are not
    those of every day are marked long.

    Tests with a fixture of their module stay together, and those that a marker ``xdist_group(name)`` says.
    """
    taken = times.read()
    together: dict[str, list[pytest.Item]] = {}
    for item in items:
        if (daily := item.get_closest_marker("daily")) and not any(part in _case(item) for part in daily.args):
            item.add_marker("long")
        if item.get_closest_marker("browser"):  # once more where chromium was stuck
            item.add_marker(pytest.mark.flaky(reruns=1, only_rerun=["TargetClosedError", "TimeoutError"]))
        shared = _shared(item)
        if any(scope == "module" for _, scope in shared) and not item.get_closest_marker("xdist_group"):
            item.add_marker(pytest.mark.xdist_group(times.file_of(item.nodeid)))
        begun = max((times.beginning(taken, place) for place, _ in shared), default=0.0)
        if max(taken.get(item.nodeid, 0.0), begun) >= times.SLOW:
            item.add_marker("slow")
        group = item.get_closest_marker("xdist_group")
        together.setdefault(group.args[0] if group else item.nodeid, []).append(item)

    def seconds(tests: list[pytest.Item]) -> float:
        names = dict.fromkeys(name for item in tests for name in (item.nodeid, times.file_of(item.nodeid)))
        return sum(taken.get(name, 0.0) for name in names)  # in one order: all workers must find the same

    if len(items) > MANY:
        _every_test_has_a_daily_case(items)
    items[:] = [item for tests in sorted(together.values(), key=seconds, reverse=True) for item in tests]


MANY = 1000
"""Tests among which there are some of every effect."""


@pytest.hookimpl(trylast=True)  # the controller knows by then that this worker is ready, and lets the others begin
def pytest_collection_finish(session: pytest.Session) -> None:
    """The simulator of all effects is made first, by one worker: it serves all tests of some of them.

    What was imported and collected by then stays to the end, and is looked through no more.
    """
    gc.freeze()
    if os.environ.get("PYTEST_XDIST_WORKER") == "gw0" and len(session.items) > MANY:
        model = Model(with_all_effects(load_profile("suzaku")))
        get_backend("compiled").run(model, model.matrix(), turn(model, 20.0, 1.0))


def _every_test_has_a_daily_case(items: list[pytest.Item]) -> None:
    """None whose parameters were renamed goes over to the long ones as a whole."""
    asked = {item.nodeid.partition("[")[0] for item in items if item.get_closest_marker("daily")}
    daily = {item.nodeid.partition("[")[0] for item in items if not item.get_closest_marker("long")}
    if asked - daily:
        raise pytest.UsageError(f"no case is that of every day: {', '.join(sorted(asked - daily))}")


def _case(item: pytest.Item) -> str:
    """Which case of a test with parameters it is, in brackets."""
    return f"[{item.callspec.id}]" if isinstance(item, pytest.Function) and hasattr(item, "callspec") else ""


def _shared(item: pytest.Item) -> set[tuple[str, str]]:
    """Of fixtures of a test that are made once for several, which another worker would make again: the file or folder
    they are of, and their scope; those of this file are made in no time."""
    fixtures = item._fixtureinfo.name2fixturedefs if isinstance(item, pytest.Function) else {}
    own = [one for found in fixtures.values() for one in found if one.baseid not in ("", "tests")]
    return {(one.baseid, one.scope) for one in own if one.scope != "function"}


def _profiles() -> list[object]:
    """Bundled profiles; one built of the same components as another before it has nothing new for most tests."""
    found: dict[tuple[str, ...], list[str]] = {}
    for name in profile_names():
        found.setdefault(Model(load_profile(name)).tags, []).append(name)
    return [
        name if name == alike[0] else pytest.param(name, marks=pytest.mark.long)
        for alike in found.values()
        for name in alike
    ]


@pytest.fixture(params=_profiles())
def any_model(request: pytest.FixtureRequest) -> Model:
    """The model of each bundled profile in turn."""
    return Model(load_profile(request.param))


@pytest.fixture(scope="session")
def suzaku() -> Model:
    """SUZAKU with its pre-determined coefficients."""
    return Model(load_profile("suzaku"))


@pytest.fixture(scope="session")
def esso_osaka() -> Model:
    """The 3 m Esso Osaka with captive-test coefficients."""
    return Model(load_profile("esso_osaka_3m"))
