"""`breakline.spatial` against scipy, and facts of scipy's own tests of `Delaunay` as our cases."""

import multiprocessing
import os
import pickle
import signal
import threading

import numpy as np
import pytest
from conftest import grid, random_points, sets_of

from breakline.spatial import ClosedError, Delaunay, QhullError, tsearch


DIMENSIONS = [2, 3]


def volumes(points, simplices):
    corners = points[simplices]
    return np.linalg.det(corners[:, 1:] - corners[:, :1])


def assert_consistent(tri):
    """Check what holds for every triangulation, whichever simplices it has."""
    points, simplices, neighbors = tri.points, tri.simplices, tri.neighbors
    assert simplices.dtype == neighbors.dtype == np.int32
    assert simplices.shape == neighbors.shape == (tri.nsimplex, tri.ndim + 1)
    assert (volumes(points, simplices) > 0).all()
    # Neighbor k is opposite corner k, and shares all other corners.
    for k in range(tri.ndim + 1):
        facet = np.sort(np.delete(simplices, k, axis=1), axis=1)
        has = neighbors[:, k] >= 0
        beyond = simplices[neighbors[has, k]]
        assert all(set(f) <= set(b) for f, b in zip(facet[has].tolist(), beyond.tolist()))
    facets = np.sort(
        np.concatenate([np.delete(simplices, k, axis=1)[neighbors[:, k] < 0] for k in range(tri.ndim + 1)]), axis=1
    )
    assert sets_of(facets) == sets_of(tri.convex_hull)
    # Each point is a corner or listed as coplanar.
    corners = np.unique(simplices)
    assert sorted(corners.tolist() + tri.coplanar[:, 0].tolist()) == list(range(tri.npoints))
    for point, simplex, vertex in tri.coplanar.tolist():
        assert (points[point] == points[vertex]).all() and vertex in simplices[simplex] and vertex < point
    at = tri.vertex_to_simplex
    assert (points[simplices[at]] == points[:, None, :]).all(axis=2).any(axis=1).all()
    expected = [set() for _ in range(tri.npoints)]
    for simplex in simplices.tolist():
        for corner in simplex:
            expected[corner] |= set(simplex) - {corner}
    starts, indices = tri.vertex_neighbor_vertices
    assert len(starts) == tri.npoints + 1 and starts[-1] == len(indices)
    for k in range(tri.npoints):
        around = indices[starts[k] : starts[k + 1]].tolist()
        assert len(around) == len(set(around)) and set(around) == expected[k]


@pytest.mark.parametrize("ndim", DIMENSIONS)
@pytest.mark.parametrize("threads", [1, 2, None])
def test_random_points_have_the_simplices_of_scipy(scipy_spatial, ndim, threads):
    points = random_points(600, ndim)
    ours, theirs = Delaunay(points, threads=threads), scipy_spatial.Delaunay(points)
    assert sets_of(ours.simplices) == sets_of(theirs.simplices)
    assert sets_of(ours.convex_hull) == sets_of(theirs.convex_hull)
    assert_consistent(ours)
    assert (ours.min_bound == theirs.min_bound).all() and (ours.max_bound == theirs.max_bound).all()


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_ties_are_consistent_and_the_same_in_any_order(ndim):
    points = grid(7 if ndim == 2 else 4, ndim)
    tri = Delaunay(points)
    assert_consistent(tri)
    assert np.isclose(volumes(points, tri.simplices).sum(), (6**2 * 2) if ndim == 2 else (3**3 * 6))
    order = np.random.default_rng(1).permutation(len(points))
    shuffled = Delaunay(points[order])
    assert sets_of(order[shuffled.simplices]) == sets_of(tri.simplices)


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_equal_points_are_coplanar(ndim):
    points = random_points(10, ndim)
    tri = Delaunay(np.concatenate([points, points]))
    assert_consistent(tri)
    assert len(np.unique(tri.simplices)) == len(tri.coplanar) == 10
    assert len(np.unique(tri.coplanar[:, 2])) == 10
    assert (tri.vertex_to_simplex >= 0).all()


