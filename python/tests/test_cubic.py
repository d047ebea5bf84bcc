"""`CloughTocher2DInterpolator` against scipy."""

import pickle

import numpy as np
import pytest
from conftest import random_points

from breakline.spatial import CloughTocher2DInterpolator, Delaunay, GradientEstimationWarning


def franke(x, y):
    """Franke's function, by which methods for scattered data are compared."""
    return (
        0.75 * np.exp(-((9 * x - 2) ** 2 + (9 * y - 2) ** 2) / 4)
        + 0.75 * np.exp(-((9 * x + 1) ** 2) / 49 - (9 * y + 1) / 10)
        + 0.5 * np.exp(-((9 * x - 7) ** 2 + (9 * y - 3) ** 2) / 4)
        - 0.2 * np.exp(-((9 * x - 4) ** 2) - (9 * y - 7) ** 2)
    )


@pytest.mark.parametrize("count", [3, 4, 10, 100, 3000])
@pytest.mark.parametrize("threads", [1, 2])
def test_values_and_gradients_are_those_of_scipy(scipy_interpolate, count, threads):
    points, xi = random_points(count), random_points(5000, seed=1) * 1.2 - 0.1
    values = franke(*points.T)
    ours = CloughTocher2DInterpolator(points, values, threads=threads)
    theirs = scipy_interpolate.CloughTocher2DInterpolator(points, values)
    assert ours.grad.shape == theirs.grad.shape and np.allclose(ours.grad, theirs.grad, rtol=1e-9, atol=1e-9)
    assert np.allclose(ours(xi), theirs(xi), rtol=1e-9, atol=1e-9, equal_nan=True)
    assert np.isnan(ours(xi)).any()


@pytest.mark.parametrize("count", [33, 100, 1000])
def test_frankes_function(scipy_interpolate, count):
    points, xi = random_points(count, seed=3), random_points(20_000, seed=4)
    values, truth = franke(*points.T), franke(*xi.T)

    def rms(interpolator):
        error = interpolator(points, values)(xi) - truth
        return np.sqrt(np.nanmean(error**2))

    assert rms(CloughTocher2DInterpolator) == pytest.approx(rms(scipy_interpolate.CloughTocher2DInterpolator), rel=1e-9)


def test_values_of_several_columns_and_complex_ones(scipy_interpolate):
    points, xi = random_points(200), random_points(500, seed=1)
    values = np.stack([franke(*points.T), points[:, 0] ** 2, np.ones(200), points.sum(axis=1)], axis=1)
    for given in (values.reshape(200, 2, 2), values[:, :2] + 1j * values[:, 2:]):
        ours = CloughTocher2DInterpolator(points, given, fill_value=-1)
        theirs = scipy_interpolate.CloughTocher2DInterpolator(points, given, fill_value=-1)
        assert ours(xi).shape == theirs(xi).shape and ours(xi).dtype == theirs(xi).dtype
        assert np.allclose(ours(xi), theirs(xi), rtol=1e-9, atol=1e-9)
        assert np.allclose(ours.grad, theirs.grad, rtol=1e-9, atol=1e-9) and ours.grad.shape == theirs.grad.shape


def test_many_positions_have_the_values_of_few():
    """Of many, the elements over all triangles are made first; then all calls use them."""
    points, xi = random_points(500), random_points(5000, seed=1) * 1.2 - 0.1
    values = np.stack([franke(*points.T), points.sum(axis=1)], axis=1)
    ours = CloughTocher2DInterpolator(points, values)
    before = np.concatenate([ours(part) for part in np.array_split(xi, 50)])
    at_once = ours(xi)
    after = np.concatenate([ours(part) for part in np.array_split(xi, 50)])
    assert np.array_equal(before, at_once, equal_nan=True) and np.array_equal(after, at_once, equal_nan=True)


def test_coordinates_come_in_any_form():
    points = random_points(100)
    ours = CloughTocher2DInterpolator(points, franke(*points.T), fill_value=-1)
    x, y = np.meshgrid(np.linspace(-0.1, 1, 23), np.linspace(0, 1.1, 31))
    expected = ours(np.stack([x, y], axis=-1))
    assert expected.shape == (31, 23)
    for args in ((x, y), ((x, y),), (x.tolist(), y), (np.asfortranarray(x), y[:, :1]), (x.T.copy().T, y)):
        assert np.array_equal(ours(*args), expected)
    assert ours(x[0], y[0, 0]).shape == (23,) and ours(x[3, 4], y[3, 4]) == expected[3, 4]


