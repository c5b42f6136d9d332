"""Validations on voyages that were stopped: continued, they come to the same bytes."""

import json
import signal
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.errors import OptionError
from mmgtune.run_files import JOURNAL
from mmgtune.trial import write_trial
from mmgtune.voyages import Hooks, VoyageOptions, validate_voyages, write_voyages
from mmgtune.voyages import run as running
from mmgtune.voyages.part import noted, recalled
from tests.cli.test_interrupts import ended
from tests.command import run
from tests.voyages.conftest import rows

CLOCK = {"created", "wall_s", "command", "out"}
TABLES = ("windows.parquet", "drawn.parquet")


@pytest.fixture(scope="module")
def logs(voyage, tmp_path_factory):
    """Three voyages, one of them shorter, and wind in one."""
    folder = tmp_path_factory.mktemp("voyages") / "logs"
    wind = {"wind_speed": np.full(voyage.n_samples, 5.0), "wind_dir": np.ones(voyage.n_samples)}
    write_trial(replace(voyage, id="a"), folder / "a.parquet")
    write_trial(replace(rows(voyage, slice(0, 4000)), id="b"), folder / "b.parquet")
    write_trial(replace(voyage, id="c", extra=wind), folder / "c.parquet")
    return folder


def document(folder):
    """The result without what may differ between two runs."""
    found = json.loads((folder / "voyages.json").read_text(encoding="utf-8"))
    return {key: value for key, value in found.items() if key not in CLOCK}


def same(one, other):
    assert document(one) == document(other)
    for name in TABLES:
        assert (one / name).read_bytes() == (other / name).read_bytes()


def test_a_stopped_validation_goes_on_behind_the_last_finished_voyage(logs, tmp_path, monkeypatch):
    monkeypatch.setattr(running, "AT_ONCE", 1300)  # several portions a voyage
    profiles, options = {"one": "suzaku", "other": "kvlcc2"}, VoyageOptions(restart=100.0)
    write_voyages(validate_voyages(profiles, logs, options), tmp_path / "whole")
    told: list[str] = []
    hooks = Hooks(on_progress=lambda *words: told.append(words[2]), stop=lambda: "c" in told)
    cut = validate_voyages(profiles, logs, options, hooks=hooks, folder=tmp_path)
    assert cut.interrupted
    write_voyages(cut, tmp_path)
    assert len((tmp_path / JOURNAL).read_text().splitlines()) == 1 + 2  # what it belongs to, a and b
    with pytest.raises(OptionError, match=r"different now: restart \(None, was 100.0\)"):
        validate_voyages(profiles, logs, folder=tmp_path, resume=True)
    scored: list[int] = []
    real = running.windows_of
    monkeypatch.setattr(running, "windows_of", lambda trials: scored.append(len(trials)) or real(trials))
    resumed = validate_voyages(profiles, logs, options, folder=tmp_path, resume=True)
    assert sum(scored) == resumed.logs[2].windows + len(resumed.drawn)  # those of c alone, and those that are drawn
    write_voyages(resumed, tmp_path, overwrite=True)
    assert not (tmp_path / JOURNAL).exists()
    same(tmp_path, tmp_path / "whole")


def test_a_voyage_that_changed_is_scored_anew(logs, voyage, tmp_path):
    write_trial(replace(voyage, id="a"), tmp_path / "logs" / "a.parquet")
    write_trial(replace(voyage, id="b"), tmp_path / "logs" / "b.parquet")
    told: list[str] = []
    hooks = Hooks(on_progress=lambda *words: told.append(words[2]), stop=lambda: "b" in told)
    validate_voyages("suzaku", tmp_path / "logs", hooks=hooks, folder=tmp_path)
    (tmp_path / "logs" / "a.parquet").unlink()
    write_trial(replace(rows(voyage, slice(0, 3700)), id="a"), tmp_path / "logs" / "a.parquet")
    resumed = validate_voyages("suzaku", tmp_path / "logs", folder=tmp_path, resume=True)
    assert [log.counted.rows for log in resumed.logs] == [3700, voyage.n_samples]


def test_what_is_noted_is_recalled_to_the_last_bit(logs):
    found = []
    real = running.score_voyage

    def seen(*given):
        found.append(real(*given))
        return found[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(running, "score_voyage", seen)
        validate_voyages("suzaku_fam", logs)
    for part in found:
        assert noted(recalled(json.loads(json.dumps(noted(part), allow_nan=False)))) == noted(part)
    assert found[2].around  # the model acts on wind


def test_killed_in_the_middle_and_resumed(logs, tmp_path):
    command = ("validate", "suzaku", "kvlcc2", logs, "--no-report", "--quiet")
    whole = run(*command, "--out", "whole", cwd=tmp_path)
    assert whole.code == 0, whole.err
    before = "import mmgtune.cli.progress as p; p.Progress.on_share = lambda self, a, b, id: id == 'c' and sent()"
    arguments = [str(one) for one in (*command, "--out", "run")]
    killed = ended(tmp_path, *arguments, number=signal.SIGKILL, before=before)
    assert killed.returncode == -signal.SIGKILL
    assert not (tmp_path / "run" / "voyages.json").exists()
    again = run(*command, "--out", "run", cwd=tmp_path)
    assert again.code == 2
    assert "exists already" in again.err
    resumed = run(*command, "--out", "run", "--resume", cwd=tmp_path)
    assert resumed.code == 0, resumed.err
    same(tmp_path / "run", tmp_path / "whole")
    assert {one.name for one in (tmp_path / "run").iterdir()} == {"voyages.json", *TABLES}
    nothing = run(*command, "--out", "run", "--resume", cwd=tmp_path)
    assert nothing.code == 2
    assert "nothing to resume" in nothing.err


@pytest.mark.long
def test_ctrl_c_says_how_to_go_on(logs, tmp_path):
    before = "import mmgtune.cli.progress as p; p.Progress.on_share = lambda self, a, b, id: id == 'b' and sent()"
    arguments = ("validate", "suzaku", str(logs), "--no-report", "--quiet", "--out", "run")
    stopped = ended(tmp_path, *arguments, before=before)
    assert stopped.returncode == 130
    assert stopped.stderr.splitlines()[-1] == (
        "interrupted: what is done so far is in run; --resume --out run continues"
    )
    assert document(tmp_path / "run")["interrupted"]
    resumed = run(*arguments, "--resume", cwd=tmp_path)
    assert resumed.code == 0, resumed.err
    assert not document(tmp_path / "run")["interrupted"]


def test_resume_is_asked_for_with_its_folder(logs, tmp_path):
    ended = run("validate", "suzaku", logs, "--resume", cwd=tmp_path)
    assert ended.code == 2
    assert "--resume needs the folder" in ended.err
