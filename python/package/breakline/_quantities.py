"""Slope, aspect, curvature and roughness in cells, as functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, Optional, Union

from . import _inputs
from ._call import Progress, call
from ._names import Gradient, Method, Overviews
from ._results import Raster, frame_of, of_cells
from ._verbs import surface_of, written_by
from ._written import Written, quantity_of

__all__ = ["aspect", "curvature", "roughness", "slope", "tpi", "tri"]


def _computed(verb: Callable[..., Any], given: dict[str, Any]) -> Union[Raster, Written]:
    """Return or write what the function of a verb computes, by its parameters."""
    written = written_by(verb, dict(given))
    if written is not None:
        return written
    by, name = _inputs.name(given["method"], "method"), verb.__name__
    threads, progress = given["threads"], given["progress"]
    found = surface_of(given["points"], given["surface"], threads, progress, by)
    frame = frame_of(given["resolution"], given["extent"], given["align_to"])
    with call(threads, progress) as request:
        return of_cells(found.quantity(frame, by, quantity_of(name, given), request), name)


def slope(
    points: Any,
    *,
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    percent: bool = False,
    formula: Gradient = "horn",
    z_factor: Optional[float] = None,
    output: Any = None,
    overwrite: bool = False,
    overviews: Overviews = "auto",
    memory: Any = None,
    tiles: Optional[str] = None,
    job: Any = None,
    resume: bool = False,
    update: bool = False,
    skip_bad: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Union[Raster, Written]:
    """Return the slope in cells, in degrees or percent.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes. Surfaces other than rasters
        are drawn as heights in cells first.
    resolution, extent, align_to, method, threads, progress
        As for :func:`dem`; a raster keeps its cells.
    percent : bool
        True for percent: 100 is 45 degrees.
    formula
        ``"horn"``: from the eight cells around, for rough surfaces; ``"zevenbergen-thorne"``: from the four cells beside;
        ``"faces"``: that of the triangle at the center of the cell (not of a raster).
    z_factor : float, optional
        Factor for heights; by default what converts them to the units of x and y.
    output, overwrite, overviews, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.slope([[0, 0, 0], [10, 0, 10], [10, 10, 10], [0, 10, 0]], resolution=5).array.tolist()
    [[45.0, 45.0], [45.0, 45.0]]
    """
    return _computed(slope, dict(locals()))


def aspect(
    points: Any,
    *,
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    formula: Gradient = "horn",
    z_factor: Optional[float] = None,
    output: Any = None,
    overwrite: bool = False,
    overviews: Overviews = "auto",
    memory: Any = None,
    tiles: Optional[str] = None,
    job: Any = None,
    resume: bool = False,
    update: bool = False,
    skip_bad: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Union[Raster, Written]:
    """Return the direction in which the surface falls in cells, in degrees clockwise from north; nan where it is level.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes. Surfaces other than rasters
        are drawn as heights in cells first.
    resolution, extent, align_to, method, threads, progress
        As for :func:`dem`; a raster keeps its cells.
    formula
        ``"horn"``: from the eight cells around, for rough surfaces; ``"zevenbergen-thorne"``: from the four cells beside;
        ``"faces"``: that of the triangle at the center of the cell (not of a raster).
    z_factor : float, optional
        Factor for heights; by default what converts them to the units of x and y.
    output, overwrite, overviews, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.aspect([[0, 0, 0], [10, 0, 10], [10, 10, 10], [0, 10, 0]], resolution=5).array.tolist()
    [[270.0, 270.0], [270.0, 270.0]]
    """
    return _computed(aspect, dict(locals()))


def curvature(
    points: Any,
    *,
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    formula: Literal["profile", "plan"] = "profile",
    z_factor: Optional[float] = None,
    output: Any = None,
    overwrite: bool = False,
    overviews: Overviews = "auto",
    memory: Any = None,
    tiles: Optional[str] = None,
    job: Any = None,
    resume: bool = False,
    update: bool = False,
    skip_bad: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Union[Raster, Written]:
    """Return the curvature in cells, per unit of length: positive where the surface is convex.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes. Surfaces other than rasters
        are drawn as heights in cells first.
    resolution, extent, align_to, method, threads, progress
        As for :func:`dem`; a raster keeps its cells.
    formula
        ``"profile"``: along the steepest slope; ``"plan"``: across it, positive on spurs.
    z_factor : float, optional
        Factor for heights; by default what converts them to the units of x and y.
    output, overwrite, overviews, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.curvature([[0, 0, 0], [10, 0, 10], [10, 10, 10], [0, 10, 0]], resolution=5).array.tolist()
    [[0.0, 0.0], [0.0, 0.0]]
    """
    return _computed(curvature, dict(locals()))


def roughness(
    points: Any,
    *,
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    output: Any = None,
    overwrite: bool = False,
    overviews: Overviews = "auto",
    memory: Any = None,
    tiles: Optional[str] = None,
    job: Any = None,
    resume: bool = False,
    update: bool = False,
    skip_bad: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Union[Raster, Written]:
    """Return the highest minus the lowest of the 3 x 3 cells around each cell, in units of height.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes. Surfaces other than rasters
        are drawn as heights in cells first.
    resolution, extent, align_to, method, threads, progress
        As for :func:`dem`; a raster keeps its cells.
    output, overwrite, overviews, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.roughness([[0, 0, 0], [10, 0, 10], [10, 10, 10], [0, 10, 0]], resolution=5).array.tolist()
    [[10.0, 10.0], [10.0, 10.0]]
    """
    return _computed(roughness, dict(locals()))


def tri(
    points: Any,
    *,
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    formula: Literal["riley", "wilson"] = "riley",
    output: Any = None,
    overwrite: bool = False,
    overviews: Overviews = "auto",
    memory: Any = None,
    tiles: Optional[str] = None,
    job: Any = None,
    resume: bool = False,
    update: bool = False,
    skip_bad: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Union[Raster, Written]:
    """Return the terrain ruggedness index in cells, in units of height.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes. Surfaces other than rasters
        are drawn as heights in cells first.
    resolution, extent, align_to, method, threads, progress
        As for :func:`dem`; a raster keeps its cells.
    formula
        ``"riley"``: the root of the sum of the squares of the eight differences; ``"wilson"``: their mean.
    output, overwrite, overviews, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.tri([[0, 0, 0], [10, 0, 10], [10, 10, 10], [0, 10, 0]], resolution=5, formula="wilson").array.tolist()
    [[3.75, 3.75], [3.75, 3.75]]
    """
    return _computed(tri, dict(locals()))


def tpi(
    points: Any,
    *,
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    output: Any = None,
    overwrite: bool = False,
    overviews: Overviews = "auto",
    memory: Any = None,
    tiles: Optional[str] = None,
    job: Any = None,
    resume: bool = False,
    update: bool = False,
    skip_bad: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Union[Raster, Written]:
    """Return the topographic position index: the height of each cell above the mean of the eight around it.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes. Surfaces other than rasters
        are drawn as heights in cells first.
    resolution, extent, align_to, method, threads, progress
        As for :func:`dem`; a raster keeps its cells.
    output, overwrite, overviews, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.tpi([[0, 0, 0], [10, 0, 10], [10, 10, 10], [0, 10, 0]], resolution=5).array.tolist()
    [[0.0, 0.0], [0.0, 0.0]]
    """
    return _computed(tpi, dict(locals()))
