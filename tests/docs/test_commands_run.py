"""Every command of the README and of the guides, run as it stands, page by page in a folder of its own.

The pages on measured ships need data that does not travel with the program (tests/measured), the tutorial has a test of
its own (test_tutorial.py), fits to sea-trial reports take minutes and are run by tests/fitting/test_stated.py, and the
output of some commands here is what other tests are about: here they must work.  Searches are cut short by options that
stand after those of the page; whole ones are run by tests/fitting.
"""

import re
import shlex
import shutil
from dataclasses import replace
from glob import glob

import pytest

from mmgtune.model import Model
from mmgtune.networks import save_network
from mmgtune.profile import load_profile
from mmgtune.resources import folder
from mmgtune.trial import read_trial, write_trial
from mmgtune.trial.schema import ATTRIBUTES
from tests.command import QUICK, run
from tests.docs.test_docs import ROOT, code
from tests.networks.made import network
from tools.generate_voyage import make_voyage

PAGES = [
    ROOT / "README.md",
    *sorted(page for page in (ROOT / "docs" / "guides").glob("*.md") if page.name != "sea-trial-report.md"),
    *sorted((ROOT / "docs" / "theory").glob("*.md")),
    ROOT / "docs" / "check-sensitivity.md",
    *ROOT.glob("*/README.md"),
    *ROOT.glob("*/*/README.md"),
]
DAILY = ("README.md", "bands.md", "ci.md", "diagnose.md", "import.md", "validate.md")
"""Pages of what is done every day; those of the others are run by make long."""
MAKES_TRIALS = "trials import"
TRIALS = ("turn_p35", "turn_m20", "zigzag_10", "zigzag_20")


def commands(page):
    """Commands of a page in order; what a shell would do with the rest of the line is left out."""
    return [
        line.split(" #")[0].strip()
        for language in ("", "sh")
        for block in code(page, language)
        for line in map(str.strip, block.splitlines())
        if line.startswith("mmgtune ")
    ]


def words(line, folder):
    """The arguments of a command as a shell in a folder would give them."""
    found = []
    for word in shlex.split(line)[1:]:
        found += sorted(glob(word, root_dir=folder)) or [word]
    return found


@pytest.fixture
def desk(tmp_path):
    """What the pages presuppose: a profile and trials of one's own, logs with their map, a baseline, a run."""
    profile = folder("ship_profiles") / "suzaku.toml"
    for name in ("my_ship.toml", "before.toml", "after.toml", "ship.toml"):
        shutil.copy(profile, tmp_path / name)
    logs = ROOT / "docs" / "tutorial" / "logs"
    shutil.copytree(logs, tmp_path / "logs")
    for log in logs.glob("*.csv"):
        shutil.copy(log, tmp_path)
    (toml,) = [block for block in code(ROOT / "docs" / "tutorial" / "index.md", "toml") if "[columns]" in block]
    for name in ("map.toml", "m.toml"):
        (tmp_path / name).write_text(toml, encoding="utf-8")
    shutil.copytree(folder("trials"), tmp_path / "trials")
    shutil.copy(folder("trials") / "suzaku" / "check.json", tmp_path)
    save_network(network(members=5, size=0.05, step=1.0), tmp_path / "model.safetensors")
    write_trial(make_voyage(Model(load_profile("suzaku")), 1.5), tmp_path / "voyages" / "voyage.parquet")
    return tmp_path


def own_trials(desk, name, trials=TRIALS):
    """A small set of trials under that name: bundled ones, every other sample of them."""
    for trial in trials:
        whole = read_trial(folder("trials") / "suzaku" / f"{trial}.parquet")
        thin = {channel: getattr(whole, channel)[::2] for channel in ATTRIBUTES.values()}
        write_trial(replace(whole, **thin), desk / name / f"{trial}.parquet", overwrite=True)


SHORTER = {
    "diagnose": ("--effects", "current,rudder-offset"),
    "fit": ("--method", "least-squares", "--starts", "2", "--integrator", "euler"),
    "leave-out": ("--starts", "1", "--folds", "2", "--integrator", "euler"),
    "learn ensemble": ("--steps", "5"),
    "learn hybrid": ("--steps", "10"),
    "learn rnn": ("--steps", "10"),
    "plan": ("--particles", "50", "--integrator", "euler"),
    "posterior": ("--particles", "50", "--integrator", "euler"),
    "sweep": ("--starts", "2", "--ar", "0.2,0.5"),
    "trials make": ("--sets", "test-b"),
}
"""What is added to commands that begin so and would take long; the last of two values of an option counts."""


def shorter(words):
    """What is added to a command of these words."""
    return SHORTER.get(words[0], ()) + SHORTER.get(" ".join(words[:2]), ())


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.name, marks=() if page.name in DAILY else pytest.mark.long)
        for page in PAGES
        if commands(page)
    ],
)
def test_commands_of_a_page_run(page, desk):
    lines = commands(page)
    if not any(MAKES_TRIALS in line for line in lines):
        own_trials(desk, "my_trials")
    for name, text in re.findall(
        r'```(?:toml|csv) title="([^"]+)"\n(.*?)```', page.read_text(encoding="utf-8"), re.DOTALL
    ):
        (desk / name).write_text(text, encoding="utf-8")
    if page.name == "fleets.md":
        for ship in ("s1", "s2", "s3"):
            own_trials(desk, f"measured/{ship}/2026-05", ("turn_m20", "zigzag_20"))
    if page.name == "ci.md":
        shutil.rmtree(desk / "trials")
        own_trials(desk, "trials")
        (desk / "check.json").unlink()
    if any("runs/demo" in line for line in lines):
        assert run("fit", *QUICK, "--out", "runs/demo", cwd=desk).code == 0
    for line in lines:
        command = words(line, desk)
        ended = run(*command, *shorter(command), cwd=desk, env={"GITHUB_STEP_SUMMARY": "summary.md"})
        # What a diagnosis says of these trials is for it to say.
        good = (0, 1) if "--fail-on" in line else (0,)
        assert ended.code in good, (line, ended.out[-2000:], ended.err)
        assert "Traceback" not in ended.err
