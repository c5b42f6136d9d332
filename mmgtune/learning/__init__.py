"""Networks trained on trials: needs the extra ``mmgtune[learn]``; what comes of it, ``networks`` uses without.

samples, splitting   trials on one time step, and whole runs kept back to choose by
recipes, starting    the five types of the paper; where weights begin
rolling, losses      roll-outs of the equations of ``networks.recurrent`` on JAX, and what is made small
aims, choosing       windows of trials as what is trained for, and what chooses among weights
training             the steps, and the way back from divergence
keeping, folder      checkpoints, and what a run leaves behind
run                  all of it, as ``mmgtune learn rnn``
hybrid, gains        a network beside a model of forces, and what it gains on unseen runs
refitting            the model of forces tuned anew without the runs kept back
hybrid_run           all of that, as ``mmgtune learn hybrid``
ensemble             feed-forward networks by the likelihood of what was observed
ensemble_run         several of them side by side, as ``mmgtune learn ensemble``
following, known     runs where a hybrid takes them; what coefficients and effects would add along them
selecting, reading   terms chosen by what they explain on unseen runs: what a network says, in known terms
"""

from ..hooks import Hooks
from .ensemble_run import LearnedEnsemble, learn_ensemble
from .folder import write_learned
from .hybrid_run import LearnedHybrid, learn_hybrid
from .mixing import LearnedMixture, compare_parts, learn_mixture
from .reading import Reading, read_network
from .run import Learned, learn_rnn

__all__ = [
    "Hooks",
    "Learned",
    "LearnedEnsemble",
    "LearnedHybrid",
    "LearnedMixture",
    "Reading",
    "compare_parts",
    "learn_ensemble",
    "learn_hybrid",
    "learn_mixture",
    "learn_rnn",
    "read_network",
    "write_learned",
]
