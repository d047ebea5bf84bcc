"""Points in columns, and the verb ``points``."""

from __future__ import annotations

from typing import Any, Optional

from . import _breakline, _inputs
from ._call import Progress, call
from ._columns import Points
from ._errors import usage


def _read(columns: Any, partial: bool, copc_resolution: Any = None) -> "dict[str, Any]":
    if columns is not None and not isinstance(columns, str):
        columns = ",".join(map(str, _inputs.whole_numbers(columns, "columns", 255)))
    resolution = _inputs.optional_number(copc_resolution, "copc_resolution")
    return {"columns": columns, "partial": bool(partial), "copc_resolution": resolution}


def _selection(
    classes: Any,
    returns: Any,
    drop_withheld: bool,
    bounds: Any,
    boundary: Any,
    thin: Any,
    thin_keep: Any,
    seed: Any,
    round: bool = False,
) -> "dict[str, Any]":
    return {
        "classes": _inputs.classes(classes),
        "returns": _inputs.returns(returns),
        "drop_withheld": bool(drop_withheld),
        "bounds": _inputs.bounds(bounds),
        "boundary": [] if boundary is None else _inputs.files(boundary, "boundary"),
        "thin": None if thin is None else _inputs.name(thin, "thin"),
        "thin_keep": None if thin_keep is None else _inputs.name(thin_keep, "thin_keep"),
        "seed": None if seed is None else _inputs.whole_numbers([seed], "seed", 2**64 - 1)[0],
        "round": bool(round),
    }


def _tiles(tile: Any, buffer: Any, flag_buffer: bool) -> "Optional[tuple[str, Optional[str], bool]]":
    if tile is None and (buffer is not None or flag_buffer):
        raise usage("buffer without tiles", buffer, "pass tile, too")
    if tile is None:
        return None
    return str(tile), None if buffer is None else str(buffer), bool(flag_buffer)


def _systems(options: "dict[str, Any]") -> "dict[str, Any]":
    """Return the coordinate systems among some options as the library takes them."""
    return {
        "crs": _inputs.crs_text(options.get("crs")),
        "to_crs": _inputs.crs_text(options.get("to_crs")),
        "force_degrees": bool(options.get("force_degrees", False)),
        "require_grids": bool(options.get("require_grids", False)),
        "epoch": _inputs.optional_number(options.get("epoch"), "epoch"),
    }


