"""``mmgtune predict`` as a user runs it."""

from __future__ import annotations

import pytest

from mmgtune.networks import save_network
from tests.command import run, typed
from tests.networks.made import network


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    """A network of twenty-one members, and a list of orders."""
    folder = tmp_path_factory.mktemp("desk")
    save_network(network(members=21, size=0.05, step=1.0), folder / "model.safetensors")
    (folder / "orders.csv").write_text("t [s], delta [deg], n [rpm]\n0, 0, 600\n5, 35, 600\n60, 0, 0\n90,,\n")
    return folder


APPROACH = ("--speed", "1 m/s", "--rpm", "600")


def test_turn_with_a_band(desk):
    arguments = "predict", "model.safetensors", "--turn", "35", *APPROACH, "--out", "foretold", "--keep-particles"
    ended = run(*arguments, "--json", cwd=desk)
    assert ended.code == 0, ended.err
    document = ended.json()
    assert (document["kind"], document["particles"], document["has_band"]) == ("predict", 21, True)
    for name in ("predict.json", "bands.parquet", "tracks.parquet", "paths.parquet", "report.html", "report.md"):
        assert (desk / "foretold" / name).is_file()
    again = run(*arguments, cwd=desk)
    assert again.code == 2
    assert "exists" in again.err
    assert run(*arguments, "--force", "--no-report", cwd=desk).code == 0
    assert run("report", "foretold", cwd=desk).code == 0


def test_a_list_of_orders_on_the_console(desk):
    ended = run("predict", "model.safetensors", "orders.csv", *APPROACH, cwd=desk)
    assert ended.code == 0, ended.err
    assert "21 particles" in ended.out
    assert "± half the band of 90 %" in ended.out
    assert "orders  (3 orders of orders.csv, 90 s" in ended.out
    assert "at the end: north" in ended.out or "advance" in ended.out
    assert "no steering gear" in ended.err


def test_a_profile_and_a_hybrid_say_that_they_have_no_band(tmp_path):
    ended = run("predict", "suzaku", "--turn", "35", cwd=tmp_path)
    assert ended.code == 0, ended.err
    assert "there is no band" in ended.err
    assert "learn rnn" in ended.err
    assert "advance" in ended.out
    assert "±" not in ended.out.replace("± half", "")
    hybrid = run("predict", "esso_osaka_3m_hybrid", "--turn", "35", "--json", cwd=tmp_path)
    assert hybrid.code == 0, hybrid.err
    (turn,) = hybrid.json()["runs"]
    assert turn["indices"][0]["mean"] > 0.0
    assert turn["indices"][0]["half_width"] is None


@pytest.mark.parametrize("asked", [("--turn", "35"), ("--trials", "suzaku")])
def test_the_report_of_a_model_without_a_band_says_so_once_and_speaks_of_none(tmp_path, asked):
    ended = run("predict", "suzaku", *asked, "--out", "run", cwd=tmp_path)
    assert ended.code == 0, ended.err
    lines = (tmp_path / "run" / "report.md").read_text(encoding="utf-8").splitlines()
    told = [line for line in lines if "there is no band" not in line]
    assert len(told) == len(lines) - 1
    assert told[2] == "suzaku · one model, no band"
    spoken = "\n".join(told[3:])
    assert not [word for word in ("particle", "band", "never reach it", "holds", "L\\_Maha") if word in spoken]
    assert "| index | foretold | in ship lengths |" in spoken


def test_trials_and_their_scores(tmp_path):
    ended = run("predict", "suzaku_fam", "-t", "suzaku", "--restart", "100", cwd=tmp_path)
    assert ended.code == 0, ended.err
    assert "measured" in ended.out
    assert ended.out.rstrip().splitlines()[-1].startswith("all  L_fit")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("suzaku", "nowhere.csv"), "nowhere.csv"),
        (("nowhere",), "nowhere"),
        (("suzaku", "--turn", "0.6"), "--turn"),
        (("suzaku", "--astern", "60"), "--astern"),
        (("suzaku", "--restart", "60"), "--restart"),
        (("suzaku", "-t", "suzaku", "--turn", "35"), "own inputs"),
        (("suzaku", "--level", "0.9"), "--level"),
        (("suzaku", "--sampling", "TS2"), "did you mean"),
        (("suzaku", "--sampling", "TS1"), "--sampling"),
        (("suzaku", "--particles", "0"), "--particles"),
        (("suzaku", "--keep-particles"), "--keep-particles"),
        (("suzaku", "--force"), "--force"),
    ],
)
def test_wrong_arguments(arguments, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ended = typed("predict", *arguments)
    assert ended.code == 2
    assert said in ended.err
    assert "Traceback" not in ended.err
