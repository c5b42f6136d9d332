"""Logs where trials are expected: the answer is the commands that make trials of them, and these can be pasted."""

import shlex

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mmgtune import resources
from mmgtune.errors import TrialError
from mmgtune.trial import load_trials, load_voyages
from tests.command import run

PRESET = (resources.import_maps() / "simman-marin.toml").read_text(encoding="utf-8")
LOG = "time,x,y\n0,0,0\n1,2,0\n"


def commands(fix):
    """The commands in a fix, as a shell splits them."""
    return [shlex.split(part.partition(", ")[0]) for part in fix.split("mmgtune ")[1:]]


@pytest.fixture
def folder(tmp_path):
    """A folder whose name needs quoting, with two logs and a text that is none."""
    where = tmp_path / "my logs"
    where.mkdir()
    for name in ("a.csv", "b.csv"):
        (where / name).write_text(LOG)
    (where / "README.txt").write_text("about them\n")
    return where


def test_a_folder_of_logs_is_answered_with_commands(folder):
    with pytest.raises(TrialError) as caught:
        load_trials(folder)
    (problem,) = caught.value.problems
    assert problem.what == "the folder holds logs, not trials"
    mapping, importing = commands(problem.fix)
    assert mapping == ["trials", "map", f"{folder}/*.csv", "-o", "map.toml"]
    assert importing == ["trials", "import", f"{folder}/*.csv", "--map", "map.toml", "-o", "imported"]
    assert "'/*.csv" in problem.fix  # the star is for the shell, outside of the quotes


@pytest.mark.parametrize("load", [load_trials, load_voyages])
def test_so_is_a_single_log(folder, load):
    with pytest.raises(TrialError, match=r"mmgtune trials map '.*a\.csv' -o map\.toml"):
        load(folder / "a.csv")


@pytest.mark.parametrize("of", [PRESET, 'schema = 1\n[log]\ndecimal = ","\n[trial]\nship = "a"\n[columns]\n'])
def test_a_map_beside_logs_is_no_trial(of, folder):
    (folder / "map.toml").write_text(of)
    with pytest.raises(TrialError) as caught:
        load_trials(folder)
    (problem,) = caught.value.problems
    assert problem.what == "the folder holds logs, not trials"
    with pytest.raises(TrialError) as caught:
        load_trials(folder / "map.toml")
    (problem,) = caught.value.problems
    assert problem.what == "'map.toml' is a map of logs, not a trial"
    (importing,) = commands(problem.fix)
    assert importing[-4:] == ["--map", f"{folder}/map.toml", "-o", "imported"]


def test_a_file_that_only_is_called_parquet_too(tmp_path):
    (tmp_path / "log.parquet").write_text(LOG)
    with pytest.raises(TrialError, match="not Parquet") as caught:
        load_trials(tmp_path)
    assert "mmgtune trials map" in caught.value.problems[0].fix


@pytest.mark.parametrize("load", [load_trials, load_voyages])
def test_parquet_with_the_columns_of_a_log_is_one(load, tmp_path):
    write_parquet(tmp_path / "a.parquet")
    for given in (tmp_path, tmp_path / "a.parquet"):
        with pytest.raises(TrialError) as caught:
            load(given)
        (problem,) = caught.value.problems
        assert problem.what == "'a.parquet' is a log, not a trial"
        assert commands(problem.fix)[0] == ["trials", "map", f"{tmp_path}/a.parquet", "-o", "map.toml"]
    write_parquet(tmp_path / "b.parquet")
    with pytest.raises(TrialError) as caught:
        load(tmp_path)
    (problem,) = caught.value.problems
    assert problem.what == "the folder holds logs, not trials"
    assert commands(problem.fix)[1][2] == f"{tmp_path}/*.parquet"


def test_a_trial_that_lacks_a_column_is_still_one(tmp_path):
    whole = pq.read_table(resources.folder("trials") / "suzaku" / "turn_p35.parquet")
    pq.write_table(whole.drop_columns(["delta"]).replace_schema_metadata(None), tmp_path / "a.parquet")
    with pytest.raises(TrialError, match="column 'delta' is missing"):
        load_trials(tmp_path)


def write_parquet(path):
    columns = {name: [0.0, 1.0, 2.0] for name in ("Time", "Lat", "Lon", "HDG", "SOG", "Rudder", "RPM")}
    pq.write_table(pa.table(columns), path)


def test_an_empty_folder_and_one_of_texts_are_not_taken_for_logs(tmp_path):
    (tmp_path / "README.txt").write_text("nothing here\n")
    with pytest.raises(TrialError, match="no trial files"):
        load_trials(tmp_path)


@pytest.mark.parametrize("command", ["fit", "validate", "leave-out", "diagnose"])
def test_commands_say_it(command, folder, tmp_path):
    given = ("suzaku", str(folder)) if command == "validate" else ("-p", "suzaku", "-t", str(folder))
    said = run(command, *given, cwd=tmp_path)
    assert said.code == 2
    assert "mmgtune trials map" in " ".join(said.err.split())
