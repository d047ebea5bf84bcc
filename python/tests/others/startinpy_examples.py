"""What the documentation and the tests of `startinpy` do, done with breakline. Run by hand:

    python python/tests/others/startinpy_examples.py

Nothing is fetched. `startinpy` is no drop-in's original: each of its methods is either called beside its counterpart
here, on the same points, or listed with the reason why there is none. Exit code 1 if a result differs, or a method is
in neither list.
"""

from __future__ import annotations

import importlib.metadata
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import startinpy

import breakline
from breakline import spatial

#: Methods without a counterpart, and why.
NOT_OFFERED = {
    "attributes get_attributes_schema get_vertex_attributes set_attributes_schema set_vertex_attributes": (
        "attributes are columns of the caller's arrays, which `points` follows"
    ),
    "remove is_vertex_removed collect_garbage has_garbage": "no vertex is removed in Python: build without it",
    "update_vertex_z_value vertical_exaggeration": "change heights in numpy: triangulations do not depend on them",
    "snap_tolerance": "points are merged if they are equal: round or thin the array before",
    "jump_and_walk": "searches begin near by themselves",
    "write_cityjson write_geojson": "not among the formats of `Tin.write`: `Tin.to_geopandas().to_file` writes GeoJSON",
}
#: Methods that return what an array of numpy has at once.
IN_ARRAYS = {
    "area2d_triangle area3d_triangle volume_triangle normal_triangle normal_vertex": "numpy on `points[simplices]`",
    "is_triangle is_finite get_point": "rows of `simplices` and `points`",
}


def points(count: int = 400) -> np.ndarray:
    return np.random.default_rng(5).random((count, 3)) * [100, 100, 10]


def both(at: np.ndarray) -> "tuple[startinpy.DT, spatial.Delaunay]":
    """Return the triangulations of points; vertex `k` here is `k + 1` there."""
    theirs = startinpy.DT()
    theirs.insert(at)
    return theirs, spatial.Delaunay(at[:, :2])


def rows(simplices: np.ndarray) -> set[frozenset[int]]:
    return {frozenset(simplex) for simplex in np.asarray(simplices).tolist()}


def triangles() -> None:
    theirs, tri = both(points())
    assert rows(np.asarray(theirs.triangles, int) - 1) == rows(tri.simplices)
    assert theirs.number_of_triangles() == tri.nsimplex and theirs.number_of_vertices() == tri.npoints
    assert np.array_equal(theirs.points[1:, :2], tri.points)


def hull() -> None:
    theirs, tri = both(points())
    corners = spatial.ConvexHull(tri.points).vertices
    expected = np.asarray(theirs.convex_hull(), int) - 1
    start = expected.tolist().index(corners[0])
    assert np.roll(expected, -start).tolist() == corners.tolist()
    inside = np.asarray([theirs.is_vertex_convex_hull(k + 1) for k in range(tri.npoints)])
    assert np.array_equal(np.flatnonzero(inside), np.unique(tri.convex_hull))
    for position in [[50.0, 50.0], [-7.1, 2.1]]:
        assert theirs.is_inside_convex_hull(position) == (tri.find_simplex(position) >= 0)


def box() -> None:
    theirs, tri = both(points())
    assert np.array_equal(theirs.get_bbox(), np.concatenate([tri.min_bound, tri.max_bound]))


def around() -> None:
    theirs, tri = both(points())
    starts, neighbors = tri.vertex_neighbor_vertices
    for k in range(tri.npoints):
        finite = {int(v) - 1 for v in theirs.adjacent_vertices_to_vertex(k + 1)} - {-1}
        assert finite == set(neighbors[starts[k] : starts[k + 1]].tolist())
        incident = [t for t in theirs.incident_triangles_to_vertex(k + 1) if theirs.is_finite(t)]
        assert rows(np.asarray(incident, int) - 1) == rows(tri.simplices[(tri.simplices == k).any(axis=1)])
    for simplex, beyond in zip(tri.simplices[:50], tri.neighbors):
        adjacent = theirs.adjacent_triangles_to_triangle((simplex + 1).tolist())
        finite = [t for t in adjacent if theirs.is_finite(t)]
        assert rows(np.asarray(finite, int).reshape(-1, 3) - 1) == rows(tri.simplices[beyond[beyond >= 0]])


def searches() -> None:
    theirs, tri = both(points())
    nearest = spatial.NearestNDInterpolator(tri.points, np.arange(tri.npoints))
    for position in 20 + 60 * np.random.default_rng(1).random((100, 2)):
        assert {int(v) - 1 for v in theirs.locate(position)} == set(tri.simplices[tri.find_simplex(position)].tolist())
        assert theirs.closest_point(position) - 1 == nearest(position)


