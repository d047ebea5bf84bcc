"""Breakline among other packages: lines and points of all kinds go in, results are what these packages expect."""

import json
import pickle

import breakline
import numpy as np
import pytest
from breakline.spatial import Delaunay
from conftest import judge

SQUARE = [[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]
RIDGE = [[2, 5, 9], [8, 5, 9]]
POOL = [[4, 7, 2], [6, 7, 2], [6, 8, 2], [4, 7, 2]]


@pytest.fixture
def square():
    return breakline.tin(SQUARE, max_edge="none")


def with_lines(lines):
    return breakline.tin(SQUARE, breaklines=lines, max_edge="none").elevation([[5, 5], [5, 2.5]]).tolist()


def test_lines_of_all_kinds_give_one_surface():
    shapely, geopandas = judge("shapely"), judge("geopandas")
    expected = with_lines([RIDGE])
    line = shapely.LineString(RIDGE)
    feature = {"type": "Feature", "properties": {"name": "ridge", "n": 1}, "geometry": line.__geo_interface__}
    series = geopandas.GeoSeries([line])
    for lines in (
        line,
        [line],
        np.array([line], object),
        series,
        series.values,
        geopandas.GeoDataFrame({"n": [1]}, geometry=series),
        feature,
        line.__geo_interface__,
        {"type": "FeatureCollection", "features": [feature, {**feature, "geometry": None}]},
        json.loads(series.to_json()),
    ):
        assert with_lines(lines) == expected, type(lines)
    with pytest.raises(ValueError, match="GeoJSON"):
        with_lines({"type": "Nothing"})
    with pytest.raises(ValueError, match="lines and polygons"):
        with_lines(np.array([shapely.Point(1, 2, 3)], object))


def test_properties_of_features_are_attributes():
    judge("shapely")
    ring = {"type": "Polygon", "coordinates": [[[2, 2], [4, 2], [4, 4], [2, 2]]]}
    features = [{"type": "Feature", "properties": {"z": 0.5, "name": "lake"}, "geometry": ring}]
    lakes = {"type": "FeatureCollection", "features": features}
    tin = breakline.tin(SQUARE, flat=lakes, flat_height="z", max_edge="none")
    assert tin.elevation([3.5, 2.5]) == 0.5


def test_contours_are_lines_with_heights(square):
    contours = square.contours(0.5)
    again = breakline.tin(SQUARE, breaklines=contours, max_edge="none")
    assert again.elevation([[5, 2.5], [3, 7.5]]).tolist() == [1.5, 2.5]
    assert again.report["breaklines"] == len(contours) == 3


def test_columns_that_know_missing_values():
    pandas, pyarrow = judge("pandas"), judge("pyarrow")
    columns = {name: [row[axis] for row in SQUARE] for axis, name in enumerate("xyz")}
    expected = breakline.tin(SQUARE, max_edge="none").vertices
    for frame in (
        pandas.DataFrame(columns, dtype="Float64"),
        pandas.DataFrame(columns, dtype="Int64"),
        pandas.DataFrame(columns, dtype="double[pyarrow]"),
        pyarrow.table(columns),
        pyarrow.record_batch(columns),
    ):
        assert np.array_equal(breakline.tin(frame, max_edge="none").vertices, expected), type(frame)
    more = {name: [*values, None] for name, values in columns.items()}
    more = {**more, "x": [*columns["x"], 7.0], "y": [*columns["y"], 7.0]}
    for frame in (pandas.DataFrame(more).astype("Float64"), pyarrow.table(more)):
        with pytest.warns(breakline.BreaklineWarning, match="1 of 5 points are masked"):
            tin = breakline.tin(frame, max_edge="none")
        assert np.array_equal(tin.vertices, expected) and tin.report["masked_rows"] == 1


def test_what_is_no_geojson_is_named_with_its_place():
    judge("shapely")
    line = {"type": "LineString", "coordinates": RIDGE}
    feature = {"type": "Feature", "properties": {}, "geometry": line}

    class Odd:
        def __init__(self, interface):
            self.__geo_interface__ = interface

    def collection(*features, **members):
        return {"type": "FeatureCollection", "features": list(features), **members}

    for lines, message in (
        ({"type": "FeatureCollection"}, "no list of features"),
        ({"type": "FeatureCollection", "features": None}, "no list of features"),
        ({"type": "FeatureCollection", "features": {"a": 1}}, "no list of features"),
        (collection(feature, None), "feature 1: .* none of GeoJSON"),
        (collection(feature, {**feature, "geometry": "line"}), "feature 1: .* geometry of GeoJSON"),
        (collection({**feature, "properties": [1]}), "feature 0: .* properties of GeoJSON"),
        (collection(feature, crs="EPSG:25832"), "crs of GeoJSON"),
        (collection(feature, crs={"properties": {"name": 25832}}), "name of the crs"),
        (Odd("line"), "__geo_interface__"),
        (Odd({}), "__geo_interface__"),
        (np.array([None, 5], object), "row 1: .* no geometry"),
    ):
        with pytest.raises(breakline.UsageError, match=message) as caught:
            with_lines(lines)
        assert caught.value.cure, message
    # What is not used as heights may be as it likes.
    assert with_lines(collection({**feature, "properties": {"n": 10**400}})) == with_lines(line)


def test_columns_that_are_no_numbers_are_named():
    pyarrow = judge("pyarrow")
    columns = {name: [float(row[axis]) for row in SQUARE] for axis, name in enumerate("xyz")}
    for heights, message in (
        (pyarrow.array(["1", "2", "3", None]), "column z has the type"),
        (pyarrow.array([[1.0], [2.0], [3.0], None]), "column z has the type"),
        (pyarrow.array([{"a": 1.0}, None, None, None]), "column z has the type"),
        (pyarrow.nulls(4), "all 4 points are masked"),
    ):
        with pytest.raises(breakline.UsageError, match=message):
            breakline.tin(pyarrow.table({**columns, "z": heights}))
    with pytest.raises(breakline.UsageError, match="all 4 points are masked"):
        breakline.tin(pyarrow.table({**columns, "class": pyarrow.nulls(4)}))
    for odd in ({"x": 1.0, "y": 2.0, "z": 3.0}, dict.fromkeys("xyz", np.ones((4, 3)))):
        with pytest.raises(breakline.UsageError, match="column x of points has the shape"):
            breakline.tin(odd)


def test_a_surface_of_lines_alone(tmp_path):
    expected = breakline.tin(np.empty((0, 3)), breaklines=[SQUARE], max_edge="none").vertices
    for none in ([], ()):
        assert np.array_equal(breakline.tin(none, breaklines=[SQUARE], max_edge="none").vertices, expected)
    breakline.dem([], breaklines=[SQUARE], max_edge="none", resolution=1, output=tmp_path / "dem.tif")
    with pytest.raises(breakline.FormatError, match="no points"):
        breakline.tin([])


@pytest.mark.filterwarnings("ignore:.* of the convex hull is left out")
def test_what_is_lost_with_flat_triangles_is_a_warning():
    rails = [[i, (i % 2) * 0.04 - 300, i] for i in range(40)]
    field = [[2 * (i % 20) + i // 20 % 3, 2 * (i // 20), 7] for i in range(400)]
    with pytest.warns(breakline.BreaklineWarning, match="left out at the rim.*all triangles of 40 points .keep them with max_edge="):
        breakline.tin([*rails, *field])


def test_vertices_know_their_rows():
    points = np.array([[5, 5, 2], [0, 0, 1], [10, 0, 1], [0, 0, 0.5], [10, 10, 3], [0, 10, 3], [0, 0, 0.5]], float)
    tin = breakline.tin(points, breaklines=[[[2, 3, 9], [8, 3, 9]]], max_edge="none")
    rows = tin.point_index(points)
    assert sorted(rows.tolist()) == [-1, -1, 0, 2, 3, 4, 5]
    assert np.array_equal(points[rows[rows >= 0]], tin.vertices[rows >= 0])
    assert np.array_equal(tin.point_index([points[:4], points[4:]]), rows), "rows of several inputs are counted on"
    masked = np.ma.array(np.concatenate([points[:1], points]))
    masked[0] = np.ma.masked
    with pytest.warns(breakline.BreaklineWarning, match="masked"):
        assert np.array_equal(tin.point_index(masked), np.where(rows < 0, -1, rows + 1))
    with pytest.raises(ValueError, match="read_points"):
        tin.point_index("valley.laz")


def test_results_are_compared_by_their_content(square):
    dem, contours, points = square.dem(1), square.contours(0.5), breakline.Points(*np.transpose(SQUARE))
    for one, other, different in (
        (dem, square.dem(1), square.dem(2)),
        (dem, square.dem(1), square.hillshade(1)),
        (contours, square.contours(0.5), square.contours(1.0)),
        (contours[0], square.contours(0.5)[0], contours[1]),
        (points, breakline.Points(*np.transpose(SQUARE)), breakline.Points(*np.transpose(SQUARE[:3]))),
        (breakline.Flaw("a", np.ones((2, 2))), breakline.Flaw("a", np.ones((2, 2))), breakline.Flaw("b", np.ones(2))),
        (square.notices, square.notices, None),
    ):
        assert one == other and not one != other
        assert one != different and not one == different
        assert one != "something else" and one in [other]
    assert pickle.loads(pickle.dumps(dem)) == dem
    outside = breakline.Raster(np.full((2, 2), np.nan), dem.transform)
    assert outside == breakline.Raster(np.full((2, 2), np.nan), dem.transform), "NaN equals NaN"


def test_a_raster_is_an_array(square):
    dem = square.dem(5)
    assert np.array_equal(np.asarray(dem), dem.array) and np.nanmax(dem) == 2.5
    assert np.asarray(dem, float).dtype == np.float64
    masked = breakline.Raster(np.ma.masked_greater(dem.array, 2), dem.transform)
    assert np.isnan(np.asarray(masked)).sum() == 2


def test_xarray_knows_what_no_value_is(square):
    judge("xarray")
    heights, shades = square.dem(5).to_xarray(), square.hillshade(5).to_xarray()
    assert np.isnan(heights.attrs["_FillValue"]) and heights.attrs["_FillValue"].dtype == np.float32
    assert shades.attrs["_FillValue"] == 0 and shades.attrs["_FillValue"].dtype == np.uint8
    assert (heights.name, shades.name, square.dem(5).to_xarray("z").name) == ("elevation", "hillshade", "z")


def test_plots(square):
    matplotlib = judge("matplotlib")
    matplotlib.use("agg")
    for drawn in (square, square.dem(1), square.hillshade(1), square.contours(0.5)):
        ax = drawn.plot()
        assert drawn.plot(ax=ax, cmap="terrain") is ax
        ax.figure.canvas.draw()
        assert ax.get_aspect() == 1.0
    left, right, bottom, top = square.dem(1).plot().images[0].get_extent()
    assert (left, bottom, right, top) == square.dem(1).bounds


def test_triangles_as_polygons(square):
    judge("geopandas")
    frame = square.to_geopandas()
    assert len(frame) == 2 and frame.geometry.has_z.all() and frame.area.sum() == 100.0
    assert frame.geometry[0].exterior.coords[0] == tuple(square.vertices[square.triangles[0, 0]])


def test_notebooks_show_thumbnails(square):
    for shown in (square, square.dem(1), square.hillshade(1)):
        page = shown._repr_html_()
        assert "data:image/png;base64," in page and page.startswith("<div>"), shown
    rotated = breakline.Raster(np.zeros((2, 2), np.int16), square.dem(5).transform)
    assert rotated._repr_html_().startswith("<div>"), "what has no picture has text"


def test_types_are_complete():
    api = judge("mypy.api")
    import pathlib

    project = pathlib.Path(__file__).resolve().parents[1]
    out, err, status = api.run(["--config-file", str(project / "pyproject.toml"), str(project / "package" / "breakline")])
    assert status == 0, out + err


def test_rows_are_counted_from_0():
    points = np.array([[0, 0, 1], [10, 0, 1], [10, np.nan, 3], [0, 10, 3]])
    for build in (breakline.tin, lambda points: Delaunay(points[:, :2])):
        with pytest.raises(ValueError) as refused:
            build(points)
        assert refused.value.location == "row 2"
    masked = np.ma.array(points)
    masked[0] = np.ma.masked
    with pytest.warns(breakline.BreaklineWarning, match="masked"), pytest.raises(ValueError) as refused:
        breakline.tin(masked)
    assert refused.value.location == "row 2", "of the rows that were given"
    # Too large for the arithmetic: the row is that of all points, whatever their classes.
    columns = dict(zip("xyz", np.array(SQUARE + [[1e200, 0, 0]], float).T), classification=[5, 2, 2, 2, 2])
    with pytest.raises(breakline.LimitError, match="1e200") as refused:
        breakline.tin(columns, classes=2)
    assert refused.value.location == "row 4"
