"""The difference of two surfaces, as a function."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _breakline, _inputs
from ._call import Progress, call
from ._errors import usage
from ._names import Method
from ._results import Raster, frame_of, of_cells
from ._verbs import names_of, refuse_kept, surfaces_of

__all__ = ["ChangedArea", "Comparison", "compare"]


@dataclass(frozen=True, eq=False)
class ChangedArea:
    """An area in which two surfaces differ by more than a height.

    It has ``__geo_interface__``, so that shapely and ``geopandas.GeoDataFrame.from_features`` take it.

    Attributes
    ----------
    change : str
        ``"raised"`` if the first surface is above the second, else ``"lowered"``.
    rings : list of (n, 2) array of float64
        The outer ring, clockwise, and the holes; each repeats its first vertex at the end.
    area, volume : float
        The area in plan, and the volume between both surfaces.
    largest : float
        The largest difference of the heights, first minus second.
    x, y : float
        Where it is.
    """

    change: str
    rings: "list[NDArray[np.float64]]"
    area: float
    volume: float
    largest: float
    x: float
    y: float

    @property
    def __geo_interface__(self) -> "dict[str, Any]":
        """The area as a feature of GeoJSON."""
        numbers = {"area": self.area, "volume": self.volume, "largest": self.largest, "x": self.x, "y": self.y}
        return {
            "type": "Feature",
            "properties": {"change": self.change, **numbers},
            "geometry": {"type": "Polygon", "coordinates": [ring[::-1].tolist() for ring in self.rings]},
        }


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
    areas : list of ChangedArea or None
        The areas in which the surfaces differ by more, those with the largest volumes first; ``None`` unless
        ``min_area`` was given.
    unit : str or None
        The unit of their volumes, such as ``"m3"``, whose squares are that of areas; ``None`` if no coordinate system
        is known: then they are in cubes of the unit of the data.
    left_out : int
        How many areas were left out because they are smaller than ``min_area``.
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
    areas: "Optional[list[ChangedArea]]" = None
    unit: Optional[str] = None
    left_out: int = 0


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
    min_area: Optional[float] = None,
    memory: Any = None,
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
    min_area : float, optional
        With ``changed``: also find the areas in which the surfaces differ by more, exact on the triangles of both, and
        leave out those that are smaller than this; 0 keeps all.
    memory : int or str, optional
        As for :func:`sample`.
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
    >>> found = breakline.compare(slope, slope, resolution=5, changed=0.5, min_area=0)
    >>> found.areas
    []
    """
    refuse_kept(surface)
    by = _inputs.name(method, "method")
    frame = frame_of(resolution, extent, align_to)
    height = _inputs.optional_number(changed, "changed")
    least = _inputs.optional_number(min_area, "min_area")
    if least is not None and (height is None or not least >= 0):
        raise usage("min_area is not the size of areas", min_area, "pass a number from 0 on, together with changed")
    places = _inputs.whole_numbers([worst], "worst", 1_000_000)[0]
    first, second = surfaces_of([a, b], surface, memory, threads, progress, by)
    with call(threads, progress) as request:
        cells, count, numbers, found, counts, changes = _breakline.compare(
            first, second, frame, by, places, height, least, names_of([(a, "a"), (b, "b")]), request
        )
    raster = of_cells(cells, "difference")
    if changes is None:
        return Comparison(raster, count, *numbers, found, counts)
    areas, unit, left_out = changes
    changed_areas = [
        ChangedArea("raised" if is_raised else "lowered", rings, *of_area) for is_raised, rings, of_area in areas
    ]
    return Comparison(raster, count, *numbers, found, counts, changed_areas, unit, left_out)
