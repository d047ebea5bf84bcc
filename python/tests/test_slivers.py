"""`find_simplex` and linear values in thin simplices, against rational arithmetic."""

import os
from fractions import Fraction

import numpy as np
import pytest

from breakline.spatial import Delaunay, LinearNDInterpolator, NaturalNeighborInterpolator, NearestNDInterpolator

#: How many positions are judged.
COUNT = int(os.environ.get("BREAKLINE_SLIVERS", 2000))

SLIVER = np.array([(0.0, 0.0), (1000.0, 0.0), (500.0, 9e-8), (500.0, 500.0)])


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    minors = (row[0] * determinant([other[1:] for other in rows if other is not row]) for row in rows)
    return sum(minor if k % 2 == 0 else -minor for k, minor in enumerate(minors))


def exact(point):
    return [Fraction(float(x)) for x in point]


def volume(corners):
    first, *others = corners
    return determinant([[p - q for p, q in zip(corner, first)] for corner in others])


def barycentric(corners, position):
    """Return the barycentric coordinates of a position, by Cramer's rule."""
    whole = volume(corners)
    return [volume(corners[:k] + [position] + corners[k + 1 :]) / whole for k in range(len(corners))]


def grid(rng, ndim):
    """Some points of a grid with spacing 0.1."""
    side = 4 if ndim == 2 else 3
    steps = np.stack(np.meshgrid(*[np.arange(side)] * ndim), axis=-1).reshape(-1, ndim)
    return rng.permutation(steps)[: rng.integers(ndim + 2, 13)] * 0.1


def flattened(rng, ndim):
    """Points that are nearly on a line or a plane, at a distance from 1e-3 of the others to nearly none."""
    points = rng.integers(0, 6, (rng.integers(ndim + 1, 9), ndim)) * rng.choice([0.1, 1.0, 100.0])
    axis = rng.integers(ndim)
    points[:, axis] = rng.integers(-3, 4, len(points)) * 10.0 ** rng.integers(-18, -2)
    points[0, axis] += rng.choice([0, 1, 500])
    return points


