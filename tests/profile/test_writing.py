"""What is written of a profile is read back as the same profile, however it was changed."""

import copy
import hashlib
import multiprocessing
import pickle  # noqa: TID251 - what a spawned process does to its arguments
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mmgtune.effects import effects, find_effect
from mmgtune.effects.effect import Effect
from mmgtune.model import Model
from mmgtune.profile import (
    Approach,
    load_profile,
    missing_for,
    parse_profile,
    profile_text,
    tuned,
    with_all_effects,
    with_effects,
)
from mmgtune.profile.changing import joined
from mmgtune.resources import profile_names

FACTS = {"a_r": 0.5, "tuned_on": ["a", "b"], "trials": {"a": "00", "b-c": "11"}}


def read_back(profile):
    text = profile_text(profile)
    again = parse_profile(text)
    assert again == profile
    assert profile.sha256 == again.sha256 == hashlib.sha256(text.encode()).hexdigest()
    assert np.array_equal(Model(again).base, Model(profile).base)
    return again


def tune(profile, rng, suffix="tuned"):
    names = [name for name in profile.targets if np.isfinite(profile.value(name))]
    values = {name: profile.value(name) * rng.uniform(0.5, 0.99) for name in names}
    stderr = {name: rng.uniform(0.0, 1.0) if rng.random() < 0.5 else None for name in names}
    return tuned(profile, values, stderr, FACTS, suffix, "CC BY-NC 4.0", "Measured et al.")


def extend(profile, rng):
    """Some effects with any finite value that is possible for every parameter, some at their null."""
    values, stderr = {}, {}
    for effect in effects():
        if missing_for(effect, profile) or rng.random() < 0.5:
            continue
        chosen = [name for name in effect.parameters if rng.random() < 0.5]
        words = {name: effect.parameters[name].choices for name in chosen}
        given = {
            name: rng.choice([*words[name].values()])
            if words[name]
            else rng.uniform(1e-9, min(0.5, effect.parameters[name].high or 0.5))
            for name in chosen
        }
        values[effect.tag] = given
        stderr[effect.tag] = {name: rng.uniform(0.0, 1.0) for name in given if not words[name] and rng.random() < 0.5}
    return with_effects(profile, values, "a test", stderr)


CHANGES = {
    "as read": lambda p, rng: p,
    "every effect": lambda p, rng: with_all_effects(p),
    "effects": extend,
    "tuned": tune,
    "tuned, then extended": lambda p, rng: extend(tune(p, rng), rng),
    "extended, then tuned": lambda p, rng: tune(extend(p, rng), rng),
    "tuned twice": lambda p, rng: tune(tune(p, rng), rng, "again"),
    "extended twice": lambda p, rng: extend(extend(p, rng), rng),
}


@pytest.mark.daily("suzaku-", "vectwin_3m-")
@pytest.mark.parametrize("template", [True, False])
@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", profile_names())
def test_what_is_written_is_read_back(name, change, template):
    rng = np.random.default_rng([len(name), len(change), template])
    profile = load_profile(name)
    read_back(CHANGES[change](profile if template else replace(profile, template=""), rng))


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), changes=st.lists(st.sampled_from(list(CHANGES)), min_size=1, max_size=4))
def test_what_is_written_is_read_back_after_any_changes(seed, changes):
    rng = np.random.default_rng(seed)
    profile = load_profile(rng.choice(profile_names()))
    for change in changes:
        profile = CHANGES[change](profile, rng)
        if rng.random() < 0.5:
            profile = read_back(profile)
    assert read_back(tune(profile, rng)).licence == joined(profile.licence, "CC BY-NC 4.0")


@pytest.mark.parametrize("name", profile_names())
def test_a_profile_that_was_not_changed_is_its_own_file(name):
    profile = load_profile(name)
    text = profile.path.read_text()
    assert profile.text == text
    assert replace(profile, template=text + "# a comment\n").sha256 != profile.sha256


def test_comments_and_written_forms_stay():
    ship = load_profile("suzaku")
    was, source = ship.text.splitlines(), ship.sections["hull"].source
    now = tuned(ship, {"hull.R_0": 0.02}, {}, {}).text.splitlines()
    assert [line for line in was if line not in now] == ['name = "M.V. SUZAKU"', "R_0 = 0.017"]
    assert [line for line in now if line not in was] == [
        'name = "M.V. SUZAKU (tuned)"',
        f'R_0 = {{value = 0.02, pre_determined = 0.017, source = "tuned by mmgtune; before: {source}"}}',
    ]
    windy = with_effects(ship, {"wind": {"measured": 1.0}}, "a test")
    assert windy.text.startswith(ship.text)
    assert "[effects.wind]" in windy.text
    assert ship.text.count("#") == windy.text.count("#")


