"""The graph of a job on a cluster of Dask."""

import contextlib
import json
import os
import random
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections import defaultdict
from pathlib import Path

import breakline
import pytest

distributed = pytest.importorskip("distributed")

import breakline.dask  # noqa: E402
import psutil  # noqa: E402
from breakline._objects import Objects  # noqa: E402

FIXTURES = Path(__file__).parents[2] / "fixtures"
VALLEY = FIXTURES / "valley.laz"


@pytest.fixture
def client(tmp_path):
    import dask

    settings = {
        # One kill is too many for Dask.
        "distributed.scheduler.allowed-failures": 0,
        # A cluster on one machine else gives up a worker that is killed again soon.
        "distributed.deploy.lost-worker-timeout": "1 hour",
        "temporary-directory": str(tmp_path / "scratch"),
    }
    with (
        dask.config.set(settings),
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


@pytest.fixture
def whole(tmp_path):
    path = tmp_path / "whole.tif"
    run("dem", str(VALLEY), "-o", str(path), "-q")
    return path.read_bytes()


def tasks(job):
    """The tasks of a job, as the program tells."""
    words = [sys.executable, "-m", "breakline", "job", "status", str(job), "--json"]
    return json.loads(subprocess.run(words, check=True, capture_output=True).stdout)["tasks"]


def run(*words):
    subprocess.run([sys.executable, "-m", "breakline", *words], check=True)


def test_a_cluster_writes_the_bytes_of_one_machine(client, whole, tmp_path):
    made = breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, tiles="4x3")
    assert made.read_bytes() == whole
    assert not (tmp_path / "dem.tif.job").exists()
    made = breakline.dask.hillshade([VALLEY], tmp_path / "shade.tif", client=client, tiles="2x2", azimuth=200)
    run("hillshade", str(VALLEY), "-o", str(tmp_path / "one.tif"), "--azimuth", "200", "-q")
    assert made.read_bytes() == (tmp_path / "one.tif").read_bytes()
    made = breakline.dask.contour(VALLEY, tmp_path / "lines.geojson", client=client, tiles="2x2", interval=5)
    run("contour", str(VALLEY), "-o", str(tmp_path / "one.geojson"), "--interval", "5", "-q")
    assert made.read_bytes() == (tmp_path / "one.geojson").read_bytes()
    made = breakline.dask.tin(VALLEY, tmp_path / "valley.tins", client=client, tiles="2x2")
    run("dem", str(made), "-o", str(tmp_path / "of_parts.tif"), "-q")
    assert (tmp_path / "of_parts.tif").read_bytes() == whole


class Transitions(distributed.SchedulerPlugin):
    """The tasks that came to each state of Dask."""

    def __init__(self, client):
        self.tasks = defaultdict(list)
        client.cluster.scheduler.add_plugin(self)

    def transition(self, key, start, finish, *args, **kwargs):
        self.tasks[finish].append(key)


class Killer(threading.Thread):
    """Kills workers while they do a task; if the job is given, once files of tasks are there, which are remembered."""

    def __init__(self, client, count, job=None):
        super().__init__()
        self.cluster, self.count, self.job = client.cluster, count, job
        self.kills, self.done, self.files = 0, threading.Event(), {}

    def __enter__(self):
        self.start()

    def __exit__(self, *error):
        self.done.set()
        self.join()

    def run(self):
        while self.kills < self.count and not self.done.wait(random.uniform(0.05, 0.2)):
            victims = [nanny for nanny in list(self.cluster.workers.values()) if self.is_busy(nanny)]
            if self.job:
                self.files = {**written(self.job), **self.files}
            if victims and (self.files or not self.job):
                with contextlib.suppress(psutil.Error):
                    psutil.Process(random.choice(victims).pid).kill()
                    self.kills += 1

    def is_busy(self, nanny):
        worker = self.cluster.scheduler.workers.get(nanny.worker_address)
        return nanny.pid is not None and worker is not None and bool(worker.processing)


