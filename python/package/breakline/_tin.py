"""Surfaces: the verbs ``tin`` and ``check``, and what can be asked of a surface."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, overload

import numpy as np

from . import _breakline, _inputs
from ._call import Progress, call
from ._compare import same
from ._errors import ArgumentTypeError, FormatError, LimitError, usage
from ._inputs import PathLike
from ._names import CrossingHeight, EdgeLimit, Height, Method, OnCrossing, Severity, Shading, Side
from ._points import _read, _systems
from ._pictures import SIDE, axes, missing, page
from ._results import Contours, Raster, draw, frame_of, light, of_cells
from ._surface import LINES, Building, refuse_building, surface_arguments
from ._written import HOW, Writing, Written, refuse_how, write

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: The name of each kind of edges, by its number in ``Tin.edge_kinds``.
EDGE_KINDS: "tuple[str, ...]" = tuple(_breakline.edge_kinds())


class Flaw(NamedTuple):
    """What is wrong with a surface, and the positions that it concerns, (n, 2)."""

    text: str
    at: np.ndarray

    def __eq__(self, other: object) -> bool:
        return isinstance(other, tuple) and same(tuple(self), tuple(other))

    def __ne__(self, other: object) -> bool:
        return not self == other


class Notice(NamedTuple):
    """What was assumed or looks wrong; ``severity`` is ``"detail"``, ``"note"`` or ``"warning"``."""

    severity: Severity
    text: str


class Tin:
    """A surface of triangles over points and breaklines. Made by :func:`tin`, and never changed.

    All methods may be called from many threads at once; they release the interpreter's lock. A ``Tin`` can be pickled:
    into the bytes of a ``.tin`` file, which open in milliseconds.
    """

    __slots__ = ("_surface", "_report", "_masked", "_lists", "_edges", "__weakref__")

    def __init__(self, surface: _breakline.Surface, report: "Optional[dict[str, Any]]" = None, masked: int = 0) -> None:
        if not isinstance(surface, _breakline.Surface):
            raise usage("a Tin is made by breakline.tin", surface, "call breakline.tin(points)", ArgumentTypeError)
        self._surface = surface
        self._report = report
        self._masked = masked
        self._lists: "Optional[tuple[np.ndarray, np.ndarray]]" = None
        self._edges: "Optional[tuple[np.ndarray, np.ndarray]]" = None

    def __repr__(self) -> str:
        report = self.report
        name = self.crs_name or "no coordinate system"
        return f"<breakline.Tin: {report['vertices']} vertices, {report['triangles']} triangles, {name}>"

    def _repr_html_(self) -> str:
        xmin, ymin, xmax, ymax = self.bounds
        resolution = max(xmax - xmin, ymax - ymin) / SIDE
        return page([repr(self)], lambda: self.hillshade(resolution))

    def __reduce__(self) -> Any:
        return _unpickle, (self.to_bytes(), self.report)

    def to_bytes(self) -> bytes:
        """Return the bytes of a ``.tin`` file.

        Raises
        ------
        UnsupportedError
            If the surface was read from a mesh, and has no triangulation.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.to_bytes()[:4]
        b'brkT'
        """
        with call(None, None) as request:
            return self._surface.to_bytes(request)

    @property
    def kind(self) -> str:
        """``"tin"``, or ``"mesh"`` for triangles from a file of another kind."""
        return self._surface.kind

    @property
    def crs(self) -> Optional[str]:
        """The coordinate system, as WKT; None if it is not known."""
        return self._surface.crs[0] if self._surface.crs else None

    @property
    def crs_name(self) -> Optional[str]:
        """The coordinate system in words."""
        return self._surface.crs[1] if self._surface.crs else None

    @property
    def bounds(self) -> "tuple[float, float, float, float]":
        """The box around the surface in plan: xmin, ymin, xmax, ymax."""
        low, high = self._surface.extent
        return low[0], low[1], high[0], high[1]

    @property
    def report(self) -> "dict[str, Any]":
        """Counts of vertices, triangles and edges, and of what was done with the input.

        ``masked_rows`` are the points and vertices of lines in arrays that were left out because they are masked.
        ``crossing_heights`` and ``water_overlaps`` are where breaklines meet, and waters overlap or touch, at different heights.
        """
        if self._report is None:
            self._report = {**self._surface.report(), "masked_rows": self._masked}
        return self._report

    @property
    def notices(self) -> "list[Notice]":
        """What was assumed and what looks wrong, in the order in which it was found."""
        return [Notice(severity, text) for severity, text in self._surface.notices]

    @property
    def replaced_points(self) -> np.ndarray:
        """The points that water and walls replaced, (n, 3) float64; empty unless ``flat_points=True`` was given."""
        return self._surface.replaced_points()

    def _listed(self) -> "tuple[np.ndarray, np.ndarray]":
        if self._lists is None:
            with call(None, None) as request:
                self._lists = self._surface.list(request)
        return self._lists

    @property
    def vertices(self) -> np.ndarray:
        """The vertices, (n, 3) float64, in the order of the files that :meth:`write` writes.

        Made when first asked for, in linear time, and kept; read-only.
        """
        return self._listed()[0]

    @property
    def triangles(self) -> np.ndarray:
        """The corners of the triangles, (m, 3) int32, counter-clockwise, as indices of ``vertices``.

        Numbered as in the files that :meth:`write` writes; made when first asked for, and kept; read-only.
        """
        return self._listed()[1]

    def _edge_lists(self) -> "tuple[np.ndarray, np.ndarray]":
        if self._edges is None:
            with call(None, None) as request:
                self._edges = self._surface.edges(request)
        return self._edges

    @property
    def edges(self) -> np.ndarray:
        """The ends of all edges, (k, 2) int32, each edge once; read-only."""
        return self._edge_lists()[0]

    @property
    def edge_kinds(self) -> np.ndarray:
        """The kind of each edge, (k,) uint8; :data:`breakline.EDGE_KINDS` has the names. Read-only."""
        return self._edge_lists()[1]

    def elevation(
        self, xy: Any, *, method: Method = "linear", threads: Optional[int] = None, progress: Progress = None
    ) -> Any:
        """Return heights at positions.

        Parameters
        ----------
        xy : array_like, (..., 2)
            Positions in plan, in any order.
        method : str
            ``"linear"`` (on each triangle), ``"nearest"``, ``"natural"``, ``"laplace"``, ``"smooth"`` or ``"idw"``.
        threads, progress
            See :func:`tin`.

        Returns
        -------
        ndarray of float64, (...)
            nan outside of the surface, and where a coordinate is masked or not finite. A single height for a single position.

        Notes
        -----
        O(n log n) for n positions with ``"linear"``. The first call with another method prepares the whole surface, and
        72 bytes are kept for each vertex.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.elevation([5, 5], method="smooth")
        np.float64(2.0)
        """
        positions = _inputs.positions(xy)
        flat = positions.reshape(-1, 2)
        with call(threads, progress) as request:
            heights = self._surface.elevations(flat, _inputs.name(method, "method"), request)
        return heights.reshape(positions.shape[:-1])[()]

    def dem(
        self,
        resolution: Optional[float] = None,
        *,
        extent: Any = None,
        align_to: Any = None,
        method: Method = "linear",
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Raster:
        """Return heights at the centers of cells.

        Parameters
        ----------
        resolution : float, optional
            Size of a cell, 1 by default, in the units of the coordinate system. Cells start at multiples of it.
        extent : (xmin, ymin, xmax, ymax), optional
            Extent of the raster, enlarged to whole cells; that of the surface by default.
        align_to : path, optional
            A raster whose grid of cells is used.
        method : str
            As for :meth:`elevation`.
        threads, progress
            See :func:`tin`.

        Returns
        -------
        Raster
            float32, nan where there is no surface.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.dem(5).array.tolist()
        [[2.5, 2.5], [1.5, 1.5]]
        """
        with call(threads, progress) as request:
            frame = frame_of(resolution, extent, align_to)
            return of_cells(self._surface.dem(frame, _inputs.name(method, "method"), request))

    def hillshade(
        self,
        resolution: Optional[float] = None,
        *,
        extent: Any = None,
        align_to: Any = None,
        method: Method = "linear",
        shading: Shading = "standard",
        azimuth: Optional[float] = None,
        altitude: Optional[float] = None,
        z_factor: Optional[float] = None,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Raster:
        """Return shades from 1 (dark) to 255 (bright), 0 where there is no surface.

        Parameters
        ----------
        shading : str
            ``"standard"``, ``"combined"``, ``"multidirectional"`` or ``"igor"``, as gdaldem has them.
        azimuth : float, optional
            Direction that the light comes from, in degrees clockwise from north; 315 by default. Not for
            ``"multidirectional"``, which has four lights.
        altitude : float, optional
            Angle of the light above the horizon, in degrees; 45 by default. Not for ``"igor"``.
        z_factor : float, optional
            Factor for heights; by default what converts them to the units of x and y.
        resolution, extent, align_to, method, threads, progress
            As for :meth:`dem`.

        Returns
        -------
        Raster
            uint8.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.hillshade(5, azimuth=180.0).array.min() > 0
        np.True_
        """
        sun = light(shading, azimuth, altitude, z_factor)
        with call(threads, progress) as request:
            frame = frame_of(resolution, extent, align_to)
            return of_cells(self._surface.hillshade(frame, _inputs.name(method, "method"), sun, request))

    def contours(
        self,
        interval: Optional[float] = None,
        *,
        base: float = 0.0,
        levels: Any = (),
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Contours:
        """Draw contours, exactly on the triangles.

        They never cross, none is lost where a vertex lies on a level, and higher ground is on the right.

        Parameters
        ----------
        interval : float, optional
            Height between contours, 1 by default.
        base : float
            A height at which there is a contour.
        levels : sequence of float
            These heights instead of an interval.
        threads, progress
            See :func:`tin`.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.contours(0.5).levels.tolist()
        [1.5, 2.0, 2.5]
        """
        return draw(self._surface, self.crs, interval, base, levels, threads, progress)

    def check(self, *, threads: Optional[int] = None, progress: Progress = None) -> "list[Flaw]":
        """Return the flaws of the surface; none proves that it is correct.

        Links between triangles, orientation, overlaps, and the Delaunay law between lines, by exact predicates.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.check()
        []
        """
        with call(threads, progress) as request:
            flaws = self._surface.check(request)
        return [Flaw(text, np.array(at, dtype=float).reshape(-1, 2)) for text, at in flaws]

    def write(
        self,
        path: Any,
        *,
        plain: bool = False,
        overwrite: bool = False,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> None:
        """Write the surface as ``.tin``, ``.ply``, ``.obj``, ``.off``, ``.stl``, ``.xml`` (LandXML),
        ``.dxf``, ``.glb``, ``.2dm``, ``.nc`` (UGRID) or ``.cityjson``.

        Parameters
        ----------
        path : path
            Its extension names the format.
        plain : bool
            Write only vertices and triangles, not which edges are on lines: for programs that do not read the ``.ply``
            otherwise, such as meshio.
        overwrite : bool
            Replace a file that exists.
        threads, progress
            See :func:`tin`.

        Raises
        ------
        FileKeptError
            If the file exists and ``overwrite`` is False.
        UnsupportedError
            If the format cannot hold the surface.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.write("surface.ply", overwrite=True)
        """
        with call(threads, progress) as request:
            self._surface.write(_inputs.path(path, "path"), bool(plain), bool(overwrite), request)

    def to_matplotlib(self) -> Any:
        """Return a ``matplotlib.tri.Triangulation`` of the surface in plan; heights are ``vertices[:, 2]``.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.to_matplotlib().triangles.shape
        (2, 3)
        """
        try:
            from matplotlib.tri import Triangulation
        except ImportError:
            raise missing("matplotlib", "to_matplotlib") from None
        return Triangulation(self.vertices[:, 0], self.vertices[:, 1], self.triangles)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the triangles with matplotlib, colored by height, and return the axes.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; new axes by default.
        **options
            Those of ``tripcolor``, such as ``cmap`` or ``edgecolors``.

        Notes
        -----
        For more than some 100 000 triangles, ``tin.hillshade(resolution).plot()`` is faster.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> ax = tin.plot(cmap="terrain")
        """
        ax = axes(ax)
        ax.tripcolor(self.to_matplotlib(), self.vertices[:, 2], **{"shading": "gouraud", **options})
        return ax

    def to_geopandas(self) -> Any:
        """Return a ``geopandas.GeoDataFrame`` of the triangles, polygons with heights in the order of ``triangles``.

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> tin.to_geopandas().geometry.area.tolist()
        [50.0, 50.0]
        """
        try:
            import geopandas
            import shapely
        except ImportError:
            raise missing("geopandas", "to_geopandas") from None
        return geopandas.GeoDataFrame(geometry=shapely.polygons(self.vertices[self.triangles]), crs=self.crs)

    def point_index(self, points: Any) -> np.ndarray:
        """Return for each vertex the row of the point that it was made of.

        Parameters
        ----------
        points : array_like (n, 3), record or frame
            The points, as they were given to :func:`tin`; not files. Rows of several are counted on.

        Returns
        -------
        ndarray of int64, as many as ``vertices``
            Rows, from 0; -1 for vertices of lines and crossings, and of points that are not given. Of several points at
            one position, the first with the height of the vertex, else the first.

        Notes
        -----
        O(n log n).

        Examples
        --------
        >>> import breakline
        >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> import numpy
        >>> classes = numpy.array([2, 2, 8, 9])
        >>> rows = tin.point_index([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
        >>> classes[rows][tin.vertices[:, 1] == 10].tolist()
        [9, 8]
        """
        inputs = _inputs.points(points)
        if any(isinstance(item, str) for item in inputs):
            raise usage("points are files, whose rows are not known", points, "pass read_points(files)")
        return rows_at(self.vertices, inputs)


