"""A drop-in for the package `triangle`: the same dict, the same switches, no process that exits.

>>> from breakline import triangle
>>> square = {"vertices": [[0, 0], [0, 1], [1, 1], [1, 0]]}
>>> len(triangle.triangulate(square)["triangles"])
2

What differs is listed in ``docs/python-drop-ins.md``.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _masked
from ._breakline import TriangleSwitches, triangulate_arrays
from ._call import call
from ._errors import ArgumentTypeError, BreaklineWarning, FormatError, LimitError, UnsupportedError, UsageError, usage

__all__ = ["convex_hull", "delaunay", "triangulate"]

#: A switch with its number.
_SWITCH = re.compile(r"([A-Za-z])(\d+\.?\d*|\.\d+)?")

#: Switches without a number that are obeyed.
_OBEYED = frozenset("pqaAcenjBPNEOS")

#: Switches that change nothing here, with the reason.
_HARMLESS = {
    "C": "results are correct by construction; the tests of breakline check them",
    "F": "one algorithm",
    "Q": "nothing is printed",
    "V": "nothing is printed",
    "X": "predicates are always exact",
    "i": "one algorithm",
    "l": "one algorithm",
    "v": "triangulate() of the package returns no Voronoi diagram either",
    "z": "numbers begin at 0",
}

#: Switches that raise, with the reason.
_ABSENT = {
    "D": "meshes are constrained Delaunay; Delaunay as a whole exists in Rust only (ConstrainedDelaunay::conformed)",
    "I": "it is about files",
    "Y": "no rule forbids vertices on the boundary",
    "g": "it is about files",
    "h": "it prints a page of help",
    "o": "elements of higher order do not exist",
    "r": "an earlier mesh cannot be refined: triangulate its vertices and segments again, with p and the new bounds",
    "s": "segments are never split merely to recover them",
    "u": "there is no user-defined constraint on triangles",
}

#: Switches that leave an array out.
_DROPPED = (
    ("N", "vertices"),
    ("N", "vertex_markers"),
    ("N", "vertex_attributes"),
    ("E", "triangles"),
    ("E", "triangle_attributes"),
    ("P", "segments"),
    ("P", "segment_markers"),
)

#: Keys of the dict.
_KEYS = frozenset(
    "vertices vertex_attributes vertex_markers triangles triangle_max_area triangle_attributes segments"
    " segment_markers holes regions neighbors edges edge_markers".split()
)

#: What `_drop_unused` needs, also where switches leave it out of the result.
_NUMBERED = frozenset({"vertices", "triangles"})

#: The smallest angle of the switch q without a number, in degrees.
_ANGLE = 20.0


def __getattr__(name: str) -> NoReturn:
    absent = {
        "compare": "plot with matplotlib",
        "get_data": "use triangle.get_data",
        "loads": "use breakline.triangulate, which reads Triangle's files",
        "plot": "plot with matplotlib",
        "show_data": "use triangle.show_data",
        "voronoi": "use the Rust crate breakline-triangulation (voronoi_cell), or triangle.voronoi",
    }
    if name in absent:
        raise AttributeError(f"breakline.triangle has no {name}: {absent[name]}")
    raise AttributeError(f"module 'breakline.triangle' has no attribute {name!r}")


class UnknownKeyError(UsageError, KeyError):
    """The dict has a key that the package `triangle` does not have."""

    __str__ = UsageError.__str__


def triangulate(tri: Mapping[str, Any], opts: str = "", *, threads: int | None = None) -> dict[str, NDArray[Any]]:
    """Triangulate points and segments.

    Parameters
    ----------
    tri : dict
        The input, by the names of the package `triangle`:

        ``vertices`` : (n, 2) floats. Positions.
        ``vertex_attributes`` : (n, k) floats, optional. Those of added vertices are interpolated
        linearly in the triangulation without them.
        ``vertex_markers`` : (n,) or (n, 1) ints, optional.
        ``segments`` : (m, 2) ints, optional. Ends of segments; used with ``p``.
        ``segment_markers`` : (m,) or (m, 1) ints, optional.
        ``holes`` : (h, 2) floats, optional. A site in each hole; used with ``p``.
        ``regions`` : (r, 4) floats, optional. A site, an attribute (used with ``A``) and a largest
        area (used with ``a`` without a number) of each region.

        Other keys of the package are accepted, and ignored. Masked rows are left out, and counted
        in warnings; numbers count the vertices that remain, and segments to others are left out.
    opts : str, optional
        Switches of Triangle:

        ``p`` : use segments, holes and regions.
        ``q``, ``q30`` : add vertices until no angle is smaller than 20 degrees, or than this.
        ``a0.5``, ``a`` : add vertices until no triangle is larger than this, or than the area of
        its region.
        ``A`` : return the attributes of regions.
        ``c`` : keep the convex hull.
        ``e``, ``n`` : return edges, neighbors.
        ``S100`` : add at most so many vertices.
        ``j`` : drop vertices that are in no triangle.
        ``O`` : ignore holes.
        ``B``, ``P``, ``N``, ``E`` : return no markers, segments, vertices, triangles.
        ``z Q V X C i F l v`` : accepted; they change nothing.

        All others raise, with the reason.
    threads : int, optional
        The number of threads; all processors by default. The result does not depend on it.

    Returns
    -------
    dict
        ``vertices`` (float64), ``vertex_markers``, ``triangles`` (int32), and what the switches and
        the input ask for: ``vertex_attributes``, ``triangle_attributes`` (float64), ``neighbors``,
        ``edges``, ``edge_markers``, ``segments``, ``segment_markers`` (int32), ``holes``,
        ``regions``.

    Raises
    ------
    UsageError
        If there are less than three vertices, a shape is wrong, a segment names a vertex that does
        not exist, or a coordinate is not finite; a `ValueError`.
    ArgumentTypeError
        If a dtype does not fit; a `TypeError`.
    UnknownKeyError
        If the dict has an unknown key; a `KeyError`.
    UnsupportedError
        If a switch does not exist here; a `NotImplementedError` whose message has the reason.
    FormatError
        If no triangle is left, because the outer boundary is open.
    LimitError
        If a million added vertices do not reach the bounds.

    Warns
    -----
    BreaklineWarning
        If some triangles are not as ``q`` and ``a`` require: at small angles between segments, or
        because ``S`` ended the refinement.

    Notes
    -----
    O(n log n) for n vertices and segments; refinement in time proportional to its result. Where
    segments cross, a vertex is added.

    Examples
    --------
    >>> from breakline.triangle import triangulate
    >>> square = {"vertices": [[0, 0], [0, 1], [1, 1], [1, 0]]}
    >>> mesh = triangulate(square, "qa0.1")
    >>> len(mesh["triangles"]) >= 10
    True
    """
    switches, read = _read(opts)
    if not _KEYS.issuperset(tri):
        unknown = ", ".join(sorted(set(tri) - _KEYS))
        raise usage(f"unknown keys {unknown}", cure=f"known are {', '.join(sorted(_KEYS))}", kind=UnknownKeyError)
    try:
        with call(threads, None) as checked:
            made = triangulate_arrays(tri, read, checked)
            if made is None:
                # Lists, other types, masked rows; or something is wrong, and this raises.
                made = triangulate_arrays(_graph(tri, switches), read, checked)
    except FormatError as error:
        error.cure = "close the outer boundary with segments, or add the switch c to keep the convex hull"
        raise
    except LimitError as error:
        error.cure = "use a smaller angle or a larger area, or end the refinement by the switch S"
        raise
    arrays, short = made
    if short:
        warnings.warn(
            f"{short} triangles are not as {opts!r} requires: at small angles between segments, or because the limit"
            " of added vertices was reached",
            BreaklineWarning,
            stacklevel=2,
        )
    if "j" in switches:
        _drop_unused(arrays)
        for name in _NUMBERED - set(_wanted(switches)):
            del arrays[name]
    return arrays


def delaunay(pts: ArrayLike) -> NDArray[np.int32]:
    """Return the triangles of a Delaunay triangulation of points, as an (m, 3) array of int32.

    Examples
    --------
    >>> from breakline import triangle
    >>> triangle.delaunay([[0, 0], [4, 0], [0, 4]]).shape
    (1, 3)
    """
    return triangulate({"vertices": pts})["triangles"]


def convex_hull(pts: ArrayLike) -> NDArray[np.int32]:
    """Return the edges of the convex hull of points, as a (k, 2) array of int32.

    Examples
    --------
    >>> from breakline import triangle
    >>> triangle.convex_hull([[0, 0], [4, 0], [0, 4], [1, 1]]).shape
    (3, 2)
    """
    return triangulate({"vertices": pts}, "c")["segments"]


def _unsupported(message: str) -> UnsupportedError:
    error = UnsupportedError(message)
    error.message, error.cure = message, "leave the switch out"
    return error


@lru_cache(maxsize=64)
def _read(opts: str) -> tuple[Mapping[str, Any], TriangleSwitches]:
    """Return the switches that are obeyed, also as `triangulate_arrays` takes them."""
    switches = _switches(opts)
    wanted = _wanted(switches)
    read = {
        "lines": "p" in switches,
        "convex": "c" in switches or "p" not in switches,
        "min_angle": switches.get("q"),
        "max_area": switches.get("a"),
        "region_areas": "a" in switches and switches["a"] is None,
        "max_added": switches.get("S"),
        "ignore_holes": "O" in switches,
        "return_given": "p" in switches and "P" not in switches,
        "names": list(dict.fromkeys([*wanted, *_NUMBERED])) if "j" in switches else wanted,
    }
    return switches, TriangleSwitches(read)


def _switches(opts: str) -> Mapping[str, Any]:
    """Return the switches that are obeyed, with their numbers or None."""
    switches: dict[str, Any] = {}
    position = 0
    while position < len(opts):
        match = _SWITCH.match(opts, position)
        if match is None:
            raise usage(f"switches {opts!r}: {opts[position]!r} at position {position} is not a letter")
        letter, number = match.groups()
        if letter in _ABSENT:
            raise _unsupported(f"switch {letter!r} of {opts!r}: {_ABSENT[letter]}")
        if letter not in _OBEYED and letter not in _HARMLESS:
            raise usage(f"switches {opts!r}: {letter!r} is no switch of Triangle")
        if number is not None and letter not in "qaS":
            raise usage(f"switches {opts!r}: {letter!r} takes no number")
        if letter == "q":
            switches[letter] = _ANGLE if number is None else float(number)
        elif letter == "S":
            switches[letter] = 0 if number is None else int(float(number))
        elif letter == "a":
            switches[letter] = None if number is None else float(number)
            if switches[letter] == 0:
                raise usage(f"switches {opts!r}: the largest area is 0, expected more")
        elif letter in _OBEYED:
            switches[letter] = None
        position = match.end()
    return switches


def _graph(tri: Mapping[str, Any], switches: Mapping[str, Any]) -> dict[str, NDArray[Any]]:
    """Return the arrays of the input that the switches use, as `triangulate_arrays` reads them."""
    lines = tri if "p" in switches else {}
    vertices = _floats(tri, "vertices", 2)
    count = len(vertices)
    attributes = _attributes(tri, count)
    markers = _markers(tri, "vertex_markers", count)
    kept = _masked.kept("vertices", vertices, attributes, markers)
    vertices, attributes, markers = _finite(vertices, "vertices"), np.asarray(attributes), np.asarray(markers)
    segments, segment_markers = _segments(lines, count)
    if kept is not None:
        vertices, attributes, markers = vertices[kept], attributes[kept], markers[kept]
        remain = kept[segments].all(axis=1)
        segments, segment_markers = (np.cumsum(kept) - 1)[segments[remain]], segment_markers[remain]
    if len(vertices) < 3:
        raise usage(f"{len(vertices)} vertices, expected at least three")
    graph = {
        "vertices": vertices,
        "vertex_attributes": attributes,
        "vertex_markers": markers,
        "segments": segments.astype(np.int64, copy=False),
        "segment_markers": segment_markers,
    }
    return graph | {name: _rows(lines, name, width) for name, width in (("holes", 2), ("regions", 4)) if name in lines}


def _attributes(tri: Mapping[str, Any], count: int) -> NDArray[np.float64]:
    """Return the attributes of so many vertices."""
    if "vertex_attributes" not in tri:
        return np.empty((count, 0))
    attributes = _masked.as_array(tri["vertex_attributes"]).astype(np.float64, copy=False)
    if len(attributes) != count:
        raise usage(f"{len(attributes)} vertex_attributes, expected one row for each of {count} vertices")
    return attributes


def _segments(lines: Mapping[str, Any], count: int) -> tuple[NDArray[Any], NDArray[np.int32]]:
    """Return the segments between so many vertices, and their markers."""
    if "segments" not in lines and "segment_markers" not in lines:
        return np.empty((0, 2), np.int64), np.empty(0, np.int32)
    segments = _integers(lines, "segments")
    if segments.ndim != 2 or segments.shape[1] != 2:
        raise usage(f"segments of shape {segments.shape}, expected (m, 2)")
    markers = _markers(lines, "segment_markers", len(segments))
    segments, markers = _masked.rows("segments", segments, markers)
    # One comparison for all, as long as none is wrong.
    if segments.size and not 0 <= segments.min() <= segments.max() < count:
        outside = (segments < 0) | (segments >= count)
        row = int(np.nonzero(outside.any(axis=1))[0][0])
        raise usage(f"segment {row} joins vertices {segments[row].tolist()}, expected 0 to {count - 1}")
    return segments, markers


def _rows(tri: Mapping[str, Any], key: str, width: int) -> NDArray[np.float64]:
    """Return rows of finite numbers, without those that are masked."""
    if key not in tri:
        return np.empty((0, width))
    (rows,) = _masked.rows(key, _floats(tri, key, width))
    return _finite(rows, key)


def _floats(tri: Mapping[str, Any], key: str, width: int) -> NDArray[np.float64]:
    """Return rows of numbers, masked if they are."""
    values = _masked.as_array(tri.get(key, ()))
    if values.size == 0:
        return np.empty((0, width))
    if values.dtype.kind not in "biuf":
        raise usage(f"{key} of dtype {values.dtype}, expected real numbers", kind=ArgumentTypeError)
    if values.ndim != 2 or values.shape[1] != width:
        raise usage(f"{key} of shape {values.shape}, expected (n, {width})")
    return values.astype(np.float64)


def _finite(values: NDArray[np.float64], key: str) -> NDArray[np.float64]:
    """Return rows as a plain array; what is masked may be any number, the others are finite."""
    plain = np.asarray(values)
    # `all()` takes more than twice as long, which matters for four vertices.
    if np.logical_and.reduce(np.isfinite(plain), axis=None):
        return plain
    wrong = ~(np.isfinite(plain) | np.ma.getmaskarray(values)).all(axis=1)
    if wrong.any():
        row = int(np.nonzero(wrong)[0][0])
        raise usage(f"row {row} of {key} is {plain[row].tolist()}, expected finite numbers")
    return plain


def _integers(tri: Mapping[str, Any], key: str) -> NDArray[Any]:
    values = _masked.as_array(tri.get(key, ()))
    if values.size == 0:
        return np.empty((0, 2), np.int64)
    if values.dtype.kind not in "iu":
        raise usage(f"{key} of dtype {values.dtype}, expected integers", kind=ArgumentTypeError)
    return values


def _markers(tri: Mapping[str, Any], key: str, count: int) -> NDArray[np.int32]:
    if key not in tri:
        return np.zeros(count, np.int32)
    values = _masked.as_array(tri.get(key, ()))
    if values.size == 0:
        return np.zeros(count, np.int32)
    if values.dtype.kind not in "iu":
        raise usage(f"{key} of dtype {values.dtype}, expected integers", kind=ArgumentTypeError)
    if values.size != count:
        raise usage(f"{key} of shape {values.shape}, expected one for each of {count}")
    return values.reshape(count).astype(np.int32)


def _wanted(switches: Mapping[str, Any]) -> list[str]:
    """Return the names of the arrays that the switches ask for, as if vertices and regions had attributes."""
    wanted = ["vertices", "vertex_markers", "triangles", "vertex_attributes"]
    if "A" in switches:
        wanted.append("triangle_attributes")
    if "n" in switches:
        wanted.append("neighbors")
    if "p" in switches or "c" in switches:
        wanted += ["segments", "segment_markers"]
    if "e" in switches:
        wanted += ["edges", "edge_markers"]
    if "B" in switches:
        wanted = [name for name in wanted if not name.endswith("_markers")]
    for switch, dropped in _DROPPED:
        if switch in switches and dropped in wanted:
            wanted.remove(dropped)
    return wanted


def _drop_unused(arrays: dict[str, NDArray[Any]]) -> None:
    """Remove vertices that are in no triangle, and number the others anew."""
    used = np.zeros(len(arrays["vertices"]), bool)
    used[arrays["triangles"].ravel()] = True
    numbers = (np.cumsum(used) - 1).astype(np.int32)
    for name in {"vertices", "vertex_markers", "vertex_attributes"} & arrays.keys():
        arrays[name] = arrays[name][used]
    for name in {"triangles", "segments", "edges"} & arrays.keys():
        arrays[name] = numbers[arrays[name]]
