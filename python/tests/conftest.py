"""What the tests share: the valley of the repository, judges that may be absent, and points."""

import importlib
import pathlib

import breakline
import numpy as np
import pytest

FIXTURES = pathlib.Path(__file__).resolve().parents[2] / "fixtures"

#: Packages that judge, and the names of those that are missing, counted at the end.
_MISSING = {}


def judge(name):
    """Return a package that judges; skip the test by its name if it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        _MISSING[name] = _MISSING.get(name, 0) + 1
        pytest.skip(f"judge {name} is not installed")


@pytest.fixture
def scipy_spatial():
    """What judges triangulations, hulls and diagrams."""
    return judge("scipy.spatial")


@pytest.fixture
def scipy_interpolate():
    """What judges interpolators."""
    return judge("scipy.interpolate")


def random_points(count, ndim=2, seed=0):
    """Return points in the unit square or cube."""
    return np.random.default_rng(seed).random((count, ndim))


def grid(side, ndim):
    """Return all points of an integer grid: every square and cube of it is a tie."""
    return np.stack(np.meshgrid(*[np.arange(side)] * ndim, indexing="ij"), axis=-1).reshape(-1, ndim).astype(float)


def sets_of(simplices):
    """Return the rows of an array as sets, so that their order makes no difference."""
    return {frozenset(simplex) for simplex in simplices.tolist()}


def pytest_terminal_summary(terminalreporter):
    """Name the judges that were missing."""
    for name, count in sorted(_MISSING.items()):
        terminalreporter.write_line(f"judge {name} is missing: {count} tests skipped")


@pytest.fixture(scope="session")
def valley():
    """The valley with its breaklines, clipped to its boundary."""
    return breakline.tin(
        FIXTURES / "valley.laz", breaklines=FIXTURES / "breaklines.shp", boundary=FIXTURES / "boundary.shp"
    )


@pytest.fixture(scope="session")
def ground():
    """The ground points of the valley."""
    return breakline.read_points(FIXTURES / "valley.laz", classes="ground")


@pytest.fixture(scope="session")
def cloud():
    """Ten thousand points on a smooth surface, with coordinates as in a map."""
    random = np.random.default_rng(7)
    x = 600_000 + 1000 * random.random(10_000)
    y = 5_200_000 + 1000 * random.random(10_000)
    return np.column_stack([x, y, 20 * np.sin(x / 90) + 15 * np.cos(y / 70)])