def interpolators() -> None:
    at = points()
    theirs, tri = both(at)
    positions = np.vstack([20 + 60 * np.random.default_rng(2).random((200, 2)), [[144.0, 48.0]], at[:5, :2]])
    methods = {
        "TIN": spatial.LinearNDInterpolator(tri, at[:, 2]),
        "NNI": spatial.NaturalNeighborInterpolator(tri, at[:, 2]),
    }
    for method, ours in methods.items():
        expected = theirs.interpolate({"method": method}, positions)
        assert np.allclose(ours(positions), expected, rtol=1e-6, equal_nan=True), method
    laplace = breakline.tin(at).elevation(positions, method="laplace")
    assert np.allclose(laplace, theirs.interpolate({"method": "Laplace"}, positions), rtol=1e-6, equal_nan=True)
    inside = positions[tri.find_simplex(positions) >= 0]
    nearest = spatial.NearestNDInterpolator(tri, at[:, 2])(inside)
    assert np.array_equal(theirs.interpolate({"method": "NN"}, inside), nearest)


def duplicates() -> None:
    twice = np.array([[0, 0, 1], [10, 0, 2], [10, 10, 3], [0, 10, 4], [5, 5, 10], [5, 5, 20]], float)
    for theirs_rule, rule in {"First": "first", "Last": "last", "Lowest": "lowest", "Highest": "highest"}.items():
        theirs = startinpy.DT()
        theirs.duplicates_handling = theirs_rule
        theirs.insert(twice)
        tin = breakline.tin(twice, duplicates=rule)
        assert theirs.get_point(5)[2] == tin.elevation([5.0, 5.0]), rule


def one_by_one() -> None:
    at = points(60)
    theirs = startinpy.DT()
    tri = spatial.Delaunay(at[:20, :2], incremental=True)
    theirs.insert(at[:20])
    for point in at[20:]:
        theirs.insert_one_pt(point)
        tri.add_points(point[None, :2])
    assert rows(np.asarray(theirs.triangles, int) - 1) == rows(tri.simplices)


def files() -> None:
    at = points()
    theirs, _ = both(at)
    with tempfile.TemporaryDirectory() as folder:
        theirs.write_obj(str(Path(folder, "theirs.obj")))
        theirs.write_ply(str(Path(folder, "theirs.ply")))
        tin = breakline.tin(at)
        for extension in ("obj", "ply"):
            tin.write(Path(folder, f"ours.{extension}"))
            assert Path(folder, f"ours.{extension}").stat().st_size > 0
        lines = [Path(folder, f"{name}.obj").read_text().splitlines() for name in ("theirs", "ours")]
        faces = [sum(line.startswith("f ") for line in text) for text in lines]
        assert faces[0] == faces[1] == len(tin.triangles)


#: What is compared, and the methods that it needs there.
EXAMPLES: "list[tuple[Callable[[], None], str]]" = [
    (triangles, "insert triangles points number_of_triangles number_of_vertices"),
    (hull, "convex_hull is_vertex_convex_hull is_inside_convex_hull"),
    (box, "get_bbox"),
    (around, "adjacent_vertices_to_vertex incident_triangles_to_vertex adjacent_triangles_to_triangle"),
    (searches, "locate closest_point"),
    (interpolators, "interpolate"),
    (duplicates, "duplicates_handling"),
    (one_by_one, "insert_one_pt"),
    (files, "write_obj write_ply"),
]


def main() -> int:
    print(f"startinpy {importlib.metadata.version('startinpy')}, breakline {breakline.__version__}")
    failed = 0
    listed: set[str] = set()
    for example, methods in EXAMPLES:
        listed |= set(methods.split())
        try:
            example()
            outcome = "passes"
        except Exception as error:  # whatever either raises
            failed += 1
            outcome = f"FAILED: {type(error).__name__}: {error}"
        print(f"{example.__name__:14} {outcome} ({methods})")
    for title, methods in (("in arrays", IN_ARRAYS), ("not offered", NOT_OFFERED)):
        for names, reason in methods.items():
            listed |= set(names.split())
            print(f"{title}: {names}: {reason}")
    print("not offered: interpolate with IDW within a radius: Tin.elevation(method='idw') uses the 12 nearest vertices")
    missing = {name for name in dir(startinpy.DT) if not name.startswith("_")} - listed
    if missing:
        print(f"FAILED: in no list: {' '.join(sorted(missing))}")
    return min(failed + len(missing), 1)


if __name__ == "__main__":
    sys.exit(main())
