"""Drop-ins for `scipy.spatial.Delaunay` and the scattered-data interpolators of `scipy.interpolate`.

===============================  ==========================================
`Delaunay`                       `scipy.spatial.Delaunay`, in 2D and 3D
`LinearNDInterpolator`           `scipy.interpolate.LinearNDInterpolator`
`CloughTocher2DInterpolator`     `scipy.interpolate.CloughTocher2DInterpolator`
`NearestNDInterpolator`          `scipy.interpolate.NearestNDInterpolator`
`NaturalNeighborInterpolator`    no counterpart: Sibson's interpolation
`tsearch`                        `scipy.spatial.tsearch`
===============================  ==========================================

Signatures, attributes, shapes and dtypes are those of scipy; ``threads`` is added. All decisions are
exact, so that no input is too degenerate to be triangulated. What differs is listed in
``docs/python-drop-ins.md``. What is absent raises, with the reason.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _masked
from ._breakline import CubicValues, Tessellation, Values
from ._call import call
from ._errors import ArgumentTypeError, BreaklineWarning, UnsupportedError, UsageError, usage, warn

__all__ = [
    "CloughTocher2DInterpolator",
    "Delaunay",
    "GradientEstimationWarning",
    "LinearNDInterpolator",
    "NaturalNeighborInterpolator",
    "NearestNDInterpolator",
    "QhullError",
    "tsearch",
]

#: How far outside of the hull, in barycentric coordinates, counts as inside: as in scipy.
_TOLERANCE = 100 * float(np.finfo(np.float64).eps)

#: Options of Qhull that do not change the result here, or that describe what always holds.
_HARMLESS_OPTIONS = frozenset({"Qbb", "Qc", "Qz", "Qx", "Q12", "Qt", "Pp"})

#: What `scipy.spatial` has and this module has not, with the reason.
_ABSENT = {
    "ConvexHull": "use Delaunay(points).convex_hull for the facets, or scipy",
    "HalfspaceIntersection": "it is no triangulation: use scipy",
    "KDTree": "use NearestNDInterpolator for the nearest point, or scipy",
    "SphericalVoronoi": "it is no triangulation: use scipy",
    "Voronoi": "use the Rust crate breakline-triangulation (voronoi_cell), or scipy",
    "cKDTree": "use NearestNDInterpolator for the nearest point, or scipy",
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


def __getattr__(name: str) -> NoReturn:
    if name in _ABSENT:
        raise AttributeError(f"breakline.spatial has no {name}: {_ABSENT[name]}")
    raise AttributeError(f"module 'breakline.spatial' has no attribute {name!r}")


class QhullError(UsageError, RuntimeError):
    """The points do not span the plane or the space. It has the name of scipy's exception; there is no Qhull."""


class ClosedError(UsageError, RuntimeError):
    """The triangulation does not take more points."""


class GradientEstimationWarning(BreaklineWarning):
    """The gradients of a `CloughTocher2DInterpolator` still change. It has the name of scipy's warning."""


