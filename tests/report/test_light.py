"""What a page costs: no library that draws, little time, few letters."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from . import fake_run


def test_a_page_needs_no_library_that_draws(tmp_path: Path) -> None:
    folder = fake_run.make_fit(tmp_path / "run")
    code = (
        "import sys; from pathlib import Path; from mmgtune.report import render; render(Path(sys.argv[1]));"
        "heavy = {'matplotlib', 'scipy', 'numba', 'pandas'} & set(sys.modules);"
        "sys.exit(' '.join(heavy) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code, str(folder)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (folder / "report.html").stat().st_size < 2e6
