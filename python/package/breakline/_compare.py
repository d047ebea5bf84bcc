"""Comparison of results that contain arrays."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np


def same(one: Any, other: Any) -> bool:
    """Return True if two values are alike; arrays are if they have the same type, shape and numbers, NaN included."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return _same_arrays(np.asanyarray(one), np.asanyarray(other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))
    return bool(one == other)


def _same_arrays(one: "np.ndarray[Any, Any]", other: "np.ndarray[Any, Any]") -> bool:
    if one.shape != other.shape or one.dtype != other.dtype:
        return False
    masks = np.ma.getmaskarray(one), np.ma.getmaskarray(other)
    if not np.array_equal(*masks):
        return False
    kept = ~masks[0]
    return np.array_equal(np.asarray(one)[kept], np.asarray(other)[kept], equal_nan=one.dtype.kind in "fc")


class Compared:
    """A result that equals another one if all its fields are alike. It has no hash."""

    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        compared = [field.name for field in fields(self) if field.compare]  # type: ignore[arg-type]
        return all(same(getattr(self, name), getattr(other, name)) for name in compared)
