"""Surfaces of chosen returns, from arrays, objects and files."""

from types import SimpleNamespace

import breakline
import numpy as np
import pytest

SIDE = np.arange(8.0)


def forest():
    """Ground 10 m high, trees of 20 m on half of it as first returns, and a bird."""
    x, y = (axis.ravel() for axis in np.meshgrid(SIDE, SIDE))
    wood = x >= 4
    axes = [np.concatenate([axis, axis[wood], [3.5]]) for axis in (x, y)]
    z = np.concatenate([np.full(64, 10.0), np.full(32, 20.0), [200.0]])
    number = np.concatenate([np.where(wood, 2, 1), np.full(32, 1), [1]])
    count = np.concatenate([np.where(wood, 2, 1), np.full(32, 2), [1]])
    classes = np.concatenate([np.full(64, 2), np.full(32, 5), [18]])
    return {
        "X": axes[0], "Y": axes[1], "Z": z, "Classification": classes,
        "ReturnNumber": number, "NumberOfReturns": count,
    }  # fmt: skip


@pytest.mark.filterwarnings("ignore::breakline.BreaklineWarning")
def test_first_returns_are_a_surface_model():
    points = forest()
    surface = breakline.tin(points, returns="first")
    assert surface.report["points_used"] == 64 and surface.report["points_of_other_returns"] == 32
    assert surface.vertices[:, 2].max() == 20 and surface.report["points_of_other_classes"] == 1
    ground = breakline.tin(points)
    assert ground.report["points_used"] == 64 and ground.vertices[:, 2].max() == 10
    for words, used in [("last", 64), ("single", 32), ([1, 2], 96), ("1-15", 96), ("all", 64)]:
        assert breakline.tin(points, returns=words).report["points_used"] == used, words
    for classes in ("all", "0-255", range(256)):
        assert breakline.tin(points, returns="first", classes=classes).report["points_used"] == 65
    with pytest.raises(breakline.UsageError):
        breakline.tin(points, returns="second")
    with pytest.raises(breakline.UsageError):
        breakline.tin(points, classes="2-1")


def test_points_without_returns_are_a_warning():
    points = forest()
    del points["NumberOfReturns"]
    with pytest.warns(breakline.BreaklineWarning, match="97 points do not say which return they are"):
        breakline.tin(points, returns="first")


@pytest.mark.filterwarnings("ignore::breakline.BreaklineWarning")
def test_points_that_were_read_keep_their_returns(valley):
    points = forest()
    columns = breakline.Points(
        points["X"], points["Y"], points["Z"],
        classification=points["Classification"].astype(np.uint8),
        return_number=points["ReturnNumber"].astype(np.uint8),
        number_of_returns=points["NumberOfReturns"].astype(np.uint8),
    )  # fmt: skip
    assert breakline.tin(columns, returns="first").report["points_used"] == 64
    record = SimpleNamespace(
        header=SimpleNamespace(scales=[0.5] * 3, offsets=[0.0] * 3),
        **{axis: (2 * points[axis]).astype(np.int32) for axis in "XYZ"},
        classification=points["Classification"], return_number=points["ReturnNumber"],
        number_of_returns=points["NumberOfReturns"],
    )  # fmt: skip
    assert breakline.tin(record, returns="last").report["points_used"] == 64
