"""The examples of deployment in the guide, as far as they can be checked without a cluster."""

from __future__ import annotations

import ast
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from mmgtune.options.flags import FLAGS
from tests.command import ROOT

GUIDE = (ROOT / "docs" / "guides" / "fleets.md").read_text(encoding="utf-8")


def block(title: str) -> str:
    """The block of the guide with that title."""
    found = re.search(rf'```\w+ title="{re.escape(title)}"\n(.*?)```', GUIDE, re.DOTALL)
    assert found is not None, title
    return found[1]


def understood(command: list[str], tmp_path: Path) -> None:
    """A command of mmgtune whose options exist, or one of Dask's whose own help has them."""
    if command[:1] == ["dask"]:
        pytest.importorskip("distributed")
        told = subprocess.run(
            [sys.executable, "-m", f"distributed.cli.dask_{command[1]}", "--help"], capture_output=True, text=True
        )
        known = set(re.findall(r"--[\w-]+", told.stdout))
    else:
        assert command[:3] == ["mmgtune", "fleet", "run"]
        known = {*FLAGS.values(), "--out", "--resume"}
    assert {word for word in command if word.startswith("--")} <= known, command


def test_kubernetes(tmp_path: Path) -> None:
    yaml = pytest.importorskip("yaml")
    documents: list[dict[str, Any]] = list(yaml.safe_load_all(block("fleet.yaml")))
    assert [one["kind"] for one in documents] == ["Service", "Deployment", "Deployment", "Job"]
    versions = {"Service": "v1", "Deployment": "apps/v1", "Job": "batch/v1"}
    assert all(one["apiVersion"] == versions[one["kind"]] and one["metadata"]["name"] for one in documents)
    service, scheduler, worker, job = documents
    labels = scheduler["spec"]["template"]["metadata"]["labels"]
    assert service["spec"]["selector"] == labels == scheduler["spec"]["selector"]["matchLabels"]
    assert worker["spec"]["selector"]["matchLabels"] == worker["spec"]["template"]["metadata"]["labels"]
    address = f"tcp://{service['metadata']['name']}:{service['spec']['ports'][0]['port']}"
    for one in (scheduler, worker, job):
        pod = one["spec"]["template"]["spec"]
        (container,) = pod["containers"]
        understood(container["args"], tmp_path)
        mounted = {mount["name"] for mount in container.get("volumeMounts", ())}
        assert mounted == {volume["name"] for volume in pod.get("volumes", ())}
        assert address in container["args"] or one is scheduler
    assert job["spec"]["template"]["spec"]["restartPolicy"] in ("OnFailure", "Never")
    threads = worker["spec"]["template"]["spec"]["containers"][0]["args"]
    assert threads[threads.index("--nthreads") + 1] == "1"


def test_slurm(tmp_path: Path) -> None:
    tree = ast.parse(block("on_slurm.py"))
    (listed,) = [one.value for one in ast.walk(tree) if isinstance(one, ast.Assign) and isinstance(one.value, ast.List)]
    understood([one.value if isinstance(one, ast.Constant) else "tcp://a:1" for one in listed.elts], tmp_path)
    (call,) = [
        one for one in ast.walk(tree) if isinstance(one, ast.Call) and getattr(one.func, "id", "") == "SLURMCluster"
    ]
    given = {word.arg: ast.literal_eval(word.value) for word in call.keywords}
    assert given["cores"] == given["processes"]  # one thread a process
    jobqueue = pytest.importorskip("dask_jobqueue")
    job = jobqueue.slurm.SLURMJob("tcp://127.0.0.1:1", "worker", **given)
    script = job.job_script()
    assert "--nthreads 1" in script
    assert "#SBATCH" in script


def test_shown_commands_have_their_options(tmp_path: Path) -> None:
    shown = [line for line in GUIDE.splitlines() if line.startswith("mmgtune fleet run")]
    assert len(shown) >= 4
    for line in shown:
        understood([word for word in shlex.split(line) if word != "--dry-run"], tmp_path)