def written(job):
    """The files of the tasks of a job, and which file each is: one that is written again is another."""
    found = {}
    for path in (job / "tasks").glob("*.task"):
        with contextlib.suppress(FileNotFoundError):
            status = path.stat()
            found[path.name] = (status.st_ino, status.st_mtime_ns)
    return found


def wait_until(is_so):
    end = time.monotonic() + 10
    while not is_so():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_workers_may_be_killed(client, whole, tmp_path):
    transitions, job = Transitions(client), tmp_path / "job"
    with (killer := Killer(client, int(os.environ.get("BREAKLINE_KILLS", 5)), job)):
        made = breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, tiles="16x16", job=job)
    assert killer.kills > 0 and transitions.tasks["erred"]
    assert made.read_bytes() == whole
    # Dask may begin what is done again when the worker that did it is killed at once; its file stays.
    kept = written(job)
    assert killer.files and killer.files.items() <= kept.items()


def test_a_task_that_kills_its_workers_is_an_error(client, tmp_path, monkeypatch):
    monkeypatch.setattr(breakline.dask, "_AGAIN", 0)
    said = r"(divide|tile|merge|rim|output).*: the workers that did this task died .*\n  cure: .*\.clean\(\), .*memory="
    with pytest.raises(breakline.BreaklineError, match=said), Killer(client, 100):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, tiles="16x16")
    wait_until(lambda: not client.cluster.scheduler.tasks)


def test_an_error_of_a_task_ends_the_run(client, tmp_path):
    files = [tmp_path / f"{letter}.laz" for letter in "abcd"]
    for file in files:
        file.write_bytes(VALLEY.read_bytes())
    job, output = tmp_path / "job", tmp_path / "dem.tif"
    run("job", "plan", str(job), "--", "dem", *map(str, files), "-o", str(output), "--tiles=3x3")
    damage(files[2])
    with pytest.raises(breakline.BreaklineError, match="c.laz.*damaged"):
        breakline.dask.dem(files, output, client=client, tiles="3x3", job=job, retries=1)
    wait_until(lambda: not client.cluster.scheduler.tasks)
    assert not output.exists()


def damage(file):
    """Change bytes in the middle, and not the time: a job looks at that only."""
    time, data = file.stat().st_mtime_ns, bytearray(file.read_bytes())
    middle = len(data) // 2
    data[middle : middle + 16] = bytes(16)
    file.write_bytes(data)
    os.utime(file, ns=(time, time))


def test_ctrl_c_cancels_what_waits(client, tmp_path):
    scheduler, job = client.cluster.scheduler, tmp_path / "job"

    def interrupt():
        wait_until(lambda: len(scheduler.tasks) > 3)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, tiles="16x16", job=job)
    thread.join()
    wait_until(lambda: not scheduler.tasks)
    assert not all(task["done"] for task in tasks(job))


def test_a_lost_scheduler_is_an_error_with_its_cure(tmp_path):
    def start(*words):
        return subprocess.Popen([sys.executable, "-m", *words], cwd=tmp_path, stderr=subprocess.DEVNULL)

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    scheduler = start("distributed.cli.dask_scheduler", "--host", address, "--dashboard-address", "127.0.0.1:0")
    worker = start("distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny", "--death-timeout", "60")
    output, job = tmp_path / "dem.tif", tmp_path / "job"

    def kill():
        wait_until(lambda: any((job / "tasks").glob("*.task")))
        scheduler.kill()

    try:
        with distributed.Client(address, timeout=60) as client:
            client.wait_for_workers(1)
            thread = threading.Thread(target=kill)
            thread.start()
            with pytest.raises(breakline.BreaklineError, match="(?s)scheduler .* was lost.*cure: .*the same call goes on"):
                breakline.dask.dem(VALLEY, output, client=client, tiles="16x16", job=job)
            thread.join()
    finally:
        for process in (scheduler, worker):
            process.kill()
            process.wait()
    assert not output.exists()
    assert any(task["done"] for task in tasks(job)) and not all(task["done"] for task in tasks(job))


