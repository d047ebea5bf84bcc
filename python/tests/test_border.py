"""What crosses the border between Python and Rust: bad input, errors, warnings, threads, processes, signals."""

import gc
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import breakline
import numpy as np
import pytest

SQUARE = np.array([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]], dtype=float)


@pytest.mark.parametrize(
    "points, kind",
    [
        (None, TypeError),
        (7, ValueError),
        (np.zeros((4, 2)), ValueError),
        (np.zeros((2, 3, 3)), ValueError),
        (np.zeros(3), ValueError),
        ([["a", "b", "c"]], TypeError),
        ([[1, 2, 3], [1, 2]], TypeError),
        (np.zeros((3, 3), dtype=complex), TypeError),
        (np.array([[0, 0, 0], [1, 0, np.nan], [0, 1, 0]]), ValueError),
        (np.array([[0, 0, 0], [np.inf, 0, 0], [0, 1, 0]]), ValueError),
        (np.empty((0, 3)), ValueError),
        (SQUARE[:2], ValueError),
        (np.zeros((5, 3)), ValueError),
        (np.ma.masked_array(SQUARE, SQUARE >= 0), ValueError),
        ({"x": [1, 2], "y": [1, 2]}, ValueError),
        ({"x": [1, 2], "y": [1, 2], "z": [1]}, ValueError),
        ([], ValueError),
        ({"x": [0, 1, 0], "y": [0, 0, 1], "z": [0, 0, 0], "classification": [258, 2, 2]}, ValueError),
        ({"x": [0, 1, 0], "y": [0, 0, 1], "z": [0, 0, 0], "classification": [2.5, 2, 2]}, ValueError),
        ("no-such-file.laz", FileNotFoundError),
        (os.curdir, OSError),
    ],
)
def test_points_that_cannot_be_used_are_refused_with_a_cure(points, kind):
    with pytest.raises(kind) as caught:
        breakline.tin(points)
    assert isinstance(caught.value, breakline.BreaklineError)
    assert caught.value.message


@pytest.mark.parametrize(
    "options",
    [
        {"max_edge": -1.0},
        {"max_edge": "far"},
        {"crossing_tolerance": float("nan")},
        {"flat_tolerance": -1.0},
        {"flat_buffer": -5.0},
        {"classes": [2.7]},
        {"bounds": (3, 3, 1, 1)},
        {"bounds": (1, 2, 3)},
        {"classes": "grass"},
        {"classes": 300},
        {"duplicates": "best"},
        {"crs": "EPSG:1"},
        {"crs": object()},
        {"threads": 0},
        {"threads": 100_000},
        {"duplicates": None},
        {"on_crossing": 1},
        {"crossing_z": None},
        {"wall_high": 3},
        {"max_edge": []},
        {"max_edge_inside": "far"},
        {"densify": [1]},
        {"flat_buffer": None},
        {"river_width": {}},
        {"bounds": 5},
        {"bounds": "abcd"},
        {"classes": [None]},
        {"classes": np.array(["grass"])},
        {"classes": object()},
        {"columns": 3},
        {"threads": 1.5},
        {"progress": 3},
        {"breaklines": np.zeros((3, 5))},
        {"breaklines": [np.zeros((3, 2))]},
        {"wall_bottom": 1.0, "wall_drop": 1.0},
        {"columns": "XYQ"},
    ],
)
def test_options_that_make_no_sense_are_refused_with_a_cure(options):
    with pytest.raises(breakline.BreaklineError) as caught:
        breakline.tin(SQUARE, **options)
    assert caught.value.cure, str(caught.value)
    assert "--" not in str(caught.value)


