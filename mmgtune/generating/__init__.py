"""Trials made of a model of this program, in place of measured ones: what was true is kept beside what is shown.

sailing    ships side by side under orders, with actuators and wandering wind
orders     helmsmen: turning circles, zigzags, orders at random
pilot      berthing: approach, slowing down, swinging and crabbing
sets       which manoeuvres make up a set, after the papers
writing    folders of trials, with noise and without
"""

from .writing import Made, make_trials

__all__ = ["Made", "make_trials"]
