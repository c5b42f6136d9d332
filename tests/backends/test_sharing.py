"""Several processes share one folder of compiled kernels."""

import os
import subprocess
import sys

from tests.backends.kernels import LOAD

CODE = (
    LOAD
    + """
print("ready", flush=True)
input()
with install_recorder("numba:compile") as recorded:
    kernel(x)
    kernel(x)
assert x.tolist() == [4.0, 4.0, 4.0]
print(len(recorded.buffer))
"""
)


def test_of_processes_that_want_a_kernel_at_once_one_compiles_it(tmp_path):
    started = [
        subprocess.Popen(
            [sys.executable, "-c", CODE],
            env={**os.environ, "MMGTUNE_CACHE": str(tmp_path)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for _ in range(3)
    ]
    for process in started:
        assert process.stdout.readline() == "ready\n"
    for process in started:
        process.stdin.write("\n")
        process.stdin.flush()
    compiled = [int(process.communicate()[0]) for process in started]
    assert [process.returncode for process in started] == [0, 0, 0]
    assert sum(count > 0 for count in compiled) == 1