def test_a_job_goes_on_with_what_is_done(client, whole, tmp_path):
    job = tmp_path / "job"
    command = ["dem", str(VALLEY), "-o", str(tmp_path / "dem.tif"), "--tiles=3x3"]
    run("job", "plan", str(job), "--", *command)
    for task in range(5):
        run("job", "run", str(job), "--task", str(task), "-q")
    before = {path.name: path.stat().st_mtime_ns for path in (job / "tasks").iterdir()}
    time.sleep(0.01)
    made = breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, tiles="3x3", job=job)
    assert made.read_bytes() == whole
    after = {path.name: path.stat().st_mtime_ns for path in (job / "tasks").iterdir()}
    assert len(after) == 12 and all(after[name] == at for name, at in before.items())
    # What was asked for is what is written: nothing is passed off as it.
    asked = {"output": tmp_path / "dem.tif", "tiles": "3x3"}
    for other in ({"output": tmp_path / "b.tif"}, {"tiles": "2x2"}, {"skip_bad": True}, {"overwrite": True}):
        with pytest.raises(breakline.OtherJobError, match=f"what differs: (the )?{next(iter(other))}"):
            breakline.dask.dem(VALLEY, client=client, job=job, **{**asked, **other})
    assert not (tmp_path / "b.tif").exists()


def test_a_result_with_holes_is_a_warning_until_the_files_are_repaired(client, whole, tmp_path):
    west, east, job, output = (tmp_path / name for name in ("west.laz", "east.laz", "job", "dem.tif"))
    for path, bounds in [(west, "0,0,688199.995,6000000"), (east, "688199.995,0,700000,6000000")]:
        run("points", str(VALLEY), "-o", str(path), f"--bounds={bounds}", "-q")
    good = east.read_bytes()
    east.write_bytes(good[: len(good) // 2])
    options = {"client": client, "tiles": "2x2", "job": job, "skip_bad": True}
    with pytest.warns(breakline.BreaklineWarning, match="files were skipped, so that .*dem.tif has holes: repair them"):
        breakline.dask.dem([west, east], output, **options)
    assert output.read_bytes() != whole
    again = [sys.executable, "-m", "breakline", "job", "run", str(job), "-q"]
    assert subprocess.run(again).returncode == 3
    east.write_bytes(good)
    assert subprocess.run(again).returncode == 0
    assert output.read_bytes() == whole
    # Nothing is left to do, and nothing is missing any more.
    assert breakline.dask.dem([west, east], output, **options).read_bytes() == whole


def test_what_is_wrong_is_an_error_with_its_cure(client, tmp_path):
    with pytest.raises(breakline.BreaklineError, match="none.laz"):
        breakline.dask.dem(tmp_path / "none.laz", tmp_path / "dem.tif", client=client)
    with pytest.raises(breakline.BreaklineError, match="does not work with tiles yet"):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, add_ridges=True)
    with pytest.raises(breakline.UsageError, match="client"):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=None)
    with pytest.raises(breakline.UsageError, match="the same call goes on"):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, resume=True)
    with pytest.raises(breakline.UsageError, match="flat_points"):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, flat_points=True)
    with pytest.raises(breakline.UsageError, match="inputs is not a path"):
        breakline.dask.dem([[0.0, 0.0, 1.0]], tmp_path / "dem.tif", client=client)
    assert list(tmp_path.glob("*.tif")) == []


