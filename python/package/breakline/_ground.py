"""The ground among points."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from . import _breakline, _inputs
from ._call import Progress, call
from ._errors import usage
from ._names import Bridges


def ground(
    points: Any,
    output: Any = None,
    *,
    from_class: Any = None,
    returns: Any = None,
    bridges: Bridges = "off",
    noise: bool = False,
    crs: Any = None,
    overwrite: bool = False,
    memory: Optional[str] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Any:
    """Find the ground among points: classes for an array, or files with classes.

    Points on the terrain get class 2, others class 1. In files every other byte stays: dates, records, flags, times,
    extra bytes, waveforms, and the order of the points. LAS stays LAS and LAZ stays LAZ, unless the name of the output
    says otherwise; of COPC, the octree is left out. Several files are one area.

    Parameters
    ----------
    points : array_like (n, 3), path or list of paths
        Positions with heights; or LAS, LAZ and COPC files, also by globs.
    output : path, optional
        For files: the file to write (``.las``, ``.laz``), or a folder for a file for each, of the same name.
    from_class : int, str or list of these, optional
        For files: the classes whose points get a new one; 0, 1 and 2 by default. The filter does not see others, nor
        points that are flagged as withheld.
    returns : str, int or list of these, optional
        For files: the returns that may be ground, such as ``"last"``; all by default. Others get class 1.
    bridges : str
        ``"off"`` the ground, or ``"ground"``.
    noise : bool
        Find noise, too: class 7 far below the ground, 18 alone in the air. In point formats 0 to 5, both are 7.
    crs : str, int or pyproj.CRS, optional
        Coordinate system of the points, for its units: lengths of the filter are in meters. By default that of the
        files; of arrays, and of files that state none, a unit is taken for a meter.
    overwrite : bool
        Replace files that exist.
    memory : str, optional
        For files: memory for the points, such as ``"2GB"``; half of what is free by default. What needs more, at 200
        bytes a point, is filtered in tiles.
    threads, progress
        As for :func:`tin`.

    Returns
    -------
    ndarray of uint8, (n,)
        Classes, for an array. Or for files a dict: for each of ``files`` its ``path`` and ``output``, how many
        ``points`` it has and how many were ``filtered``, and the points by class ``before`` and ``after``.

    Raises
    ------
    FileKeptError
        If an output exists and ``overwrite`` is False.
    UsageError
        If files have no output, or an array has one.
    LimitError
        If there is not enough memory for an array, at about 200 bytes a point, or for a tile.

    Examples
    --------
    >>> import breakline, numpy as np
    >>> x, y = (axis.ravel() for axis in np.mgrid[0:40, 0:40] / 2.0)
    >>> z = np.where((abs(x - 10) < 3) & (abs(y - 10) < 3), 6.0, 0.0)
    >>> classes = breakline.ground(np.column_stack([x, y, z]))
    >>> sorted(set(classes[z == 6].tolist())), sorted(set(classes[z == 0].tolist()))
    ([1], [2])
    """
    how = {"bridges": _inputs.name(bridges, "bridges"), "noise": bool(noise), "crs": _inputs.crs_text(crs)}
    if not _are_paths(points):
        for name, value in {"output": output, "from_class": from_class, "returns": returns, "memory": memory}.items():
            if value is not None:
                raise usage(f"{name} is for files, but points are an array", value, f"leave {name} out, or pass paths")
        array = np.require(points, dtype=np.float64, requirements="A")
        if array.ndim != 2 or array.shape[1] != 3:
            raise usage(f"points have the shape {array.shape}, expected (n, 3)", None, "pass an array (n, 3)")
        with call(threads, progress) as request:
            return _breakline.ground_classes(array, how, request)
    if output is None:
        raise usage("files are classified to files, and output is missing", None, "pass output")
    chosen = (_inputs.classes(from_class), _inputs.returns(returns))
    target = (_inputs.path(output, "output"), bool(overwrite), None if memory is None else str(memory))
    with call(threads, progress) as request:
        return _breakline.write_ground(_inputs.files(points, "points"), chosen, how, target, request)


def _are_paths(points: Any) -> bool:
    """Return whether points are in files."""
    several = points if isinstance(points, (list, tuple)) else [points]
    return len(several) > 0 and all(_inputs.is_path(one) for one in several)
