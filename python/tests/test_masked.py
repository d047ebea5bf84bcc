"""Masked arrays: all functions leave masked rows out, and count them in a warning."""

import breakline
import numpy as np
import pytest
from breakline import spatial, triangle
from conftest import FIXTURES, judge

#: Ten points, of which rows 3 and 7 are wrong, and masked where a test says so.
POINTS = np.random.default_rng(3).random((10, 3)) * 10
WRONG = [3, 7]
POINTS[WRONG] = -9999.0
RIGHT = np.delete(POINTS, WRONG, axis=0)
MASKED = np.ma.masked_equal(POINTS, -9999.0)
PARTLY = np.ma.array(POINTS, mask=np.isin(np.arange(30).reshape(10, 3), [9, 22]))  # one number of each row


def counted(text="2 of 10 points are masked, and left out"):
    return pytest.warns(breakline.BreaklineWarning, match=text)


@pytest.mark.parametrize("masked", [MASKED, PARTLY, list(PARTLY), dict(zip("xyz", PARTLY.T))])
def test_points_of_a_surface(masked):
    with counted() as caught:
        tin = breakline.tin(masked, max_edge="none")
    assert caught[0].filename == __file__
    assert np.array_equal(tin.vertices, breakline.tin(RIGHT, max_edge="none").vertices)
    assert tin.report["masked_rows"] == 2
    with counted():
        assert breakline.dem(masked, max_edge="none").shape == breakline.dem(RIGHT, max_edge="none").shape
    with counted():
        assert len(breakline.contour(masked, max_edge="none")) == len(breakline.contour(RIGHT, max_edge="none"))
    assert breakline.tin(RIGHT).report["masked_rows"] == 0
    assert breakline.tin(np.ma.array(RIGHT)).report["masked_rows"] == 0, "nothing is masked"


def test_points_with_masked_classes_and_in_structured_arrays():
    columns = dict(zip("xyz", POINTS.T), classification=np.ma.array(np.full(10, 2), mask=POINTS[:, 0] < 0))
    with counted():
        assert len(breakline.tin(columns, max_edge="none").vertices) == 8
    records = np.ma.array(list(map(tuple, POINTS)), dtype=[(axis, float) for axis in "xyz"])
    records.mask[WRONG] = (False, True, False)
    with counted():
        assert len(breakline.tin(records, max_edge="none").vertices) == 8


def test_vertices_of_lines():
    line = np.ma.array([[0, 5, 1], [5, -9999, 9], [10, 5, 1]], float)
    line[1, 1] = np.ma.masked
    square = np.array([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]], float)
    with counted("1 of 3 vertices of breaklines are masked"):
        tin = breakline.tin(square, breaklines=line)
    assert np.array_equal(tin.vertices, breakline.tin(square, breaklines=[line.data[[0, 2]]]).vertices)
    assert tin.report["masked_rows"] == 1
    with counted("1 of 5 vertices of boundary are masked"):
        ring = np.ma.array([[1, 1], [9, 1], [99, 99], [9, 9], [1, 9]], float, mask=np.arange(10).reshape(5, 2) == 4)
        clipped = breakline.tin(square, boundary=ring)
    assert clipped.bounds == (1, 1, 9, 9)


def test_positions():
    xi = np.ma.array([[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]], mask=[[0, 0], [0, 1], [0, 0]])
    square = np.array([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]], float)
    for function in (
        breakline.tin(square).elevation,
        *(kind(square[:, :2], square[:, 2]) for kind in (
            spatial.LinearNDInterpolator, spatial.NaturalNeighborInterpolator, spatial.NearestNDInterpolator
        )),
    ):
        with counted("1 of 3 positions are masked, and have no value"):
            values = function(xi)
        assert type(values) is np.ndarray and np.isnan(values).tolist() == [False, True, False]
        if not hasattr(function, "__self__"):
            with counted("1 of 3 positions"):
                assert np.array_equal(function(xi[:, 0], xi[:, 1]), values, equal_nan=True)
    with counted("1 of 3 positions"):
        assert (spatial.Delaunay(square[:, :2]).find_simplex(xi) >= 0).tolist() == [True, False, True]


