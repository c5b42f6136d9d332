"""The search for causes: which hypotheses are refitted, how, and which is taken.

search            look, add, and look again; base_fit: where it begins; look: screen, refit, decide
shortlist         which hypotheses are refitted in a look
refitter          one of them: from where, and how far; refitting: all of a look, the likeliest first
refit             whether one is believed, and what rivals it
instead           a single cause in place of re-tuning
narrow            whether the box of the targets is in the way
"""
