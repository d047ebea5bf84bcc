"""Times of breakline beside those of scipy, triangle and startinpy, in one process: medians of runs in turn.

Run it with the package and the judges installed::

    python benches/compare.py [--points 1000000] [--runs 7] [--only NAME]

All arrays are float64. A row has the medians of breakline on one and on two threads, that of the other package on
the threads that it uses (one), and how many times faster breakline is. Runs of all are taken in turn, so that a
busy machine slows all of them.
"""

from __future__ import annotations

import argparse
import gc
import os
import platform
import statistics
import time

import numpy as np

from breakline import spatial, triangle


def timed(work):
    gc.collect()
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--only", default="", help="rows whose name contains this")
    options = parser.parse_args()
    print(f"{platform.platform()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}, Python {platform.python_version()}")
    print(f"{options.points} points, medians of {options.runs}, in seconds\n")
    print(f"{'what':<34}{'1 thread':>10}{'2 threads':>11}  {'other':<12}{'seconds':>9}{'x on 1':>8}{'x on 2':>8}")
    for name, rivals, ours in rows(options.points):
        if options.only in name:
            compare(name, rivals, ours, options.runs)


def compare(name, rivals, ours, runs):
    """Print a line for each rival of one row."""
    contestants = {"1": lambda: ours(1), "2": lambda: ours(2), **rivals}
    # A rival that takes minutes is run once: it does not matter then.
    seconds = {key: [] for key in contestants}
    slow = set()
    for run in range(runs):
        for key, work in contestants.items():
            if key not in slow:
                duration, result = timed(work)
                seconds[key].append(duration)
                if duration > 60:
                    slow.add(key)
                del result
    medians = {key: statistics.median(values) for key, values in seconds.items()}
    if not rivals:
        print(f"{name:<34}{medians['1']:>10.3f}{medians['2']:>11.3f}", flush=True)
    for rival in rivals:
        once = " (1 run)" if rival in slow else ""
        print(
            f"{name:<34}{medians['1']:>10.3f}{medians['2']:>11.3f}  {rival:<12}{medians[rival]:>9.3f}"
            f"{medians[rival] / medians['1']:>8.1f}{medians[rival] / medians['2']:>8.1f}{once}",
            flush=True,
        )


def rows(count):
    """Yield the name of a row, the other packages by name, and ours as a function of the number of threads."""
    rng = np.random.default_rng(0)
    points = rng.random((count, 2))
    values = np.sin(10 * points[:, 0]) + points[:, 1]
    queries = rng.random((count, 2))
    heights = np.column_stack([points, values])

    others = installed()

    def both(tri):
        return tri.simplices, tri.neighbors

    scipy_spatial, scipy_interpolate = others.get("scipy.spatial"), others.get("scipy.interpolate")
    rivals = {}
    if scipy_spatial:
        rivals["scipy"] = lambda: both(scipy_spatial.Delaunay(points))
    if "triangle" in others:
        rivals["triangle"] = lambda: others["triangle"].triangulate({"vertices": points}, "n")
    if "startinpy" in others:

        def startinpy():
            mesh = others["startinpy"].DT()
            mesh.insert(heights, insertionstrategy="BBox")
            return mesh.triangles

        rivals["startinpy"] = startinpy
    yield "Delaunay, simplices, neighbors", rivals, lambda threads: both(spatial.Delaunay(points, threads=threads))

    if "triangle" in others:
        graph = {"vertices": points}
        yield (
            "triangle.triangulate",
            {"triangle": lambda: others["triangle"].triangulate(graph, "n")},
            lambda threads: triangle.triangulate(graph, "n", threads=threads),
        )

    space = rng.random((count // 5, 3))
    if scipy_spatial:
        yield (
            f"Delaunay in 3D, {len(space)} points",
            {"scipy": lambda: both(scipy_spatial.Delaunay(space))},
            lambda threads: both(spatial.Delaunay(space, threads=threads)),
        )

    tri = spatial.Delaunay(points)
    if scipy_spatial:
        theirs = scipy_spatial.Delaunay(points)
        theirs.find_simplex(queries[:1])  # prepares what all later calls use
        ordered = queries[np.lexsort((queries[:, 0], np.floor(queries[:, 1] * 1000)))]

        def found(positions):
            def ours(threads):
                tri.threads = threads
                return tri.find_simplex(positions)

            return ours

        yield "find_simplex, random", {"scipy": lambda: theirs.find_simplex(queries)}, found(queries)
        yield "find_simplex, in rows", {"scipy": lambda: theirs.find_simplex(ordered)}, found(ordered)

    def evaluated(kind, *arguments):
        by_threads = {threads: kind(*arguments, threads=threads) for threads in (1, 2)}
        return lambda threads: by_threads[threads](queries)

    if scipy_interpolate:
        linear = scipy_interpolate.LinearNDInterpolator(theirs, values)
        yield (
            "LinearNDInterpolator, queries",
            {"scipy": lambda: linear(queries)},
            evaluated(spatial.LinearNDInterpolator, points, values),
        )
        yield (
            "LinearNDInterpolator, all",
            {"scipy": lambda: scipy_interpolate.LinearNDInterpolator(points, values)(queries)},
            lambda threads: spatial.LinearNDInterpolator(points, values, threads=threads)(queries),
        )
        nearest = scipy_interpolate.NearestNDInterpolator(points, values)
        yield (
            "NearestNDInterpolator, queries",
            {"scipy": lambda: nearest(queries)},
            evaluated(spatial.NearestNDInterpolator, points, values),
        )
    if "startinpy" in others:
        mesh = others["startinpy"].DT()
        mesh.insert(heights, insertionstrategy="BBox")
        few = queries[: max(1, count // 20)]
        by_threads = {n: spatial.NaturalNeighborInterpolator(points, values, threads=n) for n in (1, 2)}
        yield (
            f"natural neighbor, {len(few)} queries",
            {"startinpy": lambda: mesh.interpolate({"method": "NNI"}, few)},
            lambda threads: by_threads[threads](few),
        )
        yield (
            "natural neighbor, queries",
            {},
            lambda threads: by_threads[threads](queries),
        )


def installed():
    """Return the other packages that are installed, by name."""
    found = {}
    for name in ("scipy.spatial", "scipy.interpolate", "triangle", "startinpy"):
        try:
            found[name] = __import__(name, fromlist=["_"])
        except ImportError:
            print(f"without {name}: not installed")
    return found


if __name__ == "__main__":
    main()
