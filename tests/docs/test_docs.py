"""Documents say what the program does."""

import importlib.util
import re
import shlex
import subprocess
from pathlib import Path

import pytest

import mmgtune
from mmgtune.fitting import FitOptions, fit
from mmgtune.fitting.comparison import mean_off
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials

ROOT = Path(__file__).parent.parent.parent
PAGES = [
    ROOT / "README.md",
    *sorted((ROOT / "docs").glob("**/*.md")),
    *(page for page in ROOT.glob("*/*/README.md") if "node_modules" not in page.parts),
    *ROOT.glob("*/README.md"),
]


def code(page, language):
    """Blocks of one language in a page."""
    return [
        block
        for named, block in re.findall(
            r"^ *```(\w*).*?\n(.*?)^ *```", page.read_text(encoding="utf-8"), flags=re.M | re.S
        )
        if named == language
    ]


def test_the_example_of_the_readme_runs(capsys):
    (example,) = code(ROOT / "README.md", "python")
    exec(compile(example, "README.md", "exec"), {})
    assert "4 of 4 of these trials improve" in capsys.readouterr().out


@pytest.mark.long
def test_the_examples_of_the_library_page_run(capsys):
    for example in code(ROOT / "docs" / "reference" / "api" / "index.md", "python"):
        exec(compile(example, "index.md", "exec"), {})
    assert "4 of 4 of these trials improve" in capsys.readouterr().out


def test_trials_from_tables_are_a_set_as_shown(capsys):
    (example,) = code(ROOT / "docs" / "reference" / "api" / "trial.md", "python")
    shown: dict = {}
    exec(compile(example, "trial.md", "exec"), shown)
    assert (shown["data"].tune, shown["data"].test) == (("turn_p35", "zigzag_20"), ("turn_p10",))
    assert "On 1 trial not used for tuning" in capsys.readouterr().out


def test_every_command_shown_is_understood(monkeypatch):
    """Commands are run with --help behind them: options and arguments must exist, nothing is worked on."""
    import typer.core
    from click.testing import CliRunner
    from typer.main import get_command

    from mmgtune.cli import app
    from mmgtune.errors import OptionError

    for kind in (typer.core.TyperCommand, typer.core.TyperGroup):  # drawing a page of help takes a tenth of a second
        monkeypatch.setattr(kind, "format_help", lambda *_: None)

    shown = {
        re.split(r"#|\|", line)[0].strip()
        for page in PAGES
        for language in ("", "sh")
        for block in code(page, language)
        for line in map(str.strip, block.splitlines())
        if line.startswith("mmgtune ")
    }
    assert len(shown) > 5
    understood, whole = CliRunner(), get_command(app)
    assert isinstance(understood.invoke(whole, ["fit", "--nonsense", "--help"]).exception, OptionError)
    for line in shown:
        ended = understood.invoke(whole, [*shlex.split(line)[1:], "--help"])
        assert ended.exit_code == 0, (line, ended.output, ended.exception)


def test_links_lead_somewhere():
    for page in PAGES:
        for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
            if not target.startswith("http"):
                assert (page.parent / target).exists(), (page.name, target)


def test_every_promise_of_security_has_its_test():
    named = re.findall(r"`(tests/[\w/.]+)`", (ROOT / "SECURITY.md").read_text(encoding="utf-8"))
    assert len(named) > 10
    for name in named:
        assert (ROOT / name).exists(), name


def tool(name):
    """A module of tools/."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "tools" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_nomenclature_is_current():
    text = (ROOT / "docs" / "nomenclature.md").read_text(encoding="utf-8")
    assert text == tool("write_nomenclature").nomenclature()


def test_every_public_name_is_in_the_table_of_the_library_beside_its_page():
    text = (ROOT / "docs" / "reference" / "api" / "index.md").read_text(encoding="utf-8")
    names = re.findall(r"`(\w+)`", text.partition("| name | what | page |")[2].partition("\n\n")[0])
    assert sorted(names) == sorted(mmgtune.__all__)
    assert text == tool("write_api_names").page()


def test_a_public_name_without_a_page_is_told():
    with pytest.raises(ValueError, match="describes another_name"):
        tool("write_api_names").table([*mmgtune.__all__, "another_name"])


def test_every_key_of_the_result_is_documented():
    result = fit(load_profile("suzaku"), load_trials("suzaku"), FitOptions(method="least-squares", starts=1))
    text = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")
    missing = [key for key in result.to_dict() if f"`{key}`" not in text]
    missing += [key for key in result.to_dict()["coefficients"][0] if f"`{key}`" not in text]
    missing += [key for key in result.to_dict()["trial_results"][0] if f"`{key}`" not in text]
    assert missing == []


def test_numbers_of_the_readme_are_those_of_the_program():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    guide = (ROOT / "docs" / "guides" / "calibrate.md").read_text(encoding="utf-8")
    result = fit(load_profile("suzaku"), load_trials("suzaku"), FitOptions(method="least-squares", starts=4))
    assert result.sentence() in text
    assert result.sentence() in guide
    estimated = fit(
        load_profile("suzaku"), load_trials("suzaku"), FitOptions(method="least-squares", starts=4, initial="estimated")
    )
    assert f"{estimated.J_of('test', 'after'):.2f} instead of {result.J_of('test', 'after'):.1f}" in guide
    off = [mean_off([c for c in one.compared if c.role == "test"], "after")["track"] for one in (estimated, result)]
    assert "{:.2f} m off track there instead of {:.1f} m".format(*off) in " ".join(guide.split())
    assert f"The ship is {off[0]:.2f} m off track then." in text
    assert result.bends_to_noise


@pytest.mark.long
def test_the_sweep_table_is_current():
    table = (ROOT / "docs" / "guides" / "calibrate.md").read_text(encoding="utf-8")
    for a_r in (0.2, 0.6):
        result = fit(
            load_profile("suzaku"), load_trials("suzaku"), FitOptions(method="least-squares", starts=4, a_r=a_r)
        )
        assert f"{result.J:.4g} |" in table
        assert f"{result.J_of('test', 'after'):.4g} |" in table


def test_the_project_speaks_of_itself_alone():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("not a git checkout")
    for name in listed.stdout.splitlines():
        path = ROOT / name
        if (
            path.suffix in {".py", ".md", ".toml", ".j2", ".cff", ".css", ".js", ""}
            and path != Path(__file__)
            and path.is_file()
        ):
            text = path.read_text(encoding="utf-8", errors="replace")
            for word in ("/work" + "/", "shared" + "/spec"):
                assert word not in text, (name, word)


def test_help_shows_all_of_its_words():
    """Square brackets in the help of a command or an option are taken for markup, and vanish."""
    import typer.main

    from mmgtune.cli import app

    def helps(command):
        for one in getattr(command, "commands", {}).values():
            yield from helps(one)
        yield command.name, command.help
        yield from ((one.name, getattr(one, "help", None)) for one in command.params)

    assert [name for name, text in helps(typer.main.get_command(app)) if "[" in (text or "")] == []