def test_zeros_of_both_signs_are_one_site():
    tri = Delaunay([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-0.0, -0.0]])
    assert tri.nsimplex == 1 and tri.coplanar.tolist() == [[3, 0, 0]]


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_one_simplex(ndim):
    points = np.concatenate([np.eye(ndim), np.ones((1, ndim))])
    tri = Delaunay(points)
    tri.simplices.sort()
    assert tri.simplices.tolist() == [list(range(ndim + 1))]
    assert tri.neighbors.tolist() == [[-1] * (ndim + 1)]


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_transforms_are_those_of_scipy(scipy_spatial, ndim):
    points = random_points(100, ndim)
    tri = Delaunay(points)
    assert tri.transform.shape == (tri.nsimplex, ndim + 1, ndim)
    corners = points[tri.simplices]
    moved = np.einsum("ijk,ilk->ilj", tri.transform[:, :ndim], corners - tri.transform[:, None, ndim])
    expected = np.concatenate([np.eye(ndim), np.zeros((1, ndim))])
    assert np.allclose(moved, expected, atol=1e-6)
    # Where scipy has the same simplex with the same last corner, it has the same numbers.
    theirs = scipy_spatial.Delaunay(points)
    by_corners = {frozenset(s): (i, s[-1]) for i, s in enumerate(theirs.simplices.tolist())}
    compared = 0
    for i, simplex in enumerate(tri.simplices.tolist()):
        j, last = by_corners[frozenset(simplex)]
        if last == simplex[-1]:
            order = [theirs.simplices[j].tolist().index(corner) for corner in simplex[:-1]]
            assert np.allclose(tri.transform[i, :ndim], theirs.transform[j][order], rtol=1e-6)
            compared += 1
    assert compared > 10


def test_a_flat_simplex_has_no_transform():
    tri = Delaunay([[0.0, 0.0], [1.0, 0.0], [0.5, 1e-16]])
    assert tri.nsimplex == 1 and np.isnan(tri.transform).all()


@pytest.mark.parametrize("ndim", DIMENSIONS)
@pytest.mark.parametrize("order", ["random", "sorted"])
def test_find_simplex_finds_what_contains_the_position(scipy_spatial, ndim, order):
    points = random_points(500, ndim)
    tri, theirs = Delaunay(points), scipy_spatial.Delaunay(points)
    xi = random_points(5000, ndim, seed=1) * 1.4 - 0.2
    if order == "sorted":
        xi = xi[np.lexsort(xi.T)]
    found = tri.find_simplex(xi)
    expected = theirs.find_simplex(xi)
    assert found.dtype == np.int32 and found.shape == (5000,)
    assert ((found >= 0) == (expected >= 0)).all() and (found < 0).any()
    inside = found >= 0
    assert (np.sort(tri.simplices[found[inside]]) == np.sort(theirs.simplices[expected[inside]])).all()
    for threads in (1, 2):
        assert (Delaunay(points, threads=threads).find_simplex(xi) == found).all()
    assert (tri.find_simplex(xi, bruteforce=True) == found).all()
    assert (tsearch(tri, xi) == found).all()
    # One at a time, in any shape.
    assert (np.array([tri.find_simplex(x) for x in xi[:50]]) == found[:50]).all()
    assert (tri.find_simplex(xi.reshape(50, 100, ndim)) == found.reshape(50, 100)).all()


@pytest.mark.parametrize("ndim", DIMENSIONS)
@pytest.mark.parametrize("shape", [(), (1,), (7,), (3, 40), (0,), (3, 0)])
def test_find_simplex_takes_arrays_of_any_layout(ndim, shape):
    tri = Delaunay(random_points(60, ndim))
    xi = (random_points(int(np.prod(shape)), ndim, seed=1) * 1.4 - 0.2).astype(np.float32).astype(float)
    xi = xi.reshape(*shape, ndim)
    expected = tri.find_simplex(xi.tolist() if xi.size else xi.astype(np.float32))
    unaligned = np.frombuffer(b" " + xi.tobytes(), np.uint8)[1:].view(float).reshape(xi.shape) if xi.size else xi
    kept = xi.copy()
    kept.flags.writeable = False
    layouts = [xi, kept, np.asfortranarray(xi), np.stack([xi, xi], axis=-1)[..., 0], xi.astype(np.float32)]
    layouts += [xi.astype(">f8"), unaligned, np.ma.masked_array(xi), np.repeat(xi, 2, axis=-1)[..., ::2]]
    for given in layouts:
        found = tri.find_simplex(given)
        assert type(found) is np.ndarray and found.dtype == np.int32 and found.shape == shape
        assert found.flags.writeable and np.array_equal(found, expected)


