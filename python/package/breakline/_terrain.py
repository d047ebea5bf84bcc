"""Tiles for web globes: the verb ``terrain-tiles``."""

from __future__ import annotations

import os
from typing import Any, NamedTuple, Optional

from . import _breakline, _inputs
from ._call import Progress, call
from ._errors import usage
from ._verbs import asked, refuse_kept, surface_of


class TerrainLevel(NamedTuple):
    """What was written of a level of terrain tiles.

    Attributes
    ----------
    level : int
        0 for the level with the largest tiles.
    bound : float
        No vertex of the surface should be further from the triangles than this, in meters.
    within : float
        No vertex of the surface is further from the triangles than this, in meters: the bound, or more with a warning.
    largest : float
        The largest distance of a vertex, in meters.
    tiles, bytes, vertices, triangles : int
        The sums of all tiles.
    heights : int
        The vertices that were measured.
    beyond : int
        The vertices that are further off, because the steps of a tile are too large.
    """

    level: int
    bound: float
    within: float
    largest: float
    tiles: int
    bytes: int
    vertices: int
    triangles: int
    heights: int
    beyond: int


def terrain_tiles(
    points: Any,
    *,
    output: Any,
    overwrite: bool = False,
    format: str = "quantized-mesh",
    tiling: str = "geographic",
    max_error: Optional[float] = None,
    max_level: Optional[int] = None,
    fill: Optional[float] = None,
    vertical_offset: Optional[float] = None,
    no_gzip: bool = False,
    require_grids: bool = False,
    epoch: Optional[float] = None,
    memory: Any = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> "list[TerrainLevel]":
    """Write a surface as levels of tiles for web globes such as CesiumJS, and return what was written.

    Parameters
    ----------
    points
        The surface: a :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes. Its coordinate
        system must be known.
    output : path
        The folder to write. It appears with all its files at the end, or not at all.
    overwrite : bool
        Replace the folder, if Breakline has written tiles into it, and it has no other files.
    format : str
        ``"quantized-mesh"``, with ``layer.json``, or ``"3dtiles"``.
    tiling : str
        ``"geographic"`` (EPSG:4326) or ``"mercator"`` (EPSG:3857).
    max_error : float, optional
        The bound of the finest level in meters; it doubles with each coarser level. By default it is what viewers expect
        of a level.
    max_level : int, optional
        The finest level. By default it follows from ``max_error``, or from how dense the heights are.
    fill : float, optional
        The height around the surface, above the ellipsoid. By default the lowest of the surface.
    vertical_offset : float, optional
        The height of the geoid above the ellipsoid in meters, which is added to heights. By default a build with PROJ
        transforms heights, if the coordinate system states their datum and the grid is installed.
    no_gzip : bool
        Do not compress quantized meshes. 3D Tiles are never compressed.
    require_grids, epoch
        As for :func:`crs`, for the transform to longitudes, latitudes and heights above the ellipsoid.
    memory : int or str, optional
        As for :func:`sample`.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`, if the surface is points.

    Returns
    -------
    list of TerrainLevel
        The levels, the coarsest first.

    Examples
    --------
    >>> import breakline, pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp(), "tiles")
    >>> slope = [[7.0, 46.0, 400], [7.01, 46.0, 400], [7.01, 46.01, 500], [7.0, 46.01, 500]]
    >>> levels = breakline.terrain_tiles(
    ...     slope, crs="EPSG:4326", force_degrees=True, max_edge="none", vertical_offset=0, max_level=12, output=folder
    ... )
    >>> len(levels), levels[-1].tiles, (folder / "layer.json").exists()
    (13, 1, True)
    """
    refuse_kept(surface)
    transform = {"require_grids": bool(require_grids), "epoch": _inputs.optional_number(epoch, "epoch")}
    if "to_crs" in surface:
        surface |= transform
    found = surface_of(points, surface, threads, progress, build=asked(memory))
    given = {
        "format": format,
        "tiling": tiling,
        "max_error": _inputs.optional_number(max_error, "max_error"),
        "fill": _inputs.optional_number(fill, "fill"),
        "vertical_offset": _inputs.optional_number(vertical_offset, "vertical_offset"),
        "max_level": _level(max_level),
        "no_gzip": bool(no_gzip),
        **transform,
    }
    with call(threads, progress) as request:
        levels = _breakline.terrain_tiles(found, given, (os.fspath(output), bool(overwrite)), request)
    return [
        TerrainLevel(level, *of, tiles, size, vertices, triangles, heights, beyond)
        for level, of, (tiles, size, vertices, triangles, heights, beyond) in levels
    ]


def _level(level: Any) -> Optional[int]:
    """Return a level as a number that fits into a byte."""
    if level is None:
        return None
    if isinstance(level, bool) or not hasattr(level, "__index__") or not 0 <= int(level) <= 28:
        raise usage("max_level is a number from 0 to 28", level, "pass the number of a level")
    return int(level)
