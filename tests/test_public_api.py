"""The library as a notebook user meets it."""

import re
from dataclasses import replace

import mmgtune


def test_everything_listed_can_be_had_twice():
    for name in mmgtune.__all__:
        first, second = getattr(mmgtune, name), getattr(mmgtune, name)
        assert first is second
        assert callable(first)


def test_from_profile_to_verdict(tmp_path):
    profile = mmgtune.load_profile("suzaku")
    trials = mmgtune.load_trials("suzaku")
    result = mmgtune.fit(profile, trials, mmgtune.FitOptions(a_r=0.5, method="least-squares", starts=2))
    assert "4 of 4 of these trials improve" in result.verdict()
    motion = mmgtune.simulate(result.tuned_profile(), [trials.trials["turn_p35"]])[0]
    assert not motion.diverged
    mmgtune.write_run(result, tmp_path / "run")
    report = mmgtune.render(tmp_path / "run")[0]
    assert report.name == "report.html"
    off = re.match(
        r"On 4 trials not used .* is ([\d.]+ m) off track and ([\d.]+°) off heading instead", result.verdict()
    )
    assert off is not None  # the sentence begins with what a seaman can picture, and with the numbers of the cards
    assert all(f"→ {size}" in report.read_text(encoding="utf-8") for size in off.groups())
    one, *others = result.compared
    lost = replace(one.records["after"], motion=replace(one.motions["after"], diverged=True))
    failed = replace(one, role="test", records={**one.records, "after": lost})
    worse = replace(result, compared=[failed, *others]).verdict()
    assert "; it diverges on 1 of " in worse  # and not that there were no test trials
    assert "no test trials" not in worse


def test_a_manoeuvre_of_a_bundled_ship_and_its_forces():
    motion = mmgtune.run_manoeuvre("suzaku", mmgtune.TurningOrder(0.6), longest=60.0)
    assert mmgtune.breakdown("suzaku", motion.states, motion.controls).total.X.shape == motion.t.shape
