"""What a call costs: threads that it starts, and what is prepared for the next one."""

import subprocess
import sys
import textwrap

import breakline
import numpy as np
import pytest

FEW = """
    import os, threading
    import numpy as np
    import breakline
    from breakline import triangle
    from breakline.spatial import Delaunay, LinearNDInterpolator, NaturalNeighborInterpolator

    def threads():
        return len(os.listdir("/proc/self/task"))

    def work(points):
        tri = Delaunay(points, incremental=True)
        tri.simplices, tri.transform, tri.find_simplex(points), tri.add_points(points[:3] / 2)
        LinearNDInterpolator(points, points[:, 0])(points)
        NaturalNeighborInterpolator(points, points[:, 0])(points)
        triangle.triangulate({"vertices": points}, "c")
        tin = breakline.tin(np.column_stack([points, points[:, 0]]), max_edge="none")
        tin.vertices, tin.elevation(points)
"""


def in_process(code):
    """Run code in a process of its own: threads that were started stay."""
    script = textwrap.dedent(FEW) + textwrap.dedent(code)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="threads are counted by /proc")
def test_no_thread_is_started_for_few_points():
    in_process("""
        points = np.random.default_rng(0).random((120, 2))
        before = threads()
        work(points)
        assert threads() == before, (before, threads())
    """)


def test_few_points_on_many_threads_and_after_a_fork():
    in_process("""
        points = np.random.default_rng(0).random((120, 2))
        work(points)
        workers = [threading.Thread(target=work, args=(points,)) for _ in range(8)]
        [worker.start() for worker in workers], [worker.join() for worker in workers]
        child = os.fork()
        if child == 0:
            work(points)
            os._exit(7)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7 if hasattr(os, "waitstatus_to_exitcode") else True
    """)


def test_errors_and_progress_of_few_points():
    with pytest.raises(ValueError, match="NaN"):
        breakline.spatial.Delaunay([[0, 0], [1, np.nan], [0, 1], [1, 1]])
    stages = []
    points = np.random.default_rng(0).random((50, 3))
    breakline.tin(points, max_edge="none", progress=lambda *stage: stages.append(stage))
    assert stages, "the last stage is reported"
    with pytest.raises(ZeroDivisionError):
        breakline.tin(points, max_edge="none", progress=lambda *stage: 1 / 0)


@pytest.mark.parametrize("method", ["linear", "nearest", "natural", "laplace", "smooth", "idw"])
def test_heights_by_a_prepared_method_are_those_of_the_first_call(valley, method):
    xmin, ymin, xmax, ymax = valley.bounds
    at = np.random.default_rng(1).uniform((xmin, ymin), (xmax, ymax), (300, 2))
    first = valley.elevation(at, method=method)
    assert np.array_equal(first, valley.elevation(at, method=method), equal_nan=True)
    assert np.array_equal(first[:5], [valley.elevation(q, method=method) for q in at[:5]], equal_nan=True)
