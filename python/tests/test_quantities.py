"""Slope, aspect, curvature and roughness."""

import breakline
import numpy as np
import pytest

from test_toolkit import program

VERBS = {
    "slope": [{}, {"percent": True}, {"overviews": "none"}, {"formula": "zevenbergen-thorne"}, {"z_factor": 2.0}],
    "aspect": [{}, {"formula": "zevenbergen-thorne"}],
    "curvature": [{}, {"formula": "plan"}],
    "roughness": [{}],
    "tri": [{}, {"formula": "wilson"}],
    "tpi": [{}],
}


@pytest.mark.parametrize("verb", sorted(VERBS))
def test_values_are_those_of_the_program(verb, valley, tmp_path):
    dem = valley.dem(2)
    dem.write(tmp_path / "dem.tif")
    for number, options in enumerate(VERBS[verb]):
        made = getattr(breakline, verb)(dem, **options)
        assert made.quantity == verb
        assert made.shape == dem.shape
        words = [
            word
            for name, value in options.items()
            for word in ([f"--{name}"] if value is True else [f"--{name.replace('_', '-')}", str(value)])
        ]
        path = tmp_path / f"{number}.tif"
        program(verb, tmp_path / "dem.tif", *words, "-o", path)
        assert made.write(tmp_path / "own.tif", overwrite=True) is None
        assert (tmp_path / "own.tif").read_bytes() == path.read_bytes(), (verb, options)
        written = getattr(breakline, verb)(tmp_path / "dem.tif", output=tmp_path / "w.tif", overwrite=True, **options)
        assert written.path.read_bytes() == path.read_bytes(), (verb, options)


def test_a_plane_has_one_slope():
    plane = breakline.tin([[0, 0, 0], [100, 0, 50], [100, 100, 50], [0, 100, 0]], max_edge="none")
    np.testing.assert_allclose(breakline.slope(plane, resolution=10, percent=True).array, 50.0, rtol=1e-6)
    np.testing.assert_array_equal(breakline.aspect(plane, resolution=10).array, 270.0)
    assert breakline.slope(plane, resolution=10).plot() is not None


def test_slopes_of_faces(valley, tmp_path):
    plane = breakline.tin([[0, 0, 0], [100, 0, 50], [100, 100, 50], [0, 100, 0]], max_edge="none")
    assert (breakline.slope(plane, resolution=10, percent=True, formula="faces").array == 50).all()
    valley.write(tmp_path / "v.tin")
    for verb in ("slope", "aspect"):
        made = getattr(breakline, verb)(valley, resolution=2, formula="faces")
        made.write(tmp_path / "own.tif", overwrite=True)
        program(verb, tmp_path / "v.tin", "--resolution", "2", "--formula", "faces", "-o", tmp_path / f"{verb}.tif")
        assert (tmp_path / "own.tif").read_bytes() == (tmp_path / f"{verb}.tif").read_bytes()
    with pytest.raises(breakline.UsageError, match="a raster has none"):
        breakline.slope(valley.dem(2), formula="faces")


def test_overviews_are_left_out(valley, tmp_path):
    def size(**options):
        written = breakline.slope(valley, resolution=0.1, output=tmp_path / "s.tif", overwrite=True, **options)
        return written.path.stat().st_size

    small = size(overviews="none")
    assert small < 0.9 * size()
    breakline.slope(valley, resolution=0.1).write(tmp_path / "r.tif", overviews="none")
    assert (tmp_path / "r.tif").stat().st_size == small
    with pytest.raises(breakline.UsageError, match="overviews"):
        size(overviews="some")


def test_what_is_not_understood_is_refused(valley):
    with pytest.raises(breakline.UsageError, match="formula"):
        breakline.slope(valley, resolution=5, formula="best")
    with pytest.raises(breakline.UsageError, match="z_factor"):
        breakline.slope(valley, resolution=5, z_factor="steep")
    with pytest.raises(breakline.UsageError, match="keeps its own cells"):
        breakline.tri(valley.dem(5), resolution=2)
