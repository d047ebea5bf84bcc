"""`ConvexHull` against scipy and against exact fractions: corners, facets, areas and volumes."""

import itertools
import pickle
from fractions import Fraction

import numpy as np
import pytest
from conftest import grid, random_points, sets_of

from breakline.spatial import ConvexHull, Delaunay, QhullError


def on_sphere(count, ndim, seed=0):
    points = np.random.default_rng(seed).normal(size=(count, ndim))
    return points / np.linalg.norm(points, axis=1)[:, None]


def determinant(points, corners, point):
    """Return the exact orientation of a facet and a point, positive outside."""
    rows = [[Fraction(x) - Fraction(y) for x, y in zip(points[k], points[corners[0]])] for k in [*corners[1:], point]]
    if len(rows) == 2:
        return rows[0][1] * rows[1][0] - rows[0][0] * rows[1][1]
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def assert_exact(hull):
    """Check with fractions that no point is outside, that no corner lies between others, and links."""
    points, ndim = hull.points, hull.ndim
    assert hull.vertices.dtype == hull.simplices.dtype == hull.neighbors.dtype == np.int32
    assert hull.simplices.shape == hull.neighbors.shape == (hull.nsimplex, ndim)
    assert hull.equations.shape == (hull.nsimplex, ndim + 1)
    assert np.unique(hull.simplices).tolist() == sorted(hull.vertices.tolist())
    planes = {k: set() for k in hull.vertices.tolist()}
    for facet, corners in enumerate(hull.simplices.tolist()):
        sides = [determinant(points, corners, k) for k in range(len(points))]
        assert max(sides) == 0
        for k in corners:
            planes[k].add(frozenset(q for q, side in enumerate(sides) if side == 0))
        for k in range(ndim):
            beyond = hull.neighbors[facet, k]
            assert set(corners) - {corners[k]} <= set(hull.simplices[beyond].tolist()) and beyond != facet
    # A corner is where at least as many different lines or planes meet as there are dimensions.
    assert all(len(planes) >= ndim for planes in planes.values())


@pytest.mark.parametrize("spread", [[1, 1, 1], [1e6, 1, 1e-6], [1e-40, 1e-40, 1e-42], [1, 1e-12, 1]])
@pytest.mark.parametrize("make", [random_points, on_sphere])
def test_what_is_inside_is_left_out_at_any_scale(make, spread):
    """Points in a box within the hull are not looked at; the triangulation has all of them."""
    points = np.concatenate([make(300, 3), random_points(3000, 3, seed=1) * 0.9 + 0.05]) * spread
    for points in (points, np.repeat(points, 2, axis=0), points[:, [2, 0, 1]]):
        hull = ConvexHull(points)
        assert sets_of(hull.simplices) == sets_of(Delaunay(points).convex_hull)


def test_points_on_the_box_within_are_kept():
    # The box from -1 to 1 in a cube: its sides are sides of the hull, too.
    corners = grid(2, 3) * 2 - 1
    sides = np.concatenate([corners, corners * [1.5, 0.25, 0.25], grid(5, 3) / 4 - 0.5, corners])
    assert_exact(ConvexHull(sides))
    assert_exact(ConvexHull(np.concatenate([grid(4, 3), grid(2, 3) * 3])))


@pytest.mark.parametrize("threads", [1, 2, None])
@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("make", [random_points, on_sphere])
@pytest.mark.parametrize("count", [5, 60, 2000])
def test_the_hull_is_that_of_scipy(scipy_spatial, make, count, ndim, threads):
    points = make(count, ndim)
    ours, theirs = ConvexHull(points, threads=threads), scipy_spatial.ConvexHull(points)
    assert sorted(ours.vertices.tolist()) == sorted(theirs.vertices.tolist())
    assert sets_of(ours.simplices) == sets_of(theirs.simplices)
    assert ours.volume == pytest.approx(theirs.volume, rel=1e-12)
    assert ours.area == pytest.approx(theirs.area, rel=1e-12)
    assert type(ours.volume) is type(ours.area) is float
    by_corners = {frozenset(s): e for s, e in zip(theirs.simplices.tolist(), theirs.equations)}
    expected = [by_corners[frozenset(s)] for s in ours.simplices.tolist()]
    assert np.allclose(ours.equations, expected, atol=1e-8)
    for name in ("vertices", "simplices", "neighbors", "equations", "coplanar"):
        assert getattr(ours, name).dtype == getattr(theirs, name).dtype, name
        assert getattr(ours, name).shape == getattr(theirs, name).shape, name
    assert (ours.ndim, ours.npoints, ours.nsimplex, ours.good) == (ndim, count, theirs.nsimplex, None)
    assert (ours.min_bound == theirs.min_bound).all() and (ours.max_bound == theirs.max_bound).all()
    if count <= 60:
        assert_exact(ours)


def test_corners_in_the_plane_are_counter_clockwise():
    hull = ConvexHull(random_points(200, 2))
    x, y = hull.points[hull.vertices].T
    assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2 == pytest.approx(hull.volume)
    assert hull.simplices.tolist() == np.column_stack([hull.vertices, np.roll(hull.vertices, -1)]).tolist()


