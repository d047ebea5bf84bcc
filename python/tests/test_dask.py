"""The graph of a job on a cluster of Dask."""

import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import breakline
import pytest

distributed = pytest.importorskip("distributed")

import breakline.dask  # noqa: E402

FIXTURES = Path(__file__).parents[2] / "fixtures"
VALLEY = FIXTURES / "valley.laz"


@pytest.fixture
def client(tmp_path):
    import dask

    dask.config.set({"distributed.scheduler.allowed-failures": 100, "temporary-directory": str(tmp_path / "scratch")})
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


@pytest.fixture
def whole(tmp_path):
    path = tmp_path / "whole.tif"
    run("dem", str(VALLEY), "-o", str(path), "-q")
    return path.read_bytes()


def run(*words):
    subprocess.run([sys.executable, "-m", "breakline", *words], check=True)


def test_a_cluster_writes_the_bytes_of_one_machine(client, whole, tmp_path):
    made = breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, tiles="4x3")
    assert made.read_bytes() == whole
    assert not (tmp_path / "dem.tif.job").exists()
    made = breakline.dask.hillshade([VALLEY], tmp_path / "shade.tif", client=client, tiles="2x2", azimuth=200)
    run("hillshade", str(VALLEY), "-o", str(tmp_path / "one.tif"), "--azimuth", "200", "-q")
    assert made.read_bytes() == (tmp_path / "one.tif").read_bytes()


def test_workers_may_be_killed(client, whole, tmp_path):
    done = threading.Event()
    kills, count = 0, int(os.environ.get("BREAKLINE_KILLS", 2))

    def kill():
        nonlocal kills
        while not done.wait(random.uniform(0.5, 1.0)) and kills < count:
            pids = [pid for pid in client.run(os.getpid, on_error="ignore").values() if isinstance(pid, int)]
            if pids:
                os.kill(random.choice(pids), signal.SIGKILL)
                kills += 1

    killer = threading.Thread(target=kill)
    killer.start()
    try:
        made = breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, tiles="8x8", job=tmp_path / "job")
    finally:
        done.set()
        killer.join()
    assert kills > 0
    assert made.read_bytes() == whole


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
    with pytest.raises(breakline.UsageError, match="another call"):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, tiles="2x2", job=job)


def test_what_is_wrong_is_an_error_with_its_cure(client, tmp_path):
    with pytest.raises(breakline.BreaklineError, match="none.laz"):
        breakline.dask.dem(tmp_path / "none.laz", tmp_path / "dem.tif", client=client)
    with pytest.raises(breakline.BreaklineError, match="does not work with tiles yet"):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=client, boundary=FIXTURES / "boundary.shp")
    with pytest.raises(breakline.UsageError, match="client"):
        breakline.dask.dem(VALLEY, tmp_path / "dem.tif", client=None)
    assert list(tmp_path.glob("*.tif")) == []
