"""`Delaunay`: triangulations of points in the plane or in space."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _masked
from .._breakline import Tessellation
from .._errors import usage
from ._common import PointSet, check_options, flat, positions_of, unsupported

_T = TypeVar("_T")

#: How far outside of the hull, in barycentric coordinates, counts as inside: as in scipy.
TOLERANCE = 100 * float(np.finfo(np.float64).eps)

#: Options of Qhull that do not change the result here, or that describe what always holds.
HARMLESS_OPTIONS = frozenset({"Qbb", "Qc", "Qz", "Qx", "Q12", "Qt", "Pp"})

#: Options of Qhull that are refused, with the reason and the cure.
REFUSED_OPTIONS = {
    "QJ": (
        "moves points until rounded predicates agree; here predicates are exact",
        "leave it out; points that coincide are in `coplanar`",
    )
}

#: Attributes of `scipy.spatial.Delaunay` that are absent, with the reason.
_ABSENT_OF_DELAUNAY = {
    "equations": "no hull in one dimension more is computed, so there are no facets of it",
    "good": "it belongs to an option of Qhull (QG)",
    "lift_points": "no hull in one dimension more is computed, so nothing is lifted",
    "paraboloid_scale": "no hull in one dimension more is computed, so there is no paraboloid",
    "paraboloid_shift": "no hull in one dimension more is computed, so there is no paraboloid",
    "plane_distance": "no hull in one dimension more is computed, so there are no facets of it",
    "vertices": "scipy removed it, too: use simplices",
}


def check_site(furthest_site: bool, what: str) -> None:
    """Raise unless diagrams of the nearest site are asked for."""
    if furthest_site:
        raise unsupported(f"furthest_site=True: only {what} itself is built here", "use scipy")


class Triangulated(PointSet):
    """Points with a triangulation, of which some is computed when first asked for."""

    def _build(self, points: NDArray[np.float64]) -> None:
        core = Tessellation(points, self._call)
        if core.has_no_simplices():
            cure = "add points that do not; NearestNDInterpolator does not need them"
            raise flat(points, "there are no simplices", cure)
        self.points = points
        self._core = core
        self._cache: dict[str, Any] = {}

    def _add(self, points: NDArray[np.float64], everything: NDArray[np.float64]) -> None:
        self._core.add(points, self._call)
        self.points = everything
        self._cache = {}

    def _once(self, name: str, compute: Callable[[], _T]) -> _T:
        if name not in self._cache:
            self._cache[name] = compute()
        found: _T = self._cache[name]
        return found


class Delaunay(Triangulated):
    """Delaunay triangulation of points in the plane or in space.

    Parameters
    ----------
    points : array_like of float, shape (npoints, 2) or (npoints, 3)
        Coordinates. Any finite numbers of magnitudes up to 1e60 (0 included). An array that is
        C-contiguous and float64 is not copied, and must not change while it is in use. Masked rows
        are left out, and counted in a warning: `points` has the others, and numbers count these.
    furthest_site : bool, optional
        Only False is supported.
    incremental : bool, optional
        Allow `add_points`.
    qhull_options : str, optional
        Options of Qhull. Those that are its defaults in scipy (``Qbb Qc Qz Qx Q12 Qt``, and ``Pp``)
        are accepted and change nothing; all others raise.
    threads : int, optional
        The number of threads; all processors by default. The result does not depend on it.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, ndim)
        The points.
    simplices : ndarray of int32, shape (nsimplex, ndim + 1)
        Points that are the corners of each simplex; in the plane counter-clockwise.
    neighbors : ndarray of int32, shape (nsimplex, ndim + 1)
        The simplex opposite each corner; -1 beyond the hull.
    coplanar : ndarray of int32, shape (ncoplanar, 3)
        Points that are no corners, because an earlier point has the same coordinates: the point, a
        simplex there, and the earlier point.
    convex_hull : ndarray of int32, shape (nfacets, ndim)
        Points that are the corners of the facets of the convex hull.
    vertex_to_simplex : ndarray of int32, shape (npoints,)
        A simplex at each point.
    vertex_neighbor_vertices : tuple of two ndarrays of int32, (indptr, indices)
        The points that point `k` has an edge with are ``indices[indptr[k]:indptr[k+1]]``, in the
        plane counter-clockwise.
    transform : ndarray of float64, shape (nsimplex, ndim + 1, ndim)
        Maps from positions to barycentric coordinates, as in scipy: ``transform[i, :ndim]`` is the
        inverse of the matrix of simplex `i`, ``transform[i, ndim]`` its last corner. NaN where the
        condition number of the matrix is above 4.5e12.
    ndim, npoints, nsimplex : int
        Dimension, number of points, number of simplices.
    min_bound, max_bound : ndarray of float64, shape (ndim,)
        The bounding box of the points.
    furthest_site : bool
        False.

    Raises
    ------
    UsageError
        If the shape is wrong, or a coordinate is not finite; a `ValueError`.
    LimitError
        If the magnitude of a coordinate is out of range; a `ValueError`.
    ArgumentTypeError
        If the dtype is not that of real numbers; a `TypeError`.
    QhullError
        If the points do not span the plane or the space; a `RuntimeError`.
    UnsupportedError
        For other dimensions and for what does not exist here; a `NotImplementedError` whose message
        has the reason.

    Notes
    -----
    In the plane O(n log n) at worst and linear for points that are spread evenly, on all threads; in
    space linear in practice. The triangulation is a function of the set of points: where several
    are valid (cocircular points), a symbolic perturbation decides, whatever the order of points.

    Examples
    --------
    >>> from breakline.spatial import Delaunay
    >>> tri = Delaunay([[0, 0], [4, 0], [4, 4], [0, 4], [1, 2]])
    >>> tri.nsimplex
    4
    >>> int(tri.find_simplex([9.0, 9.0]))
    -1
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
        check_site(furthest_site, "the Delaunay triangulation")
        check_options(qhull_options, HARMLESS_OPTIONS, REFUSED_OPTIONS)
        super().__init__(points, incremental, threads)

    def __getattr__(self, name: str) -> NoReturn:
        if name in _ABSENT_OF_DELAUNAY:
            raise AttributeError(f"breakline's Delaunay has no {name}: {_ABSENT_OF_DELAUNAY[name]}")
        raise AttributeError(f"'Delaunay' object has no attribute {name!r}")

    @property
    def nsimplex(self) -> int:
        return self._core.simplex_count()

    @property
    def simplices(self) -> NDArray[np.int32]:
        return self._once("tables", lambda: self._core.tables(self._call))[0]

    @property
    def neighbors(self) -> NDArray[np.int32]:
        return self._once("tables", lambda: self._core.tables(self._call))[1]

    @property
    def coplanar(self) -> NDArray[np.int32]:
        return self._once("coplanar", lambda: self._core.coplanar(self._call))

    @property
    def convex_hull(self) -> NDArray[np.int32]:
        return self._once("hull", lambda: self._core.hull(self._call))

    @property
    def vertex_to_simplex(self) -> NDArray[np.int32]:
        return self._once("simplex_at", lambda: self._core.simplex_at(self._call))

    @property
    def vertex_neighbor_vertices(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        starts, neighbors = self._once("neighbor_points", lambda: self._core.neighbor_points(self._call))
        return starts, neighbors

    @property
    def transform(self) -> NDArray[np.float64]:
        return self._once("transforms", lambda: self._core.transforms(self._call))

    def find_simplex(self, xi: ArrayLike, bruteforce: bool = False, tol: float | None = None) -> NDArray[np.int32]:
        """Return the simplex that contains each position.

        Parameters
        ----------
        xi : array_like of float, shape (..., ndim)
            Positions.
        bruteforce : bool, optional
            Accepted and ignored: the search is exact.
        tol : float, optional
            How far outside of the hull, in barycentric coordinates, still counts as inside;
            100 roundings by default, as in scipy. 0 makes the test exact. Inside of the hull it
            changes nothing: the simplex is the one that contains the position, by exact predicates.

        Returns
        -------
        ndarray of int32, shape (...)
            Simplices; -1 outside of the hull, and where a coordinate is masked or not finite. On an
            edge or a corner, one of the simplices there.

        Examples
        --------
        >>> from breakline.spatial import Delaunay
        >>> tri = Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.find_simplex([[1, 1], [3, 3]]).tolist()
        [0, -1]
        """
        if tol is None:
            found = self._core.find_plain(xi, TOLERANCE, (self.threads, None))
            if found is not None:
                return found
        xi = _masked.as_array(xi)
        if xi.shape[-1] != self.ndim:
            raise usage(f"wrong dimensionality in xi: shape {xi.shape}, expected (..., {self.ndim})")
        tolerance = TOLERANCE if tol is None else float(tol)
        if not tolerance >= 0:
            raise usage(f"tol is {tol}", tol, "pass 0 or more")
        flat, _ = positions_of(xi, self.ndim)
        return self._core.find(flat, tolerance, self._call).reshape(xi.shape[:-1])


def tsearch(tri: Delaunay, xi: ArrayLike) -> NDArray[np.int32]:
    """Return the simplex that contains each position: ``tri.find_simplex(xi)``.

    Examples
    --------
    >>> from breakline.spatial import Delaunay, tsearch
    >>> tsearch(Delaunay([[0, 0], [4, 0], [0, 4]]), [[1, 1], [3, 3]]).tolist()
    [0, -1]
    """
    return tri.find_simplex(xi)
