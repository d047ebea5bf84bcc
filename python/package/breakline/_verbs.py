"""The verbs of the program that take any input, as functions."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from inspect import signature
from typing import TYPE_CHECKING, Any, Optional, Union, overload

import numpy as np

from . import _breakline, _inputs
from ._call import Progress, call
from ._errors import ArgumentTypeError, usage
from ._compare import Compared
from ._inputs import PathLike
from ._maps import MAP
from ._names import Kernel, Labels, Method, OnCrossing, Overviews, Preset, Shading
from ._points import _read, _systems
from ._results import Contours, Raster, draw, frame_of, light, of_cells
from ._surface import FOR_ANY, Building
from ._tin import Flaw, Tin, built, tin
from ._written import HOW, Writing, Written, refuse_how, write, write_made

if TYPE_CHECKING:
    from typing_extensions import Unpack


def assigned(surface: "dict[str, Any]") -> Optional[str]:
    """Return the system of lines or points read with a surface: that of its points unless these are reprojected."""
    return None if surface.get("to_crs") is not None else _inputs.crs_text(surface.get("crs"))


def asked(memory: Any, count: int = 1) -> "Callable[..., _breakline.Surface]":
    """Return what builds one of some surfaces, in files if they need more memory: for what is only asked."""
    return partial(_breakline.Surface.ask, memory=None if memory is None else str(memory), count=count)


def surface_of(
    points: Any,
    surface: "dict[str, Any]",
    threads: Any,
    progress: Any,
    method: str = "linear",
    build: "Callable[..., _breakline.Surface]" = _breakline.Surface.build,
) -> _breakline.Surface:
    """Return the surface of the library for a Tin, a raster, or what ``tin`` takes, for heights by a method."""
    if isinstance(points, (Tin, Raster)):
        _refuse(surface, "this")
        return points._surface if isinstance(points, Tin) else points._surface()
    if _inputs.is_path(points) and os.path.isfile(points):
        systems = _systems(surface)
        with call(threads, progress) as request:
            opened = _breakline.Surface.open(os.fspath(points), systems, request)
        if opened is not None and opened.kind == "raster":
            _refuse({name: surface[name] for name in surface if name not in FOR_ANY}, os.fspath(points))
            return opened
    bound = signature(tin).bind(points, threads=threads, progress=progress, **surface)
    bound.apply_defaults()
    options = {name: value for name, value in bound.arguments.items() if name not in HOW}
    return built(options, method, build)._surface


def _refuse(surface: "dict[str, Any]", what: str) -> None:
    """Refuse options of building a surface where there is one."""
    for name, value in surface.items():
        raise usage(f"{name} is for building a TIN, but {what} is a surface already", value, f"leave {name} out")


def written_by(verb: "Callable[..., Any]", given: "dict[str, Any]") -> "Optional[Written]":
    """Write what the function of a verb makes, if it is asked to by its parameters."""
    surface, points = given.pop("surface"), given.pop("points")
    how = {name: given.pop(name) for name in HOW}
    if how["output"] is None:
        refuse_how(how)
        return None
    if isinstance(points, (Tin, Raster)):
        _refuse(surface, "this")
        running = {name: given.pop(name) for name in ("threads", "progress")}
        of_file = {name: given.pop(name) for name in ("overviews",) if name in given}
        return write_made(partial(verb, points, **given), how, running, of_file)
    return write(verb.__name__, points, {**given, **surface}, how)


@overload
def dem(
    points: Any,
    *,
    resolution: Optional[float] = ...,
    extent: Any = ...,
    align_to: Any = ...,
    method: Method = ...,
    output: None = None,
    threads: Optional[int] = ...,
    progress: Progress = ...,
    **surface: Unpack[Building],
) -> Raster: ...
@overload
def dem(
    points: Any,
    *,
    resolution: Optional[float] = ...,
    extent: Any = ...,
    align_to: Any = ...,
    method: Method = ...,
    output: PathLike,
    overviews: Overviews = ...,
    **writing: Unpack[Writing],
) -> Written: ...
def dem(
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
) -> Any:
    """Return heights at the centers of cells.

    Parameters
    ----------
    points
        A :class:`Tin`, or what :func:`tin` takes.
    extent : (xmin, ymin, xmax, ymax), optional
        Extent of the raster; ``bounds`` clips the surface, as in :func:`tin`.
    resolution, align_to, method, threads, progress
        As for :meth:`Tin.dem`.
    output, overwrite, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`: files that need more memory are worked on in
        tiles, with the same result.
    overviews
        ``"none"``: write a GeoTIFF without smaller images of it; see :meth:`Raster.write`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.dem([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]], resolution=5).array.tolist()
    [[2.5, 2.5], [1.5, 1.5]]
    >>> breakline.dem("valley.laz", resolution=5, output="dem.tif", overwrite=True).path.name
    'dem.tif'
    """
    written = written_by(dem, dict(locals()))
    if written is not None:
        return written
    by = _inputs.name(method, "method")
    found = surface_of(points, surface, threads, progress, by)
    with call(threads, progress) as request:
        return of_cells(found.dem(frame_of(resolution, extent, align_to), by, request))


def simplify(
    points: Any,
    *,
    max_error: Optional[float] = None,
    target: Optional[int] = None,
    line_tolerance: Optional[float] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> Tin:
    """Return a TIN of fewer vertices: every height that was given stays within a bound of it.

    No height is moved. Lines stay, with fewer vertices; lakes stay level, walls stand, and the outer border of the surface
    stays where it is. ``Tin.notices`` has the largest error and the root mean square.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, a file of a raster, or what :func:`tin` takes.
    max_error : float, optional
        The bound, in units of height.
    target : int, optional
        Instead of a bound: how many vertices are left at most. The bound is as small as is found for them.
    line_tolerance : float, optional
        How far in plan a vertex that is left out of a line may be from what is left of it; by default the bound, or 0 in
        degrees.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline, numpy
    >>> y, x = numpy.mgrid[0:50, 0:50]
    >>> hill = numpy.stack([x, y, 0.01 * x * y], axis=-1).reshape(-1, 3)
    >>> light = breakline.simplify(hill, max_error=0.5)
    >>> light.report["vertices"] < 100
    True
    """
    for name, value in [("max_error", max_error), ("line_tolerance", line_tolerance)]:
        if value is not None and not isinstance(value, (int, float, np.integer, np.floating)):
            raise usage(f"{name} is not a number", value, f"pass {name}=0.1", ArgumentTypeError)
    if (max_error is None) == (target is None):
        raise usage("one of max_error and target is needed", None, "pass max_error=0.1")
    found = surface_of(points, surface, threads, progress)
    with call(threads, progress) as request:
        bound = None if max_error is None else float(max_error)
        tolerance = None if line_tolerance is None else float(line_tolerance)
        return Tin(found.simplify(bound, target, tolerance, request))


@overload
def hillshade(
    points: Any,
    *,
    resolution: Optional[float] = ...,
    extent: Any = ...,
    align_to: Any = ...,
    method: Method = ...,
    shading: Shading = ...,
    azimuth: Optional[float] = ...,
    altitude: Optional[float] = ...,
    z_factor: Optional[float] = ...,
    output: None = None,
    threads: Optional[int] = ...,
    progress: Progress = ...,
    **surface: Unpack[Building],
) -> Raster: ...
@overload
def hillshade(
    points: Any,
    *,
    resolution: Optional[float] = ...,
    extent: Any = ...,
    align_to: Any = ...,
    method: Method = ...,
    shading: Shading = ...,
    azimuth: Optional[float] = ...,
    altitude: Optional[float] = ...,
    z_factor: Optional[float] = ...,
    output: PathLike,
    overviews: Overviews = ...,
    **writing: Unpack[Writing],
) -> Written: ...
def hillshade(
    points: Any,
    *,
    resolution: Optional[float] = None,
    extent: Any = None,
    align_to: Any = None,
    method: Method = "linear",
    shading: Shading = "standard",
    azimuth: Optional[float] = None,
    altitude: Optional[float] = None,
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
) -> Any:
    """Return shades of a surface or of a raster of heights.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes.
    resolution, extent, align_to, method
        As for :func:`dem`; a raster keeps its cells.
    shading, azimuth, altitude, z_factor, threads, progress
        As for :meth:`Tin.hillshade`.
    output, overwrite, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`: files that need more memory are worked on in
        tiles, with the same result.
    overviews
        ``"none"``: write a GeoTIFF without smaller images of it; see :meth:`Raster.write`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.hillshade([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]], resolution=5).shape
    (2, 2)
    """
    written = written_by(hillshade, dict(locals()))
    if written is not None:
        return written
    by = _inputs.name(method, "method")
    found = surface_of(points, surface, threads, progress, by)
    sun = light(shading, azimuth, altitude, z_factor)
    with call(threads, progress) as request:
        frame = frame_of(resolution, extent, align_to)
        return of_cells(found.hillshade(frame, by, sun, request))


@overload
def contour(
    points: Any,
    *,
    interval: Optional[float] = ...,
    base: float = ...,
    levels: Any = ...,
    preset: Optional[Preset] = ...,
    smooth: Union[float, bool, None] = ...,
    simplify: Optional[float] = ...,
    min_length: Optional[float] = ...,
    min_area: Optional[float] = ...,
    keep_depressions: bool = ...,
    index_every: Optional[int] = ...,
    bands: bool = ...,
    in_plane: bool = ...,
    labels_output: Optional[PathLike] = ...,
    labels: Labels = ...,
    label_height: Optional[float] = ...,
    output: None = None,
    threads: Optional[int] = ...,
    progress: Progress = ...,
    **surface: Unpack[Building],
) -> Contours: ...
@overload
def contour(
    points: Any,
    *,
    interval: Optional[float] = ...,
    base: float = ...,
    levels: Any = ...,
    preset: Optional[Preset] = ...,
    smooth: Union[float, bool, None] = ...,
    simplify: Optional[float] = ...,
    min_length: Optional[float] = ...,
    min_area: Optional[float] = ...,
    keep_depressions: bool = ...,
    index_every: Optional[int] = ...,
    bands: bool = ...,
    in_plane: bool = ...,
    labels_output: Optional[PathLike] = ...,
    labels: Labels = ...,
    label_height: Optional[float] = ...,
    output: PathLike,
    **writing: Unpack[Writing],
) -> Written: ...
def contour(
    points: Any,
    *,
    interval: Optional[float] = None,
    base: float = 0.0,
    levels: Any = (),
    preset: Optional[Preset] = None,
    smooth: Union[float, bool, None] = None,
    simplify: Optional[float] = None,
    min_length: Optional[float] = None,
    min_area: Optional[float] = None,
    keep_depressions: bool = False,
    index_every: Optional[int] = None,
    bands: bool = False,
    in_plane: bool = False,
    labels_output: Optional[PathLike] = None,
    labels: Labels = "readable",
    label_height: Optional[float] = None,
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
) -> Any:
    """Return contours of a surface or of a raster of heights.

    Parameters
    ----------
    points
        A :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes.
    interval, base, levels, threads, progress
        As for :meth:`Tin.contours`.
    preset : str, optional
        ``"cartographic"``: lines that can be printed. Other parameters replace parts of it.
    smooth : float or bool, optional
        Smooth the lines, as far as they stay this near to the surface, in height; True for half of the interval. No
        line crosses another one or itself.
    simplify : float, optional
        Leave out vertices that are this near to the line.
    min_length, min_area : float, optional
        Leave out lines that are shorter or enclose less.
    keep_depressions : bool
        Keep depressions, whatever area they have.
    index_every : int, optional
        Mark every Nth level in a field ``INDEX`` of the file.
    bands : bool
        Write the areas between the lines, with ``ELEV_MIN`` and ``ELEV_MAX``.
    in_plane : bool
        Write lines and labels without heights, which the field ``ELEV`` has.
    labels_output : path, optional
        A file for labels: points with ``ELEV`` and ``ROTATION``, degrees counter-clockwise from east. A GeoPackage or a
        DXF drawing can be that of the lines.
    labels : str
        Where the tops of labels are: ``"readable"`` (up on the sheet) or ``"uphill"``.
    label_height : float, optional
        Their height on the ground, two intervals by default.
    output, overwrite, memory, tiles, job, resume, update, skip_bad
        Write a file, as for :func:`tin`, and return a :class:`Written`: files that need more memory are worked on in
        tiles, with the same result.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.contour([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]], interval=0.5).levels.tolist()
    [1.5, 2.0, 2.5]
    """
    given = dict(locals())
    own = {name: given[name] for name in MAP}
    written = written_by(contour, given)
    if written is not None:
        return written
    found = surface_of(points, surface, threads, progress)
    crs = found.crs[0] if found.crs else None
    return draw(found, crs, interval, base, levels, threads, progress, own)


@dataclass(frozen=True)
class Volume:
    """The volumes between a surface and its base, in one polygon or of all of the surface.

    Attributes
    ----------
    record : int or None
        The record of the polygon in ``within``, counted from 1.
    level : float or None
        The height of the base, if it is level.
    cut, fill, net : float
        The volume of the surface above its base, that of the base above the surface, and the difference.
    cut_area, fill_area, level_area, common_area : float
        The areas in plan of both, where both are equally high, and of all three.
    surface_only, base_only : float
        The areas where only one of both is. Nothing is counted there.
    slope_area : float
        The area of the surface itself, along its slopes, wherever it is.
    loose_cut, bank_fill, balance : float or None
        With ``swell`` or ``shrink``: the cut once it is loose, the ground in place that the fill takes, and the ground in
        place that is left over.
    unit : str or None
        ``"m3"``, ``"yd3"``, ``"ft3"`` or ``"acre-ft"``; areas are in its squares, or in acres. None if no coordinate system
        is known: then volumes are in cubes of the unit of the data.
    name : str or None
        The name of the polygon, with ``name_by``.
    polygon_area : float or None
        The area of the polygon itself, also where nothing is counted.
    """

    record: Optional[int]
    level: Optional[float]
    cut: float
    fill: float
    net: float
    cut_area: float
    fill_area: float
    level_area: float
    common_area: float
    surface_only: float
    base_only: float
    slope_area: float
    loose_cut: Optional[float]
    bank_fill: Optional[float]
    balance: Optional[float]
    unit: Optional[str]
    name: Optional[str] = None
    polygon_area: Optional[float] = None


def volume(
    a: Any,
    b: Any = None,
    *,
    plane: Optional[float] = None,
    levels: Any = None,
    base: Optional[str] = None,
    within: Any = None,
    name_by: Optional[str] = None,
    unit: Optional[str] = None,
    swell: Optional[float] = None,
    shrink: Optional[float] = None,
    memory: Any = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> "list[Volume]":
    """Return cut and fill between two surfaces, or above a level, exact on the triangles.

    Parameters
    ----------
    a, b
        The surface and its base: each a :class:`Tin`, a :class:`Raster`, the path of a raster, or what :func:`tin` takes.
    plane : float, optional
        A level plane as the base, instead of ``b``.
    levels : sequence of float, optional
        Several level planes, one row for each: ``fill`` is the volume below the level and above the surface.
    base : "rim", optional
        In each polygon, the triangulation of its vertices, at the heights of the surface there: the ground under a
        stockpile that is outlined at its foot.
    within : path or polygons, optional
        Polygons, with a row for each, as :func:`tin` takes them for ``boundary``; each closed line is one, too.
    name_by : str, optional
        The attribute of the polygons in a file that names them.
    unit : "m3", "yd3", "ft3" or "acre-ft", optional
        The unit of volumes; areas are in its squares. Cubic meters if the coordinate system is known.
    swell, shrink : float, optional
        The volumes of loose and of compacted ground, as multiples of those in place, such as 1.25 and 0.9; 1 by default.
    memory : int or str, optional
        As for :func:`sample`.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`, for those of ``a`` and ``b`` that are points.

    Returns
    -------
    list of Volume

    Examples
    --------
    >>> import breakline
    >>> pit = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
    >>> (row,) = breakline.volume(pit, plane=1.5)
    >>> round(row.cut, 9), round(row.fill, 9), round(row.fill_area, 9)
    (56.25, 6.25, 25.0)
    """
    given = {"b": b, "plane": plane, "levels": levels, "base": base}
    named = [name for name, value in given.items() if value is not None]
    if len(named) != 1:
        raise usage("volumes have one base", named or None, "pass one of b, plane, levels and base")
    if base not in (None, "rim"):
        raise usage("base has an unknown value", base, 'use base="rim"')
    refuse_kept(surface)
    heights = None if levels is None else [_inputs.number(level, "levels") for level in levels]
    if plane is not None:
        heights = [_inputs.number(plane, "plane")]
    outlines = [] if within is None else _inputs.layers(within, "within", True)
    if len(outlines) > 1:
        raise usage("polygons of several layers", len(outlines), "pass one file, or one list of polygons")
    if name_by is not None and within is None:
        raise usage("name_by is for polygons", name_by, "pass them as within")
    inputs = [a] if b is None else [a, b]
    found = surfaces_of(inputs, surface, memory, threads, progress)
    factors = [_inputs.number(1 if factor is None else factor, name) for factor, name in [(swell, "swell"), (shrink, "shrink")]]
    names = names_of([(a, "a"), (b, "b")])
    with call(threads, progress) as request:
        rows, known = _breakline.volume(
            found[0],
            found[1] if b is not None else None,
            heights,
            outlines[0] if outlines else None,
            None if name_by is None else _inputs.name(name_by, "name_by"),
            assigned(surface),
            None if unit is None else _inputs.name(unit, "unit"),
            None if swell is None and shrink is None else factors,
            names,
            request,
        )
    return [Volume(record, level, *numbers, *moved, known, name, area) for record, level, numbers, moved, name, area in rows]


def surfaces_of(
    inputs: "list[Any]", surface: "dict[str, Any]", memory: Any, threads: Any, progress: Any, method: str = "linear"
) -> "list[_breakline.Surface]":
    """Return several surfaces to be asked; the memory and the options of a TIN are for those that are built."""
    are_built = [is_built(points) for points in inputs]
    of_any = {name: value for name, value in surface.items() if name in FOR_ANY}
    options = [of_any if any(are_built) and not built else surface for built in are_built]
    build = asked(memory, sum(are_built))
    return [surface_of(points, own, threads, progress, method, build) for points, own in zip(inputs, options)]


def names_of(inputs: "list[tuple[Any, str]]") -> "list[str]":
    """Return what messages call some inputs: the names of files, or those of parameters."""
    return [os.fspath(item) if _inputs.is_path(item) else name for item, name in inputs]


def refuse_kept(surface: "dict[str, Any]") -> None:
    """Refuse parameters of surfaces that are kept or written."""
    for name in [*HOW, "flat_points"]:
        if name in surface:
            raise usage(f"{name} is for a surface that is kept", surface[name], f"leave {name} out")


def is_built(points: Any) -> bool:
    """Return whether a TIN is built of what `volume` and the like take."""
    if isinstance(points, (Tin, Raster)):
        return False
    return not _inputs.is_path(points) or _breakline.kind_of(os.fspath(points)) == "points"


def check(
    points: Any,
    *,
    weighted: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **surface: Any,
) -> "list[Flaw]":
    """Return the flaws of a surface, or of tetrahedra in a file; none proves that it is correct.

    Parameters
    ----------
    points
        A :class:`Tin`, the path of a mesh (also one that is no surface) or of an ``.ele``, or what :func:`tin` takes.
    weighted : bool
        The vertices of tetrahedra have weights: check that they are regular.
    threads, progress
        As for :func:`tin`.
    **surface
        Parameters of :func:`tin`.

    Examples
    --------
    >>> import breakline
    >>> breakline.check("valley.laz")
    []
    """
    for name in HOW:
        if name in surface:
            raise usage(f"{name} is for writing a file", surface[name], f"leave {name} out")
    is_file = _inputs.is_path(points) and os.path.isfile(points)
    if isinstance(points, Raster):
        raise usage("a raster has no triangles to check", None, "pass a Tin, a mesh or points", ArgumentTypeError)
    with call(threads, progress) as request:
        if is_file and _breakline.is_of_space(os.fspath(points)):
            found = _breakline.check_space(os.fspath(points), bool(weighted), request)
            return [Flaw(text, np.empty((0, 2))) for text in found]
        if weighted:
            raise usage("weighted is for the tetrahedra of an .ele", weighted, "leave it out")
        if is_file and not surface:
            flaws = _breakline.check_file(os.fspath(points), request)
            return [Flaw(text, np.array(at, dtype=float).reshape(-1, 2)) for text, at in flaws]
    if isinstance(points, Tin):
        _refuse(surface, "this")
        return points.check(threads=threads, progress=progress)
    built: Tin = tin(points, threads=threads, progress=progress, **surface)
    return built.check(threads=threads, progress=progress)


def crs(
    from_crs: Any,
    to_crs: Any = None,
    *,
    at: Any = None,
    require_grids: bool = False,
    epoch: Optional[float] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> "dict[str, Any]":
    """Return what a coordinate system is, or how one is transformed to another.

    Parameters
    ----------
    from_crs : str, int or pyproj.CRS
        ``"EPSG:25832"``, ``"EPSG:25832+7837"`` (with heights), ``"EPSG:25832+ellipsoid"``, WKT, or a file that states a
        system.
    to_crs : as from_crs, optional
        The system that coordinates are transformed to; needs a build with PROJ.
    at : (x, y) or (x, y, z), optional
        A point to transform, easting or longitude first.
    require_grids, epoch
        As for :func:`tin`.
    threads, progress
        As for :func:`tin`.

    Returns
    -------
    dict
        As ``breakline crs --json`` prints it: for two systems with all operations, the best first.

    Raises
    ------
    UsageError
        If a system is not known.
    UnsupportedError
        If there is no operation, or the library was built without PROJ.

    Examples
    --------
    >>> import breakline
    >>> breakline.crs("EPSG:2264")["unit"]["name"]
    'US survey foot'
    """
    point = None if at is None else [_inputs.number(value, "at") for value in at]
    if point is not None and len(point) not in (2, 3):
        raise usage("at is not a point", at, "pass (x, y) or (x, y, z)")
    options = (bool(require_grids), _inputs.optional_number(epoch, "epoch"))
    from_text = _inputs.crs_text(os.fspath(from_crs) if isinstance(from_crs, os.PathLike) else from_crs)
    to_text = _inputs.crs_text(os.fspath(to_crs) if isinstance(to_crs, os.PathLike) else to_crs)
    if from_text is None:
        raise usage("from_crs is not a coordinate system", from_crs, "pass 'EPSG:25832', a code, WKT or a file")
    with call(threads, progress) as request:
        found: "dict[str, Any]" = json.loads(_breakline.crs(from_text, to_text, point, options, request))
    return found


def info(
    path: Any,
    *,
    columns: Any = None,
    partial: bool = False,
    copc_resolution: Optional[float] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> "dict[str, Any]":
    """Return what is in a file: counts, bounds, classes, coordinate system, warnings.

    Parameters
    ----------
    path : path
        Points, a vector layer, a raster or a mesh; read to its end.
    columns, partial, threads, progress
        As for :func:`tin`.
    copc_resolution : float, optional
        As for :func:`read_points`.

    Returns
    -------
    dict
        As ``breakline info --json`` prints it; ``kind`` is ``"points"``, ``"layer"``, ``"raster"``, ``"mesh"``,
        ``"picture"`` or ``"plane"``.

    Examples
    --------
    >>> import breakline
    >>> breakline.info("valley.laz")["kind"]
    'points'
    """
    with call(threads, progress) as request:
        found: "dict[str, Any]" = json.loads(
            _breakline.info(_inputs.path(path, "path"), _read(columns, partial, copc_resolution), request)
        )
    return found


@dataclass(frozen=True, eq=False)
class Triangulation(Compared):
    """A triangulation in the plane, with the counts of how it came to be.

    Attributes
    ----------
    vertices : ndarray of float64, (n, 2)
        Those of the file, then those added.
    vertex_markers : ndarray of int64, (n,)
    triangles : ndarray of int64, (m, 3)
        Counter-clockwise, as indices of ``vertices``.
    segments : ndarray of int64, (k, 2)
        Constrained edges, including the boundary.
    report : dict
    """

    vertices: np.ndarray
    vertex_markers: np.ndarray
    triangles: np.ndarray
    segments: np.ndarray
    report: "dict[str, int]"


@dataclass(frozen=True, eq=False)
class SpaceTriangulation(Compared):
    """A triangulation in space.

    Attributes
    ----------
    vertices : ndarray of float64, (n, 3)
    tetrahedra : ndarray of int64, (m, 4)
    solid : dict or None
        The alpha shape: ``triangles`` (k, 3), ``alpha``, ``volume``, ``parts``, ``is_manifold``.
    report : dict
        ``points``, ``duplicates``, ``hidden``, ``dimension``, ``volume``.
    """

    vertices: np.ndarray
    tetrahedra: np.ndarray
    solid: "Optional[dict[str, Any]]"
    report: "dict[str, Any]"


def triangulate(
    path: Any,
    *,
    output: Any = None,
    in_space: bool = False,
    weighted: bool = False,
    alpha: Any = None,
    convex: bool = False,
    on_crossing: OnCrossing = "split",
    min_angle: Optional[float] = None,
    max_area: Optional[float] = None,
    region_areas: bool = False,
    max_added: Optional[int] = None,
    kernel: Kernel = "adaptive",
    overwrite: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Any:
    """Triangulate a ``.node`` or ``.poly`` file of Triangle, or points in space.

    For arrays, see :func:`breakline.triangle.triangulate` and :class:`breakline.spatial.Delaunay`.

    Parameters
    ----------
    path : path
        A ``.node`` or ``.poly`` file; in space also LAS, LAZ, text, PLY, OBJ or OFF.
    output : path or list of paths, optional
        Files to write, in the formats of their extensions.
    in_space : bool
        Triangulate in space: tetrahedra. Assumed for a ``.node`` of dimension 3.
    weighted : bool
        Points in space have weights: a regular triangulation.
    alpha : float or "auto", optional
        In space, the squared radius of the alpha shape; ``"auto"`` is the smallest that is one solid with all points.
    convex : bool
        Keep the whole convex hull.
    on_crossing : str
        ``"split"`` or ``"reject"`` segments that cross between their ends.
    min_angle : float, optional
        Add vertices until no angle is smaller, in degrees.
    max_area : float, optional
        Add vertices until no triangle is larger.
    region_areas : bool
        Apply the largest areas of the regions of a ``.poly``.
    max_added : int, optional
        Stop after this many added vertices.
    kernel : str
        ``"adaptive"`` and ``"exact"`` are exact; ``"fast"`` is plain floating point, for experiments.
    overwrite : bool
        Replace files that exist.
    threads, progress
        As for :func:`tin`.

    Returns
    -------
    Triangulation or SpaceTriangulation

    Examples
    --------
    >>> import breakline
    >>> mesh = breakline.triangulate("square.poly", min_angle=30, max_area=0.1)
    >>> mesh.triangles.shape[1]
    3
    """
    file = _inputs.path(path, "path")
    outputs = [_inputs.path(target, "output") for target in _inputs.as_sequence(output)]
    with call(threads, progress) as request:
        if in_space or _breakline.is_of_space(file):
            of_plane = {
                "convex": convex, "on_crossing": on_crossing != "split", "min_angle": min_angle is not None,
                "max_area": max_area is not None, "region_areas": region_areas, "max_added": max_added is not None,
            }  # fmt: skip
            for name, is_given in of_plane.items():
                if is_given:
                    raise usage(f"{name} is for the plane only", None, f"leave {name} out")
            alpha = _inputs.number_or_name(alpha, "alpha")
            found = _breakline.triangulate_space(
                file, bool(weighted), alpha, _inputs.name(kernel, "kernel"), outputs, bool(overwrite), request
            )
            lists = {name: found.pop(name, None) for name in ("vertices", "tetrahedra", "solid")}
            return SpaceTriangulation(**lists, report=found)
        if weighted or alpha is not None:
            raise usage(f"{'weighted' if weighted else 'alpha'} is for points in space", None, "add in_space=True")
        options = {
            "convex": bool(convex), "on_crossing": _inputs.name(on_crossing, "on_crossing"),
            "min_angle": _inputs.optional_number(min_angle, "min_angle"),
            "max_area": _inputs.optional_number(max_area, "max_area"), "region_areas": bool(region_areas),
            "max_added": None if max_added is None else _inputs.whole_numbers([max_added], "max_added", 2**32 - 1)[0],
            "kernel": _inputs.name(kernel, "kernel"),
        }  # fmt: skip
        found = _breakline.triangulate(file, options, outputs, bool(overwrite), request)
    lists = {name: found.pop(name) for name in ("vertices", "vertex_markers", "triangles", "segments")}
    return Triangulation(**lists, report=found)


def describe() -> "dict[str, Any]":
    """Return the description of the command line, as ``breakline describe --json`` prints it.

    Examples
    --------
    >>> import breakline
    >>> sorted(breakline.describe())[:2]
    ['about', 'name']
    """
    described: "dict[str, Any]" = json.loads(_breakline.describe())
    return described
