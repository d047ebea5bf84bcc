"""Heights along lines: the verbs ``profile`` and ``drape``."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from . import _breakline, _inputs
from ._call import Progress, call
from ._errors import usage
from ._verbs import asked, assigned, names_of, refuse_kept, surface_of, surfaces_of


@dataclass(frozen=True, eq=False)
class Profile:
    """The heights of surfaces along a line, or along a section across it.

    Attributes
    ----------
    record : int
        The record of the line, counted from 1.
    part : int or None
        The part of the record, counted from 1, if it has several.
    station : float or None
        Where along the line a section is; None for a profile along the line itself.
    name : str or None
        The station as it is written, such as ``"0+050"``.
    start, end : float
        The distances at which the line starts and ends. Those of a section are negative to the left of the line.
    surfaces : list of list of ndarray, (n, 4)
        For each surface, the parts of the line that are on it: rows of distance, x, y and z. The surface is straight
        between them.
    """

    record: int
    part: Optional[int]
    station: Optional[float]
    name: Optional[str]
    start: float
    end: float
    surfaces: "list[list[np.ndarray]]"


def profile(
    *surfaces: Any,
    along: Any,
    step: Optional[float] = None,
    interval: Optional[float] = None,
    stations: Any = None,
    start: Optional[float] = None,
    left: Optional[float] = None,
    right: Optional[float] = None,
    angle: Optional[float] = None,
    station_format: Optional[str] = None,
    output: Any = None,
    overwrite: bool = False,
    exaggeration: Optional[float] = None,
    datum: Optional[float] = None,
    title: Optional[str] = None,
    memory: Any = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> "list[Profile]":
    """Return the heights of surfaces along lines, or along sections across them, exact at every edge of a triangle.

    Parameters
    ----------
    *surfaces
        Each a :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes.
    along : path or lines
        The lines to follow, as :func:`tin` takes breaklines. Their heights are not used.
    step : float, optional
        The distance of points along a line, instead of one at each edge of a triangle.
    interval, stations : float, sequence of float, optional
        Sections across each line instead: at all multiples of a distance, or at these stations.
    start : float, optional
        The station at which each line begins, 0 by default.
    left, right : float, optional
        The lengths of a section to the left and to the right of the line, seen along it.
    angle : float, optional
        The angle in degrees from the direction of the line to the left half of a section, 90 by default.
    station_format : str, optional
        How stations are written, by an example of zeros, ``"0+000"`` by default.
    output : path or list of paths, optional
        Files to write: a table (.csv), a plot (.svg) or a drawing (.dxf).
    overwrite : bool
        Replace files that exist.
    exaggeration, datum, title : optional
        Of plots: by how much heights are larger than distances, the height at which a plot begins, and a title.
    memory : int or str, optional
        As for :func:`sample`.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`, for those of the surfaces that are points.

    Returns
    -------
    list of Profile

    Examples
    --------
    >>> import breakline
    >>> slope = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
    >>> (row,) = breakline.profile(slope, along=[[[5, 0, 0], [5, 10, 0]]])
    >>> row.surfaces[0][0][[0, -1]].tolist()
    [[0.0, 5.0, 0.0, 1.0], [10.0, 5.0, 10.0, 3.0]]
    """
    if not surfaces:
        raise usage("there is no surface", None, "pass a Tin, a raster or points")
    is_across = interval is not None or stations is not None
    if interval is not None and stations is not None:
        raise usage("sections are at an interval or at stations", None, "pass one of both")
    if is_across != (left is not None or right is not None):
        raise usage("sections have stations and lengths", None, "pass interval or stations, with left and right, or none")
    of_sections = {"start": start, "angle": angle, "station_format": station_format}
    for name, value in of_sections.items():
        if value is not None and not is_across:
            raise usage(f"{name} is for sections", value, f"pass interval or stations, or leave {name} out")
    sections = None
    if is_across:
        at = [] if stations is None else [_inputs.number(value, "stations") for value in stations]
        every = _inputs.optional_number(interval, "interval")
        widths = [0.0 if value is None else _inputs.number(value, name) for name, value in [("left", left), ("right", right)]]
        first = _inputs.number(0.0 if start is None else start, "start")
        turned = _inputs.number(90.0 if angle is None else angle, "angle")
        shown = _inputs.name("0+000" if station_format is None else station_format, "station_format")
        sections = (every, at, first, widths, turned, shown)
    plot = (
        _inputs.optional_number(exaggeration, "exaggeration"),
        _inputs.optional_number(datum, "datum"),
        None if title is None else str(title),
    )
    refuse_kept(surface)
    lines = _one_layer(along, "along")
    found = surfaces_of(list(surfaces), surface, memory, threads, progress)
    names = names_of([(points, f"surface {number}") for number, points in enumerate(surfaces, 1)])
    spacing = _inputs.optional_number(step, "step")
    with call(threads, progress) as request:
        rows, _, _ = _breakline.profile(
            found, lines, assigned(surface), spacing, sections, plot, names, _outputs(output, overwrite), request
        )
    return [Profile(record, part, at, name, *ends, of) for record, part, at, name, ends, of in rows]


def drape(
    points: Any,
    *,
    lines: Any,
    step: Optional[float] = None,
    output: Any = None,
    overwrite: bool = False,
    memory: Any = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> "list[list[np.ndarray]]":
    """Return lines with the heights of a surface, at every edge that they cross or by a step.

    Parameters
    ----------
    points
        The surface: a :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes.
    lines : path or lines
        The lines, as :func:`tin` takes breaklines. Their own heights are not used.
    step : float, optional
        The distance of heights along a line, instead of one at each edge of a triangle. Vertices of lines stay.
    output : path or list of paths, optional
        Files to write: .shp, .gpkg, .geojson, .geojsonl or .dxf. Attributes of shapefiles, GeoPackage and GeoJSON are kept.
    overwrite : bool
        Replace files that exist.
    memory : int or str, optional
        As for :func:`sample`.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`, if the surface is points.

    Returns
    -------
    list of list of ndarray, (n, 3)
        For each record, the parts of its lines that are on the surface.

    Examples
    --------
    >>> import breakline
    >>> slope = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
    >>> ((part,),) = breakline.drape(slope, lines=[[[5, 0, 0], [5, 10, 0]]], step=5)
    >>> part.tolist()
    [[5.0, 0.0, 1.0], [5.0, 5.0, 2.0], [5.0, 10.0, 3.0]]
    """
    refuse_kept(surface)
    layer = _one_layer(lines, "lines")
    found = surface_of(points, surface, threads, progress, build=asked(memory))
    spacing = _inputs.optional_number(step, "step")
    name = names_of([(points, "the surface")])[0]
    with call(threads, progress) as request:
        return _breakline.drape(
            found, layer, assigned(surface), spacing, name, _outputs(output, overwrite), request
        )


def _one_layer(lines: Any, parameter: str) -> Any:
    """Return lines as one layer."""
    found = _inputs.layers(lines, parameter)
    if len(found) != 1:
        raise usage(f"{parameter} is lines of one layer", len(found), "pass one file, or one list of lines")
    return found[0]


def _outputs(output: Any, overwrite: bool) -> "tuple[list[str], bool]":
    """Return the files to write."""
    files = [] if output is None else [output] if _inputs.is_path(output) else list(output)
    return [os.fspath(file) for file in files], bool(overwrite)
