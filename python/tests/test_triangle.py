"""`breakline.triangle` against the package `triangle`."""

import numpy as np
import pytest
from conftest import judge

from breakline import triangle as ours
from breakline._errors import ArgumentTypeError, BreaklineWarning, FormatError, UnsupportedError, UsageError


@pytest.fixture
def theirs():
    return judge("triangle")


SQUARE = {"vertices": np.array([[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [2, 1], [2, 2], [1, 2], [3, 3.5]])}
#: A square with a square hole, and a vertex between them.
PLATE = {
    "vertices": SQUARE["vertices"],
    "segments": [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]],
    "holes": [[1.5, 1.5]],
}
RANDOM = {"vertices": np.random.default_rng(0).random((500, 2))}


def areas(mesh):
    a, b, c = (mesh["vertices"][mesh["triangles"][:, k]] for k in range(3))
    u, v = b - a, c - a
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def angles(mesh):
    corners = mesh["vertices"][mesh["triangles"]]
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    a, b, c = sides.T
    cosines = [(b * b + c * c - a * a) / (2 * b * c), (a * a + c * c - b * b) / (2 * a * c)]
    first, second = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
    return np.stack([first, second, 180 - first - second])


def sets_of(rows):
    return {frozenset(row) for row in rows.tolist()}


def marked(edges, markers):
    return {(frozenset(edge), int(marker)) for edge, marker in zip(edges.tolist(), markers.ravel())}


@pytest.mark.parametrize(
    "graph, opts",
    [(RANDOM, opts) for opts in ("", "n", "e", "en", "c", "z", "Q", "B", "cB", "eB", "N", "E", "P", "i", "F", "v")]
    + [(PLATE, opts) for opts in ("", "p", "pc", "pen", "pO", "pB", "pP", "pN", "pE", "pj", "pjen", "pA")],
)
def test_the_same_arrays_as_the_package(theirs, graph, opts):
    mine, expected = ours.triangulate(graph, opts), theirs.triangulate(graph, opts)
    assert set(mine) == set(expected)
    for name, array in mine.items():
        assert (array.shape, array.dtype) == (expected[name].shape, expected[name].dtype), name
    for name in ("vertices", "vertex_markers", "holes"):
        if name in mine:
            assert (mine[name] == expected[name]).all()
    # The same up to the order of rows, and to the choice of diagonals in the plate, which has ties.
    if graph is RANDOM:
        for name in ("triangles", "edges", "segments"):
            if name in mine:
                assert sets_of(mine[name]) == sets_of(expected[name]), name
        if "edge_markers" in mine:
            pairs = [marked(mesh["edges"], mesh["edge_markers"]) for mesh in (mine, expected)]
            assert pairs[0] == pairs[1]
    if "segments" in mine and "segment_markers" in mine:
        pairs = [marked(mesh["segments"], mesh["segment_markers"]) for mesh in (mine, expected)]
        assert pairs[0] == pairs[1]
    if "triangles" in mine and "vertices" in mine:
        assert (areas(mine) > 0).all() and np.isclose(areas(mine).sum(), areas(expected).sum())
    if "neighbors" in mine:
        triangles, neighbors = mine["triangles"], mine["neighbors"]
        for k in range(3):
            has = neighbors[:, k] >= 0
            shared = np.delete(triangles, k, axis=1)
            assert all(set(s) <= set(t) for s, t in zip(shared[has].tolist(), triangles[neighbors[has, k]].tolist()))


def test_markers_and_attributes(theirs):
    graph = dict(
        PLATE,
        vertex_attributes=np.arange(18.0).reshape(9, 2),
        vertex_markers=np.arange(9).reshape(9, 1),
        segment_markers=np.arange(8) + 3,
    )
    for opts in ("", "p", "pe"):
        mine, expected = ours.triangulate(graph, opts), theirs.triangulate(graph, opts)
        assert set(mine) == set(expected)
        assert (mine["vertex_attributes"] == expected["vertex_attributes"]).all()
        assert (mine["vertex_markers"] == expected["vertex_markers"]).all()
        if "segments" in mine:
            pairs = [marked(mesh["segments"], mesh["segment_markers"]) for mesh in (mine, expected)]
            assert pairs[0] == pairs[1]


def test_regions(theirs):
    graph = dict(PLATE, regions=[[3, 3, 7, 0.05]])
    mine, expected = ours.triangulate(graph, "pA"), theirs.triangulate(graph, "pA")
    assert (mine["triangle_attributes"] == 7).all() and (expected["triangle_attributes"] == 7).all()
    assert (mine["regions"] == expected["regions"]).all()
    fine = ours.triangulate(graph, "pa")
    assert areas(fine).max() <= 0.05 and np.isclose(areas(fine).sum(), 15)


