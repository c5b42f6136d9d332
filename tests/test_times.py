"""What is said of how long tests take is of tests that there are, and told by all processes that run them."""

from types import SimpleNamespace

from tests import times


def test_every_file_that_is_listed_is_there():
    assert {
        name for name in map(times.file_of, times.read()) if not (times.FILE.parent.parent / name).exists()
    } == set()


def test_names_say_nothing_of_the_machine_they_were_written_on():
    assert [name for name in times.read() if str(times.FILE.parents[1]) in name] == []


def test_what_took_long_is_written(tmp_path, monkeypatch):
    monkeypatch.setattr(times, "FILE", tmp_path / "times.json")
    assert times.read() == {}
    writer = times.Writer()
    for name, when, seconds in (
        ("tests/a.py::one[x@y]@tests/a.py", "setup", 2.04),  # as a worker calls it
        ("tests/a.py::one[x@y]@tests/a.py", "call", 0.15),
        ("tests/a.py::one[x@y]@tests/a.py", "teardown", 0.1),
        ("tests/a.py::two", "setup", 0.01),
        ("tests/a.py::two", "call", 0.03),
        ("tests/b.py::three@group", "call", 3.0),
    ):
        writer.pytest_runtest_logreport(SimpleNamespace(nodeid=name, when=when, duration=seconds))
    writer.pytest_sessionfinish()
    assert times.read() == {"tests/a.py": 2.04, "tests/a.py::one[x@y]": 0.25, "tests/b.py::three": 3.0}


def test_a_test_begins_with_what_is_made_for_its_folder():
    taken = {"tests/a/b.py": 2.0, "tests/a/c.py": 7.0, "tests/a/c.py::one": 9.0, "tests/d.py": 8.0}
    assert times.beginning(taken, "tests/a") == 7.0
    assert times.beginning(taken, "tests/a/b.py") == 2.0
    assert times.beginning(taken, "tests/e") == 0.0
