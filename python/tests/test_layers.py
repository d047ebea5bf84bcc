"""Layers that are chosen by conditions, and points in tiles."""

import json
from pathlib import Path

import breakline
import numpy as np
import pytest

VALLEY = Path(__file__).parents[2] / "fixtures" / "valley.laz"


def test_names_of_layers():
    assert breakline.layer("a.gpkg") == "a.gpkg"
    assert breakline.layer(Path("a.gpkg"), "lines", field="Z") == "a.gpkg:lines:Z"
    assert breakline.layer("a.shp", field="Z", where="n > 1") == "a.shp::Z where n > 1"


def test_a_condition_chooses_breaklines(tmp_path):
    def feature(y, kind):
        line = {"type": "LineString", "coordinates": [[0.2, y, 9], [1.8, y, 8.5]]}
        return {"type": "Feature", "properties": {"kind": kind}, "geometry": line}

    path = tmp_path / "l.geojson"
    features = [feature(0.5, "toe"), feature(1.5, "top"), feature(1.2, None)]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [2, 2, 0]], float)
    where = {"crs": "EPSG:4326", "force_degrees": True, "max_edge": "none"}
    made = breakline.tin(corners, breaklines=breakline.layer(path, where="kind <> 'top'"), **where)
    whole = breakline.tin(corners, breaklines=path, **where)
    assert len(made.vertices) < len(whole.vertices)
    with pytest.raises(breakline.UsageError, match="no field knd"):
        breakline.tin(corners, breaklines=breakline.layer(path, where="knd = 1"), **where)


def test_points_in_tiles(tmp_path):
    counts = breakline.points(VALLEY, tmp_path / "tiles", tile="50m", buffer=5, flag_buffer=True)
    files = sorted((tmp_path / "tiles").iterdir())
    assert len(files) > 1
    again = breakline.read_points(files, drop_withheld=True)
    assert len(again) == len(breakline.read_points(VALLEY, drop_withheld=True))
    assert counts["written"] == len(breakline.read_points(VALLEY))
    with pytest.raises(breakline.UsageError, match="tile: 1 furlong"):
        breakline.points(VALLEY, tmp_path / "t", tile="1 furlong")
    with pytest.raises(breakline.UsageError, match="buffer without tiles"):
        breakline.points(VALLEY, tmp_path / "t", buffer=1)