@pytest.mark.parametrize("opts, angle, area", [("pq", 20, 99), ("pq30", 30, 99), ("pqa0.1", 20, 0.1), ("pa.25", 0, 0.25)])
def test_quality(theirs, opts, angle, area):
    mine, expected = ours.triangulate(PLATE, opts), theirs.triangulate(PLATE, opts)
    assert angles(mine).min() >= angle - 1e-9 and areas(mine).max() <= area
    assert np.isclose(areas(mine).sum(), 15) and (mine["vertices"][:9] == PLATE["vertices"]).all()
    assert len(mine["triangles"]) <= 1.25 * len(expected["triangles"]) + 10


def test_quality_without_segments():
    mesh = ours.triangulate(SQUARE, "qa0.2")
    assert areas(mesh).max() <= 0.2 and np.isclose(areas(mesh).sum(), 16) and angles(mesh).min() >= 20


def test_a_limit_of_added_vertices_warns():
    with pytest.warns(BreaklineWarning, match="not as 'pq30a0.01S5' requires"):
        mesh = ours.triangulate(PLATE, "pq30a0.01S5")
    assert len(mesh["vertices"]) <= 9 + 5


def test_segments_that_cross(theirs):
    cross = {"vertices": [[0, 0], [1, 0], [0, 1], [1, 1]], "segments": [[0, 3], [1, 2]]}
    mine, expected = ours.triangulate(cross, "pc"), theirs.triangulate(cross, "pc")
    assert mine["vertices"].tolist() == expected["vertices"].tolist()
    assert sets_of(mine["triangles"]) == sets_of(expected["triangles"])
    with pytest.raises(FormatError) as caught:
        ours.triangulate(cross, "p")
    assert "switch c" in caught.value.cure


def test_equal_vertices():
    graph = {"vertices": [[0, 0], [1, 0], [0, 1], [0, 1], [0.0, -0.0]]}
    mesh = ours.triangulate(graph)
    assert mesh["triangles"].shape == (1, 3) and len(mesh["vertices"]) == 5
    assert len(ours.triangulate(graph, "j")["vertices"]) == 3


def test_collinear_vertices_have_no_triangles():
    """The package ends the process."""
    mesh = ours.triangulate({"vertices": [[0, 0], [1, 0], [2, 0]]}, "ne")
    assert mesh["triangles"].shape == mesh["neighbors"].shape == (0, 3)


def test_the_other_functions(theirs):
    points = RANDOM["vertices"]
    assert sets_of(ours.delaunay(points)) == sets_of(theirs.delaunay(points))
    assert sets_of(ours.convex_hull(points)) == sets_of(theirs.convex_hull(points))
    with pytest.raises(AttributeError, match="voronoi"):
        ours.voronoi


@pytest.mark.parametrize("threads", [1, 2])
def test_threads_do_not_change_the_result(threads):
    graph = {"vertices": np.random.default_rng(1).random((20000, 2))}
    expected = ours.triangulate(graph, "ne")
    mesh = ours.triangulate(graph, "ne", threads=threads)
    assert all((mesh[name] == expected[name]).all() for name in expected)


@pytest.mark.parametrize(
    "graph, opts, error, text",
    [
        ({}, "", UsageError, "0 vertices"),
        ({"vertices": np.zeros((0, 2))}, "", UsageError, "0 vertices"),
        ({"vertices": [[0, 0], [1, 1]]}, "", UsageError, "2 vertices"),
        ({"vertices": [[0, 0], [1, 0], [0, 1]], "foo": 1}, "", KeyError, "foo"),
        ({"vertices": [[0, 0, 1], [1, 0, 1], [0, 1, 1]]}, "", UsageError, "shape"),
        ({"vertices": [[0, 0], [1, 0], [0, np.nan]]}, "", UsageError, "row 2 of vertices"),
        ({"vertices": [["a", "b"]] * 3}, "", ArgumentTypeError, "dtype"),
        ({"vertices": np.ma.masked_all((3, 2))}, "", UsageError, "masked"),
        (dict(SQUARE, segments=[[0, 9]]), "p", UsageError, "segment 0 joins"),
        (dict(SQUARE, segments=[[0, 1], [-1, 2]]), "p", UsageError, "segment 1 joins"),
        (dict(SQUARE, segments=[[0, 1, 2]]), "p", UsageError, "shape"),
        (dict(SQUARE, segments=[[0.5, 1]]), "p", ArgumentTypeError, "integers"),
        (dict(PLATE, segment_markers=[1, 2]), "p", UsageError, "segment_markers"),
        (dict(PLATE, holes=[[1.0, 2.0, 3.0]]), "p", UsageError, "holes"),
        (dict(SQUARE, vertex_attributes=[1.0]), "", UsageError, "vertex_attributes"),
        (dict(SQUARE, vertex_markers=[1]), "", UsageError, "vertex_markers"),
        (SQUARE, "D", UnsupportedError, "Delaunay"),
        (SQUARE, "r", UnsupportedError, "earlier mesh"),
        (SQUARE, "s", UnsupportedError, "split"),
        (SQUARE, "o2", UnsupportedError, "higher order"),
        (SQUARE, "k", UsageError, "no switch"),
        (SQUARE, "p3", UsageError, "takes no number"),
        (SQUARE, "p-", UsageError, "not a letter"),
        (SQUARE, "a0", UsageError, "largest area"),
    ],
)
def test_what_cannot_be_triangulated(graph, opts, error, text):
    with pytest.raises(error, match=text):
        ours.triangulate(graph, opts)


