"""Simplification: the bound holds, the same whatever the input is, and what is refused."""

import breakline
import numpy as np
import pytest


def hill(size=60):
    y, x = np.mgrid[0:size, 0:size].astype(float)
    z = np.round(20 * np.sin(x / 17) * np.cos(y / 11), 1)
    return np.stack([x, y, z], axis=-1).reshape(-1, 3)


def test_the_bound_holds_for_points_tins_and_rasters():
    points = hill()
    tin = breakline.tin(points)
    dem = breakline.Raster(points[:, 2].reshape(60, 60)[::-1], (1, 0, -0.5, 0, -1, 59.5))
    by_points, by_tin, by_dem = (breakline.simplify(of, max_error=0.5) for of in (points, tin, dem))
    for light in (by_points, by_tin, by_dem):
        assert 10 < light.report["vertices"] < 1000
        assert np.abs(light.elevation(points[:, :2]) - points[:, 2]).max() <= 0.5 + 1e-12
        assert "all heights are within 0.5" in light.notices[-1].text
    assert by_points.report["vertices"] == by_tin.report["vertices"]
    assert by_points.report["points_used"] == 3600


def test_lines_stay_with_fewer_vertices():
    line = np.array([[x, 30.25, 40.0] for x in np.arange(5, 50, 0.5)])
    light = breakline.simplify(hill(), max_error=0.5, breaklines=[line])
    assert light.elevation([[20, 30.25]]) == pytest.approx(40)
    edges, kinds = light.edges, light.edge_kinds
    assert 1 <= (kinds == breakline.EDGE_KINDS.index("breakline")).sum() < 40 and len(edges) == len(kinds)


def test_a_number_of_vertices(tmp_path):
    light = breakline.simplify(hill(), target=100)
    assert 90 <= light.report["vertices"] <= 100
    light.write(tmp_path / "light.tin")
    again = breakline.simplify(tmp_path / "light.tin", target=50)
    assert again.report["vertices"] <= 50


@pytest.mark.parametrize(
    "options, text",
    [
        ({}, "one of max_error and target"),
        ({"max_error": 1, "target": 5}, "one of max_error and target"),
        ({"max_error": 0}, "not a bound"),
        ({"max_error": float("nan")}, "not a bound"),
        ({"target": 2}, "does not exist"),
        ({"max_error": 1, "line_tolerance": -1}, "not a tolerance"),
    ],
)
def test_what_makes_no_sense_is_refused(options, text):
    with pytest.raises(breakline.UsageError, match=text):
        breakline.simplify(hill(10), **options)


def test_numbers_are_numbers():
    with pytest.raises(breakline.ArgumentTypeError, match="max_error is not a number"):
        breakline.simplify(hill(10), max_error="much")
