"""The interpolators of `breakline.spatial` against scipy, and facts of scipy's own tests as our cases."""

import pickle
import threading

import numpy as np
import pytest
from conftest import random_points

from breakline.spatial import (
    Delaunay,
    LinearNDInterpolator,
    NaturalNeighborInterpolator,
    NearestNDInterpolator,
    QhullError,
)


FIVE = np.array([(0, 0), (-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.25, 0.3)])
SMOOTH = [LinearNDInterpolator, NaturalNeighborInterpolator]
ALL = [*SMOOTH, NearestNDInterpolator]


def values_at(points):
    return np.sin(5 * points[:, 0]) + points[:, 1] ** 2 + points[:, -1]


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("threads", [1, 2])
def test_linear_values_are_those_of_scipy(scipy_interpolate, ndim, threads):
    points, xi = random_points(800, ndim), random_points(9000, ndim, seed=1) * 1.2 - 0.1
    values = values_at(points)
    ours = LinearNDInterpolator(points, values, threads=threads)(xi)
    theirs = scipy_interpolate.LinearNDInterpolator(points, values)(xi)
    assert (np.isnan(ours) == np.isnan(theirs)).all() and np.isnan(ours).any()
    assert np.allclose(ours, theirs, rtol=1e-9, atol=1e-9, equal_nan=True)


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("offset, scale", [(0, [1, 1, 1]), (1e9, [1, 1, 1]), (0, [1, 1e-4, 1]), (0, [1e-40] * 3)])
def test_positions_in_rows_have_the_values_of_single_ones(ndim, offset, scale):
    # A search that starts from the position before finds what one without a start finds, to the bit: also in thin
    # simplices, on corners, outside, and where coordinates have few digits left.
    scale = np.array(scale[:ndim])
    points = offset + random_points(300, ndim) * scale
    along = np.linspace(-0.05, 1.05, 111).round(3)
    rows = [np.column_stack([along, *[np.full_like(along, at)] * (ndim - 1)]) for at in (0.1, 0.25, 0.333, 0.5)]
    xi = np.vstack([offset + np.vstack(rows) * scale, points, (points[1:] + points[:-1]) / 2])
    interpolator = LinearNDInterpolator(points, values_at(random_points(300, ndim)), threads=1)
    single = np.concatenate([interpolator(position[None]) for position in xi])
    assert np.array_equal(interpolator(xi), single, equal_nan=True) and np.isfinite(single).any()


@pytest.mark.parametrize("count", [2, 15, 16, 17, 33, 64, 65, 300, 4097, 9000])
@pytest.mark.parametrize("kind", ALL)
def test_many_positions_have_the_values_of_single_ones(kind, count):
    # Several searches take turns. They meet rows that begin far away, gaps, whole rows outside, corners and edges.
    points = np.vstack([np.argwhere(np.ones((20, 20))).astype(float), 19 * random_points(200, 2)])
    rng = np.random.default_rng(count)
    interpolator = kind(points, rng.random(len(points)), threads=2)
    side = int(np.ceil(count**0.5))
    xi = np.stack(np.meshgrid(np.linspace(-1, 20, side), np.linspace(-3, 22, side)), axis=-1).reshape(-1, 2)[:count]
    xi[::5] = xi[::5].round()
    if kind is not NearestNDInterpolator:  # it refuses these
        xi[::7] = np.nan
        xi[3::11, 1] = np.inf
        xi[5::13] = 1e300
    some = rng.integers(count, size=200)
    single = np.concatenate([interpolator(position[None]) for position in xi[some]])
    # On an edge, the last bit depends on which of its triangles is found.
    assert np.allclose(interpolator(xi)[some], single, rtol=0, atol=1e-15, equal_nan=True)
    found = interpolator.tri.find_simplex(xi) if kind is not NearestNDInterpolator else None
    if found is not None:
        assert [f >= 0 for f in found[some]] == [interpolator.tri.find_simplex(q) >= 0 for q in xi[some]]


