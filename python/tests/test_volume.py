"""Cut and fill: known volumes, what they are computed of, and what is refused."""

import breakline
import numpy as np
import pytest

#: A square of 10 that rises from 1 to 3.
SLOPE = [[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]


def test_two_surfaces_of_any_kind():
    slope, flat = breakline.tin(SLOPE), breakline.tin([[x + 5, y, 1] for x, y, _ in SLOPE])
    (row,) = breakline.volume(slope, flat)
    assert (row.record, row.level, row.unit) == (None, None, None) and row.fill == pytest.approx(0, abs=1e-12)
    assert row.cut == row.net == pytest.approx(50, rel=1e-12)
    assert [row.common_area, row.surface_only, row.base_only] == pytest.approx([50, 50, 50], rel=1e-12)
    (other,) = breakline.volume(flat, slope)
    assert (other.cut, other.fill, other.net) == (row.fill, row.cut, -row.net)
    assert breakline.volume(SLOPE, flat) == [row]
    dem = slope.dem(1)
    (between,) = breakline.volume(dem, slope)
    # Heights of a raster have 24 bits: those below 4 are off by at most 1.2e-7.
    assert between.common_area == pytest.approx(81, rel=1e-12)
    assert between.cut + between.fill < 81 * 1.2e-7


def test_levels_polygons_and_units():
    slope = breakline.tin(SLOPE, crs="EPSG:25832")
    rows = breakline.volume(slope, levels=np.array([1.0, 2.0, 3.0]))
    assert [row.level for row in rows] == [1, 2, 3]
    assert [row.fill for row in rows] == pytest.approx([0, 25, 100], abs=1e-10)
    halves = [np.array([[0, 0], [5, 0], [5, 10], [0, 10]]), np.array([[5, 0], [10, 0], [10, 10], [5, 10]])]
    whole = breakline.volume(slope, plane=2)[0]
    rows = breakline.volume(slope, plane=2, within=halves)
    assert [row.record for row in rows] == [1, 2] and rows[0].unit == "m3"
    assert [row.polygon_area for row in rows] == [50, 50] and whole.polygon_area is None
    assert sum(row.cut for row in rows) == pytest.approx(whole.cut, rel=1e-12)
    (yards,) = breakline.volume(slope, plane=2, unit="yd3")
    assert yards.unit == "yd3" and yards.cut * 0.9144**3 == pytest.approx(whole.cut, rel=1e-12)


def test_what_is_moved():
    slope = breakline.tin(SLOPE)
    (row,) = breakline.volume(slope, plane=2, swell=1.25, shrink=0.8)
    assert row.cut == pytest.approx(25, rel=1e-12) and row.slope_area == pytest.approx(100 * 1.04**0.5, rel=1e-12)
    assert [row.loose_cut, row.bank_fill, row.balance] == pytest.approx([31.25, 31.25, -6.25], rel=1e-12)
    (row,) = breakline.volume(slope, plane=2)
    assert row.loose_cut is row.bank_fill is row.balance is None
    for factor in (0, -1, float("nan")):
        with pytest.raises(breakline.UsageError, match="swell|multiple"):
            breakline.volume(slope, plane=2, swell=factor)


def test_a_pile_on_its_rim():
    pile = [[0, 0, 5], [4, 0, 5], [4, 4, 5], [0, 4, 5], [1, 1, 5], [3, 1, 5], [3, 3, 5], [1, 3, 5], [2, 2, 8]]
    (row,) = breakline.volume(pile, base="rim", within=np.array([[1, 1], [3, 1], [3, 3], [1, 3]]))
    assert row.cut == pytest.approx(4, rel=1e-12) and row.fill == 0


def test_what_is_refused():
    slope = breakline.tin(SLOPE)
    for wrong, said in [
        ({}, "one base"),
        ({"plane": 1, "levels": [1]}, "one base"),
        ({"base": "top"}, "unknown value"),
        ({"base": "rim"}, "within"),
        ({"plane": float("nan")}, "not a height"),
        ({"plane": 1, "unit": "m3"}, "no coordinate system"),
        ({"plane": 1, "unit": "acres"}, "unit"),
        ({"plane": 1, "output": "x.csv"}, "output"),
        ({"plane": 1, "max_edge": 3}, "max_edge"),
    ]:
        with pytest.raises(breakline.BreaklineError) as raised:
            breakline.volume(slope, **wrong)
        assert said in f"{raised.value} {raised.value.cure}", wrong
    with pytest.raises(breakline.BreaklineError, match="do not overlap"):
        breakline.volume(slope, [[x + 50, y, 1] for x, y, _ in SLOPE])


def test_areas_that_differ():
    ground = [[0, 0, 10], [10, 0, 10], [10, 10, 10], [0, 10, 10]]
    mound = [[2, 2, 10], [4, 2, 10], [4, 4, 10], [2, 4, 10], [3, 3, 14]]
    found = breakline.compare(ground + mound, ground, resolution=1, changed=2, min_area=0, crs="EPSG:25832")
    (area,) = found.areas
    assert (area.change, area.largest, area.x, area.y) == ("raised", 4, 3, 3)
    # At half of its height, a pyramid has a quarter of its foot.
    assert (area.area, area.volume) == (pytest.approx(1, rel=1e-9), pytest.approx(1 * 2 + 2 / 3, rel=1e-9))
    assert (found.unit, found.left_out) == ("m3", 0)
    assert len(area.rings) == 1 and area.rings[0][0].tolist() == area.rings[0][-1].tolist()
    shape = area.__geo_interface__
    assert shape["geometry"]["type"] == "Polygon" and shape["properties"]["change"] == "raised"
    assert breakline.compare(ground, ground, resolution=1, changed=2).areas is None
    fewer = breakline.compare(ground + mound, ground, resolution=1, changed=2, min_area=1.5)
    assert (fewer.areas, fewer.left_out, fewer.unit) == ([], 1, None)
    for wrong in ({"min_area": 1}, {"min_area": -1, "changed": 1}, {"min_area": float("nan"), "changed": 1}):
        with pytest.raises(breakline.UsageError, match="min_area"):
            breakline.compare(ground, ground, resolution=1, **wrong)


def test_an_attribute_names_polygons(tmp_path):
    lots = tmp_path / "lots.geojson"
    ring = "[[0,0],[5,0],[5,5],[0,5],[0,0]]"
    lots.write_text(
        '{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},'
        '"features":[{"type":"Feature","properties":{"lot":"A 1"},'
        f'"geometry":{{"type":"Polygon","coordinates":[{ring}]}}}}]}}'
    )
    slope = breakline.tin(SLOPE, crs="EPSG:25832")
    (row,) = breakline.volume(SLOPE, plane=0, within=lots, name_by="lot")
    assert (row.record, row.name) == (1, "A 1")
    assert breakline.volume(slope, plane=0)[0].name is None
    with pytest.raises(breakline.UsageError, match="no field street"):
        breakline.volume(SLOPE, plane=0, within=lots, name_by="street")
    with pytest.raises(breakline.UsageError, match="name_by"):
        breakline.volume(SLOPE, plane=0, name_by="lot")
