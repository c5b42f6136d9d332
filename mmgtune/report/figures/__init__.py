"""Figures as data (plot), what draws them (svg, pdf), and the figures of each kind of run."""