@pytest.mark.parametrize("ndim", [2, 3])
def test_nearest_values_are_those_of_scipy(scipy_interpolate, ndim):
    points, xi = random_points(800, ndim), random_points(9000, ndim, seed=1) * 1.6 - 0.3
    values = values_at(points)
    ours, theirs = NearestNDInterpolator(points, values), scipy_interpolate.NearestNDInterpolator(points, values)
    assert (ours(xi) == theirs(xi)).all()
    bounded = ours(xi, distance_upper_bound=0.02)
    assert np.array_equal(bounded, theirs(xi, distance_upper_bound=0.02), equal_nan=True) and np.isnan(bounded).any()
    assert (ours(xi, workers=-1, eps=0.1, p=2) == theirs(xi)).all()
    with pytest.raises(NotImplementedError, match="Euclidean"):
        ours(xi, p=1)
    with pytest.raises(TypeError, match="unexpected"):
        ours(xi, k=2)


@pytest.mark.parametrize("kind", ALL)
def test_the_value_at_a_point_is_the_given_one(kind):
    values = np.arange(5.0)
    assert (kind(FIVE, values)(FIVE) == values).all()
    assert (kind((FIVE[:, 0], FIVE[:, 1]), values)(FIVE[:, 0], FIVE[:, 1]) == values).all()
    assert (kind(FIVE, values, rescale=True)(FIVE) == values).all()
    complex_values = values - 3j * values
    interpolated = kind(FIVE, complex_values)(FIVE)
    assert interpolated.dtype == np.complex128 and (interpolated == complex_values).all()


@pytest.mark.parametrize("kind", SMOOTH)
@pytest.mark.parametrize("ndim", [2, 3])
def test_linear_and_constant_functions_are_reproduced(kind, ndim):
    points, xi = random_points(300, ndim), random_points(3000, ndim, seed=2)
    slope = np.array([3.0, -2.0, 0.5][:ndim])
    interpolated = kind(points, points @ slope + 7)(xi)
    inside = ~np.isnan(interpolated)
    assert inside.sum() > 2000 and np.allclose(interpolated[inside], (xi @ slope + 7)[inside], atol=1e-9)
    constant = kind(points, np.full(300, 0.1))(xi)
    assert (constant[inside] == 0.1).all()


@pytest.mark.parametrize("kind", SMOOTH)
def test_values_do_not_exceed_those_of_the_points(kind):
    points, values = random_points(300, 2), np.random.default_rng(4).random(300)
    interpolated = kind(points, values)(random_points(5000, 2, seed=5))
    interpolated = interpolated[~np.isnan(interpolated)]
    assert interpolated.min() >= values.min() and interpolated.max() <= values.max()


def test_natural_neighbors_against_stolen_areas():
    """Sibson's weights by pixels: the nearest point of each pixel, without and with the position."""
    points, values = random_points(12, 2, seed=8), np.random.default_rng(8).random(12)
    side = 1200
    pixels = np.stack(np.meshgrid(*[np.linspace(-1, 2, side)] * 2), axis=-1).reshape(-1, 2)
    distances = ((pixels[:, None] - points) ** 2).sum(axis=2)
    nearest, least = distances.argmin(axis=1), distances.min(axis=1)
    natural = NaturalNeighborInterpolator(points, values)
    for q in ((0.5, 0.5), (0.4, 0.6), (0.55, 0.45)):
        stolen = nearest[((pixels - q) ** 2).sum(axis=1) < least]
        assert len(stolen) > 1000 and abs(natural(*q) - values[stolen].mean()) < 0.01


@pytest.mark.parametrize("ndim", [2, 3])
def test_natural_neighbors_are_the_same_with_any_number_of_threads(ndim):
    points, xi = random_points(500, ndim), random_points(10000, ndim, seed=1)
    one, two = (NaturalNeighborInterpolator(points, values_at(points), threads=threads)(xi) for threads in (1, 2))
    assert np.array_equal(one, two, equal_nan=True)


def test_a_square():
    points, values = np.array([(0, 0), (0, 1), (1, 1), (1, 0)], float), np.array([1.0, 2.0, -3.0, 5.0])
    x, y = (a.ravel() for a in np.meshgrid(*[np.linspace(0, 1, 14)] * 2))
    # One of the two diagonals.
    lower = np.where(x + y <= 1, 1 - x - y + 2 * y + 5 * x, -3 * (x + y - 1) + 2 * (1 - x) + 5 * (1 - y))
    upper = np.where(y >= x, 1 - y + 2 * (y - x) - 3 * x, 1 - x + 5 * (x - y) - 3 * y)
    interpolated = LinearNDInterpolator(points, values)(x, y)
    assert np.allclose(interpolated, lower) or np.allclose(interpolated, upper)


