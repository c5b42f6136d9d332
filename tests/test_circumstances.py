"""What a model does not have of what trials hold, in sentences."""

from dataclasses import replace

import numpy as np

from mmgtune.circumstances import notes_on, reversals
from mmgtune.model import Model
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials


def test_revolutions_astern_that_the_propeller_does_not_have_are_told(suzaku):
    trials = load_trials("suzaku").trials
    crash = replace(trials["turn_p35"], n=np.where(trials["turn_p35"].t > 200.0, -1.0, 1.0))
    (told,) = reversals(suzaku, [trials["turn_p10"], crash])
    assert told.startswith(
        "the propeller turns astern in turn_p35, and the propeller 'four-quadrant' of 'suzaku' has no"
    )
    assert told in notes_on(suzaku, [crash])
    assert reversals(Model(load_profile("esso_osaka_3m")), [crash]) == []
    assert reversals(suzaku, list(trials.values())) == []
