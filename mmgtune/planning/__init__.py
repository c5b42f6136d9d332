"""The trial to sail next: of those that can be sailed, the one that tells most about a question.

question    an index of a manoeuvre, as people write it
candidates  trials that can be sailed
expected    what a trial would leave open
run         from particles and a question to a ranking
"""

from .question import Question
from .run import Expected, TrialPlan, plan_trial, write_plan

__all__ = ["Expected", "Question", "TrialPlan", "plan_trial", "write_plan"]
