"""Logs of trials (CSV, Parquet, NMEA 0183) to trial files.

maps/           the map of a log, and what a log can hold
formats/        files that logs come in, each as a table of named columns or as a record
cells/          numbers, dates, positions and names of columns as people and programs write them
clock           time put right; jumps: records cut where it jumps forward
record          quantities in the program's units, each with its own time; cleaning: spikes
yaw             the heading from its rate
geodesy         latitude and longitude to metres; gridding: one uniform time
motion          midship, ship axes, and velocities that were not measured; means: of several rudders or propellers
conventions     signs and axes a map does not state
cutting         what is kept of a record, and a pull-out as a trial of its own
quality         what the result is worth
importer        all of it
doubts          what a trial shows of its sensors unasked
proposing/      what columns are, by behaviour and name; proposal: a map of it, tried by the import
presets/        maps that travel along
"""

from .importer import Imported, Refused, import_logs
from .maps.mapping import LogMap
from .maps.reading_map import load_map, parse_map
from .proposal import Proposal, propose_map

__all__ = ["Imported", "LogMap", "Proposal", "Refused", "import_logs", "load_map", "parse_map", "propose_map"]
