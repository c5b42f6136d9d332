"""JSON that is read: nothing is said twice in it."""

import json
from dataclasses import replace

import pyarrow.parquet as pq
import pytest

import mmgtune
from mmgtune.checking import read_baseline, record_baseline, write_baseline
from mmgtune.documents import RepeatedKey, parsed
from mmgtune.errors import MmgtuneError, OptionError, TrialError
from mmgtune.fitting import FitOptions, fit, write_run
from mmgtune.fitting.pooled import read_sisters
from mmgtune.particles import KEY, save_particles
from mmgtune.report import render
from mmgtune.trial import load_trials, write_trial
from mmgtune.trial.parquet import METADATA_KEY, read_trial

SAID = "the key 'schema' is written twice in one object"


def twice(path):
    """The file with the first key of its object written once more."""
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("{", '{"schema": 7, ', 1), encoding="utf-8")


def test_a_key_counts_once_in_each_object():
    assert parsed('{"a": 1, "b": {"a": 2}, "c": [{"a": 1}, {"a": 1}]}') == {
        "a": 1,
        "b": {"a": 2},
        "c": [{"a": 1}, {"a": 1}],
    }
    for text in ('{"a": 1, "a": 1}', b'[{"b": {"x": 1, "a": 1, "a": 2}}]'):
        with pytest.raises(RepeatedKey, match="the key 'a' is written twice in one object"):
            parsed(text)


def test_a_trial_that_says_something_twice_is_refused(tmp_path):
    trial = load_trials("suzaku")["turn_p35"]
    path = write_trial(replace(trial, note="one"), tmp_path / "a.parquet")
    table = pq.read_table(path)
    facts = table.schema.metadata[METADATA_KEY].replace(b"{", b'{"ship": "kvlcc2", ', 1)
    pq.write_table(table.replace_schema_metadata({**table.schema.metadata, METADATA_KEY: facts}), path)
    with pytest.raises(TrialError, match="the key 'ship' is written twice") as caught:
        read_trial(path)
    assert len(caught.value.problems) == 1


def test_records_that_say_something_twice_are_refused(tmp_path):
    options = FitOptions(a_r=0.5, method="least-squares", starts=1, targets=("hull.R_0",))
    write_run(fit("suzaku", "suzaku", options), tmp_path)
    twice(tmp_path / "fit.json")
    with pytest.raises(OptionError, match=SAID):
        render(tmp_path)
    write_baseline(record_baseline("suzaku", "suzaku"), tmp_path / "check.json")
    twice(tmp_path / "check.json")
    with pytest.raises(OptionError, match=SAID):
        read_baseline(tmp_path / "check.json")
    sisters = {"schema": 1, "kind": "sister-class", "name": "one", "members": {}}
    (tmp_path / "sisters.json").write_text(json.dumps(sisters), encoding="utf-8")
    twice(tmp_path / "sisters.json")
    with pytest.raises(MmgtuneError, match=SAID):
        read_sisters(tmp_path / "sisters.json", "suzaku")


def test_particles_that_say_something_twice_are_refused(tmp_path):
    few = mmgtune.PosteriorOptions(particles=10, leave_out=False)
    path = tmp_path / "particles.parquet"
    save_particles(mmgtune.posterior("suzaku", "suzaku", few).particles, path)
    table = pq.read_table(path)
    facts = table.schema.metadata[KEY].replace(b"{", b'{"schema": 1, ', 1)
    pq.write_table(table.replace_schema_metadata({**table.schema.metadata, KEY: facts}), path)
    with pytest.raises(MmgtuneError, match=SAID):
        mmgtune.load_particles(path)
