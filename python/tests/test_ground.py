"""The ground among points, of arrays and of files."""

from pathlib import Path

import breakline
import numpy as np
import pytest

VALLEY = Path(__file__).parents[2] / "fixtures" / "valley.laz"


def town():
    """Points a meter apart on a slope, with a house in the middle; and which of them are on its roof."""
    x, y = (axis.ravel().astype(float) for axis in np.mgrid[0:60, 0:50])
    house = (x >= 25) & (x < 35) & (y >= 20) & (y < 30)
    return np.column_stack([x, y, 100 + 0.1 * x + np.where(house, 6.0, 0.0)]), house


def test_classes_of_an_array_are_those_of_the_order_of_its_points():
    points, house = town()
    classes = breakline.ground(points)
    assert classes.dtype == np.uint8 and classes.shape == (len(points),)
    assert (classes[house] == 1).all() and (classes[~house] == 2).all()
    order = np.random.default_rng(7).permutation(len(points))
    assert (breakline.ground(points[order], threads=1) == classes[order]).all()
    # The same points in feet.
    feet = breakline.ground(points / (1200 / 3937), crs="EPSG:2264")
    assert (feet == classes).all()
    assert (breakline.ground(points[:0]) == np.zeros(0)).all()


def test_a_surface_of_the_ground_has_no_house():
    points, house = town()
    tin = breakline.tin(points, ground=True, max_edge="none")
    assert len(tin.vertices) == np.count_nonzero(~house)
    assert tin.elevation([[30, 25]])[0] == pytest.approx(103, abs=1e-9)


def test_files_get_classes_and_are_counted(tmp_path):
    report = breakline.ground(VALLEY, tmp_path / "a.laz", from_class="all")
    (file,) = report["files"]
    before = breakline.read_points(VALLEY).classification
    after = breakline.read_points(tmp_path / "a.laz").classification
    assert file["points"] == len(before) == len(after)
    for counts, classes in ((file["before"], before), (file["after"], after)):
        assert counts == {int(c): int(n) for c, n in zip(*np.unique(classes, return_counts=True))}
    with pytest.raises(breakline.FileKeptError):
        breakline.ground([VALLEY], tmp_path / "a.laz")
    breakline.ground([VALLEY], tmp_path / "a.laz", from_class=255, overwrite=True)
    assert (breakline.read_points(tmp_path / "a.laz").classification == before).all()


@pytest.mark.parametrize(
    "points, given, text",
    [
        ([[0, 0, 1]], {"output": "a.las"}, "output is for files"),
        ([[0, 0, 1]], {"from_class": 2}, "from_class is for files"),
        ([[0, 0]], {}, "shape"),
        ([[0, 0, 1]], {"bridges": "up"}, "off, ground"),
        (VALLEY, {}, "output is missing"),
    ],
)
def test_what_makes_no_sense_is_refused(points, given, text):
    with pytest.raises(breakline.UsageError, match=text):
        breakline.ground(points, **given)
