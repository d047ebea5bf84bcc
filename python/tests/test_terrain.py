"""Tiles for web globes, from arrays."""

import gzip
import json
import struct

import breakline
import numpy as np
import pytest


def ridge():
    """Return points in degrees."""
    x, y = np.meshgrid(7 + np.arange(12) * 1e-3, 46 + np.arange(12) * 1e-3)
    return np.column_stack([x.ravel(), y.ravel(), 400 + 5 * np.abs(np.arange(144) % 12 - 5)])


WHERE = {"crs": "EPSG:4326", "force_degrees": True, "max_edge": "none", "vertical_offset": 50.0, "max_level": 12}


def test_the_levels_are_those_of_the_files(tmp_path):
    levels = breakline.terrain_tiles(ridge(), output=tmp_path / "tiles", **WHERE)
    layer = json.loads((tmp_path / "tiles" / "layer.json").read_text())
    assert [level.level for level in levels] == list(range(13)) and layer["maxzoom"] == 12
    for level in levels:
        files = list((tmp_path / "tiles" / str(level.level)).rglob("*.terrain"))
        assert (len(files), sum(file.stat().st_size for file in files)) == (level.tiles, level.bytes)
        assert level.largest <= level.bound and level.beyond == 0 and level.heights >= 144
    low, high = struct.unpack("<2f", gzip.decompress(files[0].read_bytes())[24:32])
    assert 449 < low <= 450 and high >= 480


def test_a_folder_is_replaced_only_if_asked_for(tmp_path):
    tin = breakline.tin(ridge(), crs="EPSG:4326", force_degrees=True, max_edge="none")
    how = {name: WHERE[name] for name in ("vertical_offset", "max_level")}
    breakline.terrain_tiles(tin, output=tmp_path / "tiles", no_gzip=True, **how)
    with pytest.raises(breakline.UsageError, match="overwrite=True"):
        breakline.terrain_tiles(tin, output=tmp_path / "tiles", **how)
    breakline.terrain_tiles(tin, output=tmp_path / "tiles", format="3dtiles", overwrite=True, **how)
    assert (tmp_path / "tiles" / "tileset.json").exists()


def test_what_is_assumed_is_a_warning_and_nonsense_an_error(tmp_path):
    where = {name: value for name, value in WHERE.items() if name != "vertical_offset"}
    with pytest.warns(breakline.BreaklineWarning, match="vertical_offset"):
        breakline.terrain_tiles(ridge(), output=tmp_path / "tiles", **where)
    for wrong in ({"max_level": 29}, {"max_error": 0}, {"tiling": "square"}, {"format": "png"}):
        with pytest.raises(breakline.BreaklineError):
            breakline.terrain_tiles(ridge(), output=tmp_path / "no", **{**WHERE, **wrong})
    assert not (tmp_path / "no").exists()
    with pytest.raises(breakline.UsageError, match="crs"):
        breakline.terrain_tiles(ridge(), max_edge="none", output=tmp_path / "no")
