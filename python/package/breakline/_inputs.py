"""What users have, as what the library takes: arrays, records, frames, geometries, paths."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Iterable, Sequence
from typing import Any, Optional, Union

import numpy as np

from . import _breakline, _masked
from ._columns import Points
from ._errors import ArgumentTypeError, BreaklineError, usage, warn

_POINT_KINDS = "an array (n, 3), columns x, y and z, a laspy or PDAL record, a GeoDataFrame of points, or paths"
#: The cure for what is not GeoJSON.
_AS_LOADED = "pass GeoJSON as json.load returns it"

_LINE_KINDS = "paths, arrays (n, 3), geometries, a GeoDataFrame, GeoJSON, or Contours"

PathLike = Union[str, "os.PathLike[str]"]

#: The numbers of the kinds of shapes.
_LINES, _POLYGON = 1, 2


def is_path(value: Any) -> bool:
    """Return True for a path, as text or as an object."""
    return isinstance(value, (str, os.PathLike))


def as_sequence(value: Any) -> "list[Any]":
    """Return a list of one or many things that are paths, arrays or objects."""
    if value is None:
        return []
    return list(value) if isinstance(value, (list, tuple)) else [value]


def files(value: Any, parameter: str) -> "list[str]":
    """Return the files that paths and globs stand for, in order, each once."""
    found = once(file for path in as_sequence(value) for file in _matches(path, parameter))
    if not found:
        raise usage(f"{parameter} names no file", value, "pass a path, or a list of paths")
    return found


def _matches(path: Any, parameter: str) -> "list[str]":
    """Return the files that a path or a glob stands for."""
    if not is_path(path):
        raise usage(f"{parameter} takes paths", path, "pass a path, or a list of paths", ArgumentTypeError)
    text = os.fsdecode(path)
    if os.path.exists(text) or not any(sign in text for sign in "*?["):
        return [text]
    matches = sorted(glob.glob(text))
    if not matches:
        raise usage(f"{parameter}: no file matches", text, "check the pattern and the working folder")
    return matches


def once(paths: "Iterable[str]") -> "list[str]":
    """Return paths without those of files that were named before, with a warning for each: the program does so, too."""
    found: "dict[str, str]" = {}
    again = []
    for path in paths:
        file = os.path.realpath(path)
        if file in found:
            again.append(f"{path} is named twice and used once")
        else:
            found[file] = path
    warn(again)
    return list(found.values())


def path(value: Any, parameter: str) -> str:
    """Return one path as text."""
    if not is_path(value):
        raise usage(f"{parameter} is not a path", value, "pass a path", ArgumentTypeError)
    return os.fsdecode(value)


def number(value: Any, parameter: str) -> float:
    """Return a number as float."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise usage(f"{parameter} is not a number", value, "pass a number", ArgumentTypeError) from None


def optional_number(value: Any, parameter: str) -> Optional[float]:
    """Return a number as float, or None."""
    return None if value is None else number(value, parameter)


def number_or_name(value: Any, parameter: str) -> "float | str | None":
    """Return a number as float, a name as it is, or None."""
    return value if isinstance(value, str) else optional_number(value, parameter)


def name(value: Any, parameter: str) -> str:
    """Return a text that names a choice; the library refuses unknown names."""
    if not isinstance(value, str):
        raise usage(f"{parameter} is not a name", value, "pass one of the names in the documentation", ArgumentTypeError)
    return value


def _listed(values: Any, parameter: str) -> "list[Any]":
    """Return one or several values as a list."""
    try:
        return [values] if np.isscalar(values) else list(values)
    except TypeError:
        raise usage(f"{parameter} is not a list", values, "pass one value, or a list", ArgumentTypeError) from None


def whole_numbers(values: Any, parameter: str, largest: int) -> "list[int]":
    """Return one or several whole numbers from 0 to the largest as a list."""
    cure = f"pass whole numbers from 0 to {largest}"
    found = []
    for value in _listed(values, parameter):
        try:
            whole = int(value)
        except (TypeError, ValueError, OverflowError):
            raise usage(f"{parameter} has {value!r}", value, cure, ArgumentTypeError) from None
        if whole != value or not 0 <= whole <= largest:
            raise usage(f"{parameter} has {value}", value, cure)
        found.append(whole)
    return found


