"""NMEA 0183 logs whose sensors are others than usual: which sentence is taken, and what is said of that."""

import numpy as np
import pytest

from mmgtune.importing import import_logs, load_map, propose_map
from mmgtune.units import KNOT

from .made import nmea, sentence, turn

VARIATION = -7.5


def log_of(tmp_path, others, more=()):
    """The log of a turn, each kind of sentence as ``others`` makes it of its fields, and ``more`` behind each fix."""
    lines = []
    for line in nmea(turn()):
        kind, fields = line[3:6], line.split("*")[0].split(",")[1:]
        made = others[kind](fields) if kind in others else line[1:].split("*")[0]
        lines += [sentence(made)] if made else []
        lines += [sentence(one) for one in more] if kind == "GGA" else []
    log = tmp_path / "log.nmea"
    log.write_text("\n".join(lines), encoding="ascii")
    return log


def imported(log):
    return import_logs([log], load_map("nmea-0183", preset=True), ".", dry_run=True).trials[0]


def gns(f):
    return f"GNGNS,{','.join(f[:5])},AAN,12,0.9,10.0,38.0,,"


def hdg(f):
    return f"HCHDG,{(float(f[0]) - VARIATION) % 360.0:.5f},,,{abs(VARIATION)},W"


def htd(f):
    angle = float(f[0])
    return f"AGHTD,A,{abs(angle):.5f},{'R' if angle > 0.0 else 'L'},M,N,35.0,,,,,,,T,A,A,A,254.7"


def test_sentences_that_stand_in_say_the_same(tmp_path):
    others = {"GGA": gns, "HDT": hdg, "RSA": htd, "VTG": lambda f: ""}
    log = log_of(tmp_path, others)
    back, trial = imported(log), turn()
    assert np.abs(back.psi - trial.psi)[:-1].max() < 1e-3
    assert back.delta == pytest.approx(trial.delta, abs=1e-5)
    assert np.abs(back.x - (trial.x - trial.x[0])).max() < 2e-3
    assert "the one ordered is taken (HTD)" in back.note
    assert "that of a magnetic compass is taken (HDG), with what HDG says" in back.note
    proposal = propose_map([log])
    assert proposal.imported == 1
    assert "(HTD)" in proposal.notes[1]
    assert "(HDG)" in proposal.notes[2]


def test_a_rudder_order_and_a_compass_without_variation(tmp_path):
    others = {"HDT": lambda f: f"HCHDM,{float(f[0]):.5f},M", "RSA": lambda f: f"AGROR,{f[0]},A,,,B"}
    back, trial = imported(log_of(tmp_path, others)), turn()
    assert np.abs(back.psi - trial.psi)[:-1].max() < 1e-3
    assert back.delta == pytest.approx(trial.delta, abs=1e-5)
    assert "(ROR)" in back.note
    assert "(HDM), without variation" in back.note


def test_the_speeds_of_a_log_are_those_of_the_ship(tmp_path):
    """Along and abeam over ground, starboard positive, where no receiver says a velocity."""
    trial = turn()
    speeds = iter(zip(trial.u / KNOT, trial.v_m / KNOT, strict=True))

    def vbw(f):
        u, v = next(speeds)
        return f"VDVBW,9.9,9.9,A,{u:.6f},{v:.6f},A"

    back = imported(log_of(tmp_path, {"VTG": vbw}))
    assert np.abs(back.u - trial.u)[:-1].max() < 1e-3
    assert np.abs(back.v_m - trial.v_m)[:-1].max() < 1e-3
    assert "u and v were not measured" not in back.note


def test_what_others_are_believed_for_is_left_out_and_said(tmp_path):
    more = ("VDVBW,9.9,9.9,A,9.9,9.9,A", "HCHDM,11.1,M", "AGHTD,A,33.0,R,M,N,35.0,,,,,,,T,A,A,A,254.7")
    back, trial = imported(log_of(tmp_path, {}, more)), turn()
    assert np.abs(back.u - trial.u)[:-1].max() < 1e-3
    assert np.abs(back.psi - trial.psi)[:-1].max() < 1e-3
    assert back.delta == pytest.approx(trial.delta, abs=1e-5)
    for words in (
        "VBW left out: the velocity is that of VTG",
        "HDM left out: the heading is that of HDT",
        "HTD left out: the rudder angle is that of RSA",
    ):
        assert words in back.note


@pytest.mark.parametrize(
    ("sounded", "depth"),
    [
        ("SDDPT,20.0,4.5,", 24.5),
        ("SDDPT,20.0,-1.5,", None),
        ("SDDPT,20.0,", None),
        ("SDDBS,65.6,f,20.0,M,10.9,F", 20.0),
    ],
)
def test_the_depth_is_that_of_the_water(tmp_path, sounded, depth):
    """Below the keel, or a transducer whose own depth is not said, is not the depth of the water."""
    back = imported(log_of(tmp_path, {}, (sounded,)))
    assert ("depth" in back.extra) == (depth is not None)
    if depth is not None:
        assert back.extra["depth"] == pytest.approx(depth)


@pytest.mark.parametrize("broken", ["HCHDG,11.1,2.0,X,,", "AGHTD,A,12.0,Q,M,N", "SDDPT,x,1.0", "VDVBW,1,1,A,x,0.0,A"])
def test_a_damaged_sentence_is_dropped(tmp_path, broken):
    alone = {"HDG": "HDT", "HTD": "RSA", "DPT": "", "VBW": "VTG"}[broken[2:5]]
    whole = {"HDT": hdg, "RSA": htd}
    others = {alone: whole[alone]} if alone in whole else {alone: lambda f: ""} if alone else {}
    back = imported(log_of(tmp_path, others, (broken,)))
    assert f"are not as the standard says and were dropped: 400 {broken[2:5]}" in back.note
