"""Causes once they are found: their sizes, what each contributes, and whether they are believed.

cause             a cause as it is named; by_run: with a value of each run
contributions     what each brings beside the others, and which are traces
belief            by which rules causes are believed; doubted: words for those that are not
"""
