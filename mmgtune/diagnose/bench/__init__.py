"""What everything in a diagnosis stands on: the trials, the model with every effect, and what is not known of them.

workbench         trials, model with every effect, box and noise, on which everything is fitted
hypotheses        what may be the cause
runs              which runs may have a value of their own
noise, inputs     what chance does to residuals, and what logged inputs do not say
beliefs, winds    what is not known of the hull, of the forms of effects and of a wind
wave_groups       what is not known of waves
of_hull           whether a hull that is further off would explain a cause as well
"""
