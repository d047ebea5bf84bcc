"""Heights of a surface at points, and its accuracy by points that are known better."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np

from . import _breakline, _inputs
from ._call import Progress, call
from ._errors import usage
from ._names import Method
from ._points import _read
from ._verbs import asked, assigned, is_built, refuse_kept, surface_of

#: How text is read.
_READING = ("columns", "partial")


def sample(
    points: Any,
    at: Any,
    *,
    add: Any = "height",
    prefix: str = "",
    method: Method = "linear",
    memory: Any = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> "dict[str, np.ndarray]":
    """Return heights, slopes and gradients of a surface at positions.

    Parameters
    ----------
    points
        The surface: a :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes.
    at : array_like, (..., 2)
        Positions in plan, in any order.
    add : str or sequence of str
        What is returned: ``"height"``, ``"slope"`` (degrees), ``"slope-percent"``, ``"aspect"`` (degrees clockwise from
        north, nan where it is level) and ``"gradient"``. Positions have no heights: ``"height-above"`` is for the
        program, which adds it to LAS and LAZ.
    prefix : str
        What the names begin with.
    method : str
        How heights between the vertices are computed, as for :func:`dem`. Slopes need ``"linear"``.
    memory : int or str, optional
        The memory for surfaces of points, such as ``"200MB"``; half of what is free by default. Files of points that need
        more become a TIN in parts first, which is used in its files, with the same result if heights are linear. The
        files are in the folder that the environment names as ``TMPDIR``, else in ``/var/tmp``, and are removed at the
        end.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`, if ``points`` are points.

    Returns
    -------
    dict of ndarray of float64, (...)
        ``surface_z``, ``slope``, ``slope_pct``, ``aspect``, ``gradient_x`` and ``gradient_y``, as far as asked for: nan outside
        of the surface, and where a coordinate is masked or not finite.

    Notes
    -----
    Heights are those of the cells of a DEM whose centers are at these positions, before a cell is rounded to 32 bits. The
    slope on an edge or a vertex is that of the steepest triangle there.

    Examples
    --------
    >>> import breakline
    >>> hill = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
    >>> found = breakline.sample(hill, [[5, 5], [50, 50]], add=["height", "slope-percent"])
    >>> found["surface_z"].tolist(), found["slope_pct"].tolist()
    ([2.0, nan], [20.0, nan])
    """
    if _inputs.is_path(at):
        raise usage("at is a file", at, "pass an array (n, 2), such as columns of read_points(at)")
    refuse_kept(surface)
    positions = _inputs.positions(at, "at")
    names = [add] if isinstance(add, str) else [_inputs.name(name, "add") for name in _inputs.as_sequence(add)]
    if not names or len(set(names)) < len(names):
        raise usage("add names a field twice, or none", names, 'pass names such as ["height", "slope"]')
    of_method = _inputs.name(method, "method")
    found = surface_of(points, surface, threads, progress, of_method, asked(memory))
    flat = positions.reshape(-1, 2)
    with call(threads, progress) as request:
        columns, values = found.samples(flat, names, _inputs.name(prefix, "prefix"), of_method, request)
    shape = positions.shape[:-1]
    return {name: values[:, i].reshape(shape) for i, name in enumerate(columns)}


@dataclass(frozen=True)
class SetAccuracy:
    """Statistics of differences, the surface minus the checkpoint.

    Attributes
    ----------
    set : str
        ``"all"``, ``"non-vegetated"``, ``"vegetated"`` or ``"group"``.
    group : str or None
        The name of the group.
    n : int
        The number of checkpoints on the surface.
    mean, median, standard_deviation, rmse, nmad, percentile_95, min, max, skew : float
        Their statistics; the percentile is that of the amounts.
    accuracy : float
        The RMSE with that of the checkpoints themselves.
    """

    set: str
    group: Optional[str]
    n: int
    mean: float
    median: float
    standard_deviation: float
    rmse: float
    nmad: float
    percentile_95: float
    min: float
    max: float
    skew: float
    accuracy: float


@dataclass(frozen=True)
class Accuracy:
    """The vertical accuracy of a surface.

    Attributes
    ----------
    sets : list of SetAccuracy
        The statistics of all checkpoints, of those without and with vegetation, and of each group.
    is_met : bool or None
        Whether the accuracy class is met; None if none was asked for.
    limit : float or None
        The accuracy class, in the unit of the heights.
    decisive : str or None
        The set that decides.
    checkpoint_error : float
        The RMSE of the checkpoints themselves.
    unit : str or None
        The unit of the heights, if it is known.
    histogram : tuple or None
        Where the first bin begins, the width of each, and the counts.
    points : dict
        ``number`` (of the line, record or point, from 1), ``x``, ``y``, ``z``, ``surface_z``, ``difference`` (nan outside) and
        ``group``, each with an entry for each checkpoint.
    """

    sets: "list[SetAccuracy]"
    is_met: Optional[bool]
    limit: Optional[float]
    decisive: Optional[str]
    checkpoint_error: float
    unit: Optional[str]
    histogram: "Optional[tuple[float, float, list[int]]]"
    points: "dict[str, Any]"


def accuracy(
    points: Any,
    checkpoints: Any,
    *,
    accuracy_class: Union[float, str, None] = None,
    checkpoint_error: Union[float, str, None] = None,
    group_by: Any = None,
    vegetated: Any = None,
    method: Method = "linear",
    memory: Any = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Accuracy:
    """Return the vertical accuracy of a surface by checkpoints, in the terms of ASPRS (2023, edition 2).

    Parameters
    ----------
    points
        The surface: a :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes.
    checkpoints
        Points that are known better: the path of a file, or points in memory as :func:`tin` takes them.
    accuracy_class : float or str, optional
        The largest RMSE that meets the class, in the unit of the heights, or with a unit: ``"10cm"``.
    checkpoint_error : float or str, optional
        The RMSE of the checkpoints themselves.
    group_by : str or sequence, optional
        A field of the file, or a label for each checkpoint in memory: statistics for each value.
    vegetated : str or sequence of str, optional
        Groups in vegetation: their accuracy is returned, and does not decide.
    method : str
        How heights between the vertices are computed, as for :func:`dem`.
    memory : int or str, optional
        As for :func:`sample`.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`, if ``points`` are points; ``columns`` and ``partial`` are for files of checkpoints, too.

    Returns
    -------
    Accuracy

    Examples
    --------
    >>> import breakline
    >>> hill = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
    >>> import warnings
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore")  # two checkpoints are too few
    ...     found = breakline.accuracy(hill, [[5, 5, 2.5], [2, 5, 1.5]], accuracy_class=0.5)
    >>> found.sets[0].rmse, found.is_met
    (0.5, True)
    """
    refuse_kept(surface)
    reading = {name: surface.get(name) for name in _READING}
    if not is_built(points):
        surface = {name: value for name, value in surface.items() if name not in _READING}
    if _inputs.is_path(checkpoints):
        inputs = [os.fspath(checkpoints)]
    else:
        inputs = _inputs.points(checkpoints)
    if len(inputs) != 1:
        raise usage("checkpoints are of several inputs", len(inputs), "pass one file, or one array")
    is_field = group_by is None or isinstance(group_by, str)
    field = group_by if is_field else None
    labels = [] if is_field else [str(label) for label in _inputs.as_sequence(group_by)]
    if field is not None and not isinstance(inputs[0], str):
        raise usage("group_by is a field, but the checkpoints are in memory", field, "pass a label for each checkpoint")
    if labels and isinstance(inputs[0], str):
        raise usage("group_by has labels, but the checkpoints are a file", None, "name a field of it")
    if vegetated is not None and group_by is None:
        raise usage("vegetated needs groups", vegetated, "pass group_by")
    named = [] if vegetated is None else [vegetated] if isinstance(vegetated, str) else list(vegetated)
    of_method = _inputs.name(method, "method")
    found = surface_of(points, surface, threads, progress, of_method, asked(memory))
    name = os.fspath(points) if _inputs.is_path(points) else "the surface"
    with call(threads, progress) as request:
        report = _breakline.accuracy(
            found,
            inputs[0],
            _read(reading["columns"], bool(reading["partial"])),
            assigned(surface),
            (field, labels, [_inputs.name(group, "vegetated") for group in named]),
            _measure(accuracy_class, "accuracy_class"),
            _measure(checkpoint_error, "checkpoint_error"),
            of_method,
            name,
            request,
        )
    columns = ("number", "x", "y", "z", "surface_z", "difference", "group")
    rest = {name: value for name, value in report.items() if name not in (*columns, "sets")}
    sets = [SetAccuracy(kind, group, count, *numbers) for kind, group, count, numbers in report["sets"]]
    return Accuracy(sets=sets, points={name: report[name] for name in columns}, **rest)


def _measure(value: Any, parameter: str) -> "float | str | None":
    """Return a difference of heights: a number, or a text with a unit."""
    if value is None or isinstance(value, str):
        return value
    return _inputs.number(value, parameter)