def _floats(values: Any, what: str) -> np.ndarray:
    """Return numbers as float64; a view if they are already. Masked if the numbers are."""
    try:
        array = _masked.as_array(values)
    except ValueError as error:  # rows of different lengths
        raise usage(f"{what} is not an array: {error}", None, "pass rows of equal length", ArgumentTypeError) from None
    if array.dtype.kind not in "fiub":
        raise usage(
            f"{what} has the type {array.dtype}", None, "convert it: numpy.asarray(a, float)", ArgumentTypeError
        )
    if isinstance(array, np.ma.MaskedArray):
        return array.astype(np.float64)
    return _aligned(array, np.float64)


def _aligned(array: np.ndarray, dtype: Any) -> np.ndarray:
    """Return an array of a type; a view, unless numbers begin at odd bytes, as in packed records."""
    return np.require(array, dtype=dtype, requirements="A")


def positions(values: Any, what: str = "positions") -> np.ndarray:
    """Return positions as an array (..., 2) of float64; a masked one is not a number, and counted in a warning."""
    array = _floats(values, what)
    if array.ndim < 1 or array.shape[-1] != 2:
        if array.size:
            raise usage(f"{what} have the shape {array.shape}, expected (n, 2)", None, "pass an array (n, 2)")
        array = array.reshape(*array.shape[:-1], 0, 2)
    if _masked.without_value(what, array) is None:
        return np.asarray(array)
    return np.ma.filled(array, np.nan)


def crs_text(crs: Any) -> Optional[str]:
    """Return a coordinate system as text: EPSG:25832, or WKT."""
    if crs is None or isinstance(crs, str):
        return crs
    if isinstance(crs, (int, np.integer)):
        return f"EPSG:{int(crs)}"
    for name in ("to_wkt", "wkt", "ExportToWkt"):  # pyproj and rasterio, others, GDAL
        found = getattr(crs, name, None)
        if found is not None:
            return str(found() if callable(found) else found) or None
    raise usage(
        "crs is not a coordinate system", crs, "pass 'EPSG:25832', a code, WKT or a pyproj.CRS", ArgumentTypeError
    )


def classes(values: Any) -> "Optional[list[int]]":
    """Return classes of points by number; names as in LAS 1.4, ranges and "all" are understood."""
    if values is None:
        return None
    several = _listed(values.split(",") if isinstance(values, str) else values, "classes")
    numbers: "list[Any]" = []
    for value in several:
        numbers.extend(_breakline.class_numbers(value) if isinstance(value, str) else [value])
    return whole_numbers(numbers, "classes", 255)


def returns(values: Any) -> "Optional[list[str]]":
    """Return the words for returns of pulses: "first", "last", "single", "all", numbers or ranges."""
    if values is None:
        return None
    several = _listed(values.split(",") if isinstance(values, str) else values, "returns")
    numbers = whole_numbers([value for value in several if not isinstance(value, str)], "returns", 255)
    return [value for value in several if isinstance(value, str)] + [str(number) for number in numbers]


def bounds(values: Any, parameter: str = "bounds") -> "Optional[list[float]]":
    """Return a box in plan as west, south, east, north."""
    if values is None:
        return None
    try:
        corners = [float(value) for value in values]
    except (TypeError, ValueError):
        corners = []
    if len(corners) != 4 or not all(np.isfinite(corners)) or corners[0] >= corners[2] or corners[1] >= corners[3]:
        raise usage(f"{parameter} is not a box", values, "pass (xmin, ymin, xmax, ymax) with xmin < xmax, ymin < ymax")
    return corners


def _columns(x: Any, y: Any, z: Any, **others: Any) -> "dict[str, Any]":
    bytewise = ("classes", "flags", "return_number", "return_count")
    found = {"scale": [1.0] * 3, "offset": [0.0] * 3, "crs": None, **dict.fromkeys(bytewise), **others}
    columns = {"x": x, "y": y, "z": z}
    columns.update({name: _bytes(found[name], name) for name in bytewise if found[name] is not None})
    for name, column in columns.items():
        if np.ndim(column) != 1:
            raise usage(f"column {name} of points has the shape {np.shape(column)}", None, "pass columns (n,)")
    lengths = [len(column) for column in columns.values()]
    if len(set(lengths)) > 1:
        raise usage("columns of points differ in length", lengths, "pass columns of equal length")
    kept = _masked.kept("points", *columns.values())
    columns = {name: np.asarray(column) if kept is None else np.asarray(column)[kept] for name, column in columns.items()}
    axes = [columns.pop(axis) for axis in "xyz"]
    return {**found, "axes": axes, "kept": kept, "masked": lengths[0] - len(axes[0]), **columns}


