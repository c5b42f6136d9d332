"""Kernels use vectors as wide as the processor has."""

import llvmlite.binding
import numpy as np
import pytest

from mmgtune.backends.compiling import njit, whole_vectors


@njit
def _doubled(values):
    whole_vectors()
    for k in range(len(values)):
        values[k] = 2.0 * values[k] + 1.0


def test_vectors_of_a_kernel_are_not_halved():
    values = np.arange(64.0)
    _doubled(values)
    assert np.array_equal(values, 2.0 * np.arange(64.0) + 1.0)
    (text,) = _doubled.inspect_llvm().values()
    assert '"prefer-vector-width"="512"' in text
    if not llvmlite.binding.get_host_cpu_features().get("avx512f"):
        pytest.skip("this processor has no AVX-512: its widest vectors are used anyhow")
    (text,) = _doubled.inspect_asm().values()
    assert "zmm" in text
