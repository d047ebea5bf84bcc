"""Verbs that write files: in one piece, in tiles, and as jobs."""

import os
import subprocess
import sys
from pathlib import Path

import breakline
import numpy as np
import pytest

FIXTURES = Path(__file__).parents[2] / "fixtures"
VALLEY = FIXTURES / "valley.laz"


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The bytes of the program, for each verb."""
    folder = tmp_path_factory.mktemp("whole")
    made = {}
    for verb, name in [("dem", "w.tif"), ("hillshade", "s.tif"), ("contour", "c.geojson"), ("tin", "t.ply")]:
        words = [sys.executable, "-m", "breakline", verb, str(VALLEY), "-o", str(folder / name), "-q"]
        subprocess.run(words, check=True)
        made[verb] = (folder / name).read_bytes()
    return made


@pytest.mark.parametrize(
    ("verb", "name"), [("dem", "w.tif"), ("hillshade", "s.tif"), ("contour", "c.geojson"), ("tin", "t.ply")]
)
def test_a_verb_writes_what_the_program_writes(whole, tmp_path, verb, name):
    made = getattr(breakline, verb)(VALLEY, output=tmp_path / name)
    assert made.path == tmp_path / name and Path(made).read_bytes() == whole[verb]
    assert made.report["in_tiles"] is False and made.report["triangles"] > 100_000
    with pytest.raises(breakline.FileKeptError):
        getattr(breakline, verb)(VALLEY, output=tmp_path / name)
    again = getattr(breakline, verb)(VALLEY, output=tmp_path / name, overwrite=True)
    assert Path(again).read_bytes() == whole[verb]


@pytest.mark.parametrize("method", ["smooth", "idw", "natural"])
def test_heights_within_bounds_are_those_of_all_points_by_any_method(tmp_path, method):
    xmin, ymin, xmax, ymax = breakline.tin(VALLEY).bounds
    bounds = (xmin, ymin, (xmin + xmax) / 2, (ymin + ymax) / 2)
    how = {"bounds": bounds, "method": method, "resolution": 5}
    in_memory = breakline.dem(VALLEY, **how)
    file = breakline.dem(VALLEY, **how, output=tmp_path / "file.tif")
    in_memory.write(tmp_path / "memory.tif")
    assert Path(file).read_bytes() == (tmp_path / "memory.tif").read_bytes()


def test_files_that_need_more_memory_are_worked_on_in_tiles(whole, tmp_path):
    made = breakline.dem(VALLEY, output=tmp_path / "d.tif", tiles="4x3")
    assert made.report["in_tiles"] and made.path.read_bytes() == whole["dem"]
    assert not (tmp_path / "d.tif.job").exists()
    several = [tmp_path / f"{number}.laz" for number in range(4)]
    for path in several:
        path.write_bytes(VALLEY.read_bytes())
    little = breakline.dem(several, output=tmp_path / "l.tif", memory="16MB")
    assert little.report["in_tiles"] and little.path.read_bytes() == whole["dem"]
    shade = breakline.hillshade(VALLEY, output=tmp_path / "s.tif", tiles="2x2")
    assert shade.path.read_bytes() == whole["hillshade"]
    lines = breakline.contour(VALLEY, output=tmp_path / "c.geojson", tiles="2x2")
    assert lines.path.read_bytes() == whole["contour"] and lines.report["lines"] > 0
    parts = breakline.tin(VALLEY, output=tmp_path / "t.tins")
    assert parts.report["in_tiles"] and parts.report["parts"] > 0
    assert breakline.dem(parts.path, output=tmp_path / "p.tif").path.read_bytes() == whole["dem"]


def test_a_file_that_is_named_twice_is_used_once(tmp_path):
    (tmp_path / "same.laz").symlink_to(VALLEY)
    with pytest.warns(breakline.BreaklineWarning, match="same.laz is named twice and used once"):
        made = breakline.dem([VALLEY, tmp_path / "same.laz"], output=tmp_path / "d.tif", duplicates="mean")
    once = breakline.dem(VALLEY, output=tmp_path / "e.tif", duplicates="mean")
    assert made.path.read_bytes() == once.path.read_bytes()
    assert made.report["sources"] == 1


def test_arrays_are_never_tiled(ground, tmp_path):
    with pytest.warns(breakline.BreaklineWarning, match="memory"):
        made = breakline.dem(ground, output=tmp_path / "a.tif", memory="16MB")
    assert made.report["in_tiles"] is False
    with pytest.raises(breakline.UsageError, match="tiles are made of files"):
        breakline.dem(ground, output=tmp_path / "b.tif", tiles="2x2")
    tin = breakline.tin(ground)
    assert breakline.dem(tin, output=tmp_path / "c.tif").path.read_bytes() == made.path.read_bytes()


def test_what_makes_no_sense_is_an_error(tmp_path):
    with pytest.raises(breakline.UsageError, match="memory is for writing a file"):
        breakline.dem(VALLEY, memory="200MB")
    tin = breakline.tin([[0, 0, 1], [10, 0, 1], [0, 10, 3]])
    for name, value in [("memory", "1GB"), ("tiles", "2x2"), ("job", tmp_path), ("resume", True), ("skip_bad", True)]:
        with pytest.raises(breakline.UsageError, match=f"{name} is for files of points: .*\n.*leave {name} out"):
            breakline.dem(tin, output=tmp_path / "d.tif", **{name: value})
    with pytest.raises(breakline.UsageError, match=r"flat_points .*\n.*flat_points=True\)\.write"):
        breakline.dem(VALLEY, output=tmp_path / "d.tif", flat_points=True)
    with pytest.raises(breakline.UsageError, match="flat_points"):
        breakline.Job.plan("tin", VALLEY, tmp_path / "t.tins", flat_points=True)
    with pytest.raises(breakline.UsageError, match="not a unit of memory"):
        breakline.dem(VALLEY, output=tmp_path / "d.tif", memory="2XB")
    with pytest.raises(breakline.UsageError, match="columns and rows"):
        breakline.dem(VALLEY, output=tmp_path / "d.tif", tiles="2")
    with pytest.raises(breakline.UsageError, match="not a format"):
        breakline.dem(VALLEY, output=tmp_path / "d.laz")
    assert list(tmp_path.iterdir()) == []
    tin.write(tmp_path / "t.ply")
    with pytest.raises(breakline.UsageError, match="the output is one of the inputs"):
        breakline.tin(tmp_path / "t.ply", output=tmp_path / "t.ply", overwrite=True)


def test_the_tasks_of_a_job_are_done_one_by_one(whole, tmp_path):
    folder, output = tmp_path / "job", tmp_path / "d.tif"
    job = breakline.Job.plan("dem", VALLEY, output, job=folder, tiles="3x2")
    tasks = job.tasks()
    assert [task.number for task in tasks] == list(range(len(tasks))) and tasks[-1].name == "output"
    assert all(tasks[needed].stage < task.stage for task in tasks for needed in task.needs)
    assert tasks[0].input == str(VALLEY) and not any(task.done for task in tasks)
    with pytest.raises(breakline.NotYetError):
        job.run_task(len(tasks) - 1)
    for task in tasks[:-1]:
        breakline.Job(folder).run_task(task.number)
    about = VALLEY.stat()
    assert job.tasks()[0].has_read == (about.st_size, about.st_mtime_ns)
    made = job.run_task(len(tasks) - 1)
    assert made.path == output and made.report["in_tiles"] and made.report["triangles"] > 100_000
    assert output.read_bytes() == whole["dem"] and all(task.done for task in job.tasks())
    # The program goes on with it, too.
    words = [sys.executable, "-m", "breakline", "job", "run", str(folder)]
    assert "is written" in subprocess.run(words, check=True, capture_output=True, text=True).stderr
    assert breakline.Job.plan("dem", VALLEY, output, job=folder, tiles="3x2").folder == folder
    job.clean()
    assert not folder.exists()


def test_a_job_of_the_program_is_done_here(whole, tmp_path):
    words = ["job", "plan", "j", "--", "dem", os.path.relpath(VALLEY, tmp_path), "-o", "d.tif", "--tiles", "2x2"]
    subprocess.run([sys.executable, "-m", "breakline", *words], check=True, cwd=tmp_path, capture_output=True)
    job = breakline.Job(tmp_path / "j")
    assert job.output == tmp_path / "d.tif" and job.write().path.read_bytes() == whole["dem"]


def test_lines_in_memory_are_for_one_process(tmp_path):
    line = np.array([[600_100.0, 5_200_100.0, 500.0], [600_200.0, 5_200_200.0, 500.0]])
    with pytest.raises(breakline.BreaklineError, match="cannot be kept with a job"):
        breakline.Job.plan("dem", VALLEY, tmp_path / "d.tif", job=tmp_path / "j", tiles="2x2", breaklines=line)