def test_find_simplex_at_centroids_is_the_simplex():
    for points in (random_points(300, 2), grid(10, 2), random_points(100, 3), grid(4, 3)):
        tri = Delaunay(points)
        centroids = points[tri.simplices].mean(axis=1)
        assert (tri.find_simplex(centroids) == np.arange(tri.nsimplex)).all()


def test_find_simplex_has_the_tolerance_of_scipy():
    """On a slanted side, positions are rounded to either side of it."""
    angle = 0.3
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    points = grid(30, 2) @ turn
    rim = np.stack([np.linspace(0, 29, 1000), np.zeros(1000)], axis=1) @ turn
    tri = Delaunay(points)
    assert (tri.find_simplex(rim) >= 0).all()
    assert (tri.find_simplex(rim, tol=0.0) < 0).any()
    assert (tri.find_simplex(rim + [1e-9, -1e-9]) < 0).all()
    assert (tri.find_simplex(rim + [1e-9, -1e-9], tol=1e-6) >= 0).all()


def test_positions_that_are_not_numbers_are_in_no_simplex():
    tri = Delaunay(random_points(50, 2))
    xi = [[np.nan, 0.5], [0.5, np.inf], [-np.inf, np.nan], [1e300, 0.5], [0.5, 0.5]]
    assert (tri.find_simplex(xi) >= 0).tolist() == [False] * 4 + [True]
    many = np.tile(xi, (200, 1))
    assert (tri.find_simplex(many) >= 0).sum() == 200


def test_find_simplex_refuses_wrong_shapes():
    tri = Delaunay([[0, 0], [0, 1.1], [1, 0], [1, 1]])
    with pytest.raises(IndexError):
        tri.find_simplex(1)
    with pytest.raises(IndexError):
        tri.find_simplex(tri)
    with pytest.raises(ValueError, match="wrong dimensionality"):
        tri.find_simplex([2, 2, 2])
    with pytest.raises(TypeError):
        tri.find_simplex([["a", "b"]])
    assert tri.find_simplex(np.empty((0, 2))).shape == (0,)
    assert tri.find_simplex(np.empty((3, 0, 2))).shape == (3, 0)


@pytest.mark.parametrize("ndim", DIMENSIONS)
@pytest.mark.parametrize("chunk", [1, 4, 16, 200])
@pytest.mark.parametrize("restart", [False, True])
def test_points_can_be_added(ndim, chunk, restart):
    points = np.concatenate([random_points(60, ndim), random_points(20, ndim)])  # 20 of them twice
    tri = Delaunay(points[: ndim + 3], incremental=True)
    for start in range(ndim + 3, len(points), chunk):
        tri.add_points(points[start : start + chunk], restart=restart)
    assert (tri.points == points).all()
    assert_consistent(tri)
    assert sets_of(tri.simplices) == sets_of(Delaunay(points).simplices)
    found = tri.find_simplex(points[tri.simplices].mean(axis=1))
    assert (found == np.arange(tri.nsimplex)).all()
    with pytest.raises(ValueError, match="NaN"):
        tri.add_points(np.full((1, ndim), np.nan))
    assert tri.npoints == len(points)
    with pytest.raises(ValueError):
        tri.add_points(np.zeros((1, 5 - ndim)))
    tri.close()
    with pytest.raises(ClosedError, match="incremental"):
        tri.add_points(points)


def test_points_cannot_be_added_without_incremental():
    tri = Delaunay(random_points(10, 2))
    with pytest.raises(RuntimeError, match="incremental"):
        tri.add_points([[0.5, 0.5]])


