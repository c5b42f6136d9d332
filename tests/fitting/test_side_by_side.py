"""Work done side by side: in order, on one core each, and remembered piece by piece."""

import sys
import time
from functools import partial

import pytest

from mmgtune import threads
from mmgtune.errors import OptionError
from mmgtune.fitting.journal import _line, _parsed, journalled, remembered, side_by_side
from mmgtune.run_files import JOURNAL
from mmgtune.threads import free_cores, on_threads

done = []


@remembered(lambda number: [number], lambda found: found, lambda noted: noted)
def work(number):
    """Something that takes a while, the sooner numbers longest."""
    time.sleep(0.0003 * (5 - number % 5))
    done.append(number)
    return 10 * number


def piece(first, n):
    return [work(first + k) for k in range(n)]


def run(folder, resume=False, other=0, stop=lambda: False):
    """A run of work on its own, thrice three pieces side by side, and more; what came of it, and what was done."""
    done.clear()
    with journalled(folder, {"run": "this"}, stop, resume=resume):
        found = [work(1)]
        for first in (100, 200 + other, 300):
            found += side_by_side([partial(piece, first + 10 * k, 1 + k) for k in range(3)])
            found.append(work(first + 50))
    return found, sorted(done)


@pytest.fixture(params=[1, 2])
def cores(request, monkeypatch):
    monkeypatch.setattr("mmgtune.fitting.journal.cores", lambda: request.param)


@pytest.mark.usefixtures("cores")
def test_a_run_cut_anywhere_goes_on(tmp_path):
    whole, everything = run(tmp_path / "whole")
    assert whole[1:4] == [[1000], [1100, 1110], [1200, 1210, 1220]]
    lines = (tmp_path / "whole" / JOURNAL).read_text().splitlines(keepends=True)
    assert len(lines) == 1 + len(everything)
    for kept in range(1, len(lines), 2):
        folder = tmp_path / str(kept)
        folder.mkdir()
        (folder / JOURNAL).write_text("".join(lines[:kept]) + lines[kept][:9])
        found, again = run(folder, resume=True)
        assert found == whole
        assert len(again) == len(lines) - kept  # nothing is done twice
        assert run(folder, resume=True) == (whole, [])


@pytest.mark.usefixtures("cores")
def test_what_a_run_did_otherwise_is_forgotten(tmp_path):
    run(tmp_path)
    other, everything = run(tmp_path / "other", other=3)
    found, again = run(tmp_path, resume=True, other=3)
    assert found == other
    assert again == [number for number in everything if number > 200]
    assert run(tmp_path, resume=True, other=3) == (other, [])


def test_a_piece_that_went_another_way_leaves_the_others_alone(tmp_path):
    def pieces(second, resume):
        done.clear()
        with journalled(tmp_path, {}, lambda: False, resume=resume):
            found = side_by_side([partial(piece, first, 3) for first in (10, second, 30)])
            return found, work(1)

    pieces(20, resume=False)
    found, last = pieces(40, resume=True)
    assert (found, last) == ([[100, 110, 120], [400, 410, 420], [300, 310, 320]], 10)
    assert sorted(done) == [1, 40, 41, 42]
    assert pieces(40, resume=True) == (found, 10)
    assert not done


def test_a_run_that_is_stopped_again_keeps_what_was_there(tmp_path):
    whole, _ = run(tmp_path)
    run(tmp_path, resume=True, other=3, stop=lambda: True)
    assert run(tmp_path, resume=True) == (whole, [])


def test_entries_that_say_nonsense_are_not_believed(tmp_path):
    whole, everything = run(tmp_path)
    path = tmp_path / JOURNAL
    lines = path.read_text().splitlines(keepends=True)
    for among in ("many", [], [1], [1, "2"], {"1": 2}):
        entry = _parsed(lines[2].partition(" ")[2])
        path.write_text("".join([*lines[:2], _line({**entry, "among": among}), *lines[3:]]))
        assert run(tmp_path, resume=True) == (whole, everything[1:])


def test_results_come_in_order_each_piece_with_a_core_of_its_own():
    def slow(k):
        time.sleep(0.01 * (4 - k))
        return k, free_cores()

    before = sys.getswitchinterval()
    assert on_threads([partial(slow, k) for k in range(4)], 2) == [(k, 1) for k in range(4)]
    assert sys.getswitchinterval() == before
    assert free_cores() == threads.cores()


def test_the_interpreter_is_shared_as_before_once_all_are_through():
    """Of two that overlap the second took what the first had set for what is usual."""
    before = sys.getswitchinterval()
    first, second = threads._SHARED, threads._SHARED
    first.__enter__()
    second.__enter__()
    first.__exit__()
    assert sys.getswitchinterval() == pytest.approx(threads.QUICKLY)
    second.__exit__()
    assert sys.getswitchinterval() == before


def test_what_a_piece_raises_comes_out_and_the_rest_is_not_begun():
    begun = []

    def bad(k):
        begun.append(k)
        time.sleep(0.01)
        if k == 0:
            raise OptionError
        return k

    with pytest.raises(OptionError):
        on_threads([partial(bad, k) for k in range(50)], 2)
    assert len(begun) < 50


def test_within_a_piece_all_is_done_one_by_one():
    def outer():
        return side_by_side([free_cores, free_cores])

    assert side_by_side([outer, outer]) == [[1, 1], [1, 1]]
