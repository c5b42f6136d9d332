"""Sister ships together: mean and spread of a class, and fits that begin from them."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmgtune.errors import OptionError
from mmgtune.fitting import FitOptions, Information, SisterClass, fit, information_of, make_problem, pooled
from mmgtune.fitting.pooled import read_sisters
from mmgtune.fleet.pooling import write_classes
from mmgtune.trial import load_trials
from tests.command import run

from .conftest import make_logs

NAMES = ("hull.R_0", "hull.Y_v", "wake.w_P0")
FEW = FitOptions(method="least-squares", starts=1, a_r=0.3, targets=NAMES)


def a_class(n: int, seed: int = 1, names: tuple[str, ...] = ("a", "b", "c")) -> tuple[SisterClass, np.ndarray]:
    """Ships of known coefficients, each known to 0.05 in two combinations of three and not at all in the third."""
    rng = np.random.default_rng(seed)
    truth = np.array([1.0, 2.0, 3.0]) + np.array([0.2, 0.1, 0.3]) * rng.standard_normal((n, 3))
    members = {}
    for k in range(n):
        seen = np.linalg.qr(rng.standard_normal((3, 3)))[0][:2]  # the third direction is of each ship's own
        told = seen @ truth[k] + 0.05 * rng.standard_normal(2)
        H = seen.T @ seen / 0.05**2
        before = np.array([0.8, 2.3, 2.5])
        members[f"s{k}"] = Information(names, H, seen.T @ told / 0.05**2, before, np.full(3, 0.5))
    return SisterClass("made", members), truth


def test_mean_and_spread_come_back_though_no_ship_tells_all() -> None:
    sisters, truth = a_class(60)
    found = pooled(sisters)
    assert np.abs(found.mean - truth.mean(axis=0)) == pytest.approx(np.zeros(3), abs=0.1)
    assert found.spread == pytest.approx(truth.std(axis=0), rel=0.4)
    assert (found.mean_error < 0.1).all()
    off = np.sqrt(np.mean((found.each - truth) ** 2, axis=0))
    assert (off < 0.9 * truth.std(axis=0)).all()  # each is better known than by the mean alone
    assert (found.predictive > found.spread).all()


def test_what_no_trial_tells_stays_as_it_was_known() -> None:
    sisters, _ = a_class(5)
    blind = {
        ship: replace(one, names=(*one.names, "d"), H=np.pad(one.H, ((0, 1), (0, 1))), b=np.append(one.b, 0.0),
                      before=np.append(one.before, 7.0), known=np.append(one.known, 0.9))
        for ship, one in sisters.members.items()
    }  # fmt: skip
    found = pooled(replace(sisters, members=blind))
    assert found.names[3] == "d"
    assert found.mean[3] == pytest.approx(7.0)
    assert found.spread[3] == pytest.approx(0.9)
    with pytest.raises(OptionError, match="2 ships"):
        pooled(replace(sisters, members=dict(list(sisters.members.items())[:2])))


def test_open_parameters_and_two_sets_of_trials() -> None:
    sisters, _ = a_class(3)
    one = sisters.members["s0"]
    whole = replace(one, H=one.H + np.diag([1.0, 2.0, 3.0]))
    left = whole.apart_from(["b"])
    covariance = np.linalg.inv(whole.H)
    assert np.linalg.inv(left.H) == pytest.approx(covariance[np.ix_([0, 2], [0, 2])], rel=1e-6)
    assert np.linalg.solve(left.H, left.b) == pytest.approx(np.linalg.solve(whole.H, whole.b)[[0, 2]], rel=1e-6)
    both = whole.and_of(left)
    assert both.H[1, 1] == whole.H[1, 1]
    assert both.b[0] == whole.b[0] + left.b[0]


def in_all(**entries: object) -> Callable[[dict[str, Any]], object]:
    """A change of the document of a class: entries of each member."""
    return lambda document: [one.update(entries) for one in document["members"].values()]


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (in_all(b=[10**400, 0.0, 0.0]), "of 's0': 'b' has something in it that is no finite number"),
        (in_all(b=[float("inf"), 0.0, 0.0]), "'b' has something in it that is no finite number"),
        (in_all(b=["1", "2", "3"]), "'b' has something in it that is no finite number"),
        (in_all(b=[1.0, 2.0]), "'b' has 2 numbers for 3"),
        (in_all(known=[0.0, 0.0, 0.0]), "'known' holds standard deviations"),
        (in_all(known=[-1.0, 1.0, 1.0]), "'known' holds standard deviations"),
        (in_all(H=[[800.0, 1.0, 0.0], [2.0, 7.0, 0.0], [0.0, 0.0, 0.0]]), "'H' is not symmetric"),
        (in_all(H=[[-800.0, 0.0, 0.0], [0.0, 7.0, 0.0], [0.0, 0.0, 7.0]]), "'H' is not symmetric"),
        (in_all(H=[[1e308, 0.0, 0.0], [0.0, 7.0, 0.0], [0.0, 0.0, 7.0]], known=[1e300] * 3), "'H' is not symmetric"),
        (in_all(names=["a", "b", "a"]), "a name twice"),
        (in_all(names="abc"), "no list of names"),
        (lambda document: document["members"].update(s0=[]), "of 's0': it is no table"),
        (lambda document: document.update(members=[]), "of another kind"),
    ],
)
def test_what_no_trials_say_is_no_class(tmp_path: Path, change: Callable[[Any], object], why: str) -> None:
    document = a_class(3)[0].to_dict()
    path = tmp_path / "class.json"
    path.write_text(json.dumps(document))
    pooled(read_sisters(path, "s1"))
    change(document)
    path.write_text(json.dumps(document))
    with pytest.raises(OptionError, match=f"no class of sister ships(?s:.*){why}") as error:
        read_sisters(path, "s1")
    assert error.value.problems[0].fix


def test_rounding_is_forgiven_and_numbers_that_run_away_are_said() -> None:
    sisters, _ = a_class(3)
    one = sisters.members["s0"]
    document = {**one.to_dict(), "H": (one.H * (1.0 + 1e-12 * np.arange(9.0).reshape(3, 3))).tolist()}
    assert Information.from_dict(document).names == one.names
    far = replace(one, b=np.array([1e308, -1e308, 1e308]), before=np.full(3, 1e306))
    with pytest.raises(OptionError, match="cannot be put together"):
        pooled(replace(sisters, members={**sisters.members, "s0": far}))


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pipes by name")
def test_a_pipe_or_a_folder_is_no_class(tmp_path: Path) -> None:
    classes = tmp_path / "classes"
    classes.mkdir()
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(OptionError, match=r"no class(?s:.*)it is a pipe"):
        read_sisters(tmp_path / "pipe", "s1")
    (classes / "a.json").mkdir()
    with pytest.raises(OptionError, match=r"no class(?s:.*)it is a folder"):
        read_sisters(tmp_path, "s1")
    write_classes(tmp_path, [])
    os.mkfifo(classes / "b.json")
    (classes / "a.json").rmdir()
    with pytest.raises(OptionError, match=r"no class(?s:.*)it is a pipe"):
        read_sisters(tmp_path, "s1")


@pytest.fixture
def sisters_file(tmp_path: Path) -> Path:
    """A class that fits to three pieces of trials make, in the folder of a fleet."""
    make_logs(tmp_path, ("a1", "a2", "a3", "a4"), ("2025-01",))
    told = {}
    for ship in ("a1", "a2", "a3"):
        data = load_trials(tmp_path / "logs" / ship / "2025-01")
        told[ship] = information_of(fit("suzaku", data, FEW), data)
    path = tmp_path / "fleet" / "classes" / "coasters.json"
    path.parent.mkdir(parents=True)
    path.write_text(json.dumps(SisterClass("coasters", told).to_dict()))
    return path


def test_a_fit_begins_from_what_sisters_say(sisters_file: Path, tmp_path: Path) -> None:
    found = pooled(read_sisters(tmp_path / "fleet", "suzaku"))
    options = replace(FEW, sisters=tmp_path / "fleet")
    data = load_trials(tmp_path / "logs" / "a4" / "2025-01")
    box = make_problem(fit("suzaku", data, FEW).profile, data, options).box
    assert box.centre == pytest.approx([found.mean[found.names.index(name)] for name in NAMES])
    result, plain = fit("suzaku", data, options), fit("suzaku", data, FEW)
    assert result.beside is not None
    assert any("sister ships" in line for line in result.beside.words())
    drawn, alone = (np.abs(np.array([one.theta[name] for name in NAMES]) - box.centre) for one in (result, plain))
    assert (drawn / box.scatter).sum() < (alone / box.scatter).sum()
    silent = "The class of sister ships has no effect: their trials say nothing of the targets, only of hull.R_0, hull."
    assert not any(line.startswith(silent) for line in result.warnings)
    assert any(
        line.startswith(silent) for line in fit("suzaku", data, replace(options, targets=("hull.N_r",))).warnings
    )


def test_what_trials_say_does_not_hold_what_was_known_before(tmp_path: Path) -> None:
    make_logs(tmp_path, ("a1",), ("2025-01",))
    data = load_trials(tmp_path / "logs" / "a1" / "2025-01")
    wide = replace(FEW, a_r=0.9, targets=("hull.R_0", "wake.w_P0"))
    plain = fit("suzaku", data, wide)
    known = information_of(plain, data)
    assert known is not None
    error = np.sqrt(np.diag(np.linalg.inv(known.H)))
    optimum = np.array(list(plain.theta.values()))
    # Sisters two errors away, who are about as alike as the trials tell.
    members = {
        f"s{k}": replace(known, H=1e4 * known.H, b=1e4 * known.H @ (optimum + (2.0 + shift) * error))
        for k, shift in enumerate((-1.0, 0.0, 1.0))
    }
    path = tmp_path / "class.json"
    path.write_text(json.dumps(SisterClass("made", members).to_dict()))
    result = fit("suzaku", data, replace(wide, sisters=path))
    told = information_of(result, data)
    assert told is not None
    drawn = np.abs(np.array(list(result.theta.values())) - optimum) / error
    left = np.abs(np.linalg.solve(told.H, told.b) - optimum) / error
    assert (drawn > 0.3).all()
    assert (left < 0.5 * drawn).all()


def test_the_command_and_its_errors(sisters_file: Path, tmp_path: Path) -> None:
    quick = [
        "fit",
        "-p",
        "suzaku",
        "-t",
        "logs/a4/2025-01",
        "--method",
        "least-squares",
        "--starts",
        "1",
        "--ar",
        "0.3",
    ]
    few = ["--targets", ",".join(NAMES)]
    planned = run(*quick, *few, "--prior", "fleet", "--dry-run", cwd=tmp_path)
    assert planned.code == 0, planned.err
    assert "prior     3 targets" in planned.out
    both = run(*quick, "--prior", "fleet", "--no-prior", cwd=tmp_path)
    assert (both.code, "--prior" in both.err) == (2, True)
    second = sisters_file.with_name("tankers.json")
    second.write_text(sisters_file.read_text().replace("coasters", "tankers"))
    several = run(*quick, "--prior", "fleet", cwd=tmp_path)
    assert (several.code, "tankers.json" in several.err) == (2, True)
    second.write_text("{}")
    broken = run(*quick, "--prior", second, cwd=tmp_path)
    assert (broken.code, "no class of sister ships" in broken.err) == (2, True)