@pytest.mark.parametrize(
    "points, error, text",
    [
        (np.ma.masked_all((4, 2)), ValueError, "masked"),
        ([[0, 0], [0, 1], [1, 1], [1, np.nan]], ValueError, "row 3: .*cannot contain NaN"),
        ([[0, 0], [0, np.inf], [1, 1]], ValueError, "row 1"),
        ([[0, 0], [1e70, 1], [1, 1]], ValueError, "scale"),
        ([[0, 0], [1e-70, 1], [1, 1]], ValueError, "scale"),
        (np.zeros((5, 4)), NotImplementedError, "2 and 3 dimensions"),
        (np.zeros((5, 1)), ValueError, "2-D"),
        (np.zeros(5), ValueError, "shape"),
        (np.zeros((5, 2, 2)), ValueError, "shape"),
        (np.zeros((0, 2)), ValueError, "no points"),
        ([], ValueError, "shape"),
        (1.0, ValueError, "shape"),
        (np.zeros((5, 2), complex), TypeError, "complex"),
        ([["a", "b"], ["c", "d"]], TypeError, "dtype"),
        ([[None, 1], [2, 3]], TypeError, "dtype"),
        ([[0, 0], [1, 1]], QhullError, "line"),
        ([[0, 0], [1, 1], [2, 2], [9, 9]], QhullError, "line"),
        ([[0, 0], [0, 0], [0, 0]], QhullError, "line"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [5, 7, 0]], QhullError, "plane"),
    ],
)
def test_what_cannot_be_triangulated(points, error, text):
    with pytest.raises(error, match=text) as caught:
        Delaunay(points)
    assert str(caught.value)


def test_the_exception_of_flat_points_is_a_runtime_error():
    """As scipy's is, which is caught by that class."""
    with pytest.raises(RuntimeError):
        Delaunay([[0, 0], [1, 1], [2, 2]])


def test_arrays_of_any_layout_and_dtype():
    points = np.random.default_rng(3).integers(0, 1000, (100, 2))
    expected = Delaunay(points.astype(float)).simplices
    read_only = points.astype(float)
    read_only.flags.writeable = False
    strided = np.zeros((200, 4))
    strided[::2, ::2] = points
    for same in (
        points,
        points.astype(np.float32),
        points.astype(np.uint16),
        points.astype(">f8"),
        np.asfortranarray(points.astype(float)),
        strided[::2, ::2],
        read_only,
        points.tolist(),
        points.astype(np.longdouble),
    ):
        assert (Delaunay(same).simplices == expected).all()


def test_the_array_is_kept_and_not_changed():
    points = random_points(100, 2)
    before = points.copy()
    tri = Delaunay(points)
    assert tri.points is points and (points == before).all()


def test_options_of_qhull():
    points = random_points(20, 2)
    assert Delaunay(points, qhull_options="Qbb Qc Qz Q12").nsimplex == Delaunay(points).nsimplex
    with pytest.raises(NotImplementedError, match="exact"):
        Delaunay(points, qhull_options="QJ Qbb Pp")
    with pytest.raises(NotImplementedError, match="QG4"):
        Delaunay(points, qhull_options="QG4")
    with pytest.raises(NotImplementedError, match="furthest_site"):
        Delaunay(points, furthest_site=True)


def test_what_is_absent_says_why():
    tri = Delaunay(random_points(20, 2))
    for name in ("equations", "lift_points", "plane_distance", "good", "paraboloid_scale"):
        with pytest.raises(AttributeError, match=f"has no {name}: "):
            getattr(tri, name)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        tri.nothing
    import breakline.spatial

    with pytest.raises(AttributeError, match="has no SphericalVoronoi: "):
        breakline.spatial.SphericalVoronoi
    with pytest.raises(ImportError):
        from breakline.spatial import HalfspaceIntersection  # noqa: F401


