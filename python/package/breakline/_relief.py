"""Heights in colors."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Optional, Union

import numpy as np

from . import _breakline, _inputs
from ._call import Progress, call
from ._names import Match, Method
from ._pictures import axes
from ._results import _affine, extent_of, frame_of
from ._verbs import surface_of, written_by
from ._written import Written, colors_of

__all__ = ["Relief", "color_relief"]


@dataclass(frozen=True, eq=False)
class Relief:
    """The heights of a surface in colors. It is an array for numpy: ``numpy.asarray(relief)``.

    Attributes
    ----------
    array : ndarray, (rows, columns, 4)
        Red, green, blue and opacity as uint8.
    transform : affine.Affine
        From column and row to coordinates, at the corners of cells.
    crs : str or None
        The coordinate system, as WKT.

    Examples
    --------
    >>> import breakline
    >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
    >>> breakline.color_relief(tin, resolution=5, ramp="gray").array[:, 0].tolist()
    [[255, 255, 255, 255], [0, 0, 0, 255]]
    """

    array: np.ndarray
    transform: Any
    crs: Optional[str]
    _surface: Any = field(repr=False)
    _asked: "tuple[dict[str, Any], str, tuple[str, str]]" = field(repr=False)

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> np.ndarray:
        return np.array(self.array, dtype=dtype) if copy else np.asarray(self.array, dtype=dtype)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the relief with matplotlib, and return the axes; options are those of ``imshow``.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> ax = breakline.color_relief(tin, resolution=5).plot()
        """
        extent = extent_of(self.transform, self.array.shape)
        ax = axes(ax)
        ax.imshow(self.array, **{"extent": extent, **options})
        return ax

    def write(
        self, path: Any, *, overwrite: bool = False, threads: Optional[int] = None, progress: Progress = None
    ) -> None:
        """Write the relief as GeoTIFF or PNG. The bytes are those of the command line.

        Parameters
        ----------
        path : path
            ``.tif`` or ``.png``.
        overwrite : bool
            Replace a file that exists.
        threads, progress
            See :func:`breakline.tin`.

        Raises
        ------
        FileKeptError
            If the file exists and ``overwrite`` is False.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> breakline.color_relief(tin, resolution=5).write("colors.png", overwrite=True)
        """
        with call(threads, progress) as request:
            self._surface.write_color_relief(self._asked, _inputs.path(path, "path"), bool(overwrite), request)


def color_relief(
    points: Any,
    *,
    ramp: Any = "elevation",
    match: Match = "linear",
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    output: Any = None,
    overwrite: bool = False,
    memory: Any = None,
    tiles: Optional[str] = None,
    job: Any = None,
    resume: bool = False,
    update: bool = False,
    skip_bad: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Union[Relief, Written]:
    """Return the heights of a surface or of a raster in colors.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes. Surfaces other than rasters
        are drawn as heights in cells first.
    ramp : str or path
        ``"elevation"``, ``"gray"`` or ``"viridis"``, from the lowest to the highest of all cells; or a file with a
        height and its color on each line, as gdaldem reads it.
    match : str
        Colors of heights between those of the ramp: ``"linear"`` in proportion; ``"nearest"`` that of the nearest;
        ``"exact"`` none.
    resolution, extent, align_to, method, threads, progress
        As for :func:`dem`; a raster keeps its cells.
    output, overwrite, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.color_relief([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]], resolution=5).array.shape
    (2, 2, 4)
    """
    written = written_by(color_relief, dict(locals()))
    if written is not None:
        return written
    by = _inputs.name(method, "method")
    found = surface_of(points, surface, threads, progress, by)
    asked = frame_of(resolution, extent, align_to), by, colors_of(ramp, match)
    with call(threads, progress) as request:
        array, transform, crs = found.color_relief(asked, request)
    return Relief(array, _affine(transform), crs, found, asked)
