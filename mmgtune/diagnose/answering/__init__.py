"""From the outcome of a search to the answer.

judging           causes, their rivals and what they gain
verdict           what was found; saying: in words a captain understands
detecting         what the trials could have told; separate: the trial that would tell
jumped            runs whose position jumps; ended: sensors at the end of their range
one_clock         two scales that are one clock; one_form: values of each run that are one form
"""
