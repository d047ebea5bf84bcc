"""`ConvexHull`: convex hulls of points in the plane or in space."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._breakline import convex_hull
from ._common import PointSet, check_options, flat

#: Options of Qhull that do not change the result here, or that describe what always holds.
_HARMLESS_OPTIONS = frozenset({"Qx", "Q12", "Qt", "Pp"})

#: Options of Qhull that are refused, with the reason and the cure.
_REFUSED_OPTIONS = {
    "Qc": (
        "lists points on facets that are no corners, which are not kept here",
        "use Delaunay(points).convex_hull, which has them as corners",
    ),
    "QJ": (
        "moves points until rounded predicates agree; here predicates are exact",
        "leave it out",
    ),
}


class ConvexHull(PointSet):
    """Convex hull of points in the plane or in space.

    Parameters
    ----------
    points : array_like of float, shape (npoints, 2) or (npoints, 3)
        Coordinates, as for `Delaunay`.
    incremental : bool, optional
        Allow `add_points`.
    qhull_options : str, optional
        Options of Qhull. ``Qt Qx Q12 Pp`` are accepted and change nothing; all others raise.
    threads : int, optional
        The number of threads; all processors by default. The result does not depend on it.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, ndim)
        The points.
    vertices : ndarray of int32, shape (nvertices,)
        Points that are corners of the hull: in the plane counter-clockwise, in space in order.
    simplices : ndarray of int32, shape (nfacet, ndim)
        Points that are the corners of each facet: in the plane the ends of a side,
        counter-clockwise; in space triangles, counter-clockwise as seen from outside.
    neighbors : ndarray of int32, shape (nfacet, ndim)
        The facet opposite each corner.
    equations : ndarray of float64, shape (nfacet, ndim + 1)
        The outward unit normal of each facet, and the offset: ``equations[:, :-1] @ p +
        equations[:, -1]`` is at most 0 for points `p` of the hull, up to rounding.
    coplanar : ndarray of int32, shape (0, 3)
        Empty, as in scipy without the option ``Qc``.
    good : None
        It belongs to an option of Qhull (``QG``).
    volume, area : float
        Volume and surface area; in the plane area and perimeter.
    ndim, npoints, nsimplex : int
        Dimension, number of points, number of facets.
    min_bound, max_bound : ndarray of float64, shape (ndim,)
        The bounding box of the points.

    Raises
    ------
    UsageError, LimitError, ArgumentTypeError, QhullError, UnsupportedError
        As for `Delaunay`.

    Notes
    -----
    Corners are extreme points, which is decided exactly: points in the interior of a side or a flat
    part are none. Of equal points the first is a corner. In space a flat part with more than three
    corners is a fan of triangles, as with the option ``Qt``, which scipy always sets; the triangles
    are a function of the set of points.

    In the plane O(n log n) at worst, and linear if few points are near the border; in space about
    O(n log h) for h corners, in practice.

    Examples
    --------
    >>> from breakline.spatial import ConvexHull
    >>> hull = ConvexHull([[0, 0], [2, 0], [4, 0], [4, 3], [2, 1]])
    >>> hull.vertices.tolist()
    [0, 2, 3]
    >>> hull.volume, hull.area
    (6.0, 12.0)
    """

    good: None = None
    vertices: NDArray[np.int32]
    simplices: NDArray[np.int32]
    neighbors: NDArray[np.int32]
    equations: NDArray[np.float64]
    volume: float
    area: float

    def __init__(
        self,
        points: ArrayLike,
        incremental: bool = False,
        qhull_options: str | None = None,
        *,
        threads: int | None = None,
    ) -> None:
        check_options(qhull_options, _HARMLESS_OPTIONS, _REFUSED_OPTIONS)
        super().__init__(points, incremental, threads)

    def _build(self, points: NDArray[np.float64]) -> None:
        self._adopt(points, convex_hull(points, 0, self._call))

    def _add(self, points: NDArray[np.float64], everything: NDArray[np.float64]) -> None:
        # The others stay inside. In order: of equal points the first is a corner.
        corners = np.sort(self.vertices)
        of = np.concatenate([corners, np.arange(self.npoints, len(everything), dtype=np.int32)])
        self._adopt(everything, convex_hull(everything[of], len(corners), self._call))
        self.vertices, self.simplices = of[self.vertices], of[self.simplices]

    def _adopt(self, points: NDArray[np.float64], hull: Any) -> None:
        if hull is None:
            raise flat(points, "the hull has no facets", "add points that do not")
        self.vertices, self.simplices, self.neighbors, self.equations, self.volume, self.area = hull
        self.points = points

    @property
    def nsimplex(self) -> int:
        return len(self.simplices)

    @property
    def coplanar(self) -> NDArray[np.int32]:
        return np.empty((0, 3), np.int32)
