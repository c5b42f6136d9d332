"""One report, five renderings: each complete, and harmless whatever trials are called."""

import json
import pkgutil
import re
import subprocess
import sys
from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest

from mmgtune.checking import Changed, Item, could_not_run, renderers, write_baseline
from mmgtune.checking.renderers import RENDERERS
from mmgtune.checking.renderers.github import render as github
from mmgtune.checking.renderers.json import render as as_json
from mmgtune.checking.renderers.junit import render as junit
from mmgtune.checking.renderers.markdown import render as markdown
from mmgtune.checking.renderers.numbers import change
from mmgtune.checking.renderers.text import difference
from mmgtune.checking.renderers.text import render as text
from mmgtune.errors import Problem
from mmgtune.options import FORMATS

HOSTILE = [
    "a<b>&\"'",
    "x|y`z`",
    "::error::%0A",
    "line\nbreak\r",
    "bell\x07\x00\ufffe",
    "comma,colon:percent%",
    "<script>alert(1)</script>",
    "<!-- ]]> -->",
    "[link](http://x)",
]


@pytest.fixture(params=HOSTILE)
def hostile(request, worse):
    """The report with a nasty name everywhere a user's word can be."""
    name = request.param
    item = Item(name, "J", 1.0, 2.0, 1.01, "regressed", name)
    lost = Item(name, "", None, None, None, "not comparable", name)
    return replace(
        worse,
        profile=name,
        trials=name,
        baseline=name,
        profile_file=name,
        items=(item, lost),
        changed=(Changed(name, 1.0, 2.0, 3, 0.5),),
        notes=(name,),
    )


def check_junit(document):
    """The rules of the schema most CI servers share (junit-10 of the Jenkins xUnit plugin), read by hand."""
    root = ET.fromstring(document)
    assert root.tag == "testsuites"
    assert set(root.attrib) <= {"name", "time", "tests", "failures", "errors"}
    for suite in root:
        assert suite.tag == "testsuite"
        assert {"name", "tests", "failures", "errors"} <= set(suite.attrib)
        assert re.fullmatch(r"\d{0,3}(\.\d{0,3})?", suite.get("time"))
        cases = list(suite)
        assert all(case.tag == "testcase" and case.get("name") for case in cases)
        assert all(set(case.attrib) <= {"name", "time", "classname", "group"} for case in cases)
        inside = [child for case in cases for child in case]
        assert {child.tag for child in inside} <= {"failure", "error", "skipped", "system-out"}
        for tag, attribute in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
            assert int(suite.get(attribute)) == sum(child.tag == tag for child in inside)
        for child in inside:
            assert set(child.attrib) <= {"type", "message"}
        assert int(suite.get("tests")) == len(cases)
    return root


def test_text_shows_what_is_wrong_and_the_verdict_last(worse):
    lines = text(worse).splitlines()
    assert lines[-1] == worse.sentence()
    assert lines[-1].startswith("FAIL")
    assert "mmgtune diagnose -p ship.toml -t trials" in lines[-2]
    assert all(len(line) <= 140 for line in lines)
    assert any("--all lists them" in line for line in lines)
    assert sum("REGRESSED" in line for line in lines) == 25
    everything = text(worse, everything=True)
    assert everything.count("\n") > len(worse.items)


def test_text_names_the_coefficients_that_matter_most(worse):
    many = tuple(Changed(f"hull.{k}", 1.0, 2.0, None, None) for k in range(30))
    assert "and 20 more" in text(replace(worse, changed=many))
    assert "hull.29" in text(replace(worse, changed=many), everything=True)


def test_text_of_a_pass_is_two_lines(worse, ship, data, baseline):
    from mmgtune.checking import check

    assert text(check(ship, data, baseline)).count("\n") == 2


def test_the_difference_a_new_baseline_makes(worse):
    told = difference(worse, "check.json").splitlines()
    assert told[-1].startswith("wrote check.json: ")
    assert "for the worse" in told[-1]
    assert any("->" in line for line in told)


def test_json_is_whole(worse):
    document = json.loads(as_json(worse))
    assert document["schema"] == 1
    assert document["verdict"] == "regressed"
    assert len(document["items"]) == len(worse.items)
    assert document["changed"][0]["name"] == "hull.N_r"
    assert sum(document["counts"].values()) == len(worse.items)


def test_junit(worse):
    root = check_junit(junit(worse))
    assert {suite.get("name") for suite in root} == set(worse.trial_ids)
    assert len(root.findall(".//failure")) == len(worse.by_status["regressed"])