@pytest.mark.parametrize(
    "call",
    [
        lambda tin: tin.elevation([[1, 1]], method=None),
        lambda tin: tin.elevation([[1, 1]], method="cubic"),
        lambda tin: tin.elevation(None),
        lambda tin: tin.elevation("abc"),
        lambda tin: tin.dem("fine"),
        lambda tin: tin.dem([1]),
        lambda tin: tin.dem(method=3),
        lambda tin: tin.contours("x"),
        lambda tin: tin.contours(-1),
        lambda tin: tin.contours(1, base=None),
        lambda tin: tin.contours(levels=["x"]),
        lambda tin: tin.hillshade(azimuth="north"),
        lambda tin: tin.dem(5.0).hillshade(z_factor=[]),
        lambda tin: tin.write(3),
        lambda tin: breakline.check(tin, max_edge=3.0),
        lambda tin: breakline.check(tin.dem(5.0)),
        lambda tin: breakline.dem(tin, max_edge=3.0),
        lambda tin: breakline.hillshade(tin.dem(5.0), max_edge=3.0),
        lambda tin: breakline.read_points("x.laz", returns=["x"]),
        lambda tin: breakline.read_points("x.laz", returns=300),
        lambda tin: breakline.triangulate("x.node", kernel=None),
        lambda tin: breakline.triangulate("x.node", max_added=-3),
        lambda tin: breakline.triangulate("x.node", min_angle="x"),
        lambda tin: breakline.triangulate("x.node", in_space=True, alpha=[1]),
    ],
)
def test_arguments_of_other_types_are_refused_with_a_cure(call):
    tin = breakline.tin(SQUARE)
    with pytest.raises(breakline.UsageError) as caught:
        call(tin)
    assert caught.value.cure, str(caught.value)


def test_options_of_building_are_refused_for_a_raster_in_a_file(tmp_path):
    breakline.tin(SQUARE).dem(1.0).write(tmp_path / "dem.tif")
    with pytest.raises(breakline.UsageError, match="max_edge is for building"):
        breakline.contour(tmp_path / "dem.tif", max_edge=3.0)


def test_numbers_of_other_types_are_taken():
    for dtype in (np.float32, np.int32, np.int64, np.uint8, ">f8"):
        tin = breakline.tin(SQUARE.astype(dtype))
        assert len(tin.triangles) == 2
    frozen = SQUARE.copy()
    frozen.flags.writeable = False
    assert len(breakline.tin(frozen).triangles) == 2


def test_cures_and_notices_name_parameters(tmp_path):
    with pytest.raises(breakline.FormatError) as caught:
        breakline.tin(SQUARE, walls=[[[1, 1, 1], [5, 5, 2]]])
    assert "give its height with wall_bottom or wall_drop, or" in caught.value.cure
    with pytest.raises(breakline.FormatError) as caught:
        breakline.tin(SQUARE, breaklines=[[[0, 0, 1], [9, 9, 1]], [[0, 9, 1], [9, 0, 1]]], on_crossing="reject")
    assert 'split them there with on_crossing="split"' in caught.value.cure
    tin = breakline.tin(SQUARE, max_edge="none")
    assert any('(max_edge="none")' in notice.text for notice in tin.notices), tin.notices
    # What only the program has is named as there.
    with pytest.raises(breakline.UnsupportedError) as caught:
        tin.write(tmp_path / "parts.tins")
    assert "use breakline.tin() for points" in caught.value.cure


def test_an_error_in_a_file_names_file_location_and_cure(tmp_path):
    (tmp_path / "broken.xyz").write_text("1 2 3\n4 5 6\n7 eight 9\n")
    with pytest.raises(breakline.FormatError) as caught:
        breakline.tin(tmp_path / "broken.xyz")
    error = caught.value
    assert error.file.endswith("broken.xyz") and error.location == "line 3"
    again = pickle.loads(pickle.dumps(error))
    assert (again.file, again.location, again.cure, str(again)) == (error.file, error.location, error.cure, str(error))
    with pytest.raises(breakline.FileMissingError) as caught:
        breakline.info(tmp_path / "none.laz")
    assert caught.value.errno == 2


def test_what_looks_wrong_is_a_warning_at_the_line_of_the_caller(tmp_path):
    first = np.array([[0, 5, 1], [10, 5, 1]], dtype=float)
    second = np.array([[5, 0, 9], [5, 10, 9]], dtype=float)
    with pytest.warns(breakline.BreaklineWarning, match="different heights") as caught:
        tin = breakline.tin(SQUARE, breaklines=[first, second])
    assert caught[0].filename == __file__
    assert tin.report["crossing_heights"][0]["at"] == [5.0, 5.0]
    assert any(notice.severity == "warning" for notice in tin.notices)


