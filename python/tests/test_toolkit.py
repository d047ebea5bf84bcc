"""Points, surfaces and their products, against the program and other packages."""

import json
import os
import pickle
import subprocess
import sys

import breakline
import numpy as np
import pytest
from conftest import FIXTURES, judge

VALLEY = FIXTURES / "valley.laz"


def program(*arguments):
    """Run the program; return what it prints."""
    run = [sys.executable, "-m", "breakline", *map(os.fspath, arguments)]
    return subprocess.run(run, capture_output=True, text=True, check=True, timeout=120).stdout


def test_points_of_a_file_are_those_that_laspy_reads(ground):
    laspy = judge("laspy")
    record = laspy.read(VALLEY)
    wanted = (record.classification == 2) & (record.withheld == 0)
    kept = ground.flags & 4 == 0
    assert np.array_equal(ground.x[kept], record.x[wanted])
    assert np.array_equal(ground.z[kept], record.z[wanted])
    assert (ground.classification == 2).all()
    assert ground.crs and ground.report["written"] == len(ground)


def test_points_are_clipped_and_merged(tmp_path, ground):
    box = (ground.x.min(), ground.y.min(), np.median(ground.x), ground.y.max())
    part = breakline.read_points(VALLEY, classes="ground", bounds=box)
    assert 0 < len(part) < len(ground) and part.x.max() <= box[2]
    report = breakline.points([VALLEY], tmp_path / "part.laz", classes=2, bounds=box)
    assert report["written"] == len(part)
    again = breakline.read_points(tmp_path / "part.laz")
    assert np.array_equal(again.xyz, part.xyz)
    with pytest.raises(breakline.FileKeptError, match="the file exists") as caught:
        breakline.points(VALLEY, tmp_path / "part.laz")
    assert "overwrite=True" in caught.value.cure


@pytest.mark.parametrize("make", ["array", "fortran", "strided", "points", "structured", "dict", "laspy", "frame"])
def test_a_tin_is_the_same_whatever_the_points_are_kept_in(ground, make):
    xyz = ground.xyz[ground.flags & 4 == 0]  # withheld points are never used
    reference = breakline.tin(xyz)
    if make == "fortran":
        xyz = np.asfortranarray(xyz)
    elif make == "strided":
        xyz = np.repeat(np.column_stack([xyz, xyz]), 2, axis=0)[::2, :3]
    elif make == "points":
        xyz = ground
    elif make == "structured":
        xyz = np.array(list(map(tuple, xyz)), dtype=[("X", "f8"), ("Y", "f8"), ("Z", "f8")])
    elif make == "dict":
        xyz = dict(zip("xyz", xyz.T))
    elif make == "laspy":
        xyz = judge("laspy").read(VALLEY)
    elif make == "frame":
        geopandas = judge("geopandas")
        xyz = geopandas.GeoDataFrame(geometry=geopandas.points_from_xy(*xyz.T), crs=ground.crs)
    tin = breakline.tin(xyz)
    assert np.array_equal(tin.vertices, reference.vertices)
    assert np.array_equal(tin.triangles, reference.triangles)


def test_lists_are_those_of_the_file_that_is_written(valley, tmp_path):
    valley.write(tmp_path / "valley.off")
    lines = (tmp_path / "valley.off").read_text().splitlines()
    lines = [line for line in lines if line and not line.startswith("#")]
    vertices, faces = map(int, lines[1].split()[:2])
    numbers = np.array([line.split() for line in lines[2 : 2 + vertices]], dtype=float)
    corners = np.array([line.split()[1:4] for line in lines[2 + vertices : 2 + vertices + faces]], dtype=int)
    assert np.array_equal(numbers, valley.vertices) and np.array_equal(corners, valley.triangles)
    assert valley.vertices.dtype == np.float64 and valley.triangles.dtype == np.int32
    assert valley.vertices is valley.vertices and not valley.vertices.flags.writeable
    with pytest.raises(ValueError):
        valley.triangles[0, 0] = 1


