"""Fleets on Dask, and what is said where it is not there."""

from __future__ import annotations

import builtins
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from mmgtune.errors import OptionError
from mmgtune.fleet import read_results, run_fleet
from mmgtune.fleet.cluster import connected
from mmgtune.options import FleetOptions

from .conftest import QUICK, make_logs

pytestmark = pytest.mark.filterwarnings("ignore")  # of libraries that are not ours

ALONE = FleetOptions(scheduler="local", workers=1)


def test_without_the_extra_the_error_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def lacking(name: str, *rest: Any, **more: Any) -> Any:
        if name.partition(".")[0] == "distributed":
            raise ImportError("No module named 'distributed'")
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", lacking)
    with pytest.raises(OptionError) as error, connected(ALONE):
        pass
    assert "pip install 'mmgtune[cluster]'" in error.value.problems[0].fix


@pytest.mark.long
def test_a_cluster_of_its_own_does_the_same_and_listens_on_loopback_only(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    make_logs(tmp_path, ("a1", "a2"), ("2025-01",))
    table = tmp_path / "fleet.toml"
    # Trials at URLs, too: each worker copies those of its job.
    table.write_text(QUICK.replace("logs/", f"file://{tmp_path}/logs/"), encoding="utf-8")
    with connected(ALONE) as client:
        info = client.scheduler_info()
        addresses = [info["address"], *info["workers"]]
        assert all(one.startswith("tcp://127.0.0.1:") for one in addresses)
        threads = client.nthreads()
        assert list(threads.values()) == [1]
        found = run_fleet(table, tmp_path / "dask", FleetOptions(scheduler=info["address"]))
    assert found.document["jobs"]["good"] == 2
    assert run_fleet(table, tmp_path / "here", FleetOptions(workers=1)).document["jobs"]["good"] == 2
    there, here = read_results(tmp_path / "dask"), read_results(tmp_path / "here")
    for row in (*there, *here):
        row.pop("seconds")
    assert there == here


def certificates(folder: Path) -> dict[str, Path]:
    """An authority of one's own and a certificate that it signed."""
    folder.mkdir(parents=True)
    quiet = {"cwd": folder, "check": True, "capture_output": True}
    made = ["-days", "2", "-nodes", "-newkey", "rsa:2048", "-keyout"]
    subprocess.run(["openssl", "req", "-x509", "-subj", "/CN=fleet", *made, "ca.key", "-out", "ca.pem"], **quiet)
    asked = ["-subj", "/CN=worker", *made[2:]]
    subprocess.run(["openssl", "req", *asked, "own.key", "-out", "own.csr"], **quiet)
    signed = ["-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial", "-days", "2"]
    subprocess.run(["openssl", "x509", "-req", "-in", "own.csr", *signed, "-out", "own.pem"], **quiet)
    return {"tls_ca": folder / "ca.pem", "tls_cert": folder / "own.pem", "tls_key": folder / "own.key"}


@pytest.mark.skipif(shutil.which("openssl") is None, reason="needs openssl to make certificates")
def test_tls_is_passed_through(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    files = certificates(tmp_path / "tls")
    ca, cert, key = (str(files[name]) for name in ("tls_ca", "tls_cert", "tls_key"))
    security = distributed.Security(
        tls_ca_file=ca, tls_scheduler_cert=cert, tls_scheduler_key=key, tls_worker_cert=cert, tls_worker_key=key,
        tls_client_cert=cert, tls_client_key=key, require_encryption=True,
    )  # fmt: skip
    how = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(host="tls://127.0.0.1", security=security, **how) as cluster:
        address = cluster.scheduler_address
        assert address.startswith("tls://")
        with connected(FleetOptions(scheduler=address, **files)) as client:
            assert client.submit(sum, [1, 2]).result() == 3


@pytest.mark.long
def test_a_scheduler_that_is_not_there(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("mmgtune.fleet.cluster.PATIENCE", "1s")
    with pytest.raises(OptionError) as error, connected(FleetOptions(scheduler="tcp://127.0.0.1:9")):
        pass
    assert error.value.problems[0].what == "the scheduler does not answer"


def test_addresses_and_certificates_that_do_not_go_together(tmp_path: Path) -> None:
    for given, words in (
        ({"scheduler": "10.0.0.5:8786"}, "write tcp://10.0.0.5:8786"),
        ({"scheduler": "tls://a:1"}, "add tls_ca=FILE, tls_cert=FILE, tls_key=FILE"),
        ({"scheduler": "tcp://a:1", "workers": 2}, "workers of this machine"),
        ({"tls_ca": tmp_path}, "certificates without a scheduler"),
    ):
        with pytest.raises(OptionError) as error:
            FleetOptions(**given)
        assert words in str(error.value)
