"""Masked arrays, treated alike by all functions: rows with a masked value are left out, and counted."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from ._errors import usage, warn


def as_array(values: Any) -> np.ndarray:
    """Return an array, without a copy if it is one; a masked one if the values, or items of a list, are masked.

    So are missing values of columns of pandas, pyarrow and polars.
    """
    if type(values) is np.ndarray or isinstance(values, np.ma.MaskedArray):
        return values
    if hasattr(values, "dtype") and hasattr(values.dtype, "na_value"):
        return _of_pandas(values)
    if hasattr(values, "null_count"):
        return _of_arrow(values)
    if isinstance(values, (list, tuple)) and any(isinstance(item, np.ma.MaskedArray) for item in values):
        return np.ma.array(values)
    return np.asarray(values)


def _of_pandas(column: Any) -> np.ndarray:
    """Return a column of one of the types of pandas that know missing values."""
    dtype = getattr(column.dtype, "numpy_dtype", None)
    if dtype is None or dtype.kind not in "biuf":
        return np.asarray(column)
    absent = np.asarray(column.isna(), bool)
    values = column.to_numpy(dtype=dtype, na_value=0)
    return np.ma.masked_array(values, absent) if absent.any() else values


def _of_arrow(column: Any) -> np.ndarray:
    """Return a column of pyarrow or polars."""
    count = column.null_count() if callable(column.null_count) else column.null_count
    if not count:
        return np.asarray(column)
    if count == len(column):
        return np.ma.masked_array(np.zeros(count, np.uint8), True)
    try:
        filled = np.asarray(column.fill_null(0))
    except (TypeError, ValueError, NotImplementedError):  # not numbers: who takes the column says so
        return np.asarray(column)
    return np.ma.masked_array(filled, np.asarray(column.is_null(), bool))


def kept(what: str, *columns: Any) -> Optional[np.ndarray]:
    """Return which rows of arrays of one length have no masked value, as an array of bool; None if all rows.

    The number of other rows is a warning.

    Raises
    ------
    UsageError
        If no row is left.
    """
    masked = _masked_rows(*columns)
    if masked is None:
        return None
    count, of = int(masked.sum()), len(masked)
    if count == of:
        raise usage(f"all {of} {what} are masked", None, "unmask those that are to be used")
    warn([f"{count} of {of} {what} are masked, and left out"])
    return ~masked


def rows(what: str, *columns: Any) -> "list[np.ndarray]":
    """Return arrays of one length as plain ones, without the rows in which one of them is masked; see `kept`."""
    keep = kept(what, *columns)
    return [np.asarray(column) if keep is None else np.asarray(column)[keep] for column in columns]


def without_value(what: str, positions: np.ndarray) -> Optional[np.ndarray]:
    """Return which of some positions, (..., n), are masked, and get no value; None if none is. Their number is a warning."""
    masked = _masked_rows(positions.reshape(-1, positions.shape[-1]))
    if masked is None:
        return None
    warn([f"{int(masked.sum())} of {len(masked)} {what} are masked, and have no value"])
    return masked


def _masked_rows(*columns: Any) -> Optional[np.ndarray]:
    masked = None
    for column in columns:
        mask = np.ma.getmask(column)
        if mask is not np.ma.nomask and mask.any():
            of_rows = mask.reshape(len(mask), -1).any(axis=1)
            masked = of_rows if masked is None else masked | of_rows
    return masked