def _bytes(values: Any, name: str) -> Any:
    """Return whole numbers from 0 to 255 as uint8, without a copy if they are that already. Masked if they are."""
    values = _masked.as_array(values)
    if values.dtype == np.uint8:
        return values
    if values.size and (values.dtype.kind not in "biu" or values.min() < 0 or values.max() > 255):
        raise usage(f"{name} of points are whole numbers from 0 to 255", str(values.dtype), "convert the column")
    return values.astype(np.uint8)


def _of_laspy(points: Any) -> "dict[str, Any]":
    """Return the points of a laspy record: whole steps of its lattice, as they are."""
    header = getattr(points, "header", points)
    scales, offsets = getattr(points, "scales", None), getattr(points, "offsets", None)
    scales = header.scales if scales is None else scales
    offsets = header.offsets if offsets is None else offsets
    steps = [_aligned(np.asarray(axis), np.int32) for axis in (points.X, points.Y, points.Z)]
    withheld = getattr(points, "withheld", None)
    flags = None if withheld is None else np.asarray(withheld).astype(np.uint8) * np.uint8(4)
    return _columns(
        *steps,
        scale=[float(value) for value in scales],
        offset=[float(value) for value in offsets],
        classes=np.asarray(points.classification),
        flags=flags,
        return_number=getattr(points, "return_number", None),
        return_count=getattr(points, "number_of_returns", None),
        crs=_system_of_laspy(header),
    )


def _system_of_laspy(header: Any) -> Optional[str]:
    """Return the system that a laspy header states: its WKT, else by pyproj where that is installed."""
    for record in [*getattr(header, "vlrs", ()), *(getattr(header, "evlrs", None) or ())]:
        if type(record).__name__ == "WktCoordinateSystemVlr" and record.string:
            return str(record.string).rstrip("\0")
    try:
        return crs_text(header.parse_crs())
    except Exception:  # no pyproj, no such method, or keys that it does not know: then no system is known
        return None


def _of_fields(points: Any, names: "Iterable[str]") -> "dict[str, Any]":
    """Return the points of a structured array, a DataFrame or a dictionary of columns."""
    known: "dict[str, list[str]]" = {}
    for name in names:
        known.setdefault(name.lower(), []).append(name)

    def column(*spellings: str) -> Any:
        found = next((known[spelling] for spelling in spellings if spelling in known), [])
        if len(found) > 1:
            raise usage(f"the points have the columns {' and '.join(found)}", None, "leave one of them out")
        return points[found[0]] if found else None

    axes = [column(axis) for axis in "xyz"]
    if any(axis is None for axis in axes):
        raise usage("the points have no columns x, y and z", sorted(map(str, names)), "name the columns x, y and z")
    if all("XYZ"[k] in known["xyz"[k]] and np.asarray(axis).dtype == np.int32 for k, axis in enumerate(axes)):
        raise usage(
            "X, Y and Z of the points are whole steps, as in a LAS file, whose scale and offset are not known",
            None,
            "pass the record itself (las.points, not las.points.array); if they are coordinates, convert them to float",
        )
    axes = [_floats(axis, f"column {name}") for axis, name in zip(axes, "xyz")]
    withheld = column("withheld")  # as PDAL names it
    if withheld is not None:
        withheld = (_masked.as_array(withheld) != 0).astype(np.uint8) * np.uint8(4)
    return _columns(
        *axes,
        classes=column("classification", "class"),
        flags=withheld,
        return_number=column("returnnumber", "return_number"),  # as PDAL and laspy name them
        return_count=column("numberofreturns", "number_of_returns"),
    )


