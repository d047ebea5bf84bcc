"""Points in columns."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np

from ._compare import Compared


@dataclass(frozen=True, eq=False)
class Points(Compared):
    """Points in columns of equal length.

    Attributes
    ----------
    x, y, z : ndarray of float64, (n,)
        Coordinates, in the units of the coordinate system.
    classification : ndarray of uint8, (n,), or None
        Classes as in LAS (2 is ground); None if no file has any.
    flags : ndarray of uint8, (n,), or None
        1 synthetic, 2 key point, 4 withheld, 8 overlap.
    return_number, number_of_returns : ndarray of uint8, (n,), or None
    crs : str or None
        The coordinate system, as WKT.
    report : dict
        Counts of points that were read, and why others are not here.
    """

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    classification: Optional[np.ndarray] = None
    flags: Optional[np.ndarray] = None
    return_number: Optional[np.ndarray] = None
    number_of_returns: Optional[np.ndarray] = None
    crs: Optional[str] = None
    report: "dict[str, Any]" = field(default_factory=dict, repr=False, compare=False)

    def __len__(self) -> int:
        return len(self.x)

    @property
    def xyz(self) -> np.ndarray:
        """The coordinates as an array (n, 3) of float64, made anew."""
        return np.column_stack([self.x, self.y, self.z])