@pytest.mark.parametrize("ndim", [2, 3])
def test_drop_ins_of_scipy(ndim):
    with counted():
        tri = spatial.Delaunay(MASKED[:, :ndim], incremental=True)
    assert np.array_equal(tri.points, RIGHT[:, :ndim]) and tri.npoints == 8
    with counted("1 of 2 points"):
        tri.add_points(MASKED[2:4, :ndim])
    assert tri.npoints == 9
    values = np.arange(10.0)
    for kind in (spatial.LinearNDInterpolator, spatial.NaturalNeighborInterpolator, spatial.NearestNDInterpolator):
        with counted():
            assert np.array_equal(kind(MASKED[:, :ndim], values)(RIGHT[:, :ndim]), np.delete(values, WRONG))
        with counted():
            of_values = kind(POINTS[:, :ndim], np.ma.array(values, mask=POINTS[:, 0] < 0))
        assert np.array_equal(of_values(RIGHT[:, :ndim]), np.delete(values, WRONG))
        with counted():
            kind(tuple(PARTLY.T[:ndim]), np.ma.array(values, mask=np.isin(values, WRONG)))
        with pytest.raises(ValueError, match="masked"):
            kind(spatial.Delaunay(POINTS[:, :ndim]), np.ma.array(values, mask=values == 1))


def test_the_drop_in_of_triangle():
    vertices = np.ma.array([[0, 0], [4, 0], [9, 9], [4, 4], [0, 4]], float, mask=np.arange(10).reshape(5, 2) == 5)
    graph = {
        "vertices": vertices,
        "vertex_markers": [1, 2, 3, 4, 5],
        "vertex_attributes": [[0.0], [1.0], [2.0], [3.0], [4.0]],
        "segments": [[0, 1], [1, 2], [1, 3], [3, 4], [4, 0], [0, 3]],
        "segment_markers": [11, 12, 13, 14, 15, 16],
    }
    with counted("1 of 5 vertices are masked"):
        mesh = triangle.triangulate(graph, "p")
    assert mesh["vertices"].tolist() == [[0, 0], [4, 0], [4, 4], [0, 4]]
    assert mesh["vertex_markers"].ravel().tolist() == [1, 2, 4, 5]
    assert mesh["vertex_attributes"].ravel().tolist() == [0, 1, 3, 4]
    ends = {tuple(sorted(ends)) for ends in mesh["segments"].tolist()}
    assert ends == {(0, 1), (1, 2), (2, 3), (0, 3), (0, 2)} and len(mesh["triangles"]) == 2
    holes = np.ma.array([[1.0, 3.0], [3.0, 1.0]], mask=[[0, 0], [1, 1]])
    with counted("1 of 2 holes are masked"), pytest.warns(breakline.BreaklineWarning, match="1 of 5 vertices"):
        assert len(triangle.triangulate({**graph, "holes": holes}, "p")["triangles"]) == 1


def test_cells_of_a_raster():
    raster = breakline.tin([[0, 0, 0], [10, 0, 10], [10, 10, 10], [0, 10, 0]]).dem(1.0)
    array = raster.array.copy()
    array[2:4, 5] = -9999.0
    masked = breakline.Raster(np.ma.masked_equal(array, -9999.0), raster.transform)
    holed = breakline.Raster(np.where(array < 0, np.nan, array), raster.transform)
    assert np.array_equal(masked.contours(3).coordinates, holed.contours(3).coordinates)
    with counted("1 of 2 levels are masked"):
        levels = raster.contours(levels=np.ma.array([2.0, 5.0], mask=[0, 1])).levels
    assert set(levels) == {2.0}


@pytest.mark.parametrize(
    "call",
    [
        lambda: breakline.tin(np.ma.masked_all((4, 3))),
        lambda: spatial.Delaunay(np.ma.masked_all((4, 2))),
        lambda: spatial.LinearNDInterpolator(POINTS, np.ma.masked_all(10)),
        lambda: triangle.triangulate({"vertices": np.ma.masked_all((4, 2))}),
    ],
)
def test_where_all_rows_are_masked(call):
    with pytest.raises(ValueError, match="all .* are masked"):
        call()


def test_whole_steps_of_las_without_their_scale():
    laspy = judge("laspy")
    las = laspy.read(FIXTURES / "valley.laz")
    expected = breakline.tin(las)
    assert np.array_equal(breakline.tin(las.points).vertices, expected.vertices)
    for bare in (las.points.array, {axis: las.points.array[axis] for axis in "XYZ"}, [las.points.array]):
        with pytest.raises(ValueError, match="whole steps") as caught:
            breakline.tin(bare)
        assert "las.points" in caught.value.cure
    meters = {axis: np.array([0, 10, 0]) for axis in "XYZ"}
    meters["Y"] = np.array([0, 0, 10])
    assert len(breakline.tin(meters).triangles) == 1, "whole numbers of other types are coordinates"
    with pytest.raises(ValueError, match="columns X and x"):
        breakline.tin({**meters, "x": np.array([0.0, 1.0, 0.0])})