def _of_frame(frame: Any) -> "dict[str, Any]":
    """Return the points of a GeoDataFrame or a GeoSeries."""
    import shapely

    geometry = getattr(frame, "geometry", frame)
    shapes = np.asarray(geometry.values)
    if not np.isin(shapely.get_type_id(shapes), (0, 4)).all():
        raise usage("the frame has geometries other than points", None, "pass lines as breaklines")
    counts = shapely.get_num_coordinates(shapes)
    if (counts != 1).any():
        row = int(np.argmax(counts != 1))
        cure = "drop the empty ones (frame[~frame.is_empty]), and divide the others by explode()"
        raise usage(f"row {row} of the frame has {counts[row]} points, where each row is one", None, cure)
    coordinates = shapely.get_coordinates(shapes, include_z=True)
    if np.isnan(coordinates[:, 2]).any():
        raise usage("points of the frame have no height", None, "set z: geopandas.points_from_xy(x, y, z)")
    return _columns(*coordinates.T, crs=crs_text(getattr(frame, "crs", None)))


def _fields(value: Any) -> "tuple[str, ...]":
    """Return the names of the fields of a structured array."""
    return getattr(getattr(value, "dtype", None), "names", None) or ()


def _names_of(table: Any) -> "list[str]":
    """Return the names of the columns of a dictionary, a DataFrame or a pyarrow.Table."""
    names = table if isinstance(table, dict) else getattr(table, "column_names", None) or table.columns
    return [str(name) for name in names]


def _points_of(value: Any) -> "dict[str, Any]":
    if isinstance(value, Points):
        return _columns(
            value.x,
            value.y,
            value.z,
            classes=value.classification,
            flags=value.flags,
            return_number=value.return_number,
            return_count=value.number_of_returns,
            crs=value.crs,
        )
    if hasattr(value, "scales") or all(hasattr(value, name) for name in ("header", "X", "Y", "Z")):
        return _of_laspy(value)
    if hasattr(value, "geometry"):
        return _of_frame(value)
    if _fields(value):
        return _of_fields(value, _fields(value))
    if isinstance(value, dict) or hasattr(value, "columns"):
        return _of_fields(value, _names_of(value))
    array = _floats(value, "points")
    if array.ndim != 2 or array.shape[1] != 3:
        shape = tuple(array.shape)
        raise usage(f"points have the shape {shape}, expected (n, 3)", None, f"pass {_POINT_KINDS}")
    return _columns(*array.T)


def coordinates_and_rows(inputs: "list[Any]") -> "tuple[np.ndarray, np.ndarray]":
    """Return the coordinates of points in columns, (n, 3), and the row of each, counted over all inputs."""
    coordinates, rows, before = [], [], 0
    for columns in inputs:
        axes = [
            axis if axis.dtype.kind == "f" else axis * scale + offset
            for axis, scale, offset in zip(columns["axes"], columns["scale"], columns["offset"])
        ]
        coordinates.append(np.column_stack(axes))
        count = len(axes[0]) + columns["masked"]
        kept = np.arange(count) if columns["kept"] is None else np.flatnonzero(columns["kept"])
        rows.append(before + kept)
        before += count
    return np.concatenate(coordinates), np.concatenate(rows)


def name_row(error: BreaklineError, inputs: "list[Any]") -> None:
    """Name the row of an array, from 0, in an error that counts its points from 1."""
    counted = re.fullmatch(r"point (\d+)", error.location or "")
    if counted is None or len(inputs) != 1 or not isinstance(inputs[0], dict):
        return
    point, kept = int(counted[1]) - 1, inputs[0]["kept"]
    error.location = f"row {point if kept is None else np.flatnonzero(kept)[point]}"


def masked_rows(inputs: "Iterable[Any]") -> int:
    """Return how many rows of inputs of points or lines were masked."""
    return sum(item["masked"] for item in inputs if isinstance(item, dict))


def points(value: Any) -> "list[Any]":
    """Return the inputs of points: paths, or columns."""
    if is_path(value):
        return list(files(value, "points"))
    if isinstance(value, (list, tuple)) and value:
        if all(is_path(item) for item in value):
            return list(files(value, "points"))
        is_row = np.isscalar(value[0]) or np.ndim(value[0]) == 1 and not _fields(value[0])
        if not is_row and (hasattr(value[0], "dtype") or hasattr(value[0], "geometry")):
            return [_points_of(item) for item in value]
    if value is None:
        raise usage("points is None", None, f"pass {_POINT_KINDS}", ArgumentTypeError)
    if isinstance(value, (list, tuple)) and not value:
        return []  # a surface of lines alone
    return [_points_of(value)]


