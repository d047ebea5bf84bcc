"""The difference of two surfaces, as a function."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _breakline, _inputs
from ._call import Progress, call
from ._names import Method
from ._results import Raster, frame_of, of_cells
from ._verbs import names_of, refuse_kept, surfaces_of

__all__ = ["Comparison", "compare"]


@dataclass(frozen=True, eq=False)
class Comparison:
    """The difference of two surfaces: the heights of the first minus those of the second.

    Attributes
    ----------
    raster : Raster
        The difference in each cell, NaN where a surface has no height.
    cells : int
        How many cells are on both surfaces; the numbers are theirs, NaN if there are none.
    mean, median, standard_deviation, rmse, nmad, percentile_95, min, max, skew : float
        Statistics; ``percentile_95`` is that of the amounts.
    worst : (n, 3) array of float64
        Places with the largest differences, the largest first, at least 8 cells apart: x, y and difference.
    changed : tuple of int or None
        How many cells are higher, and lower, by more than the height that was given.
    """

    raster: Raster
    cells: int
    mean: float
    median: float
    standard_deviation: float
    rmse: float
    nmad: float
    percentile_95: float
    min: float
    max: float
    skew: float
    worst: NDArray[np.float64]
    changed: "Optional[tuple[int, int]]"


def compare(
    a: Any,
    b: Any,
    *,
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    worst: int = 10,
    changed: Optional[float] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Comparison:
    """Compare two surfaces in the cells of a raster.

    Parameters
    ----------
    a, b
        The surfaces: each a :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes.
    resolution, extent, align_to, method
        As for :func:`dem`. A raster keeps its cells: those of ``a`` if it is one, else those of ``b`` unless cells are
        given.
    worst : int
        How many of the places with the largest differences are listed.
    changed : float, optional
        A height: cells that differ by more are counted.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`, for those of ``a`` and ``b`` that are points.

    Examples
    --------
    >>> import breakline
    >>> slope = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
    >>> found = breakline.compare(slope, [[0, 0, 1], [10, 0, 1], [10, 10, 1], [0, 10, 1]], resolution=5)
    >>> found.raster.array.tolist(), found.mean
    ([[1.5, 1.5], [0.5, 0.5]], 1.0)
    """
    refuse_kept(surface)
    by = _inputs.name(method, "method")
    frame = frame_of(resolution, extent, align_to)
    height = None if changed is None else _inputs.number(changed, "changed")
    places = _inputs.whole_numbers([worst], "worst", 1_000_000)[0]
    first, second = surfaces_of([a, b], surface, threads, progress, by)
    with call(threads, progress) as request:
        cells, count, numbers, found, counts = _breakline.compare(
            first, second, frame, by, places, height, names_of([(a, "a"), (b, "b")]), request
        )
    return Comparison(of_cells(cells, "difference"), count, *numbers, found, counts)