def test_junit_of_every_status(worse):
    of = [
        Item("a", "J", 2.0, 1.0, 2.02, "improved"),
        Item("a", "rms_r", None, None, None, "not shown", "no r"),
        Item("b", "", None, None, None, "not comparable", "changed"),
        Item("b", "MED", 1.0, float("inf"), 1.1, "regressed"),
    ]
    root = check_junit(junit(replace(worse, items=tuple(of))))
    assert [len(root.findall(f".//{tag}")) for tag in ("failure", "error", "skipped", "system-out")] == [1, 1, 1, 1]
    assert "diverged" in root.find(".//failure").get("message")


def test_annotations_worst_first_and_few(worse):
    lines = github(worse).splitlines()
    errors = [line for line in lines if line.startswith("::error ")]
    assert len(errors) == 10
    assert "FAIL" in errors[0]
    assert f",line={worse.changed[0].line}," in errors[0]
    titles = [re.search(r"title=(.*?)::", line).group(1) for line in errors[1:]]
    worst = worse.by_status["regressed"][: len(titles)]
    assert all(title.startswith(item.trial) for title, item in zip(titles, worst, strict=True))


def test_markdown(worse):
    page = markdown(worse)
    assert page.startswith("### FAIL")
    assert "hull.N" in page
    assert "mmgtune check ship.toml trials --baseline check.json" in page
    rows = [line for line in page.splitlines() if line.startswith("| ")]
    assert all(len(re.findall(r"(?<!\\)\|", row)) == 8 for row in rows)


def test_could_not_run():
    report = could_not_run(("p.toml", "t", "b.json"), (Problem("it is broken", "p.toml, line 3", "why", "fix"),))
    assert report.verdict == "not comparable"
    for render in RENDERERS.values():
        assert "it is broken" in render(report)
    assert len(check_junit(junit(report)).findall(".//error")) == 1


def test_hostile_names_in_junit(hostile):
    root = check_junit(junit(hostile))
    assert len(root.findall(".//failure")) == 1
    assert "\x00" not in junit(hostile)


def test_hostile_names_in_annotations(hostile):
    lines = github(hostile).split("\n")
    assert lines[-1] == ""
    for line in lines[:-1]:
        found = re.fullmatch(r"::(error|warning|notice) ((?:\w+=[^,:]*)(?:,\w+=[^,:]*)*)::(.*)", line)
        assert found, line
        assert "\r" not in line


def test_hostile_names_in_markdown(hostile):
    page = markdown(hostile)
    outside = re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", "", page)
    assert "<script" not in outside
    assert "<!--" not in outside
    assert "](http" not in re.sub(r"\\.", "", outside)
    rows = [line for line in page.splitlines() if line.startswith("| ") and "---" not in line]
    assert all(len(re.findall(r"(?<!\\)\|", row)) == 8 for row in rows), rows
    assert len(rows) == 3


def test_hostile_names_in_json(hostile):
    assert json.loads(as_json(hostile))["profile"] == hostile.profile


def test_changes_are_plain_numbers():
    told = [change(Item("a", "J", 1.0, now, None, "regressed")) for now in (1.012, 2.4, 3.9, 20.0)]
    assert told == ["+1.2 %", "+140 %", "+290 %", "x20"]
    assert "undoes all of the loss" in str(Changed("hull.N_v", 1.0, 2.0, 3, 1.54))


def test_every_format_is_a_file_and_every_file_a_format():
    files = {found.name for found in pkgutil.iter_modules(renderers.__path__)}
    assert files - {"numbers"} == set(FORMATS) == set(RENDERERS)


SHOUT = """
import sys
from mmgtune import options
found = sys.argv.pop(1)
options.FORMATS += ("shout",)
import mmgtune.checking
from importlib.util import module_from_spec, spec_from_file_location
spec = spec_from_file_location("mmgtune.checking.renderers.shout", found)
module = module_from_spec(spec)
spec.loader.exec_module(module)
sys.modules[spec.name] = module
from mmgtune.cli import main
main()
"""


def test_a_format_is_one_file_and_one_word(folder, tmp_path, baseline):
    write_baseline(baseline, tmp_path / "check.json")
    (tmp_path / "shout.py").write_text("def render(report):\n    return report.verdict.upper() + '!'\n")
    command = [sys.executable, "-c", SHOUT, str(tmp_path / "shout.py"), "check"]
    trials = [str(folder / "ship.toml"), str(folder / "trials"), "--baseline", str(folder / "check.json")]
    done = subprocess.run([*command, *trials, "--format", "shout"], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr, done.returncode) == ("PASS!", "", 0)
    told = subprocess.run([*command, "--help"], capture_output=True, text=True, check=False).stdout
    assert "shout" in told