class _Shapes:
    """Shapes that are collected for the library."""

    def __init__(self) -> None:
        self.vertices: "list[np.ndarray]" = []
        self.parts: "list[int]" = []
        self.shapes: "list[tuple[int, int]]" = []
        self.columns: "list[tuple[str, list[float]]]" = []
        self.crs: Optional[str] = None
        self.masked = 0

    def add(self, kind: int, parts: "Sequence[np.ndarray]") -> None:
        self.vertices.extend(parts)
        self.parts.extend(len(part) for part in parts)
        self.shapes.append((kind, len(parts)))

    def add_array(self, values: Any, kind: int, parameter: str) -> None:
        array = _floats(values, parameter)
        if array.ndim != 2 or array.shape[1] not in (2, 3):
            shape = tuple(array.shape)
            raise usage(f"a line of {parameter} has the shape {shape}, expected (n, 3)", None, f"pass {_LINE_KINDS}")
        given = len(array)
        (array,) = _masked.rows(f"vertices of {parameter}", array)
        self.masked += given - len(array)
        if array.shape[1] == 2:
            array = np.column_stack([array, np.full(len(array), np.nan)])
        self.add(kind, [array])

    def add_geometry(self, geometry: Any, parameter: str) -> None:
        import shapely

        if geometry is not None and not hasattr(geometry, "geom_type"):
            raise usage(f"{parameter} has something that is no geometry", geometry, f"pass {_LINE_KINDS}", ArgumentTypeError)
        if geometry is None or geometry.is_empty:
            return self.add(_LINES, [])
        parts = list(shapely.get_parts(geometry))
        kinds = {part.geom_type for part in parts}
        if kinds <= {"LineString", "LinearRing"}:
            lines, kind = parts, _LINES
        elif kinds == {"Polygon"}:
            lines, kind = [ring for part in parts for ring in (part.exterior, *part.interiors)], _POLYGON
        else:
            raise usage(f"{parameter} takes lines and polygons", geometry.geom_type, "pass points as points")
        self.add(kind, [shapely.get_coordinates(line, include_z=True) for line in lines])

    @classmethod
    def of_frame(cls, frame: Any, parameter: str) -> "dict[str, Any]":
        """Return the shapes of a GeoDataFrame, a GeoSeries or an array of geometries."""
        shapes = cls()
        geometry = getattr(frame, "geometry", frame)
        for row, shape in enumerate(np.asarray(getattr(geometry, "values", geometry))):
            try:
                shapes.add_geometry(shape, parameter)
            except BreaklineError as error:
                error.location = f"row {row}"
                raise
        shapes.crs = crs_text(getattr(frame, "crs", None))
        for name in getattr(frame, "columns", ()):
            if getattr(frame[name].dtype, "kind", "") in "fiu" and frame[name].dtype != object:
                column = np.ma.filled(_masked.as_array(frame[name]).astype(float), np.nan)
                shapes.columns.append((str(name), column.tolist()))
        return shapes.as_dict()

    @classmethod
    def of_contours(cls, contours: Any) -> "dict[str, Any]":
        """Return contours as lines, each at its height."""
        shapes = cls()
        heights = np.repeat(contours.levels, np.diff(contours.offsets))
        vertices = np.column_stack([contours.coordinates, heights])
        for start, end in zip(contours.offsets[:-1], contours.offsets[1:]):
            shapes.add(_LINES, [vertices[start:end]])
        shapes.crs = contours.crs
        return shapes.as_dict()

    @classmethod
    def of_features(cls, collection: "dict[str, Any]", parameter: str) -> "dict[str, Any]":
        """Return the shapes of a FeatureCollection of GeoJSON, with those properties that are numbers."""
        shapes = cls()
        features = collection.get("features")
        if isinstance(features, (str, bytes, dict)) or not isinstance(features, Iterable):
            raise usage(f"{parameter}: a FeatureCollection has no list of features", features, _AS_LOADED)
        properties = []
        for row, feature in enumerate(features):
            try:
                json = _geojson(feature, parameter)
                if json is None:
                    raise usage(f"{parameter} has a feature that is none of GeoJSON", feature, _AS_LOADED)
                shapes.add_geometry(_geometry(json, parameter), parameter)
                properties.append(_member(json, "properties", parameter))
            except BreaklineError as error:
                error.location = f"feature {row}"
                raise
        for name in dict.fromkeys(name for values in properties for name in values):
            numbers = _numbers([values.get(name) for values in properties])
            if numbers is not None:
                shapes.columns.append((str(name), numbers))
        system = _member(_member(collection, "crs", parameter), "properties", parameter).get("name")
        if not isinstance(system, (str, type(None))):
            raise usage(f"{parameter}: the name of the crs is not a text", system, "such as urn:ogc:def:crs:EPSG::25832")
        shapes.crs = system
        return shapes.as_dict()

    def as_dict(self) -> "dict[str, Any]":
        vertices = np.concatenate(self.vertices) if self.vertices else np.empty((0, 3))
        names = ("parts", "shapes", "columns", "crs", "masked")
        return {"vertices": np.ascontiguousarray(vertices), **{name: getattr(self, name) for name in names}}


