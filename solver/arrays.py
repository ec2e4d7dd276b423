"""Read-only arrays with checked shapes, for frozen dataclasses; and sums that are the same on every machine."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


def dot(first: FloatArray, second: FloatArray) -> float:
    """The sum of products of two vectors (n,).

    Not by BLAS: from ten thousand entries on OpenBLAS shares them out to its threads, which spin with Python held
    when the machine is busy, and the sum depends on how many they are.
    """
    return float(np.einsum("n,n->", first, second))


def frozen_array(values: ArrayLike, dtype: Any, shape: tuple[int | None, ...], name: str) -> NDArray[Any]:
    """A read-only copy of ``values``.

    ``shape`` has one entry a dimension, None for any length. Raises ValueError when the shape differs.
    """
    array = np.array(values, dtype=dtype)
    if array.size == 0:
        array = array.reshape([0 if n is None else n for n in shape])
    if array.ndim != len(shape) or any(
        want is not None and got != want for got, want in zip(array.shape, shape, strict=True)
    ):
        raise ValueError(f"{name} has shape {array.shape}, expected {shape}")
    array.setflags(write=False)
    return array
