"""Networks trained on trials: needs the extra ``mmgtune[learn]``; what comes of it, ``networks`` uses without.

samples, splitting   trials on one time step, and whole runs kept back to choose by
recipes, starting    the five types of the paper; where weights begin
rolling, losses      roll-outs of the equations of ``networks.recurrent`` on JAX, and what is made small
aims, training       windows of trials as what is trained for; the steps, and the way back from divergence
keeping, folder      checkpoints, and what a run leaves behind
run                  all of it, as ``mmgtune learn rnn``
"""

from .folder import write_learned
from .run import Hooks, Learned, learn_rnn

__all__ = ["Hooks", "Learned", "learn_rnn", "write_learned"]
