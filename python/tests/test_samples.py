"""Heights at points and accuracy by checkpoints: values, what they are computed of, and what is refused."""

import breakline
import numpy as np
import pytest

#: A square of 10 that rises from 1 to 3 to the north.
SLOPE = [[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]]

ALL = ["height", "slope", "slope-percent", "aspect", "gradient"]


def test_samples_of_any_surface():
    slope = breakline.tin(SLOPE)
    at = [[[5, 5], [2.5, 7.5]], [[50, 50], [np.nan, 1]]]
    found = breakline.sample(slope, at, add=ALL)
    assert list(found) == ["surface_z", "slope", "slope_pct", "aspect", "gradient_x", "gradient_y"]
    assert found["surface_z"].shape == (2, 2)
    assert found["surface_z"][0].tolist() == [2.0, 2.5] and np.isnan(found["surface_z"][1]).all()
    assert found["slope_pct"][0] == pytest.approx([20, 20])
    assert found["aspect"][0].tolist() == [180, 180]
    assert found["gradient_y"][0] == pytest.approx([0.2, 0.2]) and found["gradient_x"][0].tolist() == [0, 0]
    assert breakline.sample(SLOPE, [5, 5], prefix="a_")["a_surface_z"] == 2
    dem = slope.dem(1)
    rows, columns = np.indices(dem.array.shape)
    centers = np.stack([dem.transform.c + columns + 0.5, dem.transform.f - rows - 0.5], axis=-1)
    for surface in (slope, dem):
        heights = breakline.sample(surface, centers)["surface_z"]
        assert np.array_equal(heights.astype(np.float32), dem.array.astype(np.float32), equal_nan=True)


def test_what_a_sample_refuses():
    slope = breakline.tin(SLOPE)
    for at, wrong, said in [
        ("points.csv", {}, "read_points"),
        ([[1, 2, 3]], {}, "expected"),
        ([[1, 2]], {"add": "color"}, "slope-percent"),
        ([[1, 2]], {"add": []}, "twice, or none"),
        ([[1, 2]], {"add": "slope", "method": "smooth"}, "slopes"),
        ([[1, 2]], {"max_edge": 3}, "max_edge"),
        ([[1, 2]], {"output": "x.csv"}, "output"),
    ]:
        with pytest.raises(breakline.BreaklineError) as raised:
            breakline.sample(slope, at, **wrong)
        assert said in f"{raised.value} {raised.value.cure}", wrong
    small = [[x / 1e6, y / 1e6, z] for x, y, z in SLOPE]
    degrees = breakline.tin(small, crs="EPSG:4326", force_degrees=True)
    with pytest.raises(breakline.BreaklineError, match="degrees"):
        breakline.sample(degrees, [[5e-6, 5e-6]], add="slope")


def checkpoints(count):
    """Return checkpoints on the slope: a quarter of them half a unit too low."""
    x, y = np.arange(count) % 9 + 0.5, np.arange(count) % 7 + 1.25
    return np.stack([x, y, 1 + 0.2 * y - 0.5 * (np.arange(count) % 4 == 0)], axis=1)


def test_accuracy_by_arrays_and_files(tmp_path):
    slope, points = breakline.tin(SLOPE, crs="EPSG:25832"), checkpoints(40)
    found = breakline.accuracy(slope, points, accuracy_class="30cm", checkpoint_error=0.1)
    (one,) = found.sets
    assert (one.set, one.group, one.n, found.unit) == ("all", None, 40, "metre")
    assert [one.mean, one.rmse, one.median] == pytest.approx([0.125, 0.25, 0], abs=1e-12)
    assert one.accuracy == pytest.approx(0.0725**0.5) and found.is_met and found.limit == pytest.approx(0.3)
    differences = found.points["difference"]
    assert one.standard_deviation == pytest.approx(np.std(differences, ddof=1))
    assert one.percentile_95 == pytest.approx(np.percentile(np.abs(differences), 95))
    assert sum(found.histogram[2]) == 40
    labels = ["tree" if i % 4 == 0 else "road" for i in range(40)]
    grouped = breakline.accuracy(slope, points, group_by=labels, vegetated="tree", accuracy_class=0.01)
    assert [(of.set, of.n) for of in grouped.sets] == [
        ("all", 40),
        ("non-vegetated", 30),
        ("vegetated", 10),
        ("group", 30),
        ("group", 10),
    ]
    assert grouped.is_met and grouped.decisive == "non-vegetated"
    file = tmp_path / "points.csv"
    file.write_text("x,y,z,cover\n" + "".join(f"{x},{y},{z},{label}\n" for (x, y, z), label in zip(points.tolist(), labels)))
    of_file = breakline.accuracy(slope, file, group_by="cover", vegetated=["tree"], accuracy_class=0.01)
    assert repr(of_file.sets) == repr(grouped.sets) and of_file.points["number"][0] == 2


def test_what_accuracy_warns_of_and_refuses(tmp_path):
    slope = breakline.tin(SLOPE)
    with pytest.warns(breakline.BreaklineWarning) as warned:
        found = breakline.accuracy(slope, [[5, 5, 2], [50, 50, 2]])
    said = " ".join(str(warning.message) for warning in warned)
    assert "point 2: outside" in said and "at least 30" in said
    assert found.is_met is None and found.sets[0].n == 1 and np.isnan(found.points["surface_z"][1])
    points = checkpoints(30)
    for wrong, said in [
        ({"checkpoints": [[50, 50, 1]]}, "outside of the surface"),
        ({"checkpoints": [[5, 5, np.nan]]}, "no height"),
        ({"accuracy_class": "10 miles"}, "miles"),
        ({"accuracy_class": -1}, "negative"),
        ({"group_by": "cover"}, "label"),
        ({"group_by": ["a"]}, "groups for 30"),
        ({"vegetated": "tree"}, "group_by"),
        ({"group_by": ["a"] * 30, "vegetated": "tree"}, "the groups are a"),
        ({"output": "x.csv"}, "output"),
    ]:
        given = {"checkpoints": points, **wrong}
        with pytest.raises(breakline.BreaklineError) as raised:
            breakline.accuracy(slope, **given)
        assert said in f"{raised.value} {raised.value.cure}", wrong
