"""The report's small parts: numbers as words, thinning, headings."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmgtune.diagnose.bench.hypotheses import known_causes, of_runs
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import load_profile
from mmgtune.report import advice, band_scores, confidence, html, load, motion_block, tables, wording
from mmgtune.report.blocks import Fold, Motions, Page, Picture, Section, Table
from mmgtune.report.common import cards_of_misfit
from mmgtune.report.figures import fleet_figures, motions, svg, ticks, tracks
from mmgtune.report.figures.plot import Axis, Bar, Dots, Figure, Line, Look, Panel, Words
from mmgtune.report.html import embedded
from mmgtune.report.markdown import escaped
from mmgtune.report.pages import check_page, diagnosis_page, learning_page, models_page
from mmgtune.report.pages.kinds import KINDS
from mmgtune.trial import load_trials


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.017, "0.017"), (-2.0, "−2"), (14230.4, "14\u202f230"), (1234.5, "1234"), (250.04, "250.0"), (1e-6, "1e−6"),
        (1.5e12, "1.5e12"), (123456789.0, "123\u202f500\u202f000"), (0.0, "0"), (None, "–"), (math.nan, "–"),
        (math.inf, "–"), (True, "–"), ("x", "–"),
    ],
)  # fmt: skip
def test_shown(value: object, text: str) -> None:
    assert wording.shown(value) == text


@pytest.mark.parametrize(("share", "size"), [(1e4, "100 times the noise"), (0.5, "50\u00a0%")])
def test_an_error_over_the_noise_says_of_which_trials_and_noise(tmp_path: Path, share: float, size: str) -> None:
    left = {"share_of_noise_variance": share, "structured": True, "correlation": {}}
    data = {
        "unexplained": {**left, "largest_share_by_one_quantity": {}},
        "causes": [],
        "gain": {"held_out": "test trials"},
        "trial_results": [],
    }
    (card,) = [
        one for one in diagnosis_page._cards(load.DiagnosisRecord(tmp_path, data, {})) if one.label.startswith("Left")
    ]
    assert card.value == size
    assert card.note.endswith("; of the trials looked at, over their noise from sample to sample")
    first = diagnosis_page._left(data).sentences[0]
    assert first.startswith("On the trials looked at: ")
    assert ("100 times the noise from sample to sample" in first) == (share > 1.0)


def test_parts_of_a_run_that_jumps_are_no_windows(tmp_path: Path) -> None:
    rows = [
        {"id": id, "part_of": id.partition("@")[0], "rms": {"x": rms, "y": rms, "psi": rms}}
        for id in ("turn@0", "turn@90", "zigzag@0")
        for rms in [{"before": 2.0, "after": 1.0}]
    ]
    for jumped, pieces in (({"turn": 12.0}, "3 parts of 2 trials"), ({}, "3 windows of 2 trials")):
        record = load.DiagnosisRecord(tmp_path, {"trial_results": rows, "jumped": jumped}, {})
        assert wording.count_of_trials(record.results) == pieces
        notes = [card.note for card in cards_of_misfit({}, record.results, where="held out")]
        assert notes == [f"root mean square of each {pieces.split()[1][:-1]}, mean of {pieces}"] * len(notes)
        assert notes


def test_percent() -> None:
    assert wording.percent(wording.change(200.0, 1.0)) == "−99.5\u00a0%"
    assert wording.percent(wording.change(200.0, 1e-9)) == "−99.9\u00a0%"
    assert wording.percent(wording.change(1.0, 18966341.25)) == "19\u202f000\u202f000 times"
    assert wording.percent(-0.01) == "0\u00a0%"
    assert wording.percent(wording.change(100.0, 112.34)) == "+12.3\u00a0%"
    assert wording.percent(wording.change(-2.0, -3.0)) == "−50.0\u00a0%"
    assert wording.percent(wording.change(1.0, 1.0)) == "0\u00a0%"
    assert wording.percent(wording.change(0.0, 1.0)) == "–"


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.99995, "99.9"), (0.9, "90"), (-0.3, "0"), (0.0049, "0"), (0.996, "99.6"), (1.0, "99.9"), (None, None)],
)
def test_shares_are_written_in_one_way(value: float | None, text: str | None) -> None:
    assert wording.share(value) == ("–" if text is None else f"{text}\u00a0%")


@pytest.mark.parametrize(("part", "text"), [(1.0, "100"), (0.99996, "99.9"), (0.5, "50"), (0.0, "0")])
def test_all_of_what_is_counted_may_be_meant(part: float, text: str) -> None:
    assert wording.share(part, counted=True) == f"{text}\u00a0%"


def test_an_interval_of_one_number_is_said_once() -> None:
    assert wording.span(0.9999, 1.0) == "99.9\u00a0% or more"
    assert wording.span(0.941, 0.943) == "94\u00a0%, either end"
    assert wording.span(0.4, 0.6) == "40 to 60\u00a0%"


def test_variance_beyond_noise_is_read_as_people_think() -> None:
    assert wording.beyond_noise(-0.017) == "none"
    assert wording.beyond_noise(0.3) == "30\u00a0%"
    assert wording.beyond_noise(18966340.25) == "4400 times the noise"


def test_fixed_has_no_negative_zero() -> None:
    assert wording.fixed(-0.001, 2) == "0.00"
    assert wording.fixed(-1.25, 1) == "−1.2"


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("advance_m", ("advance", "m")), ("steady_yaw_rate_deg_per_s", ("steady yaw rate", "deg/s")),
        ("time_90_s", ("time to 90 deg", "s")), ("steady_speed_m_per_s", ("steady speed", "m/s")),
        ("speed_ratio_90", ("speed ratio at 90 deg", "")), ("overshoot_1_deg", ("1st overshoot", "deg")),
    ],
)  # fmt: skip
def test_index_words(key: str, words: tuple[str, str]) -> None:
    assert wording.index_words(key) == words
    assert wording.is_index(key)


def test_circumstances_are_no_indices() -> None:
    for key in ("L_pp_m", "execute_time_s", "rudder_angle_deg", "advance_over_L", "approach_speed_m_per_s"):
        assert not wording.is_index(key)


def test_thinning_keeps_peaks() -> None:
    values = np.sin(np.arange(100_000) / 3000.0)
    values[54_321] = 7.0
    values[60_000:70_000] = np.nan
    other = np.zeros(100_000)
    other[12_345] = -1.0
    keep = motions.spread([values, other], 100_000, 1000)
    assert len(keep) <= 1005
    assert np.nanmax(values[keep]) == 7.0
    assert np.isnan(values[keep]).any()
    assert other[keep].min() == -1.0
    assert {0, 99_999} <= set(keep.tolist())
    assert motions.spread([values[:1000]], 1000, 1000).tolist() == list(range(1000))


def test_headings_begin_in_the_turn_of_the_measured_one() -> None:
    t = np.arange(50.0)
    zero = np.zeros(50)
    rest = {"t": t, "x": t, "y": t, "u": zero, "v_m": zero, "r": zero}
    measured = rest | {"psi": np.mod(0.3 * t, 2 * np.pi)}
    simulated = rest | {"psi": 0.3 * t + 2 * np.pi + 0.1}
    one = motions.Manoeuvre("one", {"measured": measured, "after": simulated})
    payload, _ = motions.payload([one], tracks.runs_of(tracks.WORDS), ())
    found = payload["manoeuvres"][0]["runs"]
    gap = motions.unpacked(found["after"]["psi"]) - motions.unpacked(found["measured"]["psi"])
    assert gap == pytest.approx(np.degrees(0.1), abs=0.03)
    days = motions.Manoeuvre("late", {"": rest | {"psi": 0.3 * t - 2 * np.pi * 37 - 0.5}})
    payload, _ = motions.payload([days], [motions.Run("", "measured", Look())], ())
    assert motions.unpacked(payload["manoeuvres"][0]["runs"][""]["psi"])[0] == pytest.approx(-np.degrees(0.5), abs=0.03)


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
def test_packed_numbers_come_back(size: float) -> None:
    values = size * np.random.default_rng(1).normal(3.0, 1.0, 500)
    values[7] = np.nan
    found = motions.unpacked(json.loads(json.dumps(motions.packed(values))))
    assert np.isnan(found[7])
    span = np.nanmax(values) - np.nanmin(values)
    assert np.nanmax(np.abs(found - values)) <= span / 130_000 + 1e-7 * np.nanmax(np.abs(values))
    assert motions.unpacked(motions.packed(np.full(3, 0.25 * size))) == pytest.approx(0.25 * size)
    assert np.isnan(motions.unpacked(motions.packed(np.full(3, np.nan)))).all()
    steady = motions.packed(np.arange(0.0, 600.0, 0.5), steady=True)
    assert steady == {"n": 1200, "o": 0.0, "s": 0.5}
    assert motions.unpacked(steady)[-1] == 599.5


def test_simulation_on_other_times_is_compared_where_both_are() -> None:
    t = np.arange(0.0, 10.0)
    measured = {"t": t, "x": 2.0 * t, "y": 0.0 * t}
    simulated = {"t": np.arange(0.0, 5.0, 0.5), "x": 2.0 * np.arange(0.0, 5.0, 0.5) + 3.0, "y": np.zeros(10)}
    _, gap = tracks.distance_from(simulated, measured)
    assert gap[:5] == pytest.approx(3.0)
    assert np.isnan(gap[5:]).all()


def test_names_that_begin_alike_differ_in_their_titles() -> None:
    names = [f"a voyage from one port to another port, window {k}" for k in range(3)]
    assert len(set(tracks.distinct(names))) == 3
    assert max(map(len, tracks.distinct(names))) <= tracks.LONGEST
    assert tracks.distinct(["turn", "zigzag"]) == ["turn", "zigzag"]


def test_evaluations_count_on_through_restarts() -> None:
    history = {"evaluations": np.array([12.0, 24.0, 24.0, 48.0])}
    assert confidence.running(history).tolist() == [12.0, 24.0, 24.0, 48.0]
    history = {"evaluations": np.array([12.0, 24.0, 12.0, 24.0, 12.0])}
    assert confidence.running(history).tolist() == [12.0, 24.0, 36.0, 48.0, 60.0]


def test_embedded_json_cannot_end_its_element() -> None:
    value = ["</script>", "<!--", "&", "\u2028"]
    text = embedded(value)
    assert not set("<>&\u2028") & set(text)
    assert json.loads(text) == value


def test_markdown_escapes() -> None:
    assert escaped("a|b <i> `c`\n# d & [e](f)") == r"a\|b &lt;i&gt; \`c\` \# d &amp; \[e\](f)"


def test_commands_quote_what_they_are_given() -> None:
    data = {
        "profile": {"path": "my ship.toml"},
        "trials": {"path": "a;b"},
        "options": {},
        "at_bound": ["x"],
        "out": "r 1/",
    }
    commands = [command for _, command in advice.after_fit(data)]
    assert commands == [
        "mmgtune sweep -p 'my ship.toml' -t 'a;b'",
        "mmgtune simulate -p 'r 1/profile.toml' --turn 35 --turn -35 --zigzag 10/10 --zigzag 20/20",
    ]


def test_deviation() -> None:
    assert tables.deviation(200.0, 210.0, "m") == "+5.0\u00a0%"
    assert tables.deviation(10.0, 8.5, "deg") == "−1.5 deg"
    assert tables.deviation(None, 8.5, "deg") == "–"


def test_what_explains_most_alone_need_not_be_the_answer() -> None:
    def row(effect: str, gain: float, J: float, by: str | None = None) -> dict[str, Any]:
        names = ["north", "east", "north_rate", "east_rate"] if effect == "current" else ["speed", "direction"]
        return {"effect": effect, "parameters": names, "by": by, "gain": gain, "p_value": 0.0, "J_test": J}

    rows = [row("wind", 9e6, 9345.0), row("current", 8e6, 1577.0, "trial"), row("current", 6e6, 1213.0)]
    data = {"causes": [{"effect": "current"}, {"effect": "rudder-offset"}], "gain": {"J_test_after": 0.1952}}
    block = diagnosis_page._candidates(rows, data)
    assert isinstance(block, Picture)
    assert "current and rudder-offset together leave J = 0.1952, wind alone 9345" in block.caption
    (panel,) = block.figure.panels
    assert [mark.look.color for mark in panel.marks if isinstance(mark, Dots)] == ["muted", "after", "after"]
    labels = [words for _, words in panel.y.ticks or ()]
    assert labels == ["wind (speed, direction)", "current (4 values, of each run)", "current (4 values)"]


def test_rivals_have_different_names_on_a_phone() -> None:
    """Two hypotheses on the compass stood there as "compass-devi… (4 values)" both."""
    ship, data = load_profile("suzaku"), load_trials("suzaku")
    trials, options = list(data.trials.values()), DiagnoseOptions()
    known = [*known_causes(ship, trials, options), *known_causes(ship, trials, options, in_place=True)]
    known += of_runs(known, trials)
    rows = [{"effect": h.tag, "parameters": list(h.variant), "by": h.by, "gain": 9.0} for h in known]
    names = [svg._fitting(diagnosis_page._label(row), svg.LETTERS, roomy=True) for row in rows]
    assert len(set(names)) == len(names) > 90
    assert not [name for name in names if "…" in name]
    assert "compass-deviation\n(sine, cosine, alone)" in names
    figures = [diagnosis_page._candidates_figure(rows[k : k + 12], []) for k in range(0, len(rows), 12)]
    assert not [figure for figure in figures if "…" in svg.inline(figure)]


def test_seeds_are_told_apart() -> None:
    """All curves of a training were orange in one panel and blue in the other."""
    curve = [{"step": step, "loss": 1.0 / step, "score": 2.0 / step} for step in (10, 20)]
    members = [{"seed": k, "curve": curve, "score": 0.1, "best_step": 20} for k in range(1, 21)]
    figure = learning_page.curves_figure(members, "L_MSE of validation [–]")
    looks = [[mark.look for mark in panel.marks if isinstance(mark, Line)] for panel in figure.panels]
    assert looks[0] == looks[1] == [look for _, look in figure.legend]
    assert len({(look.color, look.dash) for look in looks[0]}) == 20
    assert [words for words, _ in figure.legend][:2] == ["seed 1", "seed 2"]
    for panel in figure.panels[1:]:
        dots = [mark.look.color for mark in panel.marks if isinstance(mark, Dots)]
        assert dots == [look.color for look in looks[1]]
    assert learning_page.curves_figure(members[:1], "L_MSE").legend == ()


@pytest.mark.parametrize("licence", ["", "CC0-1.0"])
def test_trials_without_a_licence_have_no_row_of_it(licence: str) -> None:
    trials = {"learned_from": ["a"], "licence": licence, "citation": ""}
    made = {"trials": trials, "command": "x", "mmgtune": "1", "created": "2026-01-01", "options": {}}
    data = {"provenance": made, "held_out": [], "step_s": 1.0, "wall_s": 2.0}
    table = learning_page.made_section(data, []).blocks[0]
    assert isinstance(table, Table)
    rows = [row[0].text for row in table.rows]
    assert "learned from" in rows
    assert ("licence of the trials" in rows) == bool(licence)
    assert "cite for them" not in rows


def test_nothing_found_shows_the_model_it_speaks_of() -> None:
    t = np.arange(3.0)
    still = {name: np.zeros(3) for name in ("x", "y", "psi", "u", "v_m", "r")}
    found = {name: {which: {"t": t, **still} for which in ("measured", "before", "after")} for name in ("a", "b")}
    results = [{"id": "a", "J_before": 9.0, "J_after": 1.0}, {"id": "b", "J_before": 2.0, "J_after": None}]
    words = {"measured": "measured", "before": "re-tuned model"}
    block = motion_block.of_trials(results, found, (), "", words=words)
    assert isinstance(block, Motions)
    assert block.selected == 0
    assert [set(one["runs"]) for one in block.payload["manoeuvres"]] == [{"measured", "before"}] * 2


def test_a_check_weighs_metrics_as_its_verdict_does() -> None:
    def row(metric: str, now: float | None, allowed: float, status: str, unit: str = "") -> dict[str, Any]:
        return {"trial": "a", "metric": metric, "now": now, "baseline": 1.0, "allowed": allowed, "change": 0.1,
                "unit": unit, "status": status, "reason": ""}  # fmt: skip

    items = [row("rms_v", 0.0886, 0.055, "regressed", "m/s"), row("J", 3061.0, 700.7, "regressed"),
             row("MED", 5.0, 10.0, "improved", "m")]  # fmt: skip
    ordered = check_page._ordered({"items": items})
    assert [one["metric"] for one in ordered] == ["J", "rms_v", "MED"]
    section = check_page._worst({"items": items})
    assert section is not None
    (block,) = section.blocks
    assert isinstance(block, Picture)
    sizes = [mark.x[1] for mark in block.figure.panels[0].marks if isinstance(mark, Bar)]
    assert sizes == pytest.approx([400.0, 100.0 * 0.0886 / 0.055, 50.0])
    assert [words for words, _ in block.figure.legend] == ["passes", "fails", "as much as is allowed"]
    (worst, *_) = check_page._cards({"items": items, "counts": {}})
    assert "error of sway, rms of a" in worst.note


def test_models_are_called_by_folder_and_file() -> None:
    names = ["suzaku", "/a/b/runs/fit/profile.toml", "runs/rnn/model.safetensors"]
    assert wording.model_names(names) == ["suzaku", "fit/profile.toml", "rnn/model.safetensors"]
    twins = ["a/fit/profile.toml", "b/fit/profile.toml"]
    assert wording.model_names(twins) == twins


def test_options_are_not_broken_over_lines() -> None:
    page = Page("t", "e", "v", warnings=("--no-refit <b> helps",))
    assert '<span class="option">--no-refit</span> &lt;b&gt; helps' in html.fragment(page)


def test_a_section_of_tables_to_look_up_is_not_on_paper() -> None:
    table = Table("t", "c", ("a",), (), raw=True)
    assert not Section("s", "S", (table, Fold("more", (table,)))).printed
    assert Section("s", "S", (Fold("more", (table,), printed=True),)).printed


def test_words_beside_bars_stand_on_several_lines() -> None:
    items = [{"trial": f"turn_m{k}", "metric": "tactical_diameter", "now": 1.0, "baseline": 1.0, "allowed": 2.0,
              "unit": "%", "status": "ok"} for k in range(3)]  # fmt: skip
    section = check_page._worst({"items": items})
    assert section is not None
    (block,) = section.blocks
    assert isinstance(block, Picture)
    text = svg.inline(block.figure)
    for line in ("turn_m1", "error of tactical", "diameter"):  # whole, on a phone too
        assert text.count(f">{line}</text>") == 2 * (1 if line == "turn_m1" else 3)
    assert "all pass" in block.caption


def test_names_of_classes_are_in_the_legend(voyages_folder: Path) -> None:
    kind, record = load.find(voyages_folder, KINDS)
    figure = kind.build(record).figures()["distributions"]
    assert not [mark for panel in figure.panels for mark in panel.marks if isinstance(mark, Words)]
    assert [words for words, _ in figure.legend][-3:] == ["optimal", "satisfactory", "sub-optimal"]


def test_ticks_stay_inside_and_stagger() -> None:
    places = tuple((float(k), f"{'' if k % 2 == 0 else chr(10)}0.0123–0.4567") for k in range(5))
    panel = Panel((Line((0.0, 4.0), (1.0, 2.0), Look("after")),), Axis(low=-0.5, high=4.5, ticks=places), Axis(), "")
    text = svg.inline(Figure("f", "f", (panel, panel)))
    assert text.count("0.0123–0.4567") == 10  # none is left out


@pytest.mark.parametrize("ends", [(0.0, 5e-324), (0.0, 1e-300), (-1e308, 1e308), (1.0, 1.0)])
def test_ticks_of_an_axis_without_length(ends: tuple[float, float]) -> None:
    assert ticks.linear(*ends, 5) == [(ends[0], wording.shown(ends[0], 3))]


def test_worst_trial_is_the_diverged_one() -> None:
    assert motion_block.misfit_of({"J_after": None}) == math.inf


def test_scores_of_bands_that_no_model_has_are_left_out() -> None:
    one = {"windows": 5, "windows_lost": 0, "L_fit": 3.0, "L_Eucl": 0.01, "L_Maha": None, "correlation": None,
           "CRPS": 0.1, "coverage_50": None, "coverage_90": None, "sharpness": None}  # fmt: skip
    several = {**one, "L_Maha": 3.1, "coverage_90": 0.9, "sharpness": 0.2}
    (heads, _) = band_scores.known_scores([["a", *band_scores.score_cells(one)]], 1)
    assert heads == ("windows", "L_fit", "L_Eucl", "CRPS")
    heads, rows = band_scores.known_scores([["a", *band_scores.score_cells(of)] for of in (one, several)], 1)
    assert heads == ("windows", "L_fit", "L_Eucl", "L_Maha", "CRPS", "90 % holds", "width of 90 %")
    assert rows[0] == ["a", "5", "3", "0.01", "–", "0.1", "–", "–"]


def test_spreads_have_units_that_people_read() -> None:
    assert models_page.spread_words("psi", math.radians(30.0)) == ("spread of heading", "30.00 deg")
    assert models_page.spread_words("x", 211.6) == ("spread of position north", "211.6 m")


@pytest.mark.parametrize(
    ("errors", "densities", "said"),
    [
        ((92.1, 92.1), [0.535, 0.535], ["92.1 m off track"]),
        ((92.1, 92.11), [0.535, 0.535], ["92.1 m off track"]),
        ((12.5, 40.5), [0.12, 0.95], ["12.5 m off track", "22.5 m off track", "40.5 m off track"]),
    ],
)
def test_errors_of_a_fleet_that_are_alike_are_drawn_in_the_middle(
    errors: tuple[float, float], densities: list[float], said: list[str]
) -> None:
    found = {("suzaku", date): error for date, error in zip(("a", "b"), errors, strict=True)}
    figure = fleet_figures.ships_over_time(["suzaku"], ["a", "b"], found, [], [])
    drawn = [mark.alpha for mark in figure.panels[0].marks if isinstance(mark, Bar)]
    assert drawn == pytest.approx(densities, abs=1e-3)
    assert [label for label, _ in figure.legend] == said
