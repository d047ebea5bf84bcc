"""Several products of one surface."""

import pathlib

import breakline
import numpy as np
import pytest

POINTS = "0 0 1\n10 0 1\n10 10 3\n0 10 3\n4 5 2\n"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "a.xyz").write_text(POINTS)
    return tmp_path


def products(folder):
    return [
        {"verb": "dem", "resolution": np.float64(2.5), "te": np.array([0, 0, 10, 10]), "output": folder / "dem.tif"},
        {"verb": "volume", "plane": 1},
    ]


def test_tables_and_files_give_the_results_of_single_functions(folder):
    tables = {"input": {"files": folder / "a.xyz", "max_edge": "none"}, "product": products(folder)}
    report = breakline.run(tables)
    assert report["files"] == [str(folder / "dem.tif")]
    breakline.dem(folder / "a.xyz", resolution=2.5, max_edge="none", extent=(0, 0, 10, 10), output=folder / "single.tif")
    assert (folder / "dem.tif").read_bytes() == (folder / "single.tif").read_bytes()
    (row,) = breakline.volume(folder / "a.xyz", plane=1, max_edge="none")
    assert report["products"][1]["report"]["rows"][0]["cut"] == row.cut

    with pytest.raises(breakline.FileKeptError, match="dem.tif"):
        breakline.run(tables)
    plan = breakline.run(tables, overwrite=True, dry_run=True, memory="200MB")
    assert plan["surfaces"][0]["points"] and plan["products"][1]["command"].startswith("breakline volume ")
    stages = []
    breakline.run(tables, overwrite=True, threads=1, progress=lambda stage, *_: stages.append(stage))
    assert stages

    (folder / "site.toml").write_text('[input]\nfiles = "a.xyz"\n[[product]]\nverb = "tin"\noutput = "t.ply"\n')
    breakline.run(str(folder / "site.toml"))
    assert (folder / "t.ply").exists()
    breakline.run(pathlib.Path(folder / "site.toml"), overwrite=True)


def test_what_is_wrong_is_named_and_nothing_is_written(folder):
    tables = {"input": {"files": folder / "a.xyz"}, "product": products(folder)}
    tables["product"][1]["plan"] = tables["product"][1].pop("plane")
    with pytest.raises(breakline.UsageError, match="(?s)product 2: `plan` is not an option of `volume`.*`plane`"):
        breakline.run(tables)
    with pytest.raises(breakline.ArgumentTypeError, match="object is not a value"):
        breakline.run({"input": {"files": object()}})
    with pytest.raises(breakline.ArgumentTypeError):
        breakline.run(3)
    with pytest.raises(breakline.FileMissingError):
        breakline.run(folder / "none.toml")
    with pytest.raises(breakline.UsageError, match="memory"):
        breakline.run(tables, memory="much")
    assert [file.name for file in folder.iterdir()] == ["a.xyz"]
