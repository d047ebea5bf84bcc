"""Heights in colors."""

import breakline
import numpy as np
import pytest

from test_toolkit import program

RAMP = "# heights of the valley\nnv 1 2 3 4\n0% blue\n800,255,255,0\n100%\tred 128\n"


@pytest.mark.parametrize("match", ["linear", "nearest", "exact"])
@pytest.mark.parametrize("suffix", ["tif", "png"])
def test_files_are_those_of_the_program(valley, tmp_path, match, suffix):
    ramp, dem = tmp_path / "ramp.txt", tmp_path / "dem.tif"
    ramp.write_text(RAMP)
    valley.dem(2).write(dem)
    program("color-relief", dem, "--ramp", ramp, "--match", match, "-o", tmp_path / f"program.{suffix}")
    expected = (tmp_path / f"program.{suffix}").read_bytes()
    own = tmp_path / f"own.{suffix}"
    for surface in (dem, valley.dem(2)):
        written = breakline.color_relief(surface, ramp=ramp, match=match, output=own, overwrite=True)
        assert written.path.read_bytes() == expected
    made = breakline.color_relief(valley, resolution=2, ramp=str(ramp), match=match)
    made.write(own, overwrite=True)
    assert own.read_bytes() == expected
    with pytest.raises(breakline.FileKeptError):
        made.write(own)
    assert made.array.shape == (*valley.dem(2).shape, 4) and made.array.dtype == np.uint8
    assert (np.asarray(made)[np.isnan(valley.dem(2).array)] == [1, 2, 3, 4]).all()


def test_colors_follow_from_heights():
    plane = breakline.tin([[0, 0, 0], [100, 0, 100], [100, 100, 100], [0, 100, 0]], max_edge="none")
    gray = breakline.color_relief(plane, resolution=10, ramp="gray")
    assert gray.array[0, :, 0].tolist() == [0, 28, 57, 85, 113, 142, 170, 198, 227, 255]
    assert (gray.array[..., 3] == 255).all()
    assert gray.plot() is not None


def test_a_rotated_relief_is_not_drawn(tmp_path):
    c, s = 0.8, 0.6
    rotated = breakline.Raster(np.arange(12.0).reshape(3, 4), (c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0))
    with pytest.raises(breakline.UsageError, match="rotated"):
        breakline.color_relief(rotated).plot()


def test_what_is_no_ramp_is_refused(valley, tmp_path):
    with pytest.raises(breakline.UsageError, match="ramp rainbow: there is no such ramp"):
        breakline.color_relief(valley, resolution=5, ramp="rainbow")
    with pytest.raises(breakline.UsageError, match="match"):
        breakline.color_relief(valley, resolution=5, match="best")
    ramp = tmp_path / "ramp.txt"
    ramp.write_text("0 1 2 3\n1 2 3 300\n")
    with pytest.raises(breakline.FormatError, match=r"ramp.txt: line 2: `300` in a color"):
        breakline.color_relief(valley, resolution=5, ramp=ramp)
    with pytest.raises(breakline.UsageError, match="color relief"):
        breakline.color_relief(valley, resolution=5).write(tmp_path / "a.jpg")
