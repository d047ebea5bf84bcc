"""Fewer points of files."""

from pathlib import Path

import breakline
import numpy as np
import pytest

VALLEY = Path(__file__).parents[2] / "fixtures" / "valley.laz"


def rows(points):
    """Return the positions of points, one in a row."""
    return np.column_stack([points.x, points.y, points.z])


def test_columns_and_files_are_thinned_alike(tmp_path):
    whole = rows(breakline.read_points(VALLEY, classes=2))
    for thin, more in [
        ("grid:5", {}), ("grid:5", {"thin_keep": "lowest"}), ("poisson:4", {"seed": 3}), ("nth:100", {}),
        ("random:0.01", {"seed": 2**63}),
    ]:  # fmt: skip
        found = rows(breakline.read_points(VALLEY, classes=2, thin=thin, **more))
        path = tmp_path / "thin.laz"
        report = breakline.points(VALLEY, path, classes=2, thin=thin, overwrite=True, **more)
        assert report["written"] == len(found) and report["thinned"] == len(whole) - len(found) > 0
        assert (rows(breakline.read_points(path)) == found).all()
    assert (rows(breakline.read_points(VALLEY, classes=2, thin="nth:100")) == whole[::100]).all()


def test_a_cell_keeps_its_lowest_point():
    whole = rows(breakline.read_points(VALLEY))
    found = rows(breakline.read_points(VALLEY, thin="grid:10", thin_keep="lowest"))
    lowest = {}
    for cell, z in zip(map(tuple, np.floor(whole[:, :2] / 10)), whole[:, 2]):
        lowest[cell] = min(z, lowest.get(cell, np.inf))
    assert {tuple(np.floor(p[:2] / 10)): p[2] for p in found} == lowest and len(found) == len(lowest)


@pytest.mark.parametrize(
    "arguments",
    [
        {"thin": "grid:0"}, {"thin": "nth:1.5"}, {"thin": "all"}, {"thin": 3}, {"seed": 3}, {"thin_keep": "lowest"},
        {"thin": "grid:1", "thin_keep": "nearest"}, {"thin": "nth:2", "seed": 1}, {"thin": "random:1", "seed": -1},
        {"thin": "poisson:1", "thin_keep": "lowest"}, {"thin": "grid:1e-9"},
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused(tmp_path, arguments):
    with pytest.raises(breakline.BreaklineError):
        breakline.points(VALLEY, tmp_path / "thin.laz", **arguments)
    assert not list(tmp_path.iterdir())