def test_all_public_members_of_scipy_exist_or_say_why(scipy_spatial):
    theirs = scipy_spatial.Delaunay(random_points(20, 2))
    ours = Delaunay(random_points(20, 2))
    for name in [name for name in {*dir(theirs), *vars(theirs)} if not name.startswith("_")]:
        try:
            getattr(ours, name)
        except AttributeError as error:
            assert f"has no {name}: " in str(error)


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_pickling(ndim):
    tri = Delaunay(random_points(50, ndim), incremental=True)
    copy = pickle.loads(pickle.dumps(tri))
    assert (copy.simplices == tri.simplices).all() and (copy.points == tri.points).all()
    copy.add_points(random_points(5, ndim, seed=9))
    assert (copy.npoints, tri.npoints) == (55, 50)


def test_nasty_grids():
    """Centroids of grids that are off by a rounding, or that are there twice, are in some simplex."""
    rng = np.random.default_rng(1234)
    for ndim, side in ((2, 70), (3, 11)):
        even = grid(side, ndim) / (side - 1)
        perturbed = even.copy()
        chosen = rng.random(len(even)) < 0.2
        perturbed[chosen] += 2 * np.finfo(float).eps * (rng.random((chosen.sum(), ndim)) - 0.5)
        for points in (even, perturbed, np.concatenate([even, even])):
            tri = Delaunay(points)
            centroids = points[tri.simplices].mean(axis=1)
            assert (tri.find_simplex(centroids) >= 0).all()
            maps = tri.transform
            parts = np.einsum("ijk,ik->ij", maps[:, :ndim], centroids - maps[:, ndim])
            is_good = np.isnan(parts).all(axis=1) | (abs(parts * (ndim + 1) - 1) < 0.1).all(axis=1)
            assert is_good.all()


def test_random_shapes_of_degenerate_input():
    """Few points on a coarse grid: collinear, coplanar, coincident."""
    rng = np.random.default_rng(5)
    for _ in range(300):
        ndim = int(rng.integers(2, 4))
        points = rng.integers(0, 3, (rng.integers(1, 12), ndim)).astype(float)
        spans = np.linalg.matrix_rank(points - points[0]) == ndim
        if spans:
            assert_consistent(Delaunay(points))
        else:
            with pytest.raises(QhullError):
                Delaunay(points)


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="needs /proc")
def test_memory_of_ten_thousand_calls_is_flat():
    points, xi = random_points(200, 2), random_points(100, 2, seed=1)

    def work(times):
        for _ in range(times):
            tri = Delaunay(points, threads=1)
            tri.simplices, tri.transform, tri.vertex_neighbor_vertices
            tri.find_simplex(xi)
            tri.find_simplex(xi[0])
            with pytest.raises(ValueError):
                Delaunay([[0, 0], [np.nan, 1]])

    work(200)
    before = resident()
    work(2000)
    assert resident() - before < 4 << 20


def count_simplices(seed):
    return Delaunay(random_points(5000, 2, seed)).nsimplex


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_processes(method):
    expected = [count_simplices(seed) for seed in range(4)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map_async(count_simplices, range(4)).get(timeout=60) == expected


def test_interruption():
    """Ctrl-C ends a long call, and other calls work."""
    points = random_points(3_000_000, 2)
    timer = threading.Timer(0.15, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            Delaunay(points)
    timer.join()
    assert Delaunay(points[:10]).nsimplex > 0


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_points_are_added_while_others_ask(ndim):
    """Insertions and queries of several threads end, with one answer for what did not change."""
    triangulation = Delaunay(random_points(3000, ndim), incremental=True, threads=2)
    positions = np.random.default_rng(7).random((20_000, ndim)) + 5.0
    failures = []

    def ask():
        try:
            for _ in range(8):
                assert (triangulation.find_simplex(positions) == -1).all()
        except Exception as error:  # noqa: BLE001 - a thread's failure would be lost
            failures.append(error)

    def add():
        try:
            for k in range(8):
                triangulation.add_points(random_points(200, ndim, seed=k + 1))
        except Exception as error:  # noqa: BLE001
            failures.append(error)

    threads = [threading.Thread(target=work, daemon=True) for work in (ask, add, ask)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=120)
    assert not any(thread.is_alive() for thread in threads)
    assert not failures
    assert len(triangulation.points) == 3000 + 8 * 200
