"""Maps proposed from what logs hold.

sampling    the beginning of a log without a map; words: what names say
common      columns that all logs have
clocks      which column is time; parted: or which several are
windows     columns on average and by their change
joined      latitudes and longitudes in several columns
bearings    position and heading; look: the motion that follows from them
motions     yaw rate and velocities; orders: rudder and propeller; winds: true and apparent
finding     every quantity, of several logs at once; guess: one of them
writing     the map and a table
misnamed    units that behaviour refutes; unsaid: those that no name says
elsewhere   which column is what another one is said to be
"""