def test_words_and_tables_keep_their_written_form_beside_a_changed_source():
    ship = load_profile("suzaku")
    rudder, propeller = ship.sections["rudder"], ship.sections["propeller"]
    flap = replace(rudder.coefficients["flap"], note="another note")
    word = replace(propeller.coefficients["slipstream_kt"], value=1.0)
    changed = replace(
        ship,
        sections={
            **ship.sections,
            "rudder": replace(rudder, coefficients={**rudder.coefficients, "flap": flap}),
            "propeller": replace(propeller, coefficients={**propeller.coefficients, "slipstream_kt": word}),
        },
    )
    text = read_back(changed).text
    assert '"0, 10, 18, 25, 30, 34.5, 38, 41, 43.5, 45 deg"' in text
    assert 'value = "as-printed"' in text


def test_everything_else_that_can_differ_is_written():
    ship = load_profile("suzaku")
    changed = replace(
        ship,
        name='a "name"',
        approach=Approach(3.0, 1.0),
        steering_gear=None,
        targets=("hull.R_0",),
        limits={"rms_psi": 0.1},
        sections={kind: section for kind, section in ship.sections.items() if kind != "above_water"},
    )
    again = read_back(changed)
    assert again.approach == Approach(3.0, 1.0)
    assert again.steering_gear is None
    read_back(replace(again, approach=None, targets=(), limits={}, provenance={"by": "hand"}, sections=ship.sections))


def test_another_source_of_a_section_and_another_model():
    ship, other = load_profile("suzaku"), load_profile("kvlcc2")
    hull = replace(ship.sections["hull"], source="elsewhere")
    read_back(replace(ship, sections={**ship.sections, "hull": hull}))
    swapped = {kind: other.sections[kind] for kind in ("particulars", "hull", "propeller", "rudder", "wake")}
    read_back(replace(ship, sections={**ship.sections, **swapped}, targets=("hull.R_0",)))


def test_a_changed_area_does_not_change_the_wind_forces_of_a_profile_behind_its_back():
    ship = load_profile("suzaku")
    changed = tuned(ship, {"above_water.A_L": 800.0}, {}, {})
    assert read_back(changed).value("above_water.Y_1") == ship.value("above_water.Y_1")


@pytest.mark.parametrize("as_table", [True, False])
def test_other_ways_to_write_a_template(as_table):
    text = load_profile("suzaku").text
    text = text.replace("R_0 = 0.017\n", "" if as_table else "R_0 = 0.017 # of calm water\n")
    if as_table:
        text += '\n[hull.R_0]\nvalue = 0.017 # of calm water\nnote = "a table"\nbounds = [0.001, 0.05]\n'
    text = '[effects.current]\nnorth = "1 m/s" # as told\n' + text.replace("schema = 1", "", 1)
    ship = parse_profile("schema = 1\n" + text + '\n[effects.antenna]\nx = "3 m"\n')
    rng = np.random.default_rng(3)
    for change in CHANGES.values():
        text = read_back(change(ship, rng)).text
        assert text.count("# of calm water") == text.count("# as told") == 1


def test_infinity_is_written_where_it_is_the_null():
    ship = with_effects(load_profile("suzaku"), {"steering-lag": {"rate_limit": np.inf, "time_constant": 2.0}}, "me")
    again = read_back(ship)
    assert '"inf rad/s"' in again.text
    read_back(tuned(again, {"effects.steering-lag.rate_limit": 0.04}, {}, {}))
    read_back(tuned(again, {"effects.steering-lag.rate_limit": np.inf}, {}, {}))


def rows(profile):
    return Model(profile).base.tolist()


@pytest.mark.parametrize("name", profile_names())
def test_profiles_with_effects_pickle(name):
    ship = with_all_effects(load_profile(name))
    for again in (pickle.loads(pickle.dumps(ship)), copy.deepcopy(ship)):
        assert again == ship
        assert all(again.sections[kind].component is section.component for kind, section in ship.sections.items())


def test_profiles_go_to_a_spawned_process():
    ship = with_effects(load_profile("suzaku"), {"steering-lag": {}, "wind": {"speed": 3.0}}, "a test")
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(rows, (ship,)) == rows(ship)


def test_an_effect_that_nothing_names_is_not_pickled():
    known = find_effect("current")
    with pytest.raises(TypeError, match="entry point"):
        pickle.dumps(replace(known, title="another"))
    assert isinstance(known, Effect)
    with pytest.raises(TypeError, match="COMPONENTS"):
        pickle.dumps(replace(load_profile("suzaku").sections["hull"].component, title="another"))