def test_the_hull_belongs_to_the_domain():
    angle = 0.3
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    side = np.stack(np.meshgrid(np.arange(20.0), np.arange(20.0)), axis=-1).reshape(-1, 2)
    rim = np.stack([np.linspace(0, 19, 1000), np.zeros(1000)], axis=1)
    for kind in SMOOTH:
        assert np.allclose(kind(side @ turn, side[:, 0])(rim @ turn), rim[:, 0], atol=1e-9)


@pytest.mark.parametrize("kind", SMOOTH)
def test_fill_values(kind):
    outside, inside = (9.0, 9.0), (0.1, 0.2)
    assert np.isnan(kind(FIVE, np.arange(5.0))(outside)).all()
    assert kind(FIVE, np.arange(5.0), fill_value=-1)(outside) == -1
    assert kind(FIVE, np.arange(5.0), fill_value=-1)(inside) != -1
    assert kind(FIVE, np.arange(5.0) * 1j, fill_value=2 - 3j)(outside) == 2 - 3j
    columns = kind(FIVE, np.ones((5, 3)), -7)([outside, inside])
    assert columns.tolist() == [[-7.0] * 3, [1.0] * 3]
    with pytest.raises(TypeError):
        kind(FIVE, np.arange(5.0), fill_value=1j)


@pytest.mark.parametrize("kind", ALL)
def test_shapes(scipy_interpolate, kind):
    values = np.arange(5 * 2 * 3.0).reshape(5, 2, 3)
    ours = kind(FIVE, values)
    for x, shape in (
        ((0.1, 0.2), ()),
        (([0.1, 0.2],), (1,)),
        (([0.1, 0.2, 0.0, 0.1],), (2,)),
        ((np.zeros((4, 2)),), (4,)),
        ((np.zeros((4, 5, 2)),), (4, 5)),
        ((np.zeros((4, 1)), np.zeros(3)), (4, 3)),
        (((np.zeros(3), np.zeros(3)),), (3,)),
        ((np.zeros((0, 2)),), (0,)),
    ):
        theirs = getattr(scipy_interpolate, kind.__name__, scipy_interpolate.LinearNDInterpolator)(FIVE, values)(*x)
        assert ours(*x).shape == theirs.shape == shape + (2, 3)
    assert kind(FIVE, np.empty((5, 0)))(np.zeros((4, 2))).shape == (4, 0)
    with pytest.raises(ValueError, match="dimensions in xi"):
        ours(np.zeros((4, 3)))
    with pytest.raises(ValueError):
        ours(np.zeros(4), np.zeros(3))


@pytest.mark.parametrize("kind", ALL)
def test_wrong_values(kind):
    for values in (np.arange(4.0), np.arange(6.0), 3.0):
        with pytest.raises(ValueError, match="different number"):
            kind(FIVE, values)
    with pytest.raises(TypeError, match="numbers"):
        kind(FIVE, np.array(list("abcde")))
    with pytest.raises(ValueError, match="masked"):
        kind(np.ma.masked_all((5, 2)), np.arange(5.0))
    with pytest.raises(ValueError, match="NaN"):
        kind(np.where(FIVE == 0.3, np.nan, FIVE), np.arange(5.0))


@pytest.mark.parametrize("kind", SMOOTH)
def test_values_that_are_not_numbers_stay_where_they_have_weight(kind):
    points = np.array([[0, 0], [4, 0], [4, 4], [0, 4], [2, 2]], float)
    interpolator = kind(points, [np.nan, 1.0, 1.0, 1.0, 2.0])
    assert np.isnan(interpolator([[1.0, 0.5]]))[0]
    assert interpolator([[2.0, 2.0]]) == [2.0]
    assert np.isnan(interpolator([[0.0, 0.0]]))[0]
    assert np.isfinite(interpolator([[4.0, 1.0]]))[0], "on the hull, between two finite ones"


@pytest.mark.parametrize("kind", SMOOTH)
def test_positions_that_are_not_numbers_are_outside(kind):
    xi = np.array([[np.nan, 0.1], [0.1, np.inf], [0.1, 0.2]])
    for times in (1, 100):
        interpolated = kind(FIVE, np.ones(5), fill_value=-9)(np.tile(xi, (times, 1)))
        assert interpolated.tolist() == [-9.0, -9.0, 1.0] * times