def test_objects_are_copied_for_the_tasks_that_read_them(client, whole, tmp_path, monkeypatch):
    # Else such small ones are copied whole, for planning, too.
    monkeypatch.setattr(breakline._objects, "_SMALL", 0)
    store, scratch, planned = tmp_path / "store", tmp_path / "copies", []
    store.mkdir()
    for letter in "ab":
        (store / f"{letter}.laz").write_bytes(VALLEY.read_bytes())
    begin = breakline.Job._begin

    def watched(*arguments, **planning):
        planned.extend(path.stat() for path in scratch.rglob("*.laz"))
        return begin(*arguments, **planning)

    monkeypatch.setattr(breakline.Job, "_begin", watched)
    options = {"client": client, "scratch": scratch, "tiles": "3x3", "job": tmp_path / "job"}
    made = breakline.dask.dem(f"file://{store}/*.laz", tmp_path / "dem.tif", classes=2, **options)
    assert made.read_bytes() == whole
    # What was planned with is as long as the objects, but most of it is a hole.
    assert [about.st_size for about in planned] == [VALLEY.stat().st_size] * 2
    assert all(about.st_blocks * 512 < about.st_size / 2 for about in planned)
    assert [path for path in scratch.rglob("*") if path.is_file()] == []
    done = {path: path.stat().st_mtime_ns for path in (tmp_path / "job" / "tasks").iterdir()}
    breakline.dask.dem(f"file://{store}/*.laz", tmp_path / "dem.tif", classes=2, **options)
    assert all(path.stat().st_mtime_ns == time for path, time in done.items())
    (store / "b.laz").write_bytes(VALLEY.read_bytes()[:-1])
    with pytest.raises(breakline.UsageError, match="changed since the job has read it"):
        breakline.dask.dem(f"file://{store}/*.laz", tmp_path / "dem.tif", classes=2, **options)
    for name in ["*.las", "c.laz"]:
        with pytest.raises(breakline.UsageError, match="no object has such a name"):
            breakline.dask.dem(f"file://{store}/{name}", tmp_path / "other.tif", classes=2, **options)
    with pytest.raises(breakline.UsageError, match="one store within another"):
        breakline.dask.dem(f"zip://a.laz::file://{store}/a.zip", tmp_path / "other.tif", classes=2, **options)
    with pytest.raises(breakline.UsageError, match="classes=2"):
        breakline.dask.dem(f"file://{store}/a.laz", tmp_path / "other.tif", **options)
    with pytest.raises(breakline.UsageError, match="output is an object"):
        breakline.dask.dem(f"file://{store}/a.laz", f"file://{store}/dem.tif", classes=2, **options)


def test_an_object_whose_name_looks_like_a_pattern_goes_on(client, whole, tmp_path):
    (tmp_path / "store").mkdir()
    (tmp_path / "store" / "tile[1].laz").write_bytes(VALLEY.read_bytes())
    options = {"client": client, "classes": 2, "tiles": "2x1", "job": tmp_path / "job", "scratch": tmp_path / "copies"}
    for _ in range(2):
        made = breakline.dask.dem(f"file://{tmp_path}/store/*.laz", tmp_path / "dem.tif", **options)
        assert made.read_bytes() == whole


def test_tasks_take_what_workers_have(client, tmp_path):
    with pytest.warns(breakline.BreaklineWarning, match="valley.laz is named twice and used once"):
        breakline.dask.dem([VALLEY, VALLEY], tmp_path / "dem.tif", client=client, tiles="2x1", job=tmp_path / "job")
    plan = json.loads((tmp_path / "job" / "plan.json").read_text().splitlines()[1])
    assert len(plan["files"]) == 1
    (limit,) = {worker["memory_limit"] for worker in client.scheduler_info()["workers"].values()}
    assert plan["task_memory"] == limit // 2
    # What the caller says counts, as the error of a task that kills its workers promises.
    said = {"client": client, "tiles": "2x1", "memory": "64MB", "threads": 2}
    breakline.dask.dem(VALLEY, tmp_path / "less.tif", job=tmp_path / "less", **said)
    plan = json.loads((tmp_path / "less" / "plan.json").read_text().splitlines()[1])
    assert plan["task_memory"] == 32_000_000


