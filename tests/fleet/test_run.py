"""Fleets run by processes of this machine."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from mmgtune.checking import update_baseline
from mmgtune.errors import OutputError
from mmgtune.fitting import FitOptions, fit, write_run
from mmgtune.fleet import plan_fleet, read_results, read_table, run_fleet
from mmgtune.fleet.expanding import expand
from mmgtune.fleet.job import Job
from mmgtune.fleet.processes import pool_of
from mmgtune.fleet.work import run_job
from mmgtune.options import FleetOptions
from tests.command import run as command
from tools.fleet_speed import workers_of

from .conftest import QUICK, make_logs

OF_NOW = ("created", "command", "wall_s", "out")
"""Of a record, what no two runs have in common."""


def test_a_plan_and_a_run_are_tables(tmp_path: Path) -> None:
    make_logs(tmp_path, ("a1",), ("2025-01", "2025-02"))
    (tmp_path / "fleet.toml").write_text(QUICK, encoding="utf-8")
    plan = plan_fleet(tmp_path / "fleet.toml")
    assert repr(plan) == "FleetPlan(2 jobs, 0 done)"
    assert plan.to_frame()["date"].tolist() == ["2025-01", "2025-02"]
    assert "on one worker" in plan.sentence()


def test_a_job_is_the_single_run_to_the_last_bit(fleet: Path, tmp_path: Path) -> None:
    job = expand(read_table(fleet))[0]
    copied = Job.from_dict(json.loads(json.dumps(job.to_dict())))
    assert copied.key == job.key
    assert run_job(copied.to_dict(), str(tmp_path / "out"))[1] == "good"
    given = json.loads((tmp_path / "out" / job.place / "fit.json").read_text())
    options = FitOptions(method="least-squares", starts=1, a_r=0.3, targets=("hull.R_0", "hull.Y_v", "wake.w_P0"))
    alone = write_run(fit("suzaku", tmp_path / "logs" / "a1" / "2025-01", options), tmp_path / "alone")
    for document in (given, alone):
        for key in OF_NOW:
            document.pop(key)
        document["profile"].pop("path")
    assert given == json.loads(json.dumps(alone))
    motions = [pq.read_table(one / "motions.parquet") for one in (tmp_path / "alone", tmp_path / "out" / job.place)]
    assert motions[0].equals(motions[1])


def test_all_jobs_each_once_whatever_fails(fleet: Path, tmp_path: Path) -> None:
    bad = tmp_path / "logs" / "a2" / "2025-01" / "turn_p35.parquet"
    good = bad.read_bytes()
    bad.write_bytes(b"no parquet")
    out = tmp_path / "out"
    first = run_fleet(fleet, out, FleetOptions(workers=2))
    assert first.document["jobs"] | {"seconds": 0} == {
        "total": 6, "good": 5, "no": 0, "failed": 1, "missing": 0, "others": 0, "seconds": 0
    }  # fmt: skip
    (failure,) = first.document["failures"]
    assert (failure["ship"], failure["date"]) == ("a2", "2025-01")
    assert "turn_p35.parquet" in failure["problems"][0]["where"]
    with pytest.raises(OutputError, match="resume"):
        run_fleet(fleet, out)
    assert not run_fleet(fleet, out, resume=True).ran  # what failed is not tried again unless that is asked for
    bad.write_bytes(good)
    second = run_fleet(fleet, out, FleetOptions(workers=1), resume=True)
    assert list(second.ran) == [job.key for job in second.jobs if (job.ship, job.date) == ("a2", "2025-01")]
    rows = read_results(out)
    assert [row["answer"] for row in rows] == ["good"] * 6
    assert len({row["key"] for row in rows}) == 6
    assert not list(out.glob("runs/*/*/.attempt-*"))
    # Made once more in this process, the numbers are those of the workers.
    for job, row in zip(second.jobs, rows, strict=True):
        run_job(job.to_dict(), str(tmp_path / "here"))
        assert row["key"] == job.key
    names = ("names", "values", "errors", "off_track", "tuned_track", "verdict")
    assert [[row[name] for name in names] for row in read_results(tmp_path / "here")] == [
        [row[name] for name in names] for row in rows
    ]
    assert (out / "classes" / "coasters.json").is_file()
    seen = command("fleet", "report", out, cwd=tmp_path)
    assert (seen.code, "6 jobs" in seen.out) == (0, True)


def test_the_command_says_jobs_and_time_and_writes_nothing(tmp_path: Path) -> None:
    make_logs(tmp_path, ("a1",), ("2025-01", "2025-02"))
    (tmp_path / "fleet.toml").write_text(QUICK, encoding="utf-8")
    ended = command("fleet", "run", "fleet.toml", "--out", "out", "--dry-run", "--workers", "2", cwd=tmp_path)
    assert ended.code == 0
    assert "2 jobs" in ended.out
    assert "on 2 workers" in ended.out
    told = command("fleet", "run", "fleet.toml", "--out", "out", "--dry-run", "--json", cwd=tmp_path).json()
    assert [(one["ship"], one["date"], one["done"]) for one in told["jobs"]] == [
        ("a1", "2025-01", False), ("a1", "2025-02", False)
    ]  # fmt: skip
    assert 0.0 < told["seconds_of_one_worker"][0] < told["seconds_of_one_worker"][1]
    assert not (tmp_path / "out").exists()
    wrong = command("fleet", "run", "fleet.toml", "--scheduler", "tls://x:1", cwd=tmp_path)
    assert (wrong.code, "--tls-ca" in wrong.err) == (2, True)


@pytest.mark.long
def test_reports_of_jobs_can_be_left_out_and_made_later(tmp_path: Path) -> None:
    make_logs(tmp_path, ("a1",), ("2025-01",))
    (tmp_path / "fleet.toml").write_text(QUICK, encoding="utf-8")
    ended = command("fleet", "run", "fleet.toml", "--out", "out", "--no-job-reports", "--workers", "1", cwd=tmp_path)
    assert ended.code == 0, ended.err
    (folder,) = (tmp_path / "out" / "runs").glob("*/*/*")
    assert (folder / "job.json").is_file()
    assert not (folder / "report.html").exists()
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "/report.html" not in page
    made = shlex.join(["mmgtune", "report", str(folder)])
    assert made in re.sub("</?span>", "", page)
    assert command(*shlex.split(made)[1:], cwd=tmp_path).code == 0
    assert command("fleet", "report", "out", cwd=tmp_path).code == 0
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert f'{folder.relative_to(tmp_path / "out")}/report.html"' in page


@pytest.mark.long
def test_two_fleets_do_not_mix_in_one_folder(tmp_path: Path) -> None:
    for of in "ab":
        make_logs(tmp_path / of, (f"{of}1",), ("2025-01",))
        (tmp_path / of / "fleet.toml").write_text(QUICK, encoding="utf-8")
    one, other = (tmp_path / of / "fleet.toml" for of in "ab")
    options, out = FleetOptions(workers=1, job_reports=False), tmp_path / "out"
    run_fleet(one, out, options)
    before = (out / "jobs.json").read_bytes()
    with pytest.raises(OutputError, match="that of another fleet"):
        run_fleet(other, out, options, resume=True)
    assert (out / "jobs.json").read_bytes() == before
    shutil.copytree(tmp_path / "b" / "logs" / "b1", tmp_path / "a" / "logs" / "a2")  # one more ship of the same fleet
    more = run_fleet(one, out, options, resume=True)
    assert [job.ship for job in more.jobs if job.key in more.ran] == ["a2"]
    assert more.document["jobs"]["others"] == 0
    shutil.rmtree(tmp_path / "a" / "logs" / "a1")  # and one that is sold: what is known of her is said to be hers
    fewer = run_fleet(one, out, options, resume=True)
    assert fewer.document["jobs"]["others"] == 1
    assert command("fleet", "report", out, cwd=tmp_path).code == 0
    assert "1 result is of jobs that the table does not have" in (out / "report.html").read_text(encoding="utf-8")


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="needs /proc to find the workers")
def test_killed_workers_and_a_killed_driver_lose_nothing(tmp_path: Path) -> None:
    make_logs(tmp_path, ("a1", "a2"), ("2025-01", "2025-02", "2025-03"))
    (tmp_path / "fleet.toml").write_text(QUICK, encoding="utf-8")
    out = tmp_path / "out"
    arguments = [sys.executable, "-m", "mmgtune", "fleet", "run", "fleet.toml", "--out", "out", "--workers", "2"]
    driver = subprocess.Popen(arguments, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    _until(lambda: _rows(out) >= 1)
    for worker in workers_of(driver.pid)[:1]:
        os.kill(worker, signal.SIGKILL)
    _until(lambda: _rows(out) >= 2 or driver.poll() is not None)
    workers = workers_of(driver.pid)
    driver.kill()
    driver.communicate(timeout=60)
    _until(lambda: not any(Path(f"/proc/{worker}").exists() for worker in workers))  # nobody stays behind
    done = _rows(out)
    ended = command(
        "fleet", "run", "fleet.toml", "--out", "out", "--resume", "--workers", "1", "--no-report", cwd=tmp_path
    )
    assert ended.code == 0, ended.err
    rows = read_results(out)
    assert done <= len(rows) == len({row["key"] for row in rows}) == 6
    assert {row["answer"] for row in rows} == {"good"}
    assert not list(out.glob("runs/*/*/.attempt-*"))


def test_workers_begin_with_the_environment_of_their_driver_as_it_is_now(monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("/one", "/other"):  # the process they are forked from has been there since the first
        monkeypatch.setenv("MMGTUNE_CACHE", folder)
        with pool_of(1) as workers:
            assert workers.submit(os.getenv, "MMGTUNE_CACHE").result() == folder


def _rows(out: Path) -> int:
    return len(list(out.glob("results/*/*/*.parquet")))


def _until(true: object, seconds: float = 120.0) -> None:
    ends = time.monotonic() + seconds
    while not true():  # type: ignore[operator]
        assert time.monotonic() < ends, "it took too long"
        time.sleep(0.1)


def test_a_job_whose_data_changed_fails_and_says_so(fleet: Path, tmp_path: Path) -> None:
    job = expand(read_table(fleet))[0]
    other = tmp_path / "logs" / "a1" / "2025-01" / "zigzag_20.parquet"
    other.write_bytes((tmp_path / "logs" / "a2" / "2025-01" / "zigzag_20.parquet").read_bytes())
    assert run_job(job.to_dict(), str(tmp_path / "out"))[1] == "failed"
    (row,) = read_results(tmp_path / "out")
    assert row["problems"][0]["what"] == "the data changed since the job was made"
    assert row["problems"][0]["why"] == "zigzag_20.parquet"


def test_every_command_can_be_a_job(tmp_path: Path) -> None:
    make_logs(tmp_path, ("a1",), ("2025-01",))
    trials = tmp_path / "logs" / "a1" / "2025-01"
    update_baseline("suzaku", trials, str(tmp_path / "a1.json"))
    few = 'targets = ["hull.R_0", "wake.w_P0"]'
    entries = {
        "check": 'baseline = "{ship}.json"',
        "sweep": f'options = {{ method = "least-squares", starts = 1, widths = [0.2, 0.3], {few} }}',
        "diagnose": f'options = {{ effects = ["rudder-offset"], {few} }}',
        "validate": "",
    }
    head = 'profile = "suzaku"\ntrials = "logs/{ship}/{date}"\n'
    texts = [f'[[jobs]]\ncommand = "{name}"\n{head}{more}\n' for name, more in entries.items()]
    (tmp_path / "fleet.toml").write_text("\n".join(["schema = 1", *texts]), encoding="utf-8")
    for job in expand(read_table(tmp_path / "fleet.toml")):
        run_job(job.to_dict(), str(tmp_path / "out"))
    rows = {row["name"]: row for row in read_results(tmp_path / "out")}
    assert set(rows) == set(entries)
    assert [one for one in rows.values() if one["problems"]] == []
    assert rows["check"]["answer"] == "good"
    assert rows["sweep"]["off_track"] > rows["sweep"]["tuned_track"]
    assert rows["sweep"]["names"] == ["hull.R_0", "wake.w_P0"]
    assert rows["validate"]["off_track"] == pytest.approx(rows["sweep"]["off_track"], rel=1e-3)
    for row in rows.values():
        assert (tmp_path / "out" / row["run"] / "report.html").is_file()
        assert json.loads((tmp_path / "out" / row["run"] / row["record"]).read_text())["kind"]
