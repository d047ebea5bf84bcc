"""Profiles and draped lines: known heights, files, and what is refused."""

import breakline
import numpy as np
import pytest

#: A square of 10 that rises from 1 to 3.
SLOPE = [[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]
LINE = [[5, -5, 0], [5, 5, 0], [20, 5, 0]]


def height(y):
    return 1 + np.asarray(y) / 5


def test_profiles_of_surfaces_of_any_kind(tmp_path):
    slope, flat = breakline.tin(SLOPE), breakline.tin([[x + 5, y, 1] for x, y, _ in SLOPE])
    with pytest.warns(breakline.BreaklineWarning) as found:
        (row,) = breakline.profile(slope, flat, along=[LINE])
    texts = [str(warning.message) for warning in found]
    assert texts == [f"(memory): record 1: only in part on surface {number}" for number in (1, 2)]
    assert (row.record, row.part, row.station, row.name) == (1, None, None, None)
    assert (row.start, row.end) == (0, 25)
    ((on_slope,), (on_flat,)) = row.surfaces
    assert on_slope[[0, -1], 0].tolist() == [5, 15] and on_flat[[0, -1], 0].tolist() == [5, 20]
    assert np.allclose(on_slope[:, 3], height(on_slope[:, 2]), rtol=1e-14)
    assert (on_flat[:, 3] == 1).all()
    (stepped,) = breakline.profile(SLOPE, along=[[[5, 0, 0], [5, 10, 0]]], step=4)
    assert stepped.surfaces[0][0][:, 0].tolist() == [0, 4, 8, 10]
    dem = slope.dem(1)
    (row,) = breakline.profile(dem, along=[[[5, 2, 0], [5, 8, 0]]])
    assert np.allclose(row.surfaces[0][0][:, 3], height(row.surfaces[0][0][:, 2]), rtol=1e-6)
    files = [tmp_path / name for name in ["p.csv", "p.svg", "p.dxf"]]
    breakline.profile(slope, along=[[[5, 0, 0], [5, 10, 0]]], output=files, title="A & B", datum=0)
    assert all(file.stat().st_size > 100 for file in files)
    with pytest.raises(breakline.FileKeptError):
        breakline.profile(slope, along=[[[5, 0, 0], [5, 10, 0]]], output=files[0])


def test_sections_are_across_the_line():
    slope = breakline.tin(SLOPE)
    axis = [[[2, 5, 0], [8, 5, 0]]]
    rows = breakline.profile(slope, along=axis, interval=2, start=1, left=3, right=2, station_format="0.0")
    assert [(row.station, row.name) for row in rows] == [(2, "2.0"), (4, "4.0"), (6, "6.0")]
    assert [(row.start, row.end) for row in rows] == [(-3, 2)] * 3
    first = rows[0].surfaces[0][0]
    assert first[0].tolist() == [-3, 3, 8, pytest.approx(height(8))]
    assert first[-1].tolist() == [2, 3, 3, pytest.approx(height(3))]
    assert len(breakline.profile(slope, along=axis, stations=[0, 6], left=1)) == 2


def test_lines_are_draped(tmp_path):
    slope = breakline.tin(SLOPE, crs="EPSG:25832")
    with pytest.warns(breakline.BreaklineWarning, match="record 2: not on the surface"):
        first, second = breakline.drape(slope, lines=[[[5, 1, 0], [5, 9, 0]], [[50, 0, 0], [60, 0, 0]]])
    (part,) = first
    assert second == [] and np.allclose(part[:, 2], height(part[:, 1]), rtol=1e-14) and len(part) >= 3
    file = tmp_path / "lines.shp"
    ((stepped,),) = breakline.drape(slope, lines=[[[5, 1, 0], [5, 9, 0]]], step=4, output=file)
    assert stepped.tolist() == [[5, 1, pytest.approx(1.2)], [5, 5, pytest.approx(2)], [5, 9, pytest.approx(2.8)]]
    facts = breakline.info(file)
    assert facts["vertices"] == 3 and file.with_suffix(".prj").exists()
    ((again,),) = breakline.drape(slope, lines=file, step=4)
    assert (again == stepped).all()


def test_what_is_refused():
    slope = breakline.tin(SLOPE)
    inside = [[[5, 1, 0], [5, 9, 0]]]
    for wrong, said in [
        ({"along": [[[50, 0, 0], [60, 0, 0]]]}, "no line is on surface 1"),
        ({"along": inside, "step": 0}, "step"),
        ({"along": inside, "interval": 1}, "lengths"),
        ({"along": inside, "left": 1}, "stations"),
        ({"along": inside, "interval": 1, "stations": [1], "left": 1}, "interval"),
        ({"along": inside, "stations": [9], "left": 1}, "beyond the line"),
        ({"along": inside, "stations": [1], "left": 1, "station_format": "km"}, "station_format"),
        ({"along": inside, "datum": 2, "output": "x.svg"}, "above the lowest height"),
        ({"along": inside, "output": "x.tif"}, "csv"),
        ({"along": inside, "max_edge": 3}, "max_edge"),
    ]:
        with pytest.raises(breakline.BreaklineError, match=said):
            breakline.profile(slope, **wrong)
    with pytest.raises(breakline.BreaklineError):
        breakline.profile(along=inside)
    with pytest.raises(breakline.BreaklineError, match="no line is on"):
        breakline.drape(slope, lines=[[[50, 0, 0], [60, 0, 0]]])
