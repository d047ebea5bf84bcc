"""Interpolators of scattered data, over a triangulation."""

from __future__ import annotations

import operator
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _masked
from .._breakline import CubicValues, Tessellation, Values
from .._call import checked
from .._errors import ArgumentTypeError, BreaklineWarning, usage, warn
from ._common import Positions, are_plain, joined, numbers, points_of, positions_of, unsupported
from ._delaunay import TOLERANCE, Delaunay


class GradientEstimationWarning(BreaklineWarning):
    """The gradients of a `CloughTocher2DInterpolator` still change. It has the name of scipy's warning."""


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
        self.threads = checked(threads)
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
            points, values = joined(points), _masked.as_array(values)
            if points.ndim and values.ndim and len(points) == len(values):
                points, values = _masked.rows("points", points, values)
            points = points_of(points)
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
        xi = joined(args, ndim)
        if xi.ndim == 0 or xi.shape[-1] != ndim:
            raise usage(f"number of dimensions in xi does not match x: shape {xi.shape}, expected (..., {ndim})")
        if self.offset is not None and self.scale is not None:
            xi = (numbers(xi) - self.offset) / self.scale
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
        self._core = Values(self.tri._core, self.values.view(np.float64), outside, TOLERANCE, (self.threads, None))

    def _evaluate(self, positions: Positions, call: tuple[int | None, None]) -> NDArray[np.float64]:
        """Return the numbers of all columns at positions of shape (n, ndim), or at n for each axis."""
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
        ndim = self.points.shape[1]
        positions: Positions
        if self.offset is None and are_plain(args, ndim):
            positions, shape = [axis.ravel() for axis in args], args[0].shape
        else:
            xi = self._positions(args)
            (positions, _), shape = positions_of(xi, ndim), xi.shape[:-1]
        values = self._evaluate(positions, (self.threads, None))
        return values.view(self.values.dtype).reshape(shape + self.values_shape)


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

    def _evaluate(self, positions: Positions, call: tuple[int | None, None]) -> NDArray[np.float64]:
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
    Some twenty to forty rounds over all points prepare it. The first call with at least twice as many
    positions as there are triangles also prepares what all later calls use: 152 bytes for each
    triangle and column. A value that is not finite spoils the
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

    def _evaluate(self, positions: Positions, call: tuple[int | None, None]) -> NDArray[np.float64]:
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

    def _evaluate(self, positions: Positions, call: tuple[int | None, None]) -> NDArray[np.float64]:
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
            raise unsupported(f"tree_options={tree_options!r}: the search uses the triangulation", "leave them out")
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
        flat, masked = positions_of(xi, self.points.shape[1])
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
            raise unsupported(f"p={p!r}: distances are Euclidean (p=2)", "use scipy")
        bound = float(options.pop("distance_upper_bound", np.inf))
        workers = options.pop("workers", None)
        if options:
            raise usage(f"unexpected options {', '.join(sorted(options))}", kind=ArgumentTypeError)
        return bound, self.threads if workers is None else checked(None if workers == -1 else workers)