def read_points(
    paths: Any,
    *,
    classes: Any = None,
    returns: Any = None,
    drop_withheld: bool = False,
    bounds: Any = None,
    boundary: Any = None,
    thin: Any = None,
    thin_keep: Any = None,
    seed: Any = None,
    crs: Any = None,
    to_crs: Any = None,
    require_grids: bool = False,
    epoch: Optional[float] = None,
    columns: Any = None,
    partial: bool = False,
    copc_resolution: Optional[float] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Points:
    """Read points from files into columns.

    Parameters
    ----------
    paths : path or list of paths
        LAS, LAZ, COPC, text (x y z) or vector layers; globs are expanded.
    classes : int, str or list of these, optional
        Classes to keep, by number or by name (``"ground"``); all by default.
    returns : str, int or list of these, optional
        Returns to keep: ``"first"``, ``"last"``, ``"single"``, numbers, or ranges such as ``"2-15"``; all by default.
    drop_withheld : bool
        Leave out points that are flagged as withheld.
    bounds : (xmin, ymin, xmax, ymax), optional
        A rectangle to clip to, including its border. Of COPC files only the nodes are read that meet it.
    boundary : path or list of paths, optional
        Polygons to clip to.
    thin : str, optional
        ``"grid:SIZE"`` keeps one point of each cell; cells begin at multiples of their size. ``"poisson:DISTANCE"`` keeps
        points that are at least so far apart in plan, and leaves out only those that are closer to one of them.
        ``"nth:N"`` keeps the first of every N, ``"random:SHARE"`` a share: a smaller one is part of a larger one.
        Points are selected first, then thinned; those that stay keep their order.
    thin_keep : str, optional
        The point of a cell to keep: ``"center"`` (the nearest to it; the default), ``"lowest"`` or ``"highest"``.
    seed : int, optional
        For ``"poisson:DISTANCE"`` and ``"random:SHARE"``: with another seed, other points are kept; 0 by default.
    crs : str, int or pyproj.CRS, optional
        Coordinate system to assign, whatever the files state.
    to_crs : str, int or pyproj.CRS, optional
        Coordinate system to reproject to; needs a build with PROJ.
    require_grids : bool
        Stop if a grid is missing that the best operation needs, such as one of geoid heights; a warning by default.
    epoch : float, optional
        Epoch of the coordinates in years, such as 2021.5, for operations that depend on it; by default that of the input.
    columns : str or (x, y, z), optional
        Columns of text files: ``"PNEZD"``, ``"XYZ"``, or numbers from 1.
    partial : bool
        Use what is left of files that are cut or damaged: LAS, LAZ, text with a count, shapefiles.
    copc_resolution : float, optional
        Read only the coarse levels of COPC files: to the first one on which points are at most so far apart. All inputs
        must be COPC.
    threads : int, optional
        Number of threads; one per core by default.
    progress : bool or callable, optional
        See :func:`breakline.tin`.

    Returns
    -------
    Points

    Raises
    ------
    FileError
        If a file cannot be read.
    FormatError
        If a file is damaged.
    UsageError
        If no point is left, or an argument makes no sense.

    Notes
    -----
    Linear in the points; 28 bytes of memory for each.

    Examples
    --------
    >>> import breakline
    >>> ground = breakline.read_points("valley.laz", classes="ground")
    >>> set(ground.classification.tolist())
    {2}
    """
    selection = _selection(classes, returns, drop_withheld, bounds, boundary, thin, thin_keep, seed)
    systems = _systems({"crs": crs, "to_crs": to_crs, "require_grids": require_grids, "epoch": epoch})
    with call(threads, progress) as request:
        found = _breakline.read_points(
            _inputs.files(paths, "paths"), _read(columns, partial, copc_resolution), systems, selection, request
        )
    return Points(**found)


def points(
    inputs: Any,
    output: Any,
    *,
    classes: Any = None,
    returns: Any = None,
    drop_withheld: bool = False,
    bounds: Any = None,
    boundary: Any = None,
    thin: Any = None,
    thin_keep: Any = None,
    seed: Any = None,
    round: bool = False,
    tile: Any = None,
    buffer: Any = None,
    flag_buffer: bool = False,
    crs: Any = None,
    to_crs: Any = None,
    require_grids: bool = False,
    epoch: Optional[float] = None,
    columns: Any = None,
    partial: bool = False,
    copc_resolution: Optional[float] = None,
    overwrite: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> "dict[str, Any]":
    """Select, clip and merge points of files to a file, with all their attributes.

    Points are written in the order of the files. From LAS and LAZ to LAS and LAZ every byte of a point stays.

    Parameters
    ----------
    inputs : path or list of paths
        LAS, LAZ, COPC, text or vector layers.
    output : path
        The file to write: ``.las``, ``.laz``, ``.xyz``, ``.txt`` or ``.csv``.
    round : bool
        Round coordinates to the nearest step of the first file's scale, if scales and offsets do not fit together.
    tile : float or str
        Write a file for each square of this side, into the folder ``output``, with the name ``X_Y`` of its lower left
        corner: a number in the units of the coordinates, or a text such as ``"1km"``.
    buffer : float or str
        Points of other tiles up to this distance from a tile are in its file, too.
    flag_buffer : bool
        Flag the points of the buffer as withheld.
    overwrite : bool
        Replace files that exist.
    classes, returns, drop_withheld, bounds, boundary, thin, thin_keep, seed, crs, to_crs, require_grids,
    epoch, columns, partial, copc_resolution
        As for :func:`read_points`.
    threads, progress
        As for :func:`read_points`.

    Returns
    -------
    dict
        Counts of points that were written, and why others were not.

    Raises
    ------
    FileKeptError
        If the output exists and ``overwrite`` is False.
    UsageError
        If no point is left, or files cannot be merged without loss.

    Examples
    --------
    >>> import breakline
    >>> counts = breakline.points("valley.laz", "ground.laz", classes="ground", overwrite=True)
    """
    selection = _selection(classes, returns, drop_withheld, bounds, boundary, thin, thin_keep, seed, round)
    systems = _systems({"crs": crs, "to_crs": to_crs, "require_grids": require_grids, "epoch": epoch})
    with call(threads, progress) as request:
        return _breakline.write_points(
            _inputs.files(inputs, "inputs"),
            _read(columns, partial, copc_resolution),
            systems,
            selection,
            _inputs.path(output, "output"),
            _tiles(tile, buffer, flag_buffer),
            bool(overwrite),
            request,
        )
