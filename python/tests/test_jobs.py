"""Jobs: whose they are, what is left of them, and how they go on."""

import json
import os
import pickle
import re
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import breakline
import pytest

FIXTURES = Path(__file__).parents[2] / "fixtures"
VALLEY = FIXTURES / "valley.laz"


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The bytes of a DEM in one piece."""
    output = tmp_path_factory.mktemp("whole") / "dem.tif"
    return breakline.dem(VALLEY, output=output).path.read_bytes()


@pytest.fixture
def halves(tmp_path):
    """The valley in two files."""
    made = [tmp_path / "west.laz", tmp_path / "east.laz"]
    for path, bounds in zip(made, ["0,0,688199.995,6000000", "688199.995,0,700000,6000000"]):
        program("points", str(VALLEY), "-o", str(path), f"--bounds={bounds}", "-q")
    return made


def program(*words, **options):
    """Run the program, which must succeed."""
    subprocess.run([sys.executable, "-m", "breakline", *words], check=True, **options)


def do_what_is_named(error):
    """Call what the cure of an error names; the folder is that of the error."""
    (call,) = re.findall(r"breakline\.Job\(.*?\)\.\w+\(\)", error.cure)
    return eval(call, {"breakline": breakline, "folder": error.file})


class Stop(Exception):
    """Raised while work goes on."""


def interrupted(points, output, **options):
    """Begin to write a DEM, and stop when the first task is done."""
    folder = Path(f"{output}.job")

    def stop(*_):
        if any((folder / "tasks").glob("*.task")):
            raise Stop

    with pytest.raises(Stop) as stopped:
        breakline.dem(points, output=output, tiles="8x8", progress=stop, threads=1, **options)
    return stopped.value


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("output", {"output": "b.tif"}),
        ("skip_bad", {"skip_bad": True}),
        ("overwrite", {"overwrite": True}),
        ("tiles", {"tiles": "2x2"}),
        ("max_edge", {"max_edge": 50}),
    ],
)
def test_a_job_is_that_of_one_call(tmp_path, name, other):
    folder, asked = tmp_path / "job", {"output": "a.tif", "tiles": "3x2"}

    def plan(**options):
        output = tmp_path / options.pop("output")
        return breakline.Job.plan("dem", VALLEY, output, job=folder, **options)

    assert plan(**asked).output == plan(**asked).output == tmp_path / "a.tif"
    with pytest.raises(breakline.OtherJobError, match="what differs: ") as error:
        plan(**{**asked, **other})
    assert name in error.value.message.split("what differs: ")[1]


def test_a_handle_is_of_the_job_that_it_was_opened_with(tmp_path):
    folder = tmp_path / "job"
    old = breakline.Job.plan("dem", VALLEY, tmp_path / "old.tif", job=folder, tiles="2x1")
    count = len(old.tasks())
    breakline.Job(folder).clean()
    new = breakline.Job.plan("dem", VALLEY, tmp_path / "new.tif", job=folder, tiles="2x1")
    works = [old.tasks, old.verify, old.write, old.clean, lambda: old.has_holes, lambda: old.run_task(count - 1)]
    for _ in range(2):
        for work in works:
            with pytest.raises(breakline.OtherJobError, match="removed or replaced"):
                work()
        for task in new.tasks()[:-1]:
            new.run_task(task.number)
    assert not (tmp_path / "old.tif").exists()
    assert new.write().path.exists()


def test_paths_become_absolute_when_a_job_is_planned(whole, tmp_path, monkeypatch):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "valley.laz").write_bytes(VALLEY.read_bytes())
    monkeypatch.chdir(tmp_path)
    one_by_one = breakline.Job.plan("dem", "valley.laz", "one.tif", job="one", tiles="2x1")
    at_once = breakline.Job.plan("dem", "valley.laz", "all.tif", job="all", tiles="2x1")
    (tmp_path / "grid.tif").write_bytes(whole)
    words = ["dem", str(VALLEY), "-o", "of.tif", "--align-to", "grid.tif", "--tiles", "2x1"]
    program("job", "plan", "by-program", "--", *words)
    monkeypatch.chdir("elsewhere")
    for task in one_by_one.tasks():
        one_by_one.run_task(task.number)
    assert (tmp_path / "one.tif").read_bytes() == whole
    assert at_once.write().path.read_bytes() == whole
    assert breakline.Job("../by-program").write().path.read_bytes() == whole
    assert list(Path.cwd().iterdir()) == []


def test_the_default_folder_is_that_of_the_output(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plan.json").write_text("not that of a job")
    job = breakline.Job.plan("dem", VALLEY, "dem.tif", tiles="2x1")
    assert job.folder == tmp_path / "dem.tif.job"
    assert breakline.Job.plan("dem", VALLEY, "dem.tif", tiles="2x1").folder == job.folder


def test_what_was_interrupted_goes_on_or_is_removed(whole, tmp_path):
    output, folder = tmp_path / "dem.tif", tmp_path / "dem.tif.job"
    interrupted(VALLEY, output)
    with pytest.raises(breakline.UsageError, match="there is a job in this folder already") as error:
        breakline.dem(VALLEY, output=output, tiles="8x8")
    do_what_is_named(error.value)
    assert not folder.exists()
    interrupted(VALLEY, output)
    assert breakline.dem(VALLEY, output=output, tiles="8x8", resume=True).path.read_bytes() == whole
    assert not folder.exists()


def test_an_error_says_where_tasks_are_kept(tmp_path, halves):
    about, data = halves[1].stat(), halves[1].read_bytes()
    middle = len(data) // 2
    halves[1].write_bytes(data[:middle] + bytes(16) + data[middle + 16 :])
    os.utime(halves[1], ns=(about.st_mtime_ns, about.st_mtime_ns))
    with pytest.raises(breakline.BreaklineError, match="damaged") as error:
        breakline.dem(halves, output=tmp_path / "dem.tif", tiles="2x2")
    assert f"kept in {tmp_path / 'dem.tif.job'}" in error.value.cure and "resume=True" in error.value.cure
    if sys.version_info >= (3, 11):
        (note,) = interrupted(VALLEY, tmp_path / "other.tif").__notes__
        assert "other.tif.job" in note and "resume=True" in note


def test_a_job_whose_command_is_damaged_is_removed_as_its_error_says(tmp_path):
    folder = tmp_path / "job"
    breakline.Job.plan("dem", VALLEY, tmp_path / "dem.tif", job=folder, tiles="2x1")
    command = json.loads((folder / "command.json").read_text())
    command["words"] = ["damaged"]
    (folder / "command.json").write_text(json.dumps(command))
    with pytest.raises(breakline.FormatError, match="damaged") as error:
        breakline.Job(folder).write()
    do_what_is_named(error.value)
    assert not folder.exists()
    with pytest.raises(breakline.UsageError, match="there is no job"):
        breakline.Job(folder)


def test_a_finished_job_is_left_as_it_is(whole, tmp_path):
    output, folder = tmp_path / "dem.tif", tmp_path / "job"
    output.write_bytes(b"older")
    with pytest.raises(breakline.FileKeptError):
        breakline.Job.plan("dem", VALLEY, output, job=folder, tiles="2x1")
    job = breakline.Job.plan("dem", VALLEY, output, job=folder, tiles="2x1", overwrite=True)
    with pytest.raises(breakline.FileKeptError):
        job.write(overwrite=False)
    assert job.write().path.read_bytes() == whole
    before = output.stat()
    assert job.write(overwrite=False).report == {"has_holes": False}
    assert output.stat() == before
    last = job.tasks()[-1]
    assert last.done and Path(job.run_task(last.number)) == output
    assert output.stat() == before
    job.clean()
    assert job.output == output
    with pytest.raises(breakline.OtherJobError):
        job.write()
    assert not folder.exists()


def test_a_result_with_holes_is_replaced_when_the_files_are_repaired(whole, tmp_path, halves):
    good = halves[1].read_bytes()
    halves[1].write_bytes(good[: len(good) // 2])
    job = breakline.Job.plan("dem", halves, tmp_path / "dem.tif", tiles="2x2", skip_bad=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", breakline.BreaklineWarning)
        assert job.write().report["has_holes"] and job.has_holes
        holes = job.output.read_bytes()
        assert job.write().report["has_holes"] and job.output.read_bytes() == holes
    halves[1].write_bytes(good)
    assert job.write().report["has_holes"] is False
    assert job.output.read_bytes() == whole


def test_a_job_that_plans_again_is_that_of_its_handle(whole, tmp_path, halves):
    good = halves[1].read_bytes()
    # The header is damaged, so that nothing of the file is in the plan.
    halves[1].write_bytes(good[:10])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", breakline.BreaklineWarning)
        job = breakline.Job.plan("dem", halves, tmp_path / "dem.tif", tiles="2x2", skip_bad=True)
        assert job.write().report["has_holes"]
    count = len(job.tasks())
    halves[1].write_bytes(good)
    with pytest.warns(breakline.BreaklineWarning, match="was skipped, and can be read now: the job is planned again"):
        assert job.write().report["has_holes"] is False
    assert not job.has_holes and len(job.tasks()) == count + 1
    assert job.write().path.read_bytes() == whole
    job.clean()
    assert not job.folder.exists()


def test_workers_share_a_job(whole, tmp_path):
    output, folder = tmp_path / "dem.tif", tmp_path / "job"
    job = breakline.Job.plan("dem", VALLEY, output, job=folder, tiles="4x4")
    for name, value in [("lease", 0.5), ("lease", float("nan")), ("memory", "much")]:
        with pytest.raises(breakline.UsageError, match=name):
            job.work(**{name: value})
    with ThreadPoolExecutor() as pool:
        works = [pool.submit(breakline.Job(folder).work, threads=1, memory="1GB") for _ in range(3)]
        written = [work.result() for work in works]
    assert all(one.path == output for one in written) and output.read_bytes() == whole
    assert sum("triangles" in one.report for one in written) == 1
    assert all(task.done and task.worker is None for task in job.tasks())
    job.clean()
    assert not folder.exists()


def test_a_handle_of_an_interrupted_run_is_not_that_of_the_next_job(tmp_path):
    output, folder = tmp_path / "dem.tif", tmp_path / "dem.tif.job"
    interrupted(VALLEY, output)
    old = breakline.Job(folder)
    with pytest.raises(breakline.UsageError, match="command which goes on itself"):
        old.write()
    breakline.Job(folder).clean()
    new = breakline.Job.plan("dem", VALLEY, output, tiles="2x1")
    for work in (old.tasks, old.write, old.clean):
        with pytest.raises(breakline.OtherJobError, match="removed or replaced"):
            work()
    assert new.write().path.exists()


def test_a_folder_with_a_damaged_plan_is_no_job(tmp_path):
    folder = tmp_path / "job"
    breakline.Job.plan("dem", VALLEY, tmp_path / "dem.tif", job=folder, tiles="2x1")
    (folder / "plan.json").write_text("damaged")
    with pytest.raises(breakline.FormatError, match="not the plan of a job"):
        breakline.Job(folder)


def test_standard_input_is_not_for_a_job(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(breakline.UsageError, match="tiles are made of files, which can be read again"):
        breakline.Job.plan("dem", ["-", VALLEY], "dem.tif", skip_bad=True)


def test_a_job_is_pickled_by_its_folder(tmp_path):
    job = breakline.Job.plan("dem", VALLEY, tmp_path / "dem.tif", tiles="2x1")
    again = pickle.loads(pickle.dumps(job))
    assert again.folder == job.folder and again.tasks() == job.tasks()


INTERRUPTED = """
import fcntl, os, signal, sys, threading
import breakline
job = breakline.Job(sys.argv[1])
with open(os.path.join(sys.argv[1], "lock"), "w") as lock:
    fcntl.flock(lock, fcntl.LOCK_EX)
    threading.Timer(0.2, os.kill, [os.getpid(), signal.SIGINT]).start()
    try:
        job.clean()
    except KeyboardInterrupt:
        print("interrupted")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of Unix")