def turned(rng, ndim):
    """A grid that is turned: its sides are straight but for roundings."""
    angle = rng.random()
    points = grid(rng, ndim)
    points[:, :2] = points[:, :2] @ [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    return points + rng.choice([0.0, 1 / 3, 5e5])


def nudged(rng, ndim):
    """A grid whose points are off by a few roundings."""
    points = grid(rng, ndim)
    return points + rng.integers(-2, 3, points.shape) * rounding_of(points)


def rounding_of(numbers):
    """Return the distance to the next double; for small numbers that of a larger one."""
    return np.spacing(np.maximum(np.abs(numbers), 1e-3))


def positions(rng, tri, count):
    """Return positions in simplices, on their edges and facets and off these by a rounding, and anywhere."""
    corners = tri.points[tri.simplices[rng.integers(tri.nsimplex, size=count)]]
    weights = rng.random(corners.shape[:2])
    weights[rng.random(weights.shape) < 0.3] = 0
    weights[rng.random(count) < 0.3] = 1  # centroids
    weights[weights.sum(axis=1) == 0] = 1
    xi = (corners * (weights / weights.sum(axis=1, keepdims=True))[..., None]).sum(axis=1)
    xi += rng.integers(-1, 2, xi.shape) * rounding_of(xi) * (rng.random(count) < 0.3)[:, None]
    low, high = tri.min_bound, tri.max_bound
    anywhere = rng.random(count) < 0.1
    xi[anywhere] = low + (high - low) * (rng.random((anywhere.sum(), xi.shape[1])) * 1.2 - 0.1)
    return xi


@pytest.mark.parametrize("draw", [grid, flattened, turned, nudged])
@pytest.mark.parametrize("ndim", [2, 3])
def test_the_simplex_is_the_one_that_contains_the_position_and_has_its_value(draw, ndim):
    rng = np.random.default_rng(ndim)
    judged = compared = 0
    while judged < COUNT // 8:
        points = np.unique(draw(rng, ndim), axis=0)
        if volume_of_none(points):
            continue
        values = rng.integers(0, 100, len(points)).astype(float)
        tri, linear = Delaunay(points), LinearNDInterpolator(points, values)
        simplices = [[exact(points[corner]) for corner in simplex] for simplex in tri.simplices]
        xi = positions(rng, tri, 20)
        found, interpolated = tri.find_simplex(xi, tol=0), linear(xi)
        judged += len(xi)
        # The largest distance that a rounding moves a corner.
        rounding = np.finfo(float).eps * np.abs(points).max() * ndim
        for position, simplex, value in zip(map(exact, xi), found, interpolated):
            if simplex < 0:
                assert not any(min(barycentric(corners, position)) >= 0 for corners in simplices), (points, position)
                continue
            weights = barycentric(simplices[simplex], position)
            assert min(weights) >= 0, (points, position)
            corners = points[tri.simplices[simplex]]
            at_corners = values[tri.simplices[simplex]]
            if height(corners) > 10 * rounding:
                right = sum(weight * Fraction(v) for weight, v in zip(weights, at_corners))
                assert abs(value - float(right)) <= 1e-9 * np.ptp(values), (points, position, value, float(right))
                compared += 1
            else:
                assert values.min() <= value <= values.max()
    assert compared > judged / 3


def volume_of_none(points):
    """Return True if no points span the plane or the space."""
    if len(points) <= points.shape[1]:
        return True
    first, *others = map(exact, points)
    rows = [[p - q for p, q in zip(point, first)] for point in others]
    rank = 0
    for column in range(points.shape[1]):
        pivot = next((row for row in rows if row[column] != 0), None)
        if pivot is None:
            continue
        rank += 1
        rows.remove(pivot)
        rows = [[x - y * row[column] / pivot[column] for x, y in zip(row, pivot)] for row in rows]
    return rank < points.shape[1]


def height(corners):
    """Return about the least distance of a corner from the facet opposite."""
    spread = np.linalg.norm(corners[:, None] - corners, axis=2).max()
    return float(volume([exact(corner) for corner in corners])) / spread ** (corners.shape[1] - 1)


def test_positions_next_to_an_axis_are_inside():
    """Numbers too small for exact arithmetic, which points may not have."""
    square = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
    xi = [[1e-60, 0.5], [-5e-324, 1e-200], [0.5, -3e-50]]
    assert (Delaunay(square).find_simplex(xi) >= 0).all()
    for kind in (LinearNDInterpolator, NaturalNeighborInterpolator, NearestNDInterpolator):
        assert (kind(square, np.ones(4))(xi) == 1).all()


def test_a_sliver_has_its_own_values():
    linear = LinearNDInterpolator(SLIVER, [0.0, 0.0, 100.0, 0.0])
    assert linear(250.0, 1e-8) == pytest.approx(100 / 9, rel=1e-12)
    tri = Delaunay(SLIVER)
    thin = set(tri.simplices[int(tri.find_simplex((250.0, 1e-8), tol=0))])
    assert thin == {0, 1, 2}
    assert set(tri.simplices[int(tri.find_simplex((250.0, 1e-8)))]) == thin
    assert tri.find_simplex((250.0, -1e-30), tol=0) == -1
    with pytest.raises(ValueError, match="tol is -1"):
        tri.find_simplex((250.0, 1e-8), tol=-1)


@pytest.mark.parametrize("ndim, side", [(2, 60), (3, 9)])
def test_centroids_of_a_grid_with_spacing_of_a_tenth(ndim, side):
    points = np.stack(np.meshgrid(*[np.arange(side) * 0.1] * ndim), axis=-1).reshape(-1, ndim)
    tri = Delaunay(points)
    centroids = points[tri.simplices].mean(axis=1)
    for simplex, found in zip(range(tri.nsimplex), tri.find_simplex(centroids, tol=0)):
        if found != simplex:
            # A rounded centroid may be outside of a simplex that is thinner than a rounding.
            position = exact(centroids[simplex])
            assert min(barycentric([exact(points[k]) for k in tri.simplices[simplex]], position)) <= 0
            assert min(barycentric([exact(points[k]) for k in tri.simplices[found]], position)) >= 0


@pytest.fixture
def cubes():
    """Points of a grid, and how to turn it: then there are flat simplices between cubes, and at the hull."""
    turns = [np.eye(3), np.eye(3)]
    turns[0][:2, :2] = [[np.cos(0.3), np.sin(0.3)], [-np.sin(0.3), np.cos(0.3)]]
    turns[1][1:, 1:] = [[np.cos(0.7), np.sin(0.7)], [-np.sin(0.7), np.cos(0.7)]]
    return np.stack(np.meshgrid(*[np.arange(6.0)] * 3), axis=-1).reshape(-1, 3), turns[0] @ turns[1]


def test_natural_neighbors_between_the_cubes_of_a_turned_grid(cubes):
    """Flat simplices there are not at the hull: values are those of the grid before it was turned."""
    points, turn = cubes
    rng = np.random.default_rng(1)
    values, xi = rng.random(len(points)), rng.integers(1, 20, (500, 3)) / 4
    expected = NaturalNeighborInterpolator(points, values)(xi)
    found = NaturalNeighborInterpolator(points @ turn, values)(xi @ turn)
    assert np.allclose(found, expected, atol=1e-6)


def test_positions_on_the_hull_of_a_turned_grid_are_inside_up_to_rounding(cubes):
    points, turn = cubes
    rng = np.random.default_rng(2)
    xi = rng.integers(0, 21, (4000, 3)) / 4
    tri = Delaunay(points @ turn)
    on_hull = xi @ turn
    assert (tri.find_simplex(on_hull) >= 0).all() and (tri.find_simplex(on_hull, tol=0) < 0).any()
    outside = (xi + np.where(xi == 5, 1e-6, 0))[(xi == 5).any(axis=1)] @ turn
    assert (tri.find_simplex(outside) < 0).all() and (tri.find_simplex(outside, tol=1e-5) >= 0).all()


@pytest.mark.parametrize("kind", [LinearNDInterpolator, NaturalNeighborInterpolator])
def test_a_straight_side_whose_points_are_rounded_has_the_values_of_its_points(kind):
    """The hull passes by points that are rounded inward; values there are those of these points all the same."""
    angle = 0.3
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    points = np.stack(np.meshgrid(np.arange(20.0), np.arange(20.0)), axis=-1).reshape(-1, 2)
    values = points[:, 0] % 2  # 0 and 1 in turn
    along = np.linspace(0, 19, 500)
    for y in (0.0, 19.0):
        rim = np.stack([along, np.full(500, y)], axis=1) @ turn
        expected = 1 - np.abs(along % 2 - 1)
        assert np.allclose(kind(points @ turn, values)(rim), expected, atol=1e-6)