def test_segments_are_ignored_without_the_switch():
    assert len(ours.triangulate(dict(SQUARE, segments=[[0, 99]]))["triangles"]) == 12


def test_arrays_of_any_layout():
    points = RANDOM["vertices"]
    expected = ours.triangulate(RANDOM)["triangles"]
    read_only = points.copy()
    read_only.flags.writeable = False
    strided = np.zeros((1000, 4))
    strided[::2, ::2] = points
    for same in (read_only, strided[::2, ::2], np.asfortranarray(points), points.tolist(), points.astype(">f8")):
        assert (ours.triangulate({"vertices": same})["triangles"] == expected).all()


def test_lists_and_arrays_have_the_same_result():
    """Arrays of the types that the package returns are read at once, all others one by one."""
    graph = dict(
        PLATE,
        vertex_attributes=np.arange(18.0).reshape(9, 2),
        vertex_markers=np.arange(9),
        segment_markers=np.arange(8) + 3,
        regions=[[3, 3, 7, 0.05]],
    )
    for integer in (np.int32, np.int64):
        arrays = {name: np.array(values, float) for name, values in graph.items()}
        arrays["segments"] = arrays["segments"].astype(integer)
        for name in ("vertex_markers", "segment_markers"):
            arrays[name] = arrays[name].astype(np.int32).reshape(-1, 1)
        bytes_of_others = np.zeros(8 * 18 + 1, np.uint8)
        unaligned = np.ndarray((9, 2), float, bytes_of_others.data, 1)
        unaligned[:] = arrays["vertices"]
        assert not unaligned.flags.aligned
        for opts in ("", "e", "p", "pAe", "pq30Aa", "pO", "pP", "pBE", "pNj", "pj", "pA", "pqO", "jc"):
            expected = ours.triangulate(graph, opts)
            for same in (arrays, arrays | {"vertices": unaligned}, dict(arrays, triangles=None)):
                mesh = ours.triangulate(same, opts)
                assert list(mesh) == list(expected)
                for name, array in mesh.items():
                    assert np.array_equal(array, expected[name]) and array.dtype == expected[name].dtype


@pytest.mark.parametrize(
    "wrong, text",
    [
        ({"vertices": np.array([[0.0, 0.0], [1.0, 0.0], [0.0, np.inf]])}, "row 2 of vertices"),
        ({"vertices": np.array([[0.0, 0.0], [1.0, 0.0]])}, "2 vertices"),
        ({"segments": np.array([[0, 1], [3, 9]], np.int32)}, "segment 1 joins"),
        ({"segments": np.array([[-1, 1]])}, "segment 0 joins"),
        ({"holes": np.array([[np.nan, 0.0]])}, "row 0 of holes"),
        ({"regions": np.array([[0.0, 0.0, 1.0]])}, "regions of shape"),
        ({"vertex_markers": np.zeros(3, np.int32)}, "vertex_markers of shape"),
        ({"vertex_attributes": np.zeros(18)}, "18 vertex_attributes"),
        ({"segments": None, "segment_markers": np.zeros(3, np.int32)}, "segment_markers of shape"),
    ],
)
def test_what_is_wrong_with_arrays_is_said(wrong, text):
    graph = {"vertices": SQUARE["vertices"].astype(float), "segments": np.array([[0, 1]])} | wrong
    with pytest.raises(UsageError, match=text):
        ours.triangulate({name: values for name, values in graph.items() if values is not None}, "pc")


def test_few_points_may_need_many_vertices():
    # More than the calling thread tries; what it says meanwhile is said once.
    strip = {
        "vertices": [[0, 0], [1, 0], [1, 4e-5], [0, 4e-5]],
        "segments": [[0, 1], [1, 2], [2, 3], [3, 0]],
        "holes": [[2, 2]],
    }
    with pytest.warns(BreaklineWarning) as said:
        mesh = ours.triangulate(strip, "pq30")
    assert len(mesh["vertices"]) > 20_000 and angles(mesh).min() > 30 - 1e-9
    assert [str(warning.message).count("hole") for warning in said] == [1]
    limited = ours.triangulate({**strip, "holes": []}, "pq30S100000")
    assert np.array_equal(limited["triangles"], mesh["triangles"])
