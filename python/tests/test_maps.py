"""Contours for maps: in memory, and in files."""

import json

import breakline
import numpy as np
import pytest


@pytest.fixture(scope="module")
def hills():
    x, y = np.meshgrid(np.arange(0.0, 80, 2), np.arange(0.0, 80, 2))
    rough = np.random.default_rng(1).random(x.shape) / 2
    return np.column_stack([x.ravel(), y.ravel(), (6 * np.sin(x / 19) * np.cos(y / 23) + rough).ravel()])


def test_lines_are_fewer_and_near_to_the_surface(hills):
    exact = breakline.contour(hills)
    smooth = breakline.contour(hills, preset="cartographic")
    assert 0 < len(smooth.levels) < len(exact.levels)
    strict = breakline.contour(hills, smooth=0.25)
    assert len(strict.levels) != len(exact.levels) or len(strict.coordinates) != len(exact.coordinates)
    assert len(breakline.contour(hills, smooth=True).levels) > 0


def test_files_have_fields_labels_and_bands(hills, tmp_path):
    points = tmp_path / "hills.xyz"
    np.savetxt(points, hills)
    lines, labels, bands = (tmp_path / name for name in ("c.geojson", "l.geojson", "b.geojson"))
    written = breakline.contour(points, preset="cartographic", output=lines, labels_output=labels, label_height=1)
    assert written.report["lines"] > 0 and written.report["deviation"] <= 0.5
    fields = json.loads(lines.read_text())["features"][0]["properties"]
    assert list(fields) == ["ID", "ELEV", "DEPRESSION", "INDEX"]
    for label in json.loads(labels.read_text())["features"]:
        assert -90 < label["properties"]["ROTATION"] <= 90
    breakline.contour(points, bands=True, output=bands)
    for band in json.loads(bands.read_text())["features"]:
        assert band["properties"]["ELEV_MAX"] - band["properties"]["ELEV_MIN"] == 1


def test_what_cannot_be_is_refused(hills):
    with pytest.raises(breakline.BreaklineError, match="half of the interval"):
        breakline.contour(hills, smooth=0.7)
    with pytest.raises(breakline.BreaklineError, match="bands is for a file"):
        breakline.contour(hills, bands=True)
    with pytest.raises(breakline.BreaklineError, match="preset"):
        breakline.contour(hills, preset="nice")
