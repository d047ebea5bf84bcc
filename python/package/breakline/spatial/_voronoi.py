"""`Voronoi`: Voronoi diagrams of points in the plane or in space."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._breakline import nested_lists
from ._common import check_options
from ._delaunay import HARMLESS_OPTIONS, REFUSED_OPTIONS, Triangulated, check_site


class Voronoi(Triangulated):
    """Voronoi diagram of points in the plane or in space.

    Parameters
    ----------
    points : array_like of float, shape (npoints, 2) or (npoints, 3)
        Coordinates, as for `Delaunay`.
    furthest_site : bool, optional
        Only False is supported.
    incremental : bool, optional
        Allow `add_points`.
    qhull_options : str, optional
        Options of Qhull. Those that are its defaults in scipy (``Qbb Qc Qz Qx Q12 Qt``, and ``Pp``)
        are accepted; all others raise. As in scipy, ``Qz``, which is set unless there are other
        options or the diagram is incremental, adds an empty list to `regions`.
    threads : int, optional
        The number of threads; all processors by default. The result does not depend on it.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, ndim)
        The points.
    vertices : ndarray of float64, shape (nvertices, ndim)
        Positions of the Voronoi vertices.
    ridge_points : ndarray of int32, shape (nridges, 2)
        The points on both sides of each ridge.
    ridge_vertices : list of lists of int
        The Voronoi vertices around each ridge, in order: two in the plane. The first is -1, at
        infinity, if the ridge is unbounded.
    ridge_dict : dict
        `ridge_vertices` by the pairs of `ridge_points`.
    regions : list of lists of int
        The Voronoi vertices of each region, in the plane counter-clockwise. The first is -1, at
        infinity, if the region is unbounded.
    point_region : ndarray of int64, shape (npoints,)
        The region of each point. Equal points have one.
    ndim, npoints : int
        Dimension, number of points.
    min_bound, max_bound : ndarray of float64, shape (ndim,)
        The bounding box of the points.
    furthest_site : bool
        False.

    Raises
    ------
    UsageError, LimitError, ArgumentTypeError, QhullError, UnsupportedError
        As for `Delaunay`.

    Notes
    -----
    Points on one circle, or sphere, have one Voronoi vertex, and there are no ridges without a
    length, or area: which points are is decided exactly. So the cells of a grid have four corners,
    if its coordinates are those of a grid: those of ``0.1 * numpy.arange(9)`` are rounded, and most
    vertices there are two that are a rounding apart.

    Examples
    --------
    >>> from breakline.spatial import Voronoi
    >>> diagram = Voronoi([[0, 0], [4, 0], [4, 4], [0, 4]])
    >>> diagram.vertices.tolist()
    [[2.0, 2.0]]
    >>> diagram.regions[diagram.point_region[0]]
    [-1, 0]
    """

    furthest_site: bool = False

    def __init__(
        self,
        points: ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
        *,
        threads: int | None = None,
    ) -> None:
        check_site(furthest_site, "the Voronoi diagram of the nearest sites")
        check_options(qhull_options, HARMLESS_OPTIONS, REFUSED_OPTIONS)
        options = ("" if incremental else "Qz") if qhull_options is None else str(qhull_options)
        self._has_empty = "Qz" in options
        super().__init__(points, incremental, threads)

    def __getstate__(self) -> dict[str, Any]:
        return {**super().__getstate__(), "has_empty": self._has_empty}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._has_empty = state["has_empty"]
        super().__setstate__(state)

    def _diagram(self) -> tuple[NDArray[np.float64], NDArray[np.int32], Any, Any, NDArray[np.int64]]:
        return self._once("diagram", lambda: self._core.voronoi(self._call))

    @property
    def vertices(self) -> NDArray[np.float64]:
        return self._diagram()[0]

    @property
    def ridge_points(self) -> NDArray[np.int32]:
        return self._diagram()[1]

    @property
    def ridge_vertices(self) -> list[list[int]]:
        return self._once("ridge_vertices", lambda: nested_lists(*self._diagram()[2]))

    @property
    def ridge_dict(self) -> dict[tuple[int, int], list[int]]:
        return self._once(
            "ridge_dict", lambda: dict(zip(map(tuple, self.ridge_points.tolist()), self.ridge_vertices))
        )

    @property
    def regions(self) -> list[list[int]]:
        return self._once(
            "regions", lambda: ([[]] if self._has_empty else []) + nested_lists(*self._diagram()[3])
        )

    @property
    def point_region(self) -> NDArray[np.int64]:
        return self._once("point_region", lambda: self._diagram()[4] + int(self._has_empty))