class Delaunay:
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
    points: NDArray[np.float64]
    threads: int | None

    def __init__(
        self,
        points: ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
        *,
        threads: int | None = None,
    ) -> None:
        if furthest_site:
            raise _unsupported("furthest_site=True: only the Delaunay triangulation itself is built here", "use scipy")
        _check_options(qhull_options)
        points = _points_of(points)
        self.threads = _checked(threads)
        self._is_open = bool(incremental)
        self._build(points)

    def _build(self, points: NDArray[np.float64]) -> None:
        if len(points) == 0:
            raise usage("no points given", cure="pass at least one more point than there are dimensions")
        core = Tessellation(points, (self.threads, None))
        if core.has_no_simplices():
            flat = "line" if points.shape[1] == 2 else "plane"
            raise usage(
                f"all {len(points)} points lie on one {flat}: there are no simplices",
                cure="add points that do not; NearestNDInterpolator does not need them",
                kind=QhullError,
            )
        self.points = points
        self._core = core
        self._cache: dict[str, Any] = {}

    def __getstate__(self) -> dict[str, Any]:
        return {"points": self.points, "threads": self.threads, "is_open": self._is_open}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.threads = state["threads"]
        self._is_open = state["is_open"]
        self._build(state["points"])

    def __getattr__(self, name: str) -> NoReturn:
        if name in _ABSENT_OF_DELAUNAY:
            raise AttributeError(f"breakline's Delaunay has no {name}: {_ABSENT_OF_DELAUNAY[name]}")
        raise AttributeError(f"'Delaunay' object has no attribute {name!r}")

    def _once(self, name: str, compute: Callable[[], Any]) -> Any:
        cache = self._cache
        if name not in cache:
            cache[name] = compute()
        return cache[name]

    @property
    def _call(self) -> tuple[int | None, None]:
        return self.threads, None

    @property
    def ndim(self) -> int:
        return int(self.points.shape[1])

    @property
    def npoints(self) -> int:
        return int(self.points.shape[0])

    @property
    def nsimplex(self) -> int:
        return self._core.simplex_count()

    @property
    def min_bound(self) -> NDArray[np.float64]:
        low: NDArray[np.float64] = self.points.min(axis=0)
        return low

    @property
    def max_bound(self) -> NDArray[np.float64]:
        high: NDArray[np.float64] = self.points.max(axis=0)
        return high

    @property
    def simplices(self) -> NDArray[np.int32]:
        simplices: NDArray[np.int32] = self._once("tables", lambda: self._core.tables(self._call))[0]
        return simplices

    @property
    def neighbors(self) -> NDArray[np.int32]:
        neighbors: NDArray[np.int32] = self._once("tables", lambda: self._core.tables(self._call))[1]
        return neighbors

    @property
    def coplanar(self) -> NDArray[np.int32]:
        coplanar: NDArray[np.int32] = self._once("coplanar", lambda: self._core.coplanar(self._call))
        return coplanar

    @property
    def convex_hull(self) -> NDArray[np.int32]:
        hull: NDArray[np.int32] = self._once("hull", lambda: self._core.hull(self._call))
        return hull

    @property
    def vertex_to_simplex(self) -> NDArray[np.int32]:
        simplex_at: NDArray[np.int32] = self._once("simplex_at", lambda: self._core.simplex_at(self._call))
        return simplex_at

    @property
    def vertex_neighbor_vertices(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        neighbors: tuple[NDArray[np.int32], NDArray[np.int32]] = self._once("neighbor_points", lambda: tuple(self._core.neighbor_points(self._call)))
        return neighbors

    @property
    def transform(self) -> NDArray[np.float64]:
        transforms: NDArray[np.float64] = self._once("transforms", lambda: self._core.transforms(self._call))
        return transforms

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
        xi = _masked.as_array(xi)
        if xi.shape[-1] != self.ndim:
            raise usage(f"wrong dimensionality in xi: shape {xi.shape}, expected (..., {self.ndim})")
        tolerance = _TOLERANCE if tol is None else float(tol)
        if not tolerance >= 0:
            raise usage(f"tol is {tol}", tol, "pass 0 or more")
        flat, _ = _positions(xi, self.ndim)
        return self._core.find(flat, tolerance, self._call).reshape(xi.shape[:-1])

    def add_points(self, points: ArrayLike, restart: bool = False) -> None:
        """Add points.

        Parameters
        ----------
        points : array_like of float, shape (n, ndim)
            The points; their numbers follow those of the points so far. Masked rows are left out.
        restart : bool, optional
            Triangulate all points anew. The triangulation is the same in both cases, but the order
            of simplices may differ.

        Raises
        ------
        ClosedError
            If the triangulation is not incremental, or was closed; a `RuntimeError`.
        UsageError
            If the shape is wrong or a coordinate is not finite; nothing has changed then.

        Notes
        -----
        Many points at once (a quarter of those that are there) are triangulated anew, because that
        is faster.

        Examples
        --------
        >>> from breakline.spatial import Delaunay
        >>> tri = Delaunay([[0, 0], [4, 0], [0, 4]], incremental=True)
        >>> tri.add_points([[1, 1]])
        >>> tri.nsimplex
        3
        """
        if not self._is_open:
            raise usage("incremental mode not enabled or already closed", cure="pass incremental=True", kind=ClosedError)
        points = _points_of(points)
        if points.shape[1] != self.ndim:
            raise usage(f"points of shape {points.shape}, expected (n, {self.ndim})")
        everything = np.concatenate([self.points, points])
        if restart or 4 * len(points) > self.npoints:
            self._build(everything)
        else:
            self._core.add(points, self._call)
            self.points = everything
            self._cache = {}

    def close(self) -> None:
        """End incremental processing: `add_points` raises from now on.

        Examples
        --------
        >>> from breakline.spatial import Delaunay
        >>> Delaunay([[0, 0], [4, 0], [0, 4]], incremental=True).close()
        """
        self._is_open = False


def tsearch(tri: Delaunay, xi: ArrayLike) -> NDArray[np.int32]:
    """Return the simplex that contains each position: ``tri.find_simplex(xi)``.

    Examples
    --------
    >>> from breakline.spatial import Delaunay, tsearch
    >>> tsearch(Delaunay([[0, 0], [4, 0], [0, 4]]), [[1, 1], [3, 3]]).tolist()
    [0, -1]
    """
    return tri.find_simplex(xi)


class _Interpolator:
    """What the interpolators share: coordinates, values, rescaling, pickling."""

    tri: Any
    points: NDArray[np.float64]
    values: NDArray[Any]
    scale: NDArray[np.float64] | None
    offset: NDArray[np.float64] | None

    def __init__(
        self, points: Any, values: ArrayLike, fill_value: Any, rescale: bool, threads: int | None
    ) -> None:
        self.threads = _checked(threads)
        self.scale = None
        self.offset = None
        if isinstance(points, Delaunay):
            if rescale:
                raise usage(
                    "Rescaling is not supported when passing a Delaunay triangulation as ``points``.",
                    cure="pass the points",
                )
            self.tri = points
            values = _masked.as_array(values)
            if np.ma.is_masked(values):
                raise usage("values at a triangulation are masked", cure="pass the points: rows are left out of both")
        else:
            points, values = _joined(points), _masked.as_array(values)
            if points.ndim and values.ndim and len(points) == len(values):
                points, values = _masked.rows("points", points, values)
            points = _points_of(points)
            if rescale and len(points):
                points = self._rescaled(points)
            self.tri = self._triangulation(points)
        self.points = self._points()
        if values.ndim == 0 or values.shape[0] != len(self.points):
            raise usage(
                f"different number of values and points: values of shape {values.shape}, {len(self.points)} points"
            )
        if values.dtype.kind not in "biufc":
            raise usage(f"values of dtype {values.dtype}, expected numbers", kind=ArgumentTypeError)
        self.is_complex = values.dtype.kind == "c"
        self.values_shape = values.shape[1:]
        columns = int(np.prod(self.values_shape, dtype=np.int64))
        dtype = np.complex128 if self.is_complex else np.float64
        self.values = np.ascontiguousarray(values, dtype=dtype).reshape(len(values), columns)
        self.fill_value = complex(fill_value) if self.is_complex else float(fill_value)

    def _rescaled(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        self.offset = points.mean(axis=0)
        points = points - self.offset
        self.scale = np.ptp(points, axis=0)
        self.scale[~(self.scale > 0)] = 1.0
        points /= self.scale
        return points

    def _triangulation(self, points: NDArray[np.float64]) -> Any:
        return Delaunay(points, threads=self.threads)

    def _points(self) -> NDArray[np.float64]:
        points: NDArray[np.float64] = self.tri.points
        return points

    def _positions(self, args: tuple[Any, ...]) -> NDArray[Any]:
        """Return positions of shape (..., ndim), scaled like the points."""
        ndim = self.points.shape[1]
        xi = _joined(args, ndim)
        if xi.ndim == 0 or xi.shape[-1] != ndim:
            raise usage(f"number of dimensions in xi does not match x: shape {xi.shape}, expected (..., {ndim})")
        if self.offset is not None and self.scale is not None:
            xi = (_numbers(xi) - self.offset) / self.scale
        return xi


class _SmoothInterpolator(_Interpolator):
    """An interpolator that computes values between those of the points."""

    #: What is made of the rest, and not pickled.
    _MADE: "tuple[str, ...]" = ("_core",)

    def __init__(
        self,
        points: Any,
        values: ArrayLike,
        fill_value: complex = np.nan,
        rescale: bool = False,
        *,
        threads: int | None = None,
    ) -> None:
        super().__init__(points, values, fill_value, rescale, threads)
        self._prepare()

    def _prepare(self) -> None:
        columns = self.values.shape[1]
        fill = self.fill_value
        outside = ([fill.real, fill.imag] if self.is_complex else [fill]) * columns
        self._core = Values(self.tri._core, self.values.view(np.float64), outside, _TOLERANCE, (self.threads, None))

    def _evaluate(self, positions: NDArray[np.float64], call: tuple[int | None, None]) -> NDArray[np.float64]:
        """Return the numbers of all columns at positions of shape (n, ndim)."""
        raise NotImplementedError

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name not in self._MADE}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._prepare()

    def __call__(self, *args: Any) -> NDArray[Any]:
        """Return the values at positions.

        Parameters
        ----------
        x1, x2, ... : array_like of float
            Coordinates that can be broadcast against each other; or one array of shape (..., ndim).

        Returns
        -------
        ndarray of float64 or complex128, shape (...) + values.shape[1:]
            ``fill_value`` outside of the convex hull, and where a coordinate is masked.
        """
        xi = self._positions(args)
        flat, _ = _positions(xi, self.points.shape[1])
        values: NDArray[Any] = self._evaluate(flat, (self.threads, None))
        return values.view(self.values.dtype).reshape(xi.shape[:-1] + self.values_shape)


class LinearNDInterpolator(_SmoothInterpolator):
    """Interpolation that is linear on each simplex of a Delaunay triangulation.

    Parameters
    ----------
    points : array_like of float, shape (npoints, ndim); tuple of arrays; or `Delaunay`
        Positions of the data, in the plane or in space; or their triangulation.
    values : array_like of float or complex, shape (npoints, ...)
        Values there.
    fill_value : float or complex, optional
        What positions outside of the convex hull get; NaN by default.
    rescale : bool, optional
        Scale the points to a unit cube first, for axes of different units.
    threads : int, optional
        The number of threads; all processors by default. Results do not depend on it.

    Raises
    ------
    ValueError, TypeError
        If shapes or dtypes do not fit, or a coordinate is not finite.
    QhullError
        If the points do not span the plane or the space.

    Notes
    -----
    About O(1) for each position: many at once are visited in an order that keeps searches short.
    The value at a point is exactly the given one (of equal points that of the first), and constant
    values are reproduced exactly.

    Examples
    --------
    >>> from breakline.spatial import LinearNDInterpolator
    >>> plane = LinearNDInterpolator([[0, 0], [4, 0], [0, 4]], [0.0, 4.0, 8.0])
    >>> float(plane(1.0, 1.0))
    3.0
    """

    def _evaluate(self, positions: NDArray[np.float64], call: tuple[int | None, None]) -> NDArray[np.float64]:
        return self._core.linear(positions, call)


class CloughTocher2DInterpolator(_SmoothInterpolator):
    """Cubic interpolation without kinks, in the plane.

    On each triangle there are three cubic polynomials (Clough and Tocher). The gradients at the
    points make the curvature along edges least (Nielson 1983; Renka and Cline 1984), as in scipy:
    values agree with those of scipy to some 1e-10 of their range.

    Parameters
    ----------
    points : array_like of float, shape (npoints, 2); tuple of two arrays; or `Delaunay`
        Positions of the data in the plane, or their triangulation.
    values : array_like of float or complex, shape (npoints, ...)
        Values there.
    fill_value : float or complex, optional
        What positions outside of the convex hull get; NaN by default.
    tol : float, optional
        Gradients are final when none changes by more than this, relative to those above 1.
    maxiter : int, optional
        The most rounds of their computation; if they still change then, there is a
        `GradientEstimationWarning`.
    rescale : bool, optional
        Scale the points to a unit square first, for axes of different units.
    threads : int, optional
        The number of threads; all processors by default. Results do not depend on it.

    Attributes
    ----------
    grad : ndarray of float64 or complex128, shape (npoints, nvalues, 2)
        The gradients at the points, for each column of values.

    Raises
    ------
    ValueError, TypeError
        If shapes or dtypes do not fit, a coordinate is not finite, or the points are not in the
        plane.
    QhullError
        If the points do not span the plane.

    Notes
    -----
    Some twenty to forty rounds over all points prepare it. A value that is not finite spoils the
    gradients of all points that are connected with it. The value at a point is exactly the given one, and
    constant values are reproduced exactly.

    Examples
    --------
    >>> from breakline.spatial import CloughTocher2DInterpolator
    >>> smooth = CloughTocher2DInterpolator([[0, 0], [4, 0], [4, 4], [0, 4], [1, 2]], [0.0, 0.0, 0.0, 0.0, 8.0])
    >>> float(smooth(1.0, 2.0))
    8.0
    """

    _MADE = ("_core", "_cubic")

    def __init__(
        self,
        points: Any,
        values: ArrayLike,
        fill_value: complex = np.nan,
        tol: float = 1e-6,
        maxiter: int = 400,
        rescale: bool = False,
        *,
        threads: int | None = None,
    ) -> None:
        self._limits = (float(tol), operator.index(maxiter))
        if self._limits[1] < 0:
            raise usage(f"maxiter is {maxiter}", maxiter, "pass 0 or more")
        super().__init__(points, values, fill_value, rescale, threads=threads)

    def _prepare(self) -> None:
        super()._prepare()
        self._cubic = CubicValues(self._core, *self._limits, (self.threads, None))
        if not self._cubic.has_converged:
            tol, maxiter = self._limits
            text = f"gradients still change by more than tol={tol:g} after maxiter={maxiter} rounds: raise one of both"
            warn([text], GradientEstimationWarning)

    @property
    def grad(self) -> NDArray[Any]:
        gradients = self._cubic.gradients((self.threads, None))
        return gradients[:, 0::2] + 1j * gradients[:, 1::2] if self.is_complex else gradients

    def _evaluate(self, positions: NDArray[np.float64], call: tuple[int | None, None]) -> NDArray[np.float64]:
        return self._cubic.at(positions, call)


class NaturalNeighborInterpolator(_SmoothInterpolator):
    """Sibson's natural neighbor interpolation, smooth except at the points.

    The weight of a point is the area (volume) that its Voronoi cell loses if the position becomes a
    point. Values never exceed those of the neighbors, and linear functions are reproduced. On the
    hull, and outside of it by no more than 100 roundings, the interpolation is linear.

    Parameters
    ----------
    points, values, fill_value, rescale, threads
        Those of `LinearNDInterpolator`.

    Notes
    -----
    Some six neighbors in the plane and some 15 in space for each position.

    Examples
    --------
    >>> from breakline.spatial import NaturalNeighborInterpolator
    >>> natural = NaturalNeighborInterpolator([[0, 0], [4, 0], [4, 4], [0, 4], [1, 2]], [0.0, 0.0, 0.0, 0.0, 8.0])
    >>> float(natural(1.0, 2.0))
    8.0
    """

    def _evaluate(self, positions: NDArray[np.float64], call: tuple[int | None, None]) -> NDArray[np.float64]:
        return self._core.natural(positions, call)


class NearestNDInterpolator(_Interpolator):
    """The value of the nearest point.

    Parameters
    ----------
    x : array_like of float, shape (npoints, ndim)
        Positions of the data, in the plane or in space. They need not span it.
    y : array_like of float or complex, shape (npoints, ...)
        Values there.
    rescale : bool, optional
        Scale the points to a unit cube first, for axes of different units.
    tree_options : dict, optional
        Accepted only if empty: there is no tree.
    threads : int, optional
        The number of threads; all processors by default.

    Notes
    -----
    Exact. Of several nearest points, the one with the smallest coordinates (x first) counts, and of
    equal points the first; scipy does not define which.

    Examples
    --------
    >>> from breakline.spatial import NearestNDInterpolator
    >>> nearest = NearestNDInterpolator([[0, 0], [4, 0], [0, 4]], [1, 2, 3])
    >>> float(nearest(3.0, 1.0))
    2.0
    """

    def __init__(
        self,
        x: Any,
        y: ArrayLike,
        rescale: bool = False,
        tree_options: dict[str, Any] | None = None,
        *,
        threads: int | None = None,
    ) -> None:
        if tree_options:
            raise _unsupported(f"tree_options={tree_options!r}: the search uses the triangulation", "leave them out")
        super().__init__(x, y, np.nan, rescale, threads)
        self.values = self.values.reshape((len(self.points),) + self.values_shape)

    def _triangulation(self, points: NDArray[np.float64]) -> Any:
        if len(points) == 0:
            raise usage("no points given", cure="pass at least one point")
        self._own = points
        return Tessellation(points, (self.threads, None))

    def _points(self) -> NDArray[np.float64]:
        return self.tri.points if isinstance(self.tri, Delaunay) else self._own

    def __getattr__(self, name: str) -> NoReturn:
        if name == "tree":
            raise AttributeError("NearestNDInterpolator has no tree: the search uses the triangulation")
        raise AttributeError(f"'NearestNDInterpolator' object has no attribute {name!r}")

    def __getstate__(self) -> dict[str, Any]:
        state = dict(vars(self))
        if not isinstance(self.tri, Delaunay):
            del state["tri"]
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        if "tri" not in state:
            self.tri = self._triangulation(self._own)

    def __call__(self, *args: Any, **query_options: Any) -> NDArray[Any]:
        """Return the value of the point nearest to each position.

        Parameters
        ----------
        x1, x2, ... : array_like of float
            Coordinates that can be broadcast against each other; or one array of shape (..., ndim).
        distance_upper_bound : float, optional
            Positions with no point nearer than this get NaN.
        workers : int, optional
            The number of threads; -1 for all processors.
        eps, p : optional
            ``eps`` allows an answer that is not the nearest, and is ignored; ``p`` must be 2.

        Returns
        -------
        ndarray of float64 or complex128, shape (...) + values.shape[1:]
            NaN where a coordinate is masked.
        """
        bound, threads = self._options(query_options)
        xi = self._positions(args)
        flat, masked = _positions(xi, self.points.shape[1])
        core = self.tri._core if isinstance(self.tri, Delaunay) else self.tri
        nearest = core.nearest(flat, len(self.values), (threads, None))
        wrong = (nearest < 0) & ~masked
        if wrong.any():
            row = int(np.argmax(wrong))
            raise usage(f"position {row} is {flat[row].tolist()}, which is not finite or too large to compute with")
        values = self.values[nearest]
        if bound < np.inf:
            distance = np.sqrt(((flat - self.points[nearest]) ** 2).sum(axis=1))
            values[distance >= bound] = np.nan
        values[masked] = np.nan
        return values.reshape(xi.shape[:-1] + self.values_shape)

    def _options(self, options: dict[str, Any]) -> tuple[float, int | None]:
        options = dict(options)
        options.pop("eps", None)
        p = options.pop("p", 2)
        if p != 2:
            raise _unsupported(f"p={p!r}: distances are Euclidean (p=2)", "use scipy")
        bound = float(options.pop("distance_upper_bound", np.inf))
        workers = options.pop("workers", None)
        if options:
            raise usage(f"unexpected options {', '.join(sorted(options))}", kind=ArgumentTypeError)
        return bound, self.threads if workers is None else _checked(None if workers == -1 else workers)


def _checked(threads: int | None) -> int | None:
    """Return a number of threads, if it is one."""
    with call(threads, None) as (checked, _):
        return checked


def _check_options(options: str | bytes | None) -> None:
    if options is None:
        return
    if isinstance(options, bytes):
        options = options.decode()
    unknown = [option for option in options.split() if option not in _HARMLESS_OPTIONS]
    if "QJ" in unknown:
        raise _unsupported(
            "qhull_options: QJ moves points until rounded predicates agree; here predicates are exact",
            "leave it out; points that coincide are in `coplanar`",
        )
    if unknown:
        raise _unsupported(f"qhull_options: {' '.join(unknown)} belong to Qhull, which is not used here", "leave them out")


def _unsupported(message: str, cure: str) -> UnsupportedError:
    error = UnsupportedError(message)
    error.message, error.cure = message, cure
    return error


def _numbers(array: Any) -> NDArray[np.float64]:
    """Return an array as float64, masked if it is; without a copy if it is that already."""
    array = _masked.as_array(array)
    if array.dtype.kind not in "biuf" and array.size:
        raise usage(f"coordinates of dtype {array.dtype}, expected real numbers", kind=ArgumentTypeError)
    if isinstance(array, np.ma.MaskedArray):
        return array.astype(np.float64)
    return np.require(array, np.float64, "A")


def _points_of(points: Any) -> NDArray[np.float64]:
    """Return points as a C-contiguous array, without those that are masked."""
    points = _numbers(points)
    if points.ndim != 2:
        raise usage(f"points of shape {points.shape}, expected two dimensions: (npoints, ndim)")
    if points.shape[1] < 2:
        raise usage(f"points of shape {points.shape}: need at least 2-D data", cure="use numpy.interp")
    if points.shape[1] > 3:
        raise _unsupported(f"points of shape {points.shape}: there are 2 and 3 dimensions here", "use scipy")
    (points,) = _masked.rows("points", points)
    return np.ascontiguousarray(points)


def _positions(xi: Any, ndim: int) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return positions as a C-contiguous array of shape (n, ndim), and which of them are masked; these are NaN."""
    xi = _numbers(xi).reshape(-1, ndim)
    masked = _masked.without_value("positions", xi)
    if masked is None:
        return np.ascontiguousarray(np.asarray(xi)), np.zeros(len(xi), bool)
    return np.ma.filled(xi, np.nan), masked


def _joined(coordinates: Any, ndim: int | None = None) -> NDArray[Any]:
    """Return coordinates of shape (..., ndim) from a tuple of one array for each axis, or from one array.

    Masked where any of them is.
    """
    if isinstance(coordinates, tuple) and len(coordinates) == 1:
        coordinates = coordinates[0]
    if isinstance(coordinates, tuple):
        axes = list(map(_numbers, coordinates))
        joined: NDArray[Any] = np.stack(np.broadcast_arrays(*axes), axis=-1)
        if not any(map(np.ma.is_masked, axes)):
            return joined
        masks = np.broadcast_arrays(*map(np.ma.getmaskarray, axes))
        masked: NDArray[Any] = np.ma.masked_array(joined, np.stack(masks, axis=-1))
        return masked
    array: NDArray[Any] = _masked.as_array(coordinates)
    if array.ndim == 1:
        array = array.reshape(-1, ndim or 1)
    return array
