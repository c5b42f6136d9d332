"""Hostile inputs by the thousand: mutated files and what becomes of them.

kinds/     one module a kind of input, each with a ``KIND``; they are found by being there
mutating   what is done to bytes, lines, cells and numbers
running    one case under limits of time and memory; many in a row
corpus/    cases that once failed, a folder of files each, under their kind

``python -m tests.fuzz --kind csv --count 2000 --seed 1`` runs as many cases of a kind and keeps those that fail.
"""
