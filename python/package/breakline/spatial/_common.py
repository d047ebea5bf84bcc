"""What the drop-ins for scipy share: points, how they are checked, and errors."""

from __future__ import annotations

from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _masked
from .._call import checked
from .._errors import ArgumentTypeError, UnsupportedError, UsageError, usage


#: Positions of shape (n, ndim), or an array of shape (n,) for each axis.
Positions = Union[NDArray[np.float64], list[NDArray[np.float64]]]


class QhullError(UsageError, RuntimeError):
    """The points do not span the plane or the space. It has the name of scipy's exception; there is no Qhull."""


class ClosedError(UsageError, RuntimeError):
    """No more points are taken."""


class PointSet:
    """Points, and what is computed of them."""

    points: NDArray[np.float64]
    threads: int | None

    def __init__(self, points: ArrayLike, incremental: bool, threads: int | None) -> None:
        points = points_of(points)
        self.threads = checked(threads)
        self._is_open = bool(incremental)
        if len(points) == 0:
            raise usage("no points given", cure="pass at least one more point than there are dimensions")
        self._build(points)

    def _build(self, points: NDArray[np.float64]) -> None:
        """Compute all anew."""
        raise NotImplementedError

    def _add(self, points: NDArray[np.float64], everything: NDArray[np.float64]) -> None:
        """Add some points; `everything` has those so far, too."""
        self._build(everything)

    def __getstate__(self) -> dict[str, Any]:
        return {"points": self.points, "threads": self.threads, "is_open": self._is_open}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.threads = state["threads"]
        self._is_open = state["is_open"]
        self._build(state["points"])

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
    def min_bound(self) -> NDArray[np.float64]:
        low: NDArray[np.float64] = self.points.min(axis=0)
        return low

    @property
    def max_bound(self) -> NDArray[np.float64]:
        high: NDArray[np.float64] = self.points.max(axis=0)
        return high

    def add_points(self, points: ArrayLike, restart: bool = False) -> None:
        """Add points.

        Parameters
        ----------
        points : array_like of float, shape (n, ndim)
            The points; their numbers follow those of the points so far. Masked rows are left out.
        restart : bool, optional
            Compute all anew. The result is the same in both cases, but orders may differ.

        Raises
        ------
        ClosedError
            If it is not incremental, or was closed; a `RuntimeError`.
        UsageError
            If the shape is wrong or a coordinate is not finite; nothing has changed then.

        Notes
        -----
        If many points are added at once (a quarter of those that are there), all is computed anew,
        because that is faster.

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
        points = points_of(points)
        if points.shape[1] != self.ndim:
            raise usage(f"points of shape {points.shape}, expected (n, {self.ndim})")
        everything = np.concatenate([self.points, points])
        if restart or 4 * len(points) > self.npoints:
            self._build(everything)
        else:
            self._add(points, everything)

    def close(self) -> None:
        """End incremental processing: `add_points` raises from now on.

        Examples
        --------
        >>> from breakline.spatial import Delaunay
        >>> Delaunay([[0, 0], [4, 0], [0, 4]], incremental=True).close()
        """
        self._is_open = False


def flat(points: NDArray[np.float64], what: str, cure: str) -> UsageError:
    """Return the error of points that do not span the plane or the space."""
    shape = "line" if points.shape[1] == 2 else "plane"
    return usage(f"all {len(points)} points lie on one {shape}: {what}", cure=cure, kind=QhullError)


def check_options(options: str | bytes | None, harmless: frozenset[str], reasons: dict[str, tuple[str, str]]) -> None:
    """Raise for options of Qhull, unless they are harmless; with the reason and the cure for some."""
    if options is None:
        return
    if isinstance(options, bytes):
        options = options.decode()
    unknown = [option for option in options.split() if option not in harmless]
    for option in unknown:
        if option in reasons:
            reason, cure = reasons[option]
            raise unsupported(f"qhull_options: {option} {reason}", cure)
    if unknown:
        raise unsupported(f"qhull_options: {' '.join(unknown)} belong to Qhull, which is not used here", "leave them out")


def unsupported(message: str, cure: str) -> UnsupportedError:
    error = UnsupportedError(message)
    error.message, error.cure = message, cure
    return error


def numbers(array: Any) -> NDArray[np.float64]:
    """Return an array as float64, masked if it is; without a copy if it is that already."""
    array = _masked.as_array(array)
    if type(array) is np.ndarray and array.dtype == np.float64 and array.flags.aligned:
        return array  # what follows returns it, too, but takes a third of the time of a query
    if array.dtype.kind not in "biuf" and array.size:
        raise usage(f"coordinates of dtype {array.dtype}, expected real numbers", kind=ArgumentTypeError)
    if isinstance(array, np.ma.MaskedArray):
        return array.astype(np.float64)
    return np.require(array, np.float64, "A")


def points_of(points: Any) -> NDArray[np.float64]:
    """Return points as a C-contiguous array, without those that are masked."""
    points = numbers(points)
    if points.ndim != 2:
        raise usage(f"points of shape {points.shape}, expected two dimensions: (npoints, ndim)")
    if points.shape[1] < 2:
        raise usage(f"points of shape {points.shape}: need at least 2-D data", cure="use numpy.interp")
    if points.shape[1] > 3:
        raise unsupported(f"points of shape {points.shape}: there are 2 and 3 dimensions here", "use scipy")
    (points,) = _masked.rows("points", points)
    return np.ascontiguousarray(points)


def positions_of(xi: Any, ndim: int) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return positions as a C-contiguous array of shape (n, ndim), and which of them are masked; these are NaN."""
    xi = numbers(xi).reshape(-1, ndim)
    masked = None if type(xi) is np.ndarray else _masked.without_value("positions", xi)
    if masked is None:
        return np.ascontiguousarray(np.asarray(xi)), np.zeros(len(xi), bool)
    return np.ma.filled(xi, np.nan), masked


def are_plain(axes: tuple[Any, ...], ndim: int) -> bool:
    """Return true if these are arrays of float64, one for each axis, of one shape and not masked."""
    return len(axes) == ndim and all(
        type(axis) is np.ndarray
        and axis.dtype == np.float64
        and axis.flags.aligned
        and axis.shape == axes[0].shape
        for axis in axes
    )


def joined(coordinates: Any, ndim: int | None = None) -> NDArray[Any]:
    """Return coordinates of shape (..., ndim) from a tuple of one array for each axis, or from one array.

    Masked where any of them is.
    """
    if isinstance(coordinates, tuple) and len(coordinates) == 1:
        coordinates = coordinates[0]
    if isinstance(coordinates, tuple):
        axes = list(map(numbers, coordinates))
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
