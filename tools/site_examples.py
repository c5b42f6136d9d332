"""The commands of a page of docs/ run one after the other in a folder, and what they draw left there.

    python -m tools.site_examples docs/gallery.md FOLDER

Commands stand in blocks of sh, one a line; blocks of python draw one figure each, saved as the picture that the page
wants after the block.  Files that the tutorial has its reader save are there from the start.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import sys
from glob import glob
from pathlib import Path

ROOT = Path(__file__).parent.parent
TUTORIAL = ROOT / "docs" / "tutorial" / "index.md"
SAVED = re.compile(r'^```toml title="(.*?)"\n(.*?)^```', flags=re.M | re.S)
STEP = re.compile(r"^```(sh|python)\n(.*?)^```(?:\s*<!-- picture: (\S+) \|)?", flags=re.M | re.S)


def main(page: Path, folder: Path) -> None:
    """Run the steps of a page in a folder, which is made."""
    import matplotlib as mpl

    mpl.use("agg")
    mpl.rcParams |= {"svg.hashsalt": "mmgtune", "svg.fonttype": "none", "font.family": "sans-serif"}
    folder.mkdir(parents=True, exist_ok=True)
    text = page.read_text(encoding="utf-8")
    os.chdir(folder)
    if not Path("mmgtune").exists():
        Path("mmgtune").symlink_to(ROOT)  # where the pages say that the repository is
    for name, content in SAVED.findall(TUTORIAL.read_text(encoding="utf-8")):
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(content, encoding="utf-8")
    for language, block, picture in STEP.findall(text):
        if language == "sh":
            for line in block.splitlines():
                command(line)
        else:
            drawn(block, Path(picture))
    Path("mmgtune").unlink()


def command(line: str) -> None:
    """Run a line that begins with mmgtune.  Raises SystemExit with what it said where it fails."""
    from mmgtune.cli import app

    said = io.StringIO()
    words = [found for word in shlex.split(line)[1:] for found in (sorted(glob(word)) or [word])]
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        ended = app(words, standalone_mode=False)
    if ended:
        raise SystemExit(f"{line}: ended with {ended}\n{said.getvalue()}")


def drawn(code: str, picture: Path) -> None:
    """Run Python and save the figure that it draws."""
    import matplotlib.pyplot as plt

    plt.close("all")
    exec(compile(code, str(picture), "exec"), {})
    picture.parent.mkdir(parents=True, exist_ok=True)
    plt.gcf().savefig(picture, metadata={"Date": None})


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]))
