"""Cells and names of columns as people and programs write them.

numerals          numbers; thousands: with marks in them; with_units, digits: with a unit, with too few digits
dates, stopwatch  stamps; periods: that begin anew; time_parts: with a part in each column
degrees           latitude and longitude; position_parts, position_pair: in several columns, in one
headers           names and units; seldom: columns that most rows have no value of
"""
