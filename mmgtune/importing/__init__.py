"""Logs of trials (CSV, Parquet, NMEA 0183) to trial files.

mapping         the map of a log; reading_map: from TOML; checking_map: its contradictions; quantities: what there is
headers         names and units in logs
forms           what kind of file a log is
table           columns of a log; rows: those a map names
text            logs read as tables; parquet_log, workbook, matlab and matlab_columns; cells: of what is in memory
clock           time put right; stopwatch, dates, degrees, numerals, thousands, sides: as people write them
seldom          columns that most rows of a merged log have no value of
periods         what begins anew at midnight
time_parts      hours, minutes and seconds in columns of their own; position_parts: degrees and minutes;
                position_pair: latitude and longitude in one
record          quantities in the program's units, each with its own time; nmea: reading sentences
digits          made up for where too few are printed; yaw: the heading from its rate; cleaning: spikes
jumps           records cut where time jumps forward
geodesy         latitude and longitude to metres; gridding: one uniform time
motion          midship, ship axes, and velocities that were not measured
conventions     signs and axes a map does not state
cutting         what is kept of a record, and a pull-out as a trial of its own
quality         what the result is worth
importer        all of it
doubts          what a trial shows of its sensors unasked
proposing       what columns are, by behaviour and name; proposal: a map of it, tried by the import
"""

from .importer import Imported, import_logs
from .mapping import LogMap
from .proposal import Proposal, propose_map
from .reading_map import load_map, parse_map

__all__ = ["Imported", "LogMap", "Proposal", "import_logs", "load_map", "parse_map", "propose_map"]
