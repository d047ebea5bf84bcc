"""Points that need more than the memory that is given: asked in files, with the same results."""

import os

import numpy as np
import pytest

import breakline

#: The least that can be given.
LITTLE = "16MB"


@pytest.fixture
def ground(tmp_path, monkeypatch):
    """A file of text that is taken for more points than it has, as its numbers are long."""
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setenv("TMPDIR", str(scratch))
    zeros = "0" * 80
    rows = [f"{x}.{zeros} {y}.{zeros} {x * y % 13}.{zeros}\n" for x in range(130) for y in range(140)]
    path = tmp_path / "ground.xyz"
    path.write_text("".join(rows))
    yield str(path)
    assert os.listdir(scratch) == []


def results(points, **memory):
    """What all functions say of a surface."""
    at = [[3.5, 4.25], [77, 80], [60.5, 129]]
    along = [[[1.5, 2], [100, 131], [120, 20]]]
    sampled = breakline.sample(points, at, add=["height", "slope"], **memory)
    checked = breakline.accuracy(points, [[x + 0.5, 10, 4] for x in range(40)], **memory)
    heights = breakline.profile(points, along=along, **memory)
    draped = breakline.drape(points, lines=along, **memory)
    volumes = breakline.volume(points, levels=[2, 9], **memory)
    flat = breakline.tin([[0, 0, 3], [129, 0, 3], [129, 139, 3], [0, 139, 3]], max_edge="none")
    compared = breakline.compare(points, flat, resolution=5, **memory)
    return [
        {name: values.tolist() for name, values in sampled.items()},
        repr(checked.sets),
        [part.tobytes() for line in heights for part in line.surfaces[0]],
        [part.tobytes() for line in draped for part in line],
        repr(volumes),
        np.array(compared.raster).tobytes(),
    ]


def test_larger_points_give_the_same(ground):
    def written():
        return os.stat(os.environ["TMPDIR"]).st_mtime_ns

    before = written()
    whole = results(ground)
    assert written() == before
    assert results(ground, memory=LITTLE) == whole
    assert written() > before


def test_memory_is_checked(ground):
    with pytest.raises(breakline.UsageError, match="memory"):
        breakline.sample(ground, [[1, 1]], memory="1MB")
