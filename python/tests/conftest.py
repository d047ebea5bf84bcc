"""What the tests share: the valley of the repository, and judges that may be absent."""

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
