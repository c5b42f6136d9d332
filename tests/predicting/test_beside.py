"""Bands beside simulations and fits, by the library."""

import json

import pytest

import mmgtune

TRIALS = mmgtune.load_trials("suzaku")
TURN = mmgtune.SimulateOptions(turn=35)


@pytest.fixture(scope="module")
def fitted():
    quick = mmgtune.FitOptions(method="least-squares", starts=1, targets=("hull.N_v",))
    return mmgtune.fit("suzaku", TRIALS["turn_p35"], quick)


@pytest.fixture(scope="module")
def bands(fitted):
    return mmgtune.fit_bands(fitted, TRIALS["turn_p35"])


def test_a_fit_is_written_with_its_bands(fitted, bands, tmp_path):
    document = mmgtune.write_fit_bands(bands, tmp_path)
    assert json.loads((tmp_path / "fit.json").read_text()) == json.loads(json.dumps(document))
    assert document["bands"]["predicted"] == bands.predicted.indices()
    assert document["bands"]["particles"] == len(bands.posterior.particles)
    assert (tmp_path / "profile.toml").read_text() == fitted.tuned_profile().text
    assert len(mmgtune.load_particles(tmp_path / "particles.parquet")) == len(bands.posterior.particles)
    with pytest.raises(mmgtune.MmgtuneError, match="exists already"):
        mmgtune.write_fit_bands(bands, tmp_path)
    mmgtune.write_fit_bands(bands, tmp_path, overwrite=True)


def test_manoeuvres_by_particles_get_bands(bands):
    predictor = bands.posterior.particles.predictor()
    with_bands = mmgtune.with_bands(mmgtune.simulate(predictor, options=TURN))
    (row,) = with_bands.rows()
    (foretold,) = mmgtune.predict(predictor, options=mmgtune.PredictOptions(turn=35)).indices()["runs"]
    assert [*row["bands"].values()] == foretold["indices"]
    assert with_bands.to_dict()["runs"] == with_bands.rows()


def test_what_has_no_bands_stays_as_it_is(bands):
    alone = mmgtune.simulate("suzaku", options=TURN)
    driven = mmgtune.simulate(bands.posterior.particles.predictor(), TRIALS["turn_p35"])
    for one in (alone, driven):
        assert mmgtune.with_bands(one) is one
        assert not any("bands" in row for row in one.rows())
    with pytest.raises(mmgtune.MmgtuneError):
        mmgtune.with_bands(TRIALS["turn_p35"])
