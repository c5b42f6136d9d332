"""A page for each kind of run, and parts of the larger ones; kinds: which there are."""