def test_rescaling_and_options(scipy_interpolate):
    points = random_points(300) * [1.0, 1000.0] + [5.0, -70.0]
    xi = random_points(1000, seed=3) * [1.0, 1000.0] + [5.0, -70.0]
    values = franke(points[:, 0] - 5, points[:, 1] / 1000)
    for options in ({"rescale": True}, {"tol": 1e-3}, {"tol": 1e-12, "maxiter": 1000}):
        ours = CloughTocher2DInterpolator(points, values, **options)(xi)
        theirs = scipy_interpolate.CloughTocher2DInterpolator(points, values, **options)(xi)
        assert np.allclose(ours, theirs, rtol=1e-8, atol=1e-8, equal_nan=True)


def test_rounds_that_are_not_enough_are_a_warning():
    points = random_points(100)
    with pytest.warns(GradientEstimationWarning, match="after maxiter=2 rounds") as caught:
        CloughTocher2DInterpolator(points, franke(*points.T), maxiter=2)
    assert caught[0].filename == __file__
    with pytest.raises(ValueError, match="maxiter"):
        CloughTocher2DInterpolator(points, franke(*points.T), maxiter=-1)


def test_planes_and_constants_are_reproduced():
    points, xi = random_points(300), random_points(2000, seed=2)
    plane = CloughTocher2DInterpolator(points, points @ [3.0, -2.0] + 7, tol=1e-12)(xi)
    inside = ~np.isnan(plane)
    assert inside.sum() > 1800 and np.allclose(plane[inside], (xi @ [3.0, -2.0] + 7)[inside], atol=1e-9)
    assert (CloughTocher2DInterpolator(points, np.full(300, 0.1))(xi)[inside] == 0.1).all()


def test_there_are_no_kinks():
    """A kink across an edge is in proportion to the step; curvature is in proportion to its square."""
    points = random_points(60)
    cubic = CloughTocher2DInterpolator(points, np.random.default_rng(5).random(60))
    tri = cubic.tri

    def bend(at, across):
        left, here, right = cubic([at - across, at, at + across])
        return abs((right - here) - (here - left))

    for i, k in [(i, k) for i in range(tri.nsimplex) for k in range(3) if tri.neighbors[i, k] > i]:
        a, b = points[np.delete(tri.simplices[i], k)]
        across = 1e-5 * np.array([a[1] - b[1], b[0] - a[0]])
        assert bend(0.3 * a + 0.7 * b, across / 8) < bend(0.3 * a + 0.7 * b, across) / 16 + 1e-14


def test_equal_points_and_gradients_there():
    points = np.concatenate([random_points(20), random_points(20)])
    cubic = CloughTocher2DInterpolator(points, np.arange(40.0))
    assert (cubic(points[20:]) == np.arange(20.0)).all() and (cubic.grad[20:] == cubic.grad[:20]).all()


def test_it_is_of_the_plane_only():
    with pytest.raises(ValueError, match="2-D data only"):
        CloughTocher2DInterpolator(np.random.default_rng(0).random((9, 3)), np.arange(9.0))


def test_points_are_added_and_interpolators_pickled():
    tri = Delaunay(random_points(20), incremental=True)
    cubic = CloughTocher2DInterpolator(tri, np.arange(20.0))
    assert cubic.tri is tri
    copy = pickle.loads(pickle.dumps(cubic))
    assert copy(0.5, 0.5) == cubic(0.5, 0.5)
    tri.add_points([[0.1, 0.1]])
    with pytest.raises(ValueError, match="different number"):
        cubic(0.5, 0.5)


def test_many_positions_have_the_values_of_few():
    points, xi = random_points(500), random_points(9000, seed=7)
    cubic = CloughTocher2DInterpolator(points, franke(*points.T))
    many = cubic(xi)
    assert np.array_equal(many[::300], [cubic(*q) for q in xi[::300]], equal_nan=True)
