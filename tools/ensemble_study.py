"""What an ensemble knows of what it does not know: the fourth paper's experiments; writes ``docs/ensemble.json``.

    python -m tools.ensemble_study FOLDER [--repeats 5] [--steps 3000] [--out FILE] ...

FOLDER keeps the made trials, the models and the checkpoints.  The study can be stopped at any time, by Ctrl-C or by
SIGTERM, and goes on where it was when it is called again with the same options; what is found is written when all is
trained and scored.  Sizes are the paper's unless options say otherwise: 15 members of 3 x 256 units, windows of 100 s.

Models: the ensembles of all repeats (section 5.3), which share no network and are trained at once, and as many single
networks without initial-state networks as an ensemble has members, whose fit is held against that of the first
ensemble's (section 5.2).
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.bands import pooled, standardised_error
from mmgtune.files import write_text
from mmgtune.generating import make_trials
from mmgtune.learning import Hooks, learn_ensemble, write_learned
from mmgtune.learning.choosing import pieces_of
from mmgtune.networks import Ensemble, EnsemblePredictor, load_network
from mmgtune.objective import spread
from mmgtune.options import SAMPLINGS, EnsembleOptions
from mmgtune.predictor import cases_from
from mmgtune.run_files import CHECKPOINTS
from mmgtune.scores import window_scores
from mmgtune.trial import TrialSet, load_trials

SHIP = "vectwin_3m"
SETS = {"B": "test-b", "ZT": "test-zt", "R": "test-r"}
SIZES = (2, 3, 4, 5, 8, 10, 15)
"""Members of the ensembles that are scored: the first of those trained."""


class Study:
    """Models in a folder, and what is found of them."""

    def __init__(self, folder: Path, given: argparse.Namespace):
        self.folder, self.given = folder, given
        self.stopped = False
        self.trials = folder / "vectwin"
        if not (self.trials / "train-b").is_dir():
            make_trials("vectwin", self.trials)
        self.data = load_trials(self.trials / "train-b")
        self.truth = load_trials(self.trials / "train-b" / "truth")
        self.found: dict[str, Any] = {"options": self.options(1).to_dict(), "particles": given.particles, "models": []}

    def options(self, seed: int, **other: Any) -> EnsembleOptions:
        """Of a training."""
        given = self.given
        every = max(1, min(given.steps, given.every))
        own = {"members": given.members, "width": given.width, "layers": given.layers, "steps": given.steps}
        own |= {"rate": given.rate, "horizon": given.horizon, "initial": given.initial, "validate_every": every}
        return EnsembleOptions(**{**own, "seed": seed, "restart": 100.0, **other})

    def model(self, name: str, options: EnsembleOptions) -> Ensemble | None:
        """A model, read or trained; None where the training was stopped."""
        folder = self.folder / name
        if not (folder / "done.json").is_file():
            folder.mkdir(parents=True, exist_ok=True)
            resume = any(folder.glob(CHECKPOINTS))
            hooks = Hooks(on_progress=lambda *told: self.tell(name, *told), stop=lambda: self.stopped)
            result = learn_ensemble(SHIP, self.data, options, hooks=hooks, folder=folder, resume=resume)
            document = write_learned(result, folder, overwrite=True)
            if result.interrupted:
                return None
            row = {"name": name, "loss": [one["score"] for one in document["members"]]}
            row |= {"last_wall_s": round(result.wall_s, 1), "options": options.to_dict()}
            write_text(folder / "done.json", json.dumps(row) + "\n")
        self.found["models"].append(json.loads((folder / "done.json").read_text()))
        found = load_network(folder / "model.safetensors")
        assert isinstance(found, Ensemble)
        return found

    def tell(self, name: str, done: int, total: int, words: str) -> None:
        """Progress, a line."""
        print(f"{time.strftime('%H:%M:%S')} {name}: {100.0 * done / total:.1f} %, {words}", flush=True)

    def run(self) -> None:
        """Everything that is not there yet."""
        given = self.given
        single = self.model("as-observed", self.options(101, initial=0))
        of_all = self.model("repeats", self.options(1, members=given.members * given.repeats)) if single else None
        if single is None or of_all is None:
            return
        first = of_all.only(list(range(given.members)))
        self.found["L_fit"] = {
            "with_initial_state_network": fits(first, self.data, self.truth, given.horizon),
            "as_observed": fits(single, self.data, self.truth, given.horizon),
        }
        of_repeat = partial(scored, self.folder, given.members, given.particles)
        with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
            for rows in pool.map(of_repeat, range(1, given.repeats + 1)):
                self.found.setdefault("scores", []).extend(rows)
        self.found["complete"] = True
        write_text(given.out, json.dumps(self.found, indent=1, allow_nan=False) + "\n")


def scored(folder: Path, members: int, particles: int, repeat: int) -> list[dict[str, Any]]:
    """Scores of a repeat by set, number of members and sampling."""
    networks = load_network(folder / "repeats" / "model.safetensors")
    assert isinstance(networks, Ensemble)
    first = members * (repeat - 1)
    rows = []
    for name, of in SETS.items():
        trials = list(load_trials(folder / "vectwin" / of / "truth").trials.values())
        pieces = [one for one in pieces_of(trials, 100.0) if one.duration >= 99.0]
        for n in [*(size for size in SIZES if size < members), members]:
            some = EnsemblePredictor(networks.only(list(range(first, first + n))))
            for sampling in SAMPLINGS:
                found = pooled(window_scores(some.drawn(particles, repeat, sampling), pieces), spread(trials)).to_dict()
                rows.append({"repeat": repeat, "set": name, "members": n, "sampling": sampling, **found})
    return rows


def fits(model: Ensemble, data: TrialSet, truth: TrialSet, horizon: int) -> list[float]:
    """L_fit of each member, eq. 29: roll-outs along windows learned from, begun as in training, against the truth."""
    options = model.facts["options"]
    sigma = np.array([options["sigma_u"], options["sigma_v"], np.radians(options["sigma_r"])])
    starts = [(name, k) for name in data.tune for k in range(0, data.trials[name].n_samples - horizon, horizon)]

    trials, parts = [truth.trials[name] for name, _ in starts], [slice(k, k + horizon + 1) for _, k in starts]
    true = np.stack([trial.motion[part, 3:] for trial, part in zip(trials, parts, strict=True)])
    found = []
    for member in range(model.n_members):
        one = model.only([member])
        seen = np.stack([data.trials[name].motion[k : k + max(1, model.initial)] for name, k in starts], axis=1)
        begin = one.started(seen)[0] if model.initial else seen[0]
        cases = cases_from(trials, one.inputs, None, parts=parts, initial=list(begin))
        states = EnsemblePredictor(one).predict(cases).states[:, 0, :, 3:]
        found.append(float(standardised_error(states, true, sigma).mean()))
    return found


def main() -> None:
    """Read the command line and run what is left of the study."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent.parent / "docs" / "ensemble.json")
    usual = EnsembleOptions().to_dict()
    for name in ("members", "layers", "width", "steps", "horizon", "initial"):
        parser.add_argument(f"--{name}", type=int, default=usual[name])
    for name, default in {"repeats": 5, "particles": 100, "every": 250}.items():
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--rate", type=float, default=usual["rate"])
    study = Study((given := parser.parse_args()).folder, given)

    def stop(*_: Any) -> None:
        study.stopped = True
        print("stopping at the next checkpoint", flush=True)

    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    study.run()
    print("complete" if study.found.get("complete") else "stopped: call it again to go on", flush=True)
    sys.exit(0 if study.found.get("complete") else 3)


if __name__ == "__main__":
    main()