def test_results_do_not_depend_on_threads(cloud):
    one, two = (breakline.tin(cloud, threads=threads) for threads in (1, 2))
    assert np.array_equal(one.triangles, two.triangles)
    xy = cloud[::-1, :2] + 0.25
    assert np.array_equal(one.elevation(xy, threads=1), one.elevation(xy, threads=2), equal_nan=True)


def test_progress_is_reported_and_may_cancel(cloud):
    calls = []
    breakline.tin(cloud, progress=lambda *call: calls.append(call))
    assert calls and all(isinstance(stage, str) and done >= 0 for stage, done, _ in calls)

    def refuse(stage, done, total):
        raise LookupError("no more")

    points = np.tile(cloud, (30, 1)) + np.random.default_rng(5).random((300_000, 3))
    with pytest.raises(LookupError, match="no more"):
        breakline.tin(points, progress=refuse)


def test_eight_threads_at_once(cloud):
    expected = breakline.tin(cloud).triangles
    results, errors = [], []

    def work():
        try:
            tin = breakline.tin(cloud)
            results.append(np.array_equal(tin.triangles, expected) and np.isfinite(tin.elevation(cloud[:, :2])).all())
        except BaseException as error:  # reported below
            errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
    assert not errors and results == [True] * 8


def _count(points):
    return len(breakline.tin(points).triangles)


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_processes_of_all_kinds(cloud, method):
    expected = _count(cloud)  # so that this process has threads before it forks
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map_async(_count, [cloud] * 4).get(timeout=120) == [expected] * 4


def test_control_c_ends_a_long_call_before_its_end(tmp_path):
    # Progress sends the signal, so that it comes early whatever the machine does meanwhile. A call that missed it would
    # report progress again; one that was not canceled would leave its file, which appears at the end.
    script = (
        "import numpy, os, signal, breakline\n"
        "points = numpy.random.default_rng(1).random((2_000_000, 3)) * 1000\n"
        "tin = breakline.tin(points)\n"
        "calls = []\n"
        "def interrupt(*call):\n"
        "    calls.append(call)\n"
        "    os.kill(os.getpid(), signal.SIGINT)\n"
        "for long_call in (breakline.tin, lambda _, progress: tin.write('x.obj', progress=progress)):\n"
        "    try:\n"
        "        long_call(points, progress=interrupt)\n"
        "    except KeyboardInterrupt:\n"
        "        print('interrupted')\n"
        "print(len(calls))\n"
    )
    command = [sys.executable, "-c", script]
    found = subprocess.run(command, capture_output=True, text=True, timeout=120, cwd=tmp_path)
    assert found.stdout == "interrupted\ninterrupted\n2\n", found.stdout + found.stderr
    assert not list(tmp_path.iterdir())


def _resident():
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="the system does not report memory")
def test_memory_of_many_calls_is_flat():
    def calls(count):
        for _ in range(count):
            tin = breakline.tin(SQUARE, threads=1)
            tin.elevation([[5, 5]])
            assert len(tin.triangles) == 2 and len(tin.edges) == 5
            with pytest.raises(breakline.BreaklineError):
                breakline.tin(SQUARE[:2], threads=1)
        gc.collect()

    calls(500)
    before = _resident()
    calls(9500)
    assert _resident() - before < 4 << 20


def test_the_class_cannot_be_made_by_hand():
    with pytest.raises(breakline.ArgumentTypeError):
        breakline.Tin(SQUARE)


def test_import_is_fast():
    script = "import numpy, time; start = time.process_time(); import breakline; print(time.process_time() - start)"
    times = [float(subprocess.check_output([sys.executable, "-c", script])) for _ in range(3)]
    assert min(times) < 0.1


def test_the_example_of_the_package_runs():
    import doctest

    failed, tried = doctest.testmod(breakline)
    assert tried and not failed