def test_a_call_goes_on_with_the_same_files_only(client, tmp_path):
    points, job, output = tmp_path / "a.laz", tmp_path / "job", tmp_path / "dem.tif"
    points.write_bytes(VALLEY.read_bytes())
    options = {"client": client, "tiles": "2x1", "job": job}
    breakline.dask.dem(points, output, **options)
    os.utime(points, ns=(0, 0))
    # A finished job, and one that was interrupted.
    for _ in range(2):
        with pytest.raises(breakline.UsageError, match="a.laz: the file has changed since the job") as error:
            breakline.dask.dem(points, output, **options)
        with pytest.raises(breakline.UsageError) as own:
            breakline.Job(job).write()
        assert str(error.value) == str(own.value)
        max((job / "tasks").iterdir()).unlink(missing_ok=True)
    output.unlink()
    # As the error says.
    assert f'breakline.Job("{job}").clean()' in error.value.cure
    breakline.Job(job).clean()
    assert breakline.dask.dem(points, output, **options).exists()


def test_the_smallest_worker_counts():
    class Client:
        def __init__(self, *workers):
            self.workers = {number: dict(zip(("memory_limit", "nthreads"), one)) for number, one in enumerate(workers)}

        def scheduler_info(self):
            return {"workers": self.workers}

    assert breakline.dask._memory_of_tasks(Client((8000, 2), (1000, 1), (3000, 4), (0, 64))) == 375
    assert breakline.dask._memory_of_tasks(Client((0, 1))) is None
    assert breakline.dask._memory_of_tasks(Client()) is None


def test_objects_that_change_are_refused(tmp_path):
    stored, job = tmp_path / "a.laz", tmp_path / "job"
    stored.write_bytes(VALLEY.read_bytes())
    (one,) = Objects([f"file://{stored}"], str(tmp_path / "copies"), None, str(job)).at.values()
    with one.copied():
        assert Path(one.path).read_bytes() == VALLEY.read_bytes()
        assert Path(one.path).stat().st_mtime_ns == one.time
    assert not Path(one.path).exists()
    stored.write_bytes(VALLEY.read_bytes()[:-1])
    with pytest.raises(breakline.UsageError, match="has changed"), one.copied():
        pass


def test_keys_of_a_store_are_in_no_log(tmp_path):
    (tmp_path / "a.laz").write_bytes(VALLEY.read_bytes())
    (one,) = Objects([f"file://{tmp_path}/a.laz"], None, {"auto_mkdir": "SECRET"}, "job").at.values()
    assert "SECRET" not in repr(one)


@pytest.mark.parametrize("place", ["before", "behind", "nowhere"])
def test_of_laz_all_but_the_points_is_read_to_plan(tmp_path, monkeypatch, place):
    monkeypatch.setattr(breakline._objects, "_SMALL", 0)
    data = bytearray(VALLEY.read_bytes())
    (start,) = struct.unpack_from("<I", data, 96)
    if place != "before":
        # As a stream is written: the place of the chunk table is at the end.
        data += data[start : start + 8] if place == "behind" else bytes(8)
        data[start : start + 8] = struct.pack("<q", -1)
    (tmp_path / "a.laz").write_bytes(data)
    objects = Objects([f"file://{tmp_path}/a.laz"], str(tmp_path / "copies"), None, "job")
    (path,) = objects.at
    with objects.headers():
        about = os.stat(path)
        assert about.st_size == len(data)
        is_whole = about.st_blocks * 512 >= len(data)
        assert is_whole == (place == "nowhere")
        output, job = str(tmp_path / "dem.tif"), str(tmp_path / "job")
        run("job", "plan", job, "--headers-only", "--", "dem", path, "-o", output, "--class=2", "--tiles=auto")
        assert json.loads((tmp_path / "job" / "plan.json").read_text().splitlines()[1])["files"][0]["count"] == 62776
    assert not os.path.exists(path)