def test_positions_that_are_not_numbers_have_no_nearest_point():
    with pytest.raises(ValueError, match="finite"):
        NearestNDInterpolator(FIVE, np.ones(5))([[0.1, 0.2], [np.nan, 0.1]])


@pytest.mark.parametrize("kind", ALL)
def test_a_triangulation_as_input(kind):
    tri = Delaunay(FIVE, incremental=True)
    interpolator = kind(tri, np.arange(5.0))
    assert interpolator.tri is tri and (interpolator(FIVE) == np.arange(5.0)).all()
    with pytest.raises(ValueError, match="Rescaling is not supported"):
        kind(tri, np.arange(5.0), rescale=True)
    tri.add_points([[0.1, 0.1]])
    with pytest.raises(ValueError, match="different number"):
        interpolator(FIVE)


@pytest.mark.parametrize("kind", ALL)
def test_rescaling(scipy_interpolate, kind):
    points = random_points(200, 2) * [1.0, 1000.0] + [5.0, -70.0]
    xi = random_points(1000, 2, seed=3) * [1.0, 1000.0] + [5.0, -70.0]
    theirs = getattr(scipy_interpolate, kind.__name__, None)
    ours = kind(points, points[:, 0], rescale=True)(xi)
    if theirs:
        assert np.allclose(ours, theirs(points, points[:, 0], rescale=True)(xi), equal_nan=True)
    elif kind is NaturalNeighborInterpolator:
        inside = ~np.isnan(ours)
        assert np.allclose(ours[inside], xi[inside, 0])


@pytest.mark.parametrize("kind", ALL)
def test_pickling(kind):
    interpolator = kind(FIVE, np.arange(5) * (1 + 2j), rescale=True)
    copy = pickle.loads(pickle.dumps(interpolator))
    assert copy(0.1, 0.2) == interpolator(0.1, 0.2)


def test_nearest_of_points_that_span_nothing():
    assert NearestNDInterpolator([[1.0, 2.0]], [7.0])(5.0, 5.0) == 7.0
    line = np.stack([np.arange(5.0)] * 2, axis=1)
    assert NearestNDInterpolator(line, np.arange(5.0))([[3.2, 3.1], [99.0, 0.0]]).tolist() == [3.0, 4.0]
    with pytest.raises(ValueError, match="no points"):
        NearestNDInterpolator(np.zeros((0, 2)), [])
    for kind in SMOOTH:
        with pytest.raises(QhullError):
            kind(line, np.arange(5.0))


def test_of_equal_points_the_first_counts():
    points = np.concatenate([FIVE, FIVE])
    for kind in ALL:
        assert (kind(points, np.arange(10.0))(FIVE) == np.arange(5.0)).all()


def test_ties_of_the_nearest_point():
    """Of several nearest points the one with the smallest coordinates."""
    points = np.array([[1, 1], [0, 1], [1, 0], [0, 0]], float)
    assert NearestNDInterpolator(points, np.arange(4.0))(0.5, 0.5) == 3.0


def test_a_grid_of_queries_over_a_grid_of_points():
    side = np.arange(40.0)
    x, y = np.meshgrid(side, side)
    fine = np.linspace(0, 39, 118)
    for kind in ALL:
        interpolator = kind((x.ravel(), y.ravel()), (2 * x + y).ravel())
        interpolated = interpolator(*np.meshgrid(fine, fine))
        if kind is not NearestNDInterpolator:
            assert np.allclose(interpolated, 2 * fine + fine[:, None])
        else:
            assert np.isfinite(interpolated).all()


@pytest.mark.parametrize("kind", ALL)
def test_eight_threads_at_once(kind):
    points, xi = random_points(2000, 2), random_points(5000, 2, seed=1)
    interpolator = kind(points, values_at(points))
    expected = interpolator(xi)
    results = [None] * 8

    def work(k):
        for _ in range(2):
            results[k] = interpolator(xi)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(result, expected, equal_nan=True) for result in results)


def test_what_is_absent_says_why():
    with pytest.raises(AttributeError, match="no tree"):
        NearestNDInterpolator(FIVE, np.arange(5.0)).tree
    with pytest.raises(NotImplementedError, match="tree"):
        NearestNDInterpolator(FIVE, np.arange(5.0), tree_options={"leafsize": 4})
