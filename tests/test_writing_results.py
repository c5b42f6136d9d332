"""What the library leaves in a folder is what commands leave there, and replaces nothing unasked."""

import json

import pytest

import mmgtune
from mmgtune import run_files as names
from mmgtune.files import all_or_none, write_text
from mmgtune.writing_results import place_for, write_record
from tests.command import run

TRIALS = mmgtune.load_trials("suzaku")
TURN = TRIALS["turn_p35"]
SWEEP = mmgtune.SweepOptions(widths=(0.2, 0.3), method="least-squares", starts=1, targets=("hull.N_v",))


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Results of several kinds, and what writes them."""
    baseline = mmgtune.record_baseline("suzaku", TURN, ("J",))
    return {
        names.SWEEP: (mmgtune.sweep("suzaku", TURN, SWEEP), mmgtune.write_sweep),
        names.SIMULATION: (mmgtune.simulate("suzaku", TURN), mmgtune.write_simulation),
        names.VALIDATION: (mmgtune.validate("suzaku", TURN), mmgtune.write_validation),
        names.CHECKED: (mmgtune.check("suzaku", TURN, baseline), mmgtune.write_check),
        names.COMPARISON: (mmgtune.compare_profiles("suzaku", "suzaku_fam"), mmgtune.write_comparison),
    }


@pytest.mark.parametrize("name", [names.SWEEP, names.SIMULATION, names.VALIDATION, names.CHECKED, names.COMPARISON])
def test_every_result_is_written_alike(written, name, tmp_path):
    result, write = written[name]
    document = write(result, tmp_path)
    assert json.loads((tmp_path / name).read_text()) == json.loads(json.dumps(document))
    assert document["out"] == str(tmp_path)
    assert mmgtune.render(tmp_path)[0] == tmp_path / names.REPORT_HTML
    with pytest.raises(mmgtune.MmgtuneError, match="exists already"):
        write(result, tmp_path)
    write(result, tmp_path, overwrite=True)
    with pytest.raises(mmgtune.MmgtuneError):
        write(TURN, tmp_path / "of something else")
    with pytest.raises(mmgtune.MmgtuneError, match=write.__name__):
        mmgtune.render(result)


def test_a_sweep_is_written_as_the_command_writes_it(written, tmp_path):
    mmgtune.write_trial(TURN, tmp_path / "one.parquet")
    asked = ("--ar", "0.2,0.3", "--method", "least-squares", "--starts", "1", "--targets", "hull.N_v", "--no-report")
    assert run("sweep", "-t", "one.parquet", *asked, "--out", "typed", cwd=tmp_path).code == 0
    mmgtune.write_sweep(written[names.SWEEP][0], tmp_path / "called")
    typed, called = (
        sorted(str(path.relative_to(tmp_path / of)) for path in (tmp_path / of).rglob("*") if path.is_file())
        for of in ("typed", "called")
    )
    assert typed == called
    runs = [json.loads((tmp_path / of / names.SWEEP).read_text())["runs"] for of in ("typed", "called")]
    for one in (row for of in runs for row in of):
        del one["wall_s"]
    assert runs[0] == runs[1]


def test_of_a_result_that_cannot_be_written_nothing_stays(tmp_path):
    def write():
        with place_for(TURN, mmgtune.Trial, tmp_path, names.FIT, overwrite=False) as place:
            with all_or_none():
                write_text(place / names.PROFILE, "a part that is whole")
            write_record({"schema": 1}, place, names.FIT)
            raise RuntimeError

    with pytest.raises(RuntimeError):
        write()
    assert not list(tmp_path.iterdir())