@pytest.mark.parametrize("ndim", [2, 3])
def test_a_grid_has_the_corners_of_a_box(scipy_spatial, ndim):
    points = grid(5, ndim)
    hull = ConvexHull(points)
    assert_exact(hull)
    assert sorted(points[hull.vertices].tolist()) == (4 * grid(2, ndim)).tolist()
    assert (hull.nsimplex, hull.volume) == ((4, 16.0) if ndim == 2 else (12, 64.0))
    assert hull.area == (16.0 if ndim == 2 else 96.0)
    assert sorted(hull.vertices.tolist()) == sorted(scipy_spatial.ConvexHull(points).vertices.tolist())


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("ndim", [2, 3])
def test_points_of_a_coarse_grid_have_an_exact_hull(ndim, seed):
    points = np.random.default_rng(seed).integers(0, 4, size=(40, ndim)).astype(float)
    hull = ConvexHull(points)
    assert_exact(hull)
    # It is that of the triangulation, whose hull has all points of its border.
    assert set(hull.vertices.tolist()) <= set(Delaunay(points).convex_hull.ravel().tolist())


def test_facets_are_a_function_of_the_set_of_points():
    points = np.array([p for p in itertools.product(range(-3, 4), repeat=3) if np.dot(p, p) == 9], float)
    points = np.vstack([points, 2 * points / 3, points / 3])
    expected = None
    for seed in range(8):
        order = np.random.default_rng(seed).permutation(len(points))
        hull = ConvexHull(points[order])
        facets = {frozenset(facet) for facet in order[hull.simplices].tolist()}
        assert expected is None or facets == expected
        expected = facets
    assert_exact(hull)


def test_points_on_a_rounded_line_are_judged_as_they_are():
    # Of these, some are above the line through the ends, by a rounding.
    x = np.arange(1, 30) * 0.1
    points = np.vstack([np.column_stack([x, x / 3]), [[0.1, -1.0], [2.9, -1.0]]])
    assert_exact(ConvexHull(points))
    top = np.column_stack([x, np.cos(x), x / 3 + np.cos(x) / 7])
    assert_exact(ConvexHull(np.vstack([top, [[0.1, 0.0, -1.0], [2.9, 0.0, -1.0]]])))


@pytest.mark.parametrize("ndim", [2, 3])
def test_points_on_a_line_or_a_plane_are_refused(ndim):
    flat = random_points(9, ndim)
    flat[:, -1] = 0.5
    with pytest.raises(QhullError, match=f"all 9 points lie on one {'line' if ndim == 2 else 'plane'}"):
        ConvexHull(flat)
    for few in (flat[:1], flat[:2], flat[[0] * 5], np.outer(np.arange(7), np.ones(ndim))):
        with pytest.raises(QhullError):
            ConvexHull(few)
    with pytest.raises(ValueError, match="no points"):
        ConvexHull(np.empty((0, ndim)))


@pytest.mark.parametrize("ndim", [2, 3])
def test_of_equal_points_the_first_is_a_corner(ndim):
    points = random_points(50, ndim)
    expected = ConvexHull(points)
    order = np.random.default_rng(1).permutation(50)
    hull = ConvexHull(np.vstack([points, points[order], -0.0 * points[:1] + points]))
    assert sorted(hull.vertices.tolist()) == sorted(expected.vertices.tolist())
    assert sets_of(hull.simplices) == sets_of(expected.simplices)


def test_negative_zeros_are_zeros():
    hull = ConvexHull([[0.0, 0.0], [-0.0, 4.0], [0.0, 4.0], [4.0, -0.0], [-0.0, 0.0]])
    assert sorted(hull.vertices.tolist()) == [0, 1, 3]


@pytest.mark.parametrize("ndim", [2, 3])
def test_added_points_are_in_the_hull(ndim):
    points = np.vstack([random_points(60, ndim), grid(2, ndim) * 0.9, random_points(9, ndim)])
    hull = ConvexHull(points[:40], incremental=True)
    for start, end in [(40, 44), (44, 64), (64, 65), (65, len(points))]:
        hull.add_points(points[start:end])
        expected = ConvexHull(points[:end])
        assert sorted(hull.vertices.tolist()) == sorted(expected.vertices.tolist())
        assert sets_of(hull.simplices) == sets_of(expected.simplices)
        assert hull.volume == pytest.approx(expected.volume)
        assert hull.npoints == end
    before = hull.vertices
    with pytest.raises(ValueError, match="row 1"):
        hull.add_points([points[0], np.full(ndim, np.nan)])
    assert hull.vertices is before
    hull.close()
    with pytest.raises(RuntimeError, match="already closed"):
        hull.add_points(points[:1])


def test_a_pickle_has_the_same_hull():
    hull = ConvexHull(random_points(50, 3))
    again = pickle.loads(pickle.dumps(hull))
    assert (again.simplices == hull.simplices).all() and again.volume == hull.volume


def test_what_is_not_offered_is_refused_with_the_reason():
    points = random_points(9, 2)
    ConvexHull(points, qhull_options="Qt Pp")
    for option, reason in [("QJ", "moves points"), ("Qc", "lists points on facets"), ("QG4", "belong to Qhull")]:
        with pytest.raises(NotImplementedError, match=f"qhull_options: {option} {reason}"):
            ConvexHull(points, qhull_options=option)
    with pytest.raises(NotImplementedError, match="2 and 3 dimensions"):
        ConvexHull(random_points(9, 4))
    with pytest.raises(ValueError, match="row 2"):
        ConvexHull([[0, 0], [1, 1], [2, np.inf]])
    with pytest.raises(ValueError, match="scale the coordinates"):
        ConvexHull([[0, 0], [1, 1], [2, 1e100]])


@pytest.mark.parametrize("ndim", [2, 3])
def test_the_scale_of_coordinates_does_not_matter(ndim):
    points = on_sphere(60, ndim)
    expected = ConvexHull(points)
    for scale in (2.0**-150, 2.0**190):
        hull = ConvexHull(points * scale)
        assert sets_of(hull.simplices) == sets_of(expected.simplices)
        assert np.allclose(hull.equations[:, :-1], expected.equations[:, :-1])
        assert hull.volume / scale**ndim == pytest.approx(expected.volume)
