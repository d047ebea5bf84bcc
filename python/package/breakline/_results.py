"""Rasters and contours: what a surface gives, and what can be done with it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, Optional

import numpy as np

from . import _breakline, _inputs, _masked
from ._call import Progress, call
from ._compare import Compared, same
from ._errors import usage
from ._maps import MAP, map_of, refuse_files
from ._names import Overviews, Shading
from ._pictures import SIDE, axes, missing, page


class Affine(NamedTuple):
    """A transform from column and row to coordinates, as those of the package ``affine``.

    ``x = a * column + b * row + c``, ``y = d * column + e * row + f``, at the corners of cells.
    """

    a: float
    b: float
    c: float
    d: float
    e: float
    f: float


def _affine(gdal: "tuple[float, ...]") -> Any:
    """Return a transform from GDAL's order; of the package ``affine`` where that is installed."""
    c, a, b, f, d, e = gdal
    try:
        from affine import Affine as Whole
    except ImportError:
        return Affine(a, b, c, d, e, f)
    return Whole(a, b, c, d, e, f)


@dataclass(frozen=True, eq=False)
class Raster(Compared):
    """A raster of heights or shades. It is an array for numpy: ``numpy.nanmax(raster)``.

    Attributes
    ----------
    array : ndarray, (rows, columns)
        Heights as float32, nan where there is none; or shades as uint8 from 1 to 255, 0 where there is none. The first
        row is the northernmost, unless the raster is aligned to one that is not. Of an array of your own, masked cells
        have no height either.
    transform : affine.Affine
        From column and row to coordinates, at the corners of cells.
    crs : str or None
        The coordinate system, as WKT.
    quantity : str or None
        What the cells hold, such as ``"slope"``; None for heights and shades.

    Examples
    --------
    >>> import breakline, numpy
    >>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
    >>> dem = tin.dem(5)
    >>> dem.shape, dem.bounds
    ((2, 2), (0.0, 0.0, 10.0, 10.0))
    >>> float(numpy.nanmax(dem))
    2.5
    """

    array: np.ndarray
    transform: Any
    crs: Optional[str] = None
    quantity: Optional[str] = None

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> np.ndarray:
        plain = np.asarray(np.ma.filled(self.array, self._fill))
        if copy:
            return np.array(plain, dtype=dtype)
        array = np.asarray(plain, dtype=dtype)
        if copy is False and not np.may_share_memory(array, self.array):
            raise usage("the raster is no such array without a copy", dtype, "leave copy=False out")
        return array

    def _repr_html_(self) -> str:
        rows, columns = self.shape
        system = "with a coordinate system" if self.crs else "no coordinate system"
        return page([f"{columns} x {rows} cells of {self.array.dtype}, {system}"], self._thumbnail)

    def _thumbnail(self) -> "Raster":
        """Return shades of every so many cells."""
        step = -(-max(self.shape) // SIDE)
        c, a, b, f, d, e = self._gdal
        small = Raster(self.array[::step, ::step], _affine((c, a * step, b * step, f, d * step, e * step)), self.crs)
        return small if self._has_shades else small.hillshade()

    @property
    def _has_shades(self) -> bool:
        return self.array.dtype == np.uint8

    @property
    def _fill(self) -> Any:
        """What stands for no value; None if nothing does."""
        if self._has_shades:
            return np.uint8(0)
        return self.array.dtype.type(np.nan) if self.array.dtype.kind == "f" else None

    @property
    def shape(self) -> "tuple[int, int]":
        """The numbers of rows and columns."""
        return self.array.shape

    @property
    def _gdal(self) -> "list[float]":
        a, b, c, d, e, f = tuple(self.transform)[:6]
        return [float(value) for value in (c, a, b, f, d, e)]

    @property
    def bounds(self) -> "tuple[float, float, float, float]":
        """The box around all cells: xmin, ymin, xmax, ymax."""
        c, a, b, f, d, e = self._gdal
        rows, columns = self.array.shape
        xs = [c + a * i + b * j for i in (0, columns) for j in (0, rows)]
        ys = [f + d * i + e * j for i in (0, columns) for j in (0, rows)]
        return min(xs), min(ys), max(xs), max(ys)

    def to_xarray(self, name: Optional[str] = None) -> Any:
        """Return an ``xarray.DataArray`` with the centers of cells as coordinates ``x`` and ``y``.

        The coordinate system is in ``attrs["crs_wkt"]``, the transform in GDAL's order in ``attrs["GeoTransform"]``, as
        rioxarray reads them from ``spatial_ref``; what stands for no value is in ``attrs["_FillValue"]``.

        Parameters
        ----------
        name : str, optional
            The name of the quantity; ``"elevation"``, ``"hillshade"`` or what it is by default.

        Examples
        --------
        >>> import breakline
        >>> dem = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).dem(5)
        >>> dem.to_xarray().name, dem.hillshade().to_xarray().attrs["_FillValue"]
        ('elevation', np.uint8(0))
        """
        try:
            import xarray
        except ImportError:
            raise missing("xarray", "to_xarray") from None
        c, a, b, f, d, e = self._gdal
        if b or d:
            raise usage(
                "the raster is rotated, and has no coordinates along its axes", None, "use .array and .transform"
            )
        rows, columns = self.array.shape
        coordinates: "dict[str, Any]" = {"y": f + e * (np.arange(rows) + 0.5), "x": c + a * (np.arange(columns) + 0.5)}
        attributes = {"GeoTransform": " ".join(repr(value) for value in self._gdal)}
        if self.crs:
            attributes["crs_wkt"] = self.crs
        coordinates["spatial_ref"] = ((), 0, attributes)
        quantity = self.quantity or ("hillshade" if self._has_shades else "elevation")
        fill = {} if self._fill is None else {"_FillValue": self._fill}
        return xarray.DataArray(
            np.asarray(self),
            coords=coordinates,
            dims=("y", "x"),
            name=quantity if name is None else name,
            attrs={"long_name": quantity, "grid_mapping": "spatial_ref", **fill},
        )

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the raster with matplotlib, and return the axes.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; new axes by default.
        **options
            Those of ``imshow``, such as ``cmap``.

        Examples
        --------
        >>> import breakline
        >>> dem = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).dem(5)
        >>> ax = dem.plot(cmap="terrain")
        """
        extent = extent_of(self.transform, self.shape)
        ax = axes(ax)
        cells = np.ma.masked_equal(self.array, 0) if self._has_shades else np.ma.masked_invalid(self.array)
        ax.imshow(cells, **{"extent": extent, "cmap": "gray" if self._has_shades else "viridis", **options})
        return ax

    def write(
        self,
        path: Any,
        *,
        overwrite: bool = False,
        overviews: Overviews = "auto",
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> None:
        """Write the raster as GeoTIFF; shades also as PNG. The bytes are those of the command line.

        Parameters
        ----------
        path : path
            ``.tif``; for shades also ``.png``.
        overwrite : bool
            Replace a file that exists.
        overviews
            ``"none"``: a GeoTIFF without smaller images of it, from which programs draw it at once; written sooner.
        threads, progress
            See :func:`breakline.tin`.

        Raises
        ------
        FileKeptError
            If the file exists and ``overwrite`` is False.

        Examples
        --------
        >>> import breakline
        >>> dem = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).dem(5)
        >>> dem.write("dem.tif", overwrite=True)
        """
        shades = self._has_shades
        cells = self._cells()
        if shades:
            cells[cells == 0] = np.nan
        with call(threads, progress) as request:
            target = {
                "file": _inputs.path(path, "path"),
                "overwrite": bool(overwrite),
                "overviews": _inputs.name(overviews, "overviews"),
            }
            _breakline.write_cells(cells, self._gdal, self.crs, bool(shades), target, request)

    def _cells(self) -> np.ndarray:
        """The cells as a new array of float64; masked ones have no height."""
        return np.ma.filled(self.array.astype(np.float64), np.nan)

    def _surface(self) -> Any:
        return _breakline.Surface.of_cells(self._cells(), self._gdal, self.crs)

    def contours(
        self,
        interval: Optional[float] = None,
        *,
        base: float = 0.0,
        levels: Any = (),
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> "Contours":
        """Draw contours between the centers of cells; see :meth:`breakline.Tin.contours`.

        Examples
        --------
        >>> import breakline
        >>> dem = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).dem(1)
        >>> dem.contours(0.5).levels.tolist()
        [1.5, 2.0, 2.5]
        """
        return draw(self._surface(), self.crs, interval, base, levels, threads, progress)

    def hillshade(
        self,
        *,
        shading: Shading = "standard",
        azimuth: Optional[float] = None,
        altitude: Optional[float] = None,
        z_factor: Optional[float] = None,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> "Raster":
        """Shade the heights; see :meth:`breakline.Tin.hillshade`.

        Examples
        --------
        >>> import breakline
        >>> dem = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).dem(1)
        >>> dem.hillshade(azimuth=180.0).array.dtype
        dtype('uint8')
        """
        frame, sun = frame_of(None, None, None), light(shading, azimuth, altitude, z_factor)
        with call(threads, progress) as request:
            return of_cells(self._surface().hillshade(frame, "linear", sun, request))


def extent_of(transform: Any, shape: "tuple[int, ...]") -> "tuple[float, float, float, float]":
    """Return the extent of an image of these rows and columns, as matplotlib takes it."""
    a, b, c, d, e, f = tuple(transform)[:6]
    if b or d:
        raise usage("the raster is rotated, and its cells are no picture", None, "use .array and .transform")
    return (c, c + a * shape[1], f + e * shape[0], f)


def frame_of(resolution: Any, extent: Any, align_to: Any, overviews: Any = "auto") -> "dict[str, Any]":
    """Return the size and the position of a raster, and its overviews, as the library takes them."""
    return {
        "resolution": _inputs.optional_number(resolution, "resolution"),
        "extent": _inputs.bounds(extent, "extent"),
        "align_to": None if align_to is None else _inputs.path(align_to, "align_to"),
        "overviews": _inputs.name(overviews, "overviews"),
    }


def light(
    shading: Any, azimuth: Any, altitude: Any, z_factor: Any
) -> "tuple[str, Optional[float], Optional[float], Optional[float]]":
    """Return how slopes are shaded, where light comes from, and the factor of heights, as the library takes them."""
    return (
        _inputs.name(shading, "shading"),
        _inputs.optional_number(azimuth, "azimuth"),
        _inputs.optional_number(altitude, "altitude"),
        _inputs.optional_number(z_factor, "z_factor"),
    )


def of_cells(found: "tuple[Any, Any, Any]", quantity: Optional[str] = None) -> Raster:
    """Return a raster of a quantity from what the library returns."""
    array, transform, crs = found
    return Raster(array, _affine(transform), crs, quantity)


class Contour(NamedTuple):
    """A line at one height, with higher ground on its right; a closed one ends where it begins."""

    level: float
    points: np.ndarray

    def __eq__(self, other: object) -> bool:
        return isinstance(other, tuple) and same(tuple(self), tuple(other))

    def __ne__(self, other: object) -> bool:
        return not self == other


@dataclass(frozen=True, eq=False)
class Contours(Compared):
    """Contours of a surface, sorted by height. They are lines for :func:`breakline.tin`, too, with their heights.

    Iterating yields :class:`Contour`, whose points are views into ``coordinates``.

    Attributes
    ----------
    coordinates : ndarray of float64, (n, 2)
        The vertices of all lines, one after the other.
    offsets : ndarray of int64, (m + 1,)
        Line i has the vertices from ``offsets[i]`` to ``offsets[i + 1]``.
    levels : ndarray of float64, (m,)
        The height of each line.
    crs : str or None
        The coordinate system, as WKT.

    Examples
    --------
    >>> import breakline
    >>> contours = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).contours(0.5)
    >>> [(line.level, len(line.points)) for line in contours]
    [(1.5, 3), (2.0, 3), (2.5, 3)]
    """

    coordinates: np.ndarray
    offsets: np.ndarray
    levels: np.ndarray
    crs: Optional[str] = None

    def __len__(self) -> int:
        return len(self.levels)

    def __getitem__(self, index: int) -> Contour:
        index = range(len(self))[index]
        return Contour(float(self.levels[index]), self.coordinates[self.offsets[index] : self.offsets[index + 1]])

    def __iter__(self) -> "Iterator[Contour]":
        return (self[index] for index in range(len(self)))

    @property
    def __geo_interface__(self) -> "dict[str, Any]":
        """The lines as a GeoJSON-like ``FeatureCollection``, each with the property ``level``."""
        features = [
            {
                "type": "Feature",
                "properties": {"level": line.level},
                "geometry": {"type": "LineString", "coordinates": line.points.tolist()},
            }
            for line in self
        ]
        return {"type": "FeatureCollection", "features": features}

    def to_shapely(self) -> np.ndarray:
        """Return an array of ``shapely.LineString``.

        Examples
        --------
        >>> import breakline
        >>> contours = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).contours(0.5)
        >>> contours.to_shapely()[0].geom_type
        'LineString'
        """
        try:
            import shapely
        except ImportError:
            raise missing("shapely", "to_shapely") from None
        lines: np.ndarray = shapely.from_ragged_array(
            shapely.GeometryType.LINESTRING, self.coordinates, (self.offsets,)
        )
        return lines

    def to_geopandas(self) -> Any:
        """Return a ``geopandas.GeoDataFrame`` with the columns ``level`` and ``geometry``.

        Examples
        --------
        >>> import breakline
        >>> contours = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).contours(0.5)
        >>> contours.to_geopandas().level.tolist()
        [1.5, 2.0, 2.5]
        """
        try:
            import geopandas
        except ImportError:
            raise missing("geopandas", "to_geopandas") from None
        return geopandas.GeoDataFrame({"level": self.levels}, geometry=self.to_shapely(), crs=self.crs)

    def to_arrow(self) -> Any:
        """Return a ``pyarrow.Table`` with ``level`` and ``geometry``, a GeoArrow linestring; arrays are not copied.

        Examples
        --------
        >>> import breakline
        >>> contours = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).contours(0.5)
        >>> contours.to_arrow().column_names
        ['level', 'geometry']
        """
        try:
            import pyarrow
        except ImportError:
            raise missing("pyarrow", "to_arrow") from None
        import json

        flat = pyarrow.array(self.coordinates.reshape(-1))
        pairs = pyarrow.FixedSizeListArray.from_arrays(
            flat, type=pyarrow.list_(pyarrow.field("xy", pyarrow.float64(), False), 2)
        )
        if self.offsets[-1] > np.iinfo(np.int32).max:
            lines = pyarrow.LargeListArray.from_arrays(pyarrow.array(self.offsets), pairs)
        else:
            lines = pyarrow.ListArray.from_arrays(pyarrow.array(self.offsets.astype(np.int32)), pairs)
        metadata = {"crs": self.crs, "crs_type": "wkt2:2019"} if self.crs else {}
        extension = {"ARROW:extension:name": "geoarrow.linestring", "ARROW:extension:metadata": json.dumps(metadata)}
        fields = [pyarrow.field("level", pyarrow.float64()), pyarrow.field("geometry", lines.type, metadata=extension)]
        return pyarrow.table([pyarrow.array(self.levels), lines], schema=pyarrow.schema(fields))

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the lines with matplotlib, colored by height, and return the axes.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; new axes by default.
        **options
            Those of ``matplotlib.collections.LineCollection``, such as ``cmap`` or ``linewidths``.

        Examples
        --------
        >>> import breakline
        >>> contours = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).contours(0.5)
        >>> ax = contours.plot(cmap="terrain")
        """
        ax = axes(ax)
        from matplotlib.collections import LineCollection

        lines = LineCollection([line.points for line in self], **{"array": self.levels, **options})
        ax.add_collection(lines)
        ax.autoscale_view()
        return ax

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def write(
        self, path: Any, *, overwrite: bool = False, threads: Optional[int] = None, progress: Progress = None
    ) -> None:
        """Write the lines as a shapefile or as GeoJSON. The bytes are those of the command line.

        Parameters
        ----------
        path : path
            ``.shp``, ``.geojson`` or ``.json``.
        overwrite : bool
            Replace files that exist.
        threads, progress
            See :func:`breakline.tin`.

        Examples
        --------
        >>> import breakline
        >>> contours = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]).contours(0.5)
        >>> contours.write("contours.geojson", overwrite=True)
        """
        with call(threads, progress) as request:
            _breakline.write_contours(
                self.coordinates,
                self.offsets,
                self.levels,
                self.crs,
                _inputs.path(path, "path"),
                bool(overwrite),
                request,
            )


def draw(
    surface: Any, crs: Any, interval: Any, base: Any, levels: Any, threads: Any, progress: Any, own: Any = MAP
) -> Contours:
    """Draw the contours of a surface of the library; ``own`` are the parameters of contours for maps."""
    refuse_files(own)
    (levels,) = _masked.rows("levels", np.atleast_1d(_masked.as_array(levels)).ravel())
    levels = [_inputs.number(level, "levels") for level in levels]
    if interval is not None and levels:
        raise usage("interval and levels are given", None, "use one of them")
    interval, base = _inputs.optional_number(interval, "interval"), _inputs.number(base, "base")
    with call(threads, progress) as request:
        coordinates, offsets, heights = surface.contours(interval, base, levels, map_of(own), request)
    return Contours(coordinates, offsets, heights, crs)
