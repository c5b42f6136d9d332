"""The beginning of a program that loads a kernel: doubling every number of ``x``, three ones at first."""

LOAD = """
import numpy as np
from mmgtune.backends.compiling import load_kernel
from numba.core.event import install_recorder

TEXT = '''
from mmgtune.backends.compiling import njit


@njit(cache=True)
def kernel(x):
    for i in range(len(x)):
        x[i] = 2.0 * x[i]
'''
kernel = load_kernel(TEXT)
x = np.ones(3)
"""