def _is_geometries(value: Any) -> bool:
    """Return True for an array of geometries: of shapely, or a GeometryArray."""
    dtype = getattr(value, "dtype", None)
    return (dtype == object and np.ndim(value) == 1) or getattr(dtype, "name", None) == "geometry"


def _geojson(value: Any, parameter: str) -> "Optional[dict[str, Any]]":
    """Return the GeoJSON that a value is or has; None if it has none."""
    if isinstance(value, dict) and "type" in value:
        return value
    found = getattr(value, "__geo_interface__", None)
    if found is not None and not (isinstance(found, dict) and "type" in found):
        raise usage(f"{parameter}: what __geo_interface__ returns is not GeoJSON", found, f"pass {_LINE_KINDS}")
    return found


def _member(json: "dict[str, Any]", name: str, parameter: str) -> "dict[str, Any]":
    """Return what an object of GeoJSON has under a name, which is an object; an empty one if it is null or absent."""
    found = json.get(name)
    if found is None:
        return {}
    if not isinstance(found, dict):
        raise usage(f"{parameter}: {name} of GeoJSON is not an object", found, _AS_LOADED)
    return found


def _numbers(values: "list[Any]") -> "Optional[list[float]]":
    """Return a column of properties as numbers, not a number where one is absent; None if others are among them."""
    try:
        if all(value is None or isinstance(value, (int, float)) for value in values):
            return [np.nan if value is None else float(value) for value in values]
    except OverflowError:  # a whole number that no float can be
        pass
    return None


def _geometry(json: "dict[str, Any]", parameter: str) -> Any:
    """Return the geometry of shapely for a feature or a geometry of GeoJSON; None if it has none."""
    import shapely.geometry

    geometry = json.get("geometry") if json.get("type") == "Feature" else json
    if geometry is not None and not isinstance(geometry, dict):
        raise usage(f"{parameter}: geometry of GeoJSON is not an object", geometry, _AS_LOADED)
    try:
        return None if geometry is None else shapely.geometry.shape(geometry)
    except (shapely.errors.ShapelyError, AttributeError, KeyError, TypeError, ValueError) as error:
        raise usage(f"{parameter} has no geometry of GeoJSON: {error}", json, f"pass {_LINE_KINDS}") from None


def layers(value: Any, parameter: str, rings: bool = False) -> "list[Any]":
    """Return the inputs of lines: paths, or shapes. Arrays are rings of polygons if ``rings``."""
    found: "list[Any]" = []
    loose = _Shapes()
    is_one = hasattr(value, "dtype") and np.ndim(value) == 2
    for item in [value] if is_one else as_sequence(value):
        if is_path(item):
            found.append(os.fspath(item))
        elif hasattr(item, "geometry") or _is_geometries(item):
            found.append(_Shapes.of_frame(item, parameter))
        elif hasattr(item, "geom_type"):
            loose.add_geometry(item, parameter)
        elif hasattr(item, "levels") and hasattr(item, "offsets"):
            found.append(_Shapes.of_contours(item))
        elif (json := _geojson(item, parameter)) is None:
            loose.add_array(item, _POLYGON if rings else _LINES, parameter)
        elif json["type"] == "FeatureCollection":
            found.append(_Shapes.of_features(json, parameter))
        else:
            loose.add_geometry(_geometry(json, parameter), parameter)
    if loose.shapes:
        found.append(loose.as_dict())
    return found