def test_edges_have_kinds(valley):
    kinds = dict(zip(*np.unique(valley.edge_kinds, return_counts=True)))
    named = {breakline.EDGE_KINDS[kind]: count for kind, count in kinds.items()}
    assert named["breakline"] == valley.report["edges"]["breakline"]
    assert named["clip"] == valley.report["edges"]["clip"]
    pairs = np.sort(valley.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert len(np.unique(pairs, axis=0)) == len(valley.edges)


def test_heights_are_linear_on_triangles(cloud):
    tin = breakline.tin(cloud, max_edge="none")
    scipy = judge("scipy.interpolate")
    random = np.random.default_rng(1)
    xy = cloud[:, :2].min(axis=0) + random.random((2000, 2)) * np.ptp(cloud[:, :2], axis=0)
    linear = scipy.LinearNDInterpolator(cloud[:, :2] - cloud[0, :2], cloud[:, 2])(xy - cloud[0, :2])
    heights = tin.elevation(xy)
    both = ~np.isnan(heights) & ~np.isnan(linear)
    assert both.sum() > 1900 and (np.isnan(heights) != np.isnan(linear)).sum() <= 2
    assert np.abs(heights - linear)[both].max() < 1e-6
    assert np.array_equal(tin.elevation(cloud[:500, :2]), cloud[:500, 2])


def test_shapes_of_positions(valley):
    x, y = valley.vertices[len(valley.vertices) // 2, :2]
    assert valley.elevation([x, y]) == valley.vertices[len(valley.vertices) // 2, 2]
    assert valley.elevation(np.full((2, 3, 2), [x, y])).shape == (2, 3)
    assert valley.elevation(np.empty((0, 2))).shape == (0,)
    assert np.isnan(valley.elevation([[np.nan, y], [0.0, 0.0], [np.inf, y]])).all()
    for method in ("nearest", "natural", "laplace", "smooth", "idw"):
        assert np.isfinite(valley.elevation([[x, y]], method=method)).all()


def test_a_dem_is_the_file_of_the_program(valley, tmp_path):
    files = ["--breaklines", FIXTURES / "breaklines.shp", "--boundary", FIXTURES / "boundary.shp"]
    program("dem", VALLEY, *files, "--resolution", "2", "-o", tmp_path / "program.tif")
    raster = valley.dem(2)
    raster.write(tmp_path / "python.tif")
    assert (tmp_path / "python.tif").read_bytes() == (tmp_path / "program.tif").read_bytes()
    rasterio = judge("rasterio")
    with rasterio.open(tmp_path / "program.tif") as opened:
        assert np.array_equal(opened.read(1, masked=True).filled(np.nan), raster.array, equal_nan=True)
        assert tuple(opened.transform)[:6] == tuple(raster.transform)[:6]


def test_a_raster_becomes_an_xarray(valley):
    judge("xarray")
    raster = valley.dem(5)
    cells = raster.to_xarray()
    assert cells.shape == raster.shape and cells.dtype == np.float32
    west, south, east, north = raster.bounds
    assert float(cells.x[0]) == west + 2.5 and float(cells.y[0]) == north - 2.5


def test_a_raster_is_aligned_and_bounded(valley, tmp_path):
    whole = valley.dem(4)
    whole.write(tmp_path / "whole.tif")
    west, south, east, north = whole.bounds
    part = valley.dem(align_to=tmp_path / "whole.tif", extent=(west + 8, south + 8, east - 8, north - 8))
    assert np.array_equal(part.array, whole.array[2:-2, 2:-2], equal_nan=True)


def test_contours_are_lines_of_one_height(valley, tmp_path):
    contours = valley.contours(1.0)
    assert len(contours) == len(list(contours)) > 5
    assert (np.diff(contours.levels) >= 0).all() and np.array_equal(contours.levels % 1.0, np.zeros(len(contours)))
    line = contours[0]
    heights = valley.elevation(line.points)
    assert np.nanmax(np.abs(heights - line.level)) < 1e-6
    interface = contours.__geo_interface__
    assert interface["features"][0]["properties"]["level"] == line.level
    contours.write(tmp_path / "python.geojson")
    valley.write(tmp_path / "valley.tin")
    program("contour", tmp_path / "valley.tin", "--interval", "1", "-o", tmp_path / "program.geojson")
    assert (tmp_path / "python.geojson").read_bytes() == (tmp_path / "program.geojson").read_bytes()


def test_contours_for_geopandas_and_arrow(valley):
    contours = valley.contours(2.0)
    judge("geopandas")
    frame = contours.to_geopandas()
    assert len(frame) == len(contours) and frame.crs is not None
    assert np.array_equal(frame.geometry.iloc[3].coords[:], contours[3].points)
    judge("pyarrow")
    table = contours.to_arrow()
    assert table.num_rows == len(contours)
    assert table.schema.field("geometry").metadata[b"ARROW:extension:name"] == b"geoarrow.linestring"
    assert table["geometry"][3].as_py() == contours[3].points.tolist()


def test_a_hillshade_is_the_file_of_the_program(valley, tmp_path):
    valley.write(tmp_path / "valley.tin")
    program("hillshade", tmp_path / "valley.tin", "--resolution", "2", "-o", tmp_path / "program.tif")
    shades = valley.hillshade(2)
    shades.write(tmp_path / "python.tif")
    assert shades.array.dtype == np.uint8
    assert (tmp_path / "python.tif").read_bytes() == (tmp_path / "program.tif").read_bytes()
    of_dem = valley.dem(2).hillshade()
    assert of_dem.shape == shades.shape


def test_a_surface_is_sound_and_a_broken_mesh_is_not(valley, tmp_path):
    assert valley.check() == []
    folded = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 0 1 3\n"
    (tmp_path / "folded.off").write_text(folded)
    flaws = breakline.check(tmp_path / "folded.off")
    assert flaws and flaws[0].at.shape[1] == 2


def test_pickles_have_the_same_triangles(valley):
    again = pickle.loads(pickle.dumps(valley))
    assert np.array_equal(again.vertices, valley.vertices) and np.array_equal(again.triangles, valley.triangles)
    assert again.report == valley.report and again.crs == valley.crs
    center = [[(valley.bounds[0] + valley.bounds[2]) / 2, (valley.bounds[1] + valley.bounds[3]) / 2]]
    assert np.allclose(again.elevation(center), valley.elevation(center), atol=1e-9)
    twice = pickle.loads(pickle.dumps(again))
    assert np.array_equal(twice.triangles, valley.triangles)


def test_a_file_of_a_surface_is_opened(valley, tmp_path):
    for name in ("valley.tin", "valley.ply"):
        valley.write(tmp_path / name)
        opened = breakline.tin(tmp_path / name)
        assert np.array_equal(opened.vertices, valley.vertices), name
        with pytest.raises(breakline.UsageError, match="max_edge is for building"):
            breakline.tin(tmp_path / name, max_edge=5.0)
    with pytest.raises(breakline.FileKeptError):
        valley.write(tmp_path / "valley.tin")
    valley.write(tmp_path / "valley.tin", overwrite=True)


def test_lines_in_memory_are_those_of_the_file(ground):
    geopandas = judge("geopandas")
    frame = geopandas.read_file(FIXTURES / "breaklines.shp")
    boundary = geopandas.read_file(FIXTURES / "boundary.shp")
    reference = breakline.tin(VALLEY, breaklines=FIXTURES / "breaklines.shp", boundary=FIXTURES / "boundary.shp")
    of_frame = breakline.tin(VALLEY, breaklines=frame, boundary=boundary)
    of_shapes = breakline.tin(VALLEY, breaklines=list(frame.geometry), boundary=list(boundary.geometry))
    for tin in (of_frame, of_shapes):
        assert np.array_equal(tin.vertices, reference.vertices)
        assert np.array_equal(tin.triangles, reference.triangles)


def test_a_line_of_an_array_is_in_the_surface():
    grid = np.array([[x, y, 0.0] for x in range(11) for y in range(11)])
    line = np.array([[0.5, 0.25, 5.0], [9.5, 8.75, 5.0]])
    tin = breakline.tin(grid, breaklines=line)
    middle = line[:, :2].mean(axis=0)
    assert tin.elevation(middle) == pytest.approx(5.0)
    ring = np.array([[2, 2], [8, 2], [8, 8], [2, 8], [2, 2]], dtype=float)
    clipped = breakline.tin(grid, boundary=ring)
    assert clipped.bounds == (2, 2, 8, 8)


def test_matplotlib_takes_the_triangles(valley):
    judge("matplotlib")
    triangulation = valley.to_matplotlib()
    assert np.array_equal(triangulation.triangles, valley.triangles)


def test_facts_are_those_of_the_program():
    found = breakline.info(VALLEY)
    assert found == json.loads(program("info", "--json", VALLEY))[0]
    assert found["kind"] == "points"


def test_files_of_triangle_are_triangulated(tmp_path):
    poly = "4 2 0 0\n1 0 0\n2 4 0\n3 4 3\n4 0 3\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n"
    (tmp_path / "plate.poly").write_text(poly)
    found = breakline.triangulate(tmp_path / "plate.poly", output=tmp_path / "plate.1.ele", min_angle=25, max_area=0.5)
    assert (tmp_path / "plate.1.ele").exists()
    a, b, c = (found.vertices[found.triangles[:, i]] for i in range(3))
    areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert areas.sum() == pytest.approx(12) and 0 < areas.min() and areas.max() <= 0.5


def test_points_in_space_become_tetrahedra(tmp_path):
    points = np.random.default_rng(3).random((200, 3))
    np.savetxt(tmp_path / "cube.xyz", points)
    found = breakline.triangulate(tmp_path / "cube.xyz", in_space=True, alpha="auto")
    scipy = judge("scipy.spatial")
    assert len(found.tetrahedra) == len(scipy.Delaunay(points).simplices)
    assert found.report["volume"] == pytest.approx(scipy.ConvexHull(points).volume)
    assert found.solid["parts"] == 1


def test_withheld_points_of_records_are_never_used():
    names = [("X", "f8"), ("Y", "f8"), ("Z", "f8"), ("Withheld", "u1")]
    corners = [(0, 0, 1, 0), (10, 0, 1, 0), (10, 10, 1, 0), (0, 10, 1, 0), (5, 5, 99, 1)]
    tin = breakline.tin(np.array(corners, dtype=names))
    assert tin.elevation([5.0, 5.0]) == 1.0


def test_a_surface_of_contours_gets_ridges():
    def ring(size, z):
        return [[-size, -size, z], [size, -size, z], [size, size, z], [-size, size, z], [-size, -size, z]]

    options = {"breaklines": [ring(10, 5), ring(20, 4)], "max_edge": "none"}
    with pytest.warns(breakline.BreaklineWarning, match=r"flat.*add_ridges"):
        flat = breakline.tin(np.zeros((0, 3)), **options)
    assert flat.elevation([[0, 0]]) == [5]
    assert 5.1 < breakline.tin(np.zeros((0, 3)), add_ridges=True, **options).elevation([[0, 0]])[0] < 6