def test_ctrl_c_ends_the_wait_for_another_process(tmp_path):
    folder = tmp_path / "job"
    breakline.Job.plan("dem", VALLEY, tmp_path / "dem.tif", job=folder, tiles="2x1")
    words = [sys.executable, "-c", INTERRUPTED, str(folder)]
    assert subprocess.run(words, capture_output=True, text=True).stdout == "interrupted\n"
    assert breakline.Job(folder).tasks()


def test_memory_that_makes_no_difference_is_a_warning(tmp_path):
    with pytest.warns(breakline.BreaklineWarning, match="memory"):
        breakline.dem(VALLEY, output=tmp_path / "round.tif", memory="16MB", method="natural")


def test_what_is_not_for_a_job_is_refused(tmp_path):
    job = breakline.Job.plan("dem", VALLEY, tmp_path / "dem.tif", tiles="2x1")
    for number in (-1, 1.5, "0", True, None):
        with pytest.raises(breakline.UsageError, match="not that of a task"):
            job.run_task(number)
    with pytest.raises(breakline.BreaklineError):
        job.run_task(10**6)
    with pytest.raises(breakline.UsageError, match="resume"):
        breakline.Job.plan("dem", VALLEY, tmp_path / "dem.tif", resume=True)
    with pytest.raises(breakline.UsageError, match="there is no such verb"):
        breakline.Job.plan("points", VALLEY, tmp_path / "dem.tif")


def test_what_changed_files_reach_is_done_again(tmp_path, halves):
    first, second = (
        breakline.dem(halves[:count], output=tmp_path / "dem.tif", tiles="2x2", update=True) for count in (1, 2)
    )
    assert first.path == second.path and (tmp_path / "dem.tif.job").is_dir()
    whole = breakline.dem(halves, output=tmp_path / "whole.tif")
    assert second.path.read_bytes() == whole.path.read_bytes()
    job = breakline.Job.plan("dem", halves, tmp_path / "b.tif", tiles="2x2")
    job.write()
    halves[1].write_bytes(halves[0].read_bytes())
    assert job.update().path.read_bytes() == breakline.dem(halves[:1], output=tmp_path / "west.tif").path.read_bytes()
    assert all(task.done for task in job.tasks())
    with pytest.raises(breakline.UsageError, match="resume and update are given"):
        breakline.dem(halves, output=tmp_path / "c.tif", resume=True, update=True)
