"""Every quantity of logs found in their columns: by behaviour first, by name where behaviour does not tell."""

from __future__ import annotations

from collections.abc import Sequence

from ...errors import LogError
from ...phrases import listed
from .common import as_each_says, in_common, of_different_kinds
from .find_controls import propeller, rudder
from .find_motion import velocity, yaw_rate
from .find_rest import by_name, few_digits, missing, whole_degrees
from .find_time import doubt_rates, time
from .find_track import position_and_heading
from .find_wind import wind
from .finder import Finder
from .joined import join_positions
from .misnamed import doubt_units
from .no_values import without_codes
from .sampling import Sample
from .unread import doubt_thousands, unread
from .unsaid import say_units


def found_in(samples: Sequence[Sample]) -> Finder:
    """What the columns of logs of one kind are.  Raises LogError where they differ, or none is time."""
    together, own, differing = as_each_says(samples)
    shared, others = in_common(together)
    shared, said = without_codes(shared)
    find = Finder(shared, own)
    find.notes += [*dict.fromkeys(note for one in samples for note in one.notes), *differing, *said]
    if others:
        shown = listed([f"'{name[:60]}'" for name in others], 8)
        find.notes.append(f"not all logs have {shown}: left out")
    join_positions(find)
    time(find)
    position_and_heading(find)
    if find.looks:
        doubt_units(find)
        yaw_rate(find)
        velocity(find)
        wind(find)
        rudder(find)
        propeller(find)
    by_name(find)
    say_units(find)
    whole_degrees(find)
    few_digits(find)
    missing(find)
    if others and any("column" in one.keys and one.column is None for one in find.guesses.values()):
        raise LogError(of_different_kinds(samples))
    unread(find)
    doubt_thousands(find)
    doubt_rates(find)
    return find
