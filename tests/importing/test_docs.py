"""The map shown in the documents is one that reads."""

import re
from pathlib import Path

from mmgtune.importing import parse_map
from mmgtune.importing.maps.quantities import QUANTITIES
from mmgtune.importing.maps.reading_map import COLUMN_KEYS, TABLES

PAGE = (Path(__file__).parents[2] / "docs" / "formats.md").read_text(encoding="utf-8")
SECTION = PAGE.split("## Map of a log")[1].split("\n## ")[0]


def test_the_map_shown_reads():
    (text,) = re.findall(r"^```toml\n(.*?)^```", SECTION, flags=re.M | re.S)
    shown = parse_map(text)
    assert shown.antenna == (31.0, -2.5)
    assert set(shown.sources) <= set(QUANTITIES)


def test_every_key_is_documented():
    keys = {key for table, keys in TABLES.items() if table for key in keys} | set(COLUMN_KEYS)
    assert [key for key in sorted(keys) if f"`{key}`" not in SECTION and f"`{key} " not in SECTION] == []
