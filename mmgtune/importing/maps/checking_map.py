"""What is wrong about entries of a map that are right one by one."""

from __future__ import annotations

from typing import Any

from ...errors import closest
from ...inputs import INPUTS
from ...toml_reading import TomlReader
from ...trial.schema import MAIN_INPUTS, surrounding
from .mapping import TABLES, LogMap
from .quantities import PAIRS, meaning

IN_SENTENCES = (
    "psi", "u", "v", "r", "n", "delta", "delta_port", "delta_stbd", "wind_speed", "wind_dir", "wind_speed_app",
    "wind_dir_app", "depth",
)  # fmt: skip
"""What a map may give a sign, a factor and an offset to where the log is NMEA 0183."""


def check(made: LogMap, reader: TomlReader) -> None:
    """Note every contradiction in what was read, and everything it leaves open."""
    sources = made.sources
    for name, source in sources.items():
        if source.value is not None and name not in INPUTS and surrounding(name) is None:
            what = f"'{name}', {meaning(name)}, is given as a constant"
            reader.problem(what, f"columns.{name}", "value", "it is what a trial measures", "name its column")
    if made.shifted and made.point not in ("antenna", "stated"):
        reader.problem(
            "'velocity.shifted' says that velocities were moved, but not from where",
            "velocity",
            "shifted",
            fix='say point = { x = "3 m", y = "0 m" }, where they were measured, seen from midship',
        )
    if made.shifted and made.axes is None and made.format != "nmea" and "sog" not in sources:
        fix = 'say [velocity] axes = "earth" or axes = "ship"'
        reader.problem("are the shifted velocities in ship axes or in earth axes?", "velocity", "shifted", fix=fix)
    if made.format == "nmea":
        _sentences(made, reader)
        return
    if _table(reader, "log").get("fields") == 0:
        reader.problem("'log.fields' is 0", "log", "fields", fix="write how many fields a row has")
    if made.fields and made.header:
        reader.problem("'log.fields' is for logs without a header", "log", "fields", "columns have names there")
    text = ("delimiter", "encoding")  # texts in cells may have decimal commas wherever they stand
    meaningless = {
        "csv": (("sheet", "join", "variable"), "text"),
        "parquet": ((*text, "skip", "header", "fields", "sheet", "join", "variable"), "Parquet"),
        "xlsx": ((*text, "variable"), "a workbook"),
        "mat": ((*text, "skip", "header", "sheet", "join"), "a MATLAB file"),
    }
    if made.format in meaningless:
        _meaningless(reader, "log", *meaningless[made.format])
    if not made.time.columns and not isinstance(_table(reader, "time").get("column"), list):
        reader.problem("no column is named for time", "time", fix='write [time] with column = "..." and unit = "s"')
    for name, source in sources.items():
        if source.column is None and source.value is None:
            fix = 'write column = "..." or value = "..."'
            reader.problem(f"'{name}' has neither a column nor a value", f"columns.{name}", fix=fix)
    for name in ("psi", *MAIN_INPUTS):
        if name not in sources and name not in made.means:
            fix = f'write [columns.{name}] with column = "..." and unit, or value = "..." where it is constant'
            reader.problem(f"no column is named for '{name}', {meaning(name)}", "columns", fix=fix)
    rate = sources.get("r")
    if "psi" in sources and sources["psi"].recover and (rate is None or rate.column is None or not rate.positive):
        reader.problem(
            "the heading is to be recovered from the yaw rate, but the map does not say where that is and its sign",
            "columns.psi",
            "recover",
            fix='write [columns.r] with column = "...", unit, and positive = "starboard" or "port"',
        )
    if not ({"x", "y"} <= set(sources) or {"latitude", "longitude"} <= set(sources)):
        fix = "write [columns.x] and [columns.y], or [columns.latitude] and [columns.longitude]"
        reader.problem("no columns are named for the position", "columns", fix=fix)
    if {"x", "latitude"} <= set(sources):
        reader.problem("the map has both local and geographic positions", "columns.latitude", fix="remove one of them")
    if {"u", "sog"} <= set(sources):
        reader.problem("the map has both u and speed over ground", "columns.sog", fix="remove one of them")
    if "cog" in sources and "sog" not in sources:
        reader.problem("a course over ground is of no use without the speed", "columns.cog", fix="name sog too")
    if made.axes == "earth" and len({"u", "v"} & set(sources)) == 1:
        reader.problem("velocities in earth axes are of use only together", "velocity", "axes", fix="name u and v")
    if made.antenna and {"u", "v"} & set(sources) and made.point is None:
        reader.problem(
            "are the velocities u and v of midship or of the antenna?",
            "antenna",
            why="a ship's ends move sideways when she turns",
            fix='say [velocity] point = "midship" or point = "antenna"',
        )
    if made.point == "antenna" and made.antenna is None:
        reader.problem("velocities are of the antenna, but no [antenna] says where it is", "velocity", "point")
    if made.point == "stated" and not {"u", "v"} & set(sources) and "sog" not in sources:
        reader.problem("'velocity.point' is given, but no velocities are", "velocity", "point", fix="remove it")
    for pair in PAIRS:
        if set(pair) <= set(sources) and sources[pair[0]].late != sources[pair[1]].late:
            what = f"'{pair[0]}' and '{pair[1]}' are late by different times"
            reader.problem(what, f"columns.{pair[1]}", "late", "they are of one sensor", "say the same in both")
    for name, words, axes in (("u", ("north", "south"), "earth"), ("v", ("east", "west"), "earth")):
        positive = sources[name].positive if name in sources else None
        if positive in words and made.axes != axes:
            fix = '[velocity] axes = "earth"'
            reader.problem(f"'{name}' is positive to the {positive}: earth axes?", f"columns.{name}", fix=f"say {fix}")


def _meaningless(reader: TomlReader, table: str, keys: tuple[str, ...], form: str) -> None:
    for key in keys:
        if key in _table(reader, table):
            reader.problem(f"'{table}.{key}' has no meaning for {form}", table, key, fix="remove it")


def _sentences(made: LogMap, reader: TomlReader) -> None:
    """What a map of NMEA 0183 cannot say: sentences have columns, units, axes and times of their own."""
    _meaningless(reader, "log", TABLES["log"][1:], "NMEA 0183")
    _meaningless(reader, "time", TABLES["time"], "NMEA 0183")
    _meaningless(reader, "velocity", ("axes",), "NMEA 0183")
    for name, source in made.sources.items():
        where = f"columns.{name}"
        if name not in IN_SENTENCES and source.value is None:
            fix = closest(name, IN_SENTENCES)
            reader.problem(f"no sentence holds '{name}'", where, fix=f"{fix}; or give it as a constant")
        _meaningless_of(reader, where, ("column", "unit", "zero", "direction", "recover"))


def _meaningless_of(reader: TomlReader, where: str, keys: tuple[str, ...]) -> None:
    written = reader.data["columns"][where.removeprefix("columns.")]
    for key in keys:
        if isinstance(written, dict) and key in written:
            fix = "remove it: the standard says what sentences hold"
            reader.problem(f"'{where}.{key}' has no meaning for NMEA 0183", where, key, fix=fix)


def _table(reader: TomlReader, name: str) -> dict[str, Any]:
    table = reader.data.get(name)
    return table if isinstance(table, dict) else {}