def rows_at(vertices: np.ndarray, inputs: "list[Any]") -> np.ndarray:
    """Return for each vertex the row of the point of some inputs at its position; -1 if there is none."""
    given, rows_of_given = _inputs.coordinates_and_rows(inputs)
    both = np.concatenate([given, vertices]) + 0.0  # no zero has a sign
    # Equal positions get equal numbers, and so do equal points.
    sites = np.unique(both[:, :2], axis=0, return_inverse=True)[1].ravel()
    whole = np.unique(both, axis=0, return_inverse=True)[1].ravel()
    rows = np.full(len(vertices), -1)
    for numbers in (sites, whole):
        first = np.full(numbers.max() + 1, -1)
        first[numbers[: len(given)][::-1]] = rows_of_given[::-1]
        found = first[numbers[len(given) :]]
        rows = np.where(found >= 0, found, rows)
    return rows


def _unpickle(data: bytes, report: "dict[str, Any]") -> Tin:
    return Tin(_breakline.Surface.of_bytes(data), report)


@overload
def tin(
    points: Any,
    *,
    output: None = None,
    threads: Optional[int] = ...,
    progress: Progress = ...,
    **surface: Unpack[Building],
) -> Tin: ...
@overload
def tin(
    points: Any,
    *,
    output: PathLike,
    **writing: Unpack[Writing],
) -> Written: ...
def tin(
    points: Any,
    *,
    breaklines: Any = None,
    boundary: Any = None,
    bounds: Any = None,
    max_edge: EdgeLimit = None,
    max_edge_inside: Optional[float] = None,
    classes: Any = None,
    returns: Any = None,
    ground: bool = False,
    crs: Any = None,
    to_crs: Any = None,
    require_grids: bool = False,
    epoch: Optional[float] = None,
    force_degrees: bool = False,
    duplicates: Height = "lowest",
    on_crossing: OnCrossing = "split",
    crossing_z: CrossingHeight = "lowest",
    crossing_tolerance: Optional[float] = None,
    soft_lines: Any = None,
    draped_lines: Any = None,
    walls: Any = None,
    wall_bottom: Any = None,
    wall_drop: Any = None,
    wall_width: Optional[float] = None,
    wall_high: Side = "left",
    holes: Any = None,
    flat: Any = None,
    flat_height: Any = None,
    flat_tolerance: Optional[float] = None,
    flat_buffer: float = 0.0,
    flat_points: bool = False,
    rivers: Any = None,
    river_width: Any = None,
    densify: Optional[float] = None,
    add_ridges: bool = False,
    columns: Any = None,
    partial: bool = False,
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
) -> Any:
    """Build a TIN of points and breaklines, or open one.

    Every breakline becomes edges of the TIN; everywhere else the triangulation is Delaunay, and it does not depend on
    the order of the input.

    Parameters
    ----------
    points : array_like (n, 3), record, frame, path or list of paths
        Points with heights: an array of x, y, z; columns (:class:`Points`, a structured array such as PDAL's, a
        DataFrame or a dict with x, y, z and Classification); a laspy record, whose integers are taken as they are; a
        GeoDataFrame of points; or files, also by globs. Or one file of a surface (``.tin``, ``.ply``, ...), which is
        then opened. An empty list for a surface of lines alone. Arrays are copied. Masked rows are left out, and
        counted in a warning and in the report.
    breaklines : paths, arrays (k, 3), shapely geometries, GeoDataFrame, GeoJSON, Contours, or a list of these, optional
        Lines with heights that the surface must follow. ``"edges.shp:FIELD"`` takes heights from an attribute.
    boundary : as breaklines, optional
        Polygons that the surface is clipped to; arrays (k, 2) or (k, 3) are closed rings.
    bounds : (xmin, ymin, xmax, ymax), optional
        A rectangle to clip to. Points around it are used, too; for other methods than ``"linear"``, they may be too few,
        and a warning says so.
    max_edge : float, "auto" or "none", optional
        Longest edge at the rim; by default 100 metres, and caps (triangles with an angle over 165 degrees) are left out
        there, too.
    max_edge_inside : float, optional
        Longest edge anywhere: triangles with longer ones leave a hole.
    classes : int, str or list of these, optional
        Classes of points to use, also ranges (``"0-31"``) or ``"all"``. By default 2 (ground) if any point has it,
        else all; with ``returns`` or ``ground``, all but noise (7 and 18). Withheld points are never used.
    returns : str, int or list of these, optional
        Returns to use: ``"first"`` for surface models, ``"last"``, ``"single"``, numbers, or ranges such as ``"2-15"``;
        all by default. Points without returns are always used.
    ground : bool
        Use only points on the ground, which a filter finds among those of the classes and returns; by default of all
        classes but noise. Not in tiles. :func:`ground` returns what it finds.
    crs : str, int or pyproj.CRS, optional
        Coordinate system to assign, whatever the input states.
    to_crs : str, int or pyproj.CRS, optional
        Coordinate system to reproject to; needs a build with PROJ.
    require_grids : bool
        Stop if a grid is missing that the best operation needs, such as one of geoid heights; a warning by default.
    epoch : float, optional
        Epoch of the coordinates in years, such as 2021.5, for operations that depend on it; by default that of the
        input.
    force_degrees : bool
        Go on although coordinates are in degrees.
    duplicates : str
        Which height is used where points have the same position: ``"lowest"``, ``"highest"``, ``"mean"``, ``"first"``
        or ``"last"``.
    on_crossing : str
        ``"split"`` or ``"reject"`` breaklines that cross between their vertices.
    crossing_z : str
        Which height is used there: as ``duplicates``, or ``"error"``.
    crossing_tolerance : float, optional
        Largest difference of heights where breaklines meet, or rivers overlap, that is not reported; 0.01 metres by
        default.
    soft_lines, draped_lines, walls, holes, flat, rivers : as breaklines, optional
        Lines and areas of other kinds: lines that smooth methods pass over; lines without heights, draped over the
        surface; upper edges of walls; areas without data; lakes, level to the last bit; rivers, two banks each.
    wall_bottom, wall_drop : float or str, optional
        Height of the lower edge of walls, or how far it is below the upper one; or the attribute that has it.
    wall_width : float, optional
        Distance in plan between the edges of walls; 0.01 metres by default.
    wall_high : str
        The side of a wall on which the ground is higher, ``"left"`` or ``"right"``.
    flat_height : float or str, optional
        Height of lakes: ``"lowest"`` or ``"mean"`` of the shore, a number, or the attribute that has it;
        by default the lowest of a shore that is about level.
    flat_tolerance : float, optional
        Largest difference of heights of a shore if ``flat_height`` is not given; 0.3 metres by default.
    flat_buffer : float
        Leave out points up to this distance outside of a shore, too.
    flat_points : bool
        Keep the points that lakes, rivers and walls replace in ``Tin.replaced_points``.
    river_width : float or str, optional
        Width of rivers, or the attribute that has it: their lines run along the middle.
    densify : float, optional
        Largest distance between vertices of breaklines and soft lines: more are added.
    add_ridges : bool
        Add vertices on ridges and valleys, where triangles between contours are flat.
    columns : str or (x, y, z), optional
        Columns of text files: ``"PNEZD"``, ``"XYZ"``, or numbers from 1.
    partial : bool
        Use what is left of files that are cut or damaged: LAS, LAZ, text with a count, shapefiles.
    output : path, optional
        Write a file in the format of its extension, and return a :class:`Written` instead of a surface. ``.tins`` is a
        TIN in parts, which is made in tiles of files.
    overwrite : bool
        Replace a file that exists.
    memory : int or str, optional
        The memory to use for ``output``, such as ``"200MB"``; half of what is free by default. Files of points that
        need more are worked on in tiles, with the same result; arrays never are.
    tiles : str, optional
        Work in tiles: ``"auto"``, or columns and rows such as ``"8x8"``.
    job : path, optional
        Folder for the files of the tasks; by default the output's name with ``.job``. See :class:`Job`.
    resume : bool
        Go on with a job that was interrupted.
    update : bool
        Do again the part of an earlier job that is reached by files that were changed, added or removed since, and
        replace the output, if it is as the job has written it. The folder of the job stays, for the next update.
        Without an earlier job, one is planned.
    skip_bad : bool
        In tiles, leave a hole where a file cannot be read; ``Written.report["has_holes"]`` says so.
    threads : int, optional
        Number of threads; one per core by default. Results do not depend on it.
    progress : bool or callable, optional
        True for a bar of tqdm; or a function that is called about 20 times a second, on the calling thread, with the
        name of the stage, the items done and their number (or None). An exception in it cancels the work.

    Returns
    -------
    Tin, or Written if ``output`` is given

    Raises
    ------
    FormatError
        If the data cannot form a surface: a coordinate is not finite, a line has no heights.
    UsageError
        If an argument makes no sense.
    FileError
        If a file cannot be read.
    KeyboardInterrupt
        Soon after Ctrl-C; memory is freed.

    Notes
    -----
    O(n log n) for n points; about 100 bytes of memory for each.

    Examples
    --------
    >>> import breakline
    >>> points = [[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]
    >>> breakline.tin(points, breaklines=[[[0, 0, 1], [10, 10, 5]]], max_edge="none")
    <breakline.Tin: 4 vertices, 2 triangles, no coordinate system>
    """
    options = dict(locals())
    how = {name: options.pop(name) for name in HOW}
    if output is not None:
        return write("tin", options.pop("points"), options, how)
    refuse_how(how)
    return built(options, "linear")


def built(
    options: "dict[str, Any]", method: str, build: "Callable[..., _breakline.Surface]" = _breakline.Surface.build
) -> Tin:
    """Open or build the TIN of the parameters of `tin`, such that heights by a method are those of all points."""
    found = _inputs.points(options["points"])
    systems = _systems(options)
    is_file = len(found) == 1 and isinstance(found[0], str)
    with call(options["threads"], options["progress"]) as request:
        opened = _breakline.Surface.open(found[0], systems, request) if is_file else None
        if opened is not None:
            refuse_building(found[0], options)
            if opened.kind == "raster":
                raise usage("the file is a raster; points, a .tin or a .ply are needed", found[0], "pass points")
            return Tin(opened)
        arguments = surface_arguments(options)
        lines = [layer for name in LINES for layer in arguments[name]]
        masked = _inputs.masked_rows([*found, *lines])
        try:
            read = _read(options["columns"], options["partial"])
            surface = build(found, read, systems, arguments, method, request)
        except (FormatError, LimitError) as error:
            _inputs.name_row(error, found)
            raise
        return Tin(surface, masked=masked)
