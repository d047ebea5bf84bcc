"""Times of breakline beside those of scipy, triangle, startinpy and matplotlib, in one process: medians of runs in turn.

Run it with the package and the judges installed::

    python benches/compare.py [--points 1000000] [--runs 5] [--only NAME]

All arrays are float64. A row has the medians of breakline on one thread and as it is by default (one thread for
each core), that of the other package on the threads that it uses (one), and how many times faster breakline is, by the
median of the ratios of consecutive runs. Runs of all are taken in turn, so that a busy machine slows all of them.
A call that takes less than 20 ms is repeated until it takes as long, and divided by the number of calls.
"""

from __future__ import annotations

import argparse
import gc
import os
import platform
import statistics
import time
from math import ceil

import numpy as np

from breakline import spatial, triangle


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--only", default="", help="rows whose name contains this")
    options = parser.parse_args()
    print(f"{platform.platform()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}, Python {platform.python_version()}")
    print(f"{options.points} points, medians of {options.runs}\n")
    print("| | 1 thread | default | other | its time | ratio, 1 thread | ratio |\n|---|---|---|---|---|---|---|")
    others = installed()
    for group in (triangulations, small_inputs, refinements, positions, diagrams):
        for name, other, theirs, ours in group(options.points, others):
            if options.only in name:
                compare(name, other, theirs, ours, options.runs)


def installed():
    """Return the other packages that are installed, by name."""
    found = {}
    for name in ("scipy.spatial", "scipy.interpolate", "triangle", "startinpy", "matplotlib.tri"):
        try:
            found[name] = __import__(name, fromlist=["_"])
        except ImportError:
            print(f"without {name}: not installed")
    return found


def compare(name, other, theirs, ours, runs):
    """Print the row of an operation."""
    contestants = [lambda: ours(1), lambda: ours(None), theirs]
    calls = [max(1, ceil(0.02 / min(timed(work, 1) for _ in range(2)))) for work in contestants]
    taken = [[timed(work, count) for work, count in zip(contestants, calls)] for _ in range(runs)]
    medians = [shown(statistics.median(column)) for column in zip(*taken)]
    one, default = (statistics.median(run[2] / run[k] for run in taken) for k in (0, 1))
    print(f"| {name} | {medians[0]} | {medians[1]} | {other} | {medians[2]} | {one:.2f} | {default:.2f} |", flush=True)


def timed(work, calls):
    """Return the seconds of one of several calls."""
    gc.collect()
    start = time.perf_counter()
    for _ in range(calls):
        result = work()
    seconds = (time.perf_counter() - start) / calls
    del result
    return seconds


def shown(seconds):
    """Return a time with its unit."""
    for unit, factor in (("s", 1), ("ms", 1e3), ("us", 1e6)):
        if seconds * factor >= 1 or unit == "us":
            return f"{seconds * factor:.3g} {unit}"


def triangulations(count, others):
    """Yield rows of triangulations: the name, the other package, its work, and ours by the number of threads."""
    rng = np.random.default_rng(0)
    points = rng.random((count, 2))

    def both(tri):
        return tri.simplices, tri.neighbors

    def ours(sites, **options):
        return lambda threads: both(spatial.Delaunay(sites, threads=threads, **options))

    graph = {"vertices": points}
    if "scipy.spatial" in others:
        delaunay = others["scipy.spatial"].Delaunay
        yield f"Delaunay, {count} points", "scipy", lambda: both(delaunay(points)), ours(points)
        for n in (count // 50, count // 5):
            space = rng.random((n, 3))
            yield f"Delaunay in space, {n} points", "scipy", lambda: both(delaunay(space)), ours(space)
    if "startinpy" in others:
        few = points[: count // 10]

        def startinpy():
            mesh = others["startinpy"].DT()
            mesh.insert(np.column_stack([few, few[:, 0]]), insertionstrategy="BBox")
            return mesh.triangles

        yield f"Delaunay, {len(few)} points", "startinpy", startinpy, ours(few)
    if "matplotlib.tri" in others:
        matplotlib = others["matplotlib.tri"]
        yield f"Delaunay, {count} points", "matplotlib", lambda: matplotlib.Triangulation(*points.T).neighbors, ours(points)
    if "triangle" in others:
        theirs = others["triangle"].triangulate

        def drop_in(threads):
            return triangle.triangulate(graph, "n", threads=threads)

        yield f"triangulate 'n', {count} points", "triangle", lambda: theirs(graph, "n"), drop_in
        square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
        ring = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
        zigzag = np.column_stack([np.linspace(0.1, 0.9, count // 20), 0.5 + 0.3 * np.sin(np.linspace(0, 60, count // 20))])
        steps = 4 + np.column_stack([np.arange(len(zigzag) - 1), np.arange(1, len(zigzag))])
        planar = {
            "vertices": np.vstack([square, zigzag, points]),
            "segments": np.vstack([ring, steps]),
        }
        yield (
            f"triangulate 'p', the same with {len(steps)} segments",
            "triangle",
            lambda: theirs(planar, "p"),
            lambda threads: triangle.triangulate(planar, "p", threads=threads),
        )


def small_inputs(_, others):
    """Yield rows of few points."""
    rng = np.random.default_rng(1)
    for count in (4, 10, 100, 1_000, 10_000):
        points, space = rng.random((count, 2)), rng.random((max(count, 5), 3))
        graph = {"vertices": points}
        if "scipy.spatial" in others:
            delaunay = others["scipy.spatial"].Delaunay
            for name, sites in ((f"Delaunay, {count} points", points), (f"Delaunay in space, {len(space)} points", space)):
                yield (
                    name,
                    "scipy",
                    lambda sites=sites: delaunay(sites).simplices,
                    lambda threads, sites=sites: spatial.Delaunay(sites, threads=threads).simplices,
                )
            theirs, query = delaunay(points), points[:1] * 0.5 + 0.2
            by_threads = {threads: spatial.Delaunay(points, threads=threads) for threads in (1, None)}
            yield (
                f"find_simplex, one position in {count} points",
                "scipy",
                lambda: theirs.find_simplex(query),
                lambda threads: by_threads[threads].find_simplex(query),
            )
        if "triangle" in others:
            yield (
                f"triangulate '', {count} points",
                "triangle",
                lambda: others["triangle"].triangulate(graph),
                lambda threads: triangle.triangulate(graph, threads=threads),
            )


def refinements(_, others):
    """Yield rows of quality meshes: the examples that come with package triangle, and a disk."""
    if "triangle" not in others:
        return
    theirs = others["triangle"]
    turns = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    rim = np.column_stack([np.cos(turns), np.sin(turns)])
    disk = {"vertices": rim, "segments": np.column_stack([np.arange(200), np.roll(np.arange(200), -1)])}
    graphs = {name: theirs.get_data(name) for name in ("A", "double_hex", "double_hex2", "double_hex3", "face", "la")}
    read = ("vertices", "segments", "holes")
    graphs = {name: {key: graph[key] for key in read if key in graph} for name, graph in graphs.items()}
    attributes = theirs.get_data("A")["vertex_attributes"]
    graphs |= {"A, with attributes": {**graphs["A"], "vertex_attributes": attributes}, "disk": disk}
    for name, given in graphs.items():
        for switches in ("pq20", "pq28", "pq33", "pq30a0.0001" if name == "disk" else ""):
            if switches:
                yield (
                    f"triangulate '{switches}', `{name}` ({len(given['vertices'])} vertices)",
                    "triangle",
                    lambda: theirs.triangulate(given, switches),
                    lambda threads: triangle.triangulate(given, switches, threads=threads),
                )


def positions(count, others):
    """Yield rows of searches and interpolation, at as many positions as there are points where they are in rows."""
    if "scipy.spatial" not in others or "scipy.interpolate" not in others:
        return
    interpolate, rng = others["scipy.interpolate"], np.random.default_rng(2)
    points, random = rng.random((count, 2)), rng.random((count // 20, 2))
    values = np.sin(10 * points[:, 0]) + points[:, 1]
    side = int(count**0.5)
    rows = np.stack(np.meshgrid(*[(np.arange(side) + 0.5) / side] * 2), axis=-1).reshape(-1, 2)
    theirs = others["scipy.spatial"].Delaunay(points)
    theirs.find_simplex(random[:1])  # prepares what all later calls use
    by_threads = {threads: spatial.Delaunay(points, threads=threads) for threads in (1, None)}
    for order, xi in (("random", random), ("in rows", rows)):
        yield (
            f"find_simplex, {len(xi)} positions, {order}",
            "scipy",
            lambda: theirs.find_simplex(xi),
            lambda threads: by_threads[threads].find_simplex(xi),
        )
    kinds = {"LinearNDInterpolator": theirs, "CloughTocher2DInterpolator": theirs, "NearestNDInterpolator": points}
    for name, sites in kinds.items():
        other, own = getattr(interpolate, name), getattr(spatial, name)
        judge, prepared = other(sites, values), {n: own(points, values, threads=n) for n in (1, None)}
        for order, xi in (("random", random), ("in rows", rows)):
            yield f"{name}, {len(xi)} positions, {order}", "scipy", lambda: judge(xi), lambda threads: prepared[threads](xi)
        one = random[:1]
        yield f"{name}, one position", "scipy", lambda: judge(one), lambda threads: prepared[threads](one)
        few = slice(0, count // 5)
        yield (
            f"{name}, {count // 5} points, built and one position",
            "scipy",
            lambda: other(points[few], values[few])(one),
            lambda threads: own(points[few], values[few], threads=threads)(one),
        )
    if "startinpy" in others:
        mesh = others["startinpy"].DT()
        mesh.insert(np.column_stack([points, values]), insertionstrategy="BBox")
        natural = {n: spatial.NaturalNeighborInterpolator(points, values, threads=n) for n in (1, None)}
        yield (
            f"natural neighbor, {len(random)} positions",
            "startinpy",
            lambda: mesh.interpolate({"method": "NNI"}, random),
            lambda threads: natural[threads](random),
        )


def diagrams(count, others):
    """Yield rows of Voronoi diagrams and convex hulls."""
    if "scipy.spatial" not in others:
        return
    theirs, rng = others["scipy.spatial"], np.random.default_rng(3)
    ball = rng.normal(size=(count // 5, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, np.newaxis]
    sets = (
        ("Voronoi", f"{count // 5} points", rng.random((count // 5, 2)), "regions"),
        ("Voronoi", f"{count // 20} points in space", rng.random((count // 20, 3)), "regions"),
        ("Voronoi", "10 points", rng.random((10, 2)), "regions"),
        ("ConvexHull", f"{count} points in a square", rng.random((count, 2)), "simplices"),
        ("ConvexHull", f"{count} points in a cube", rng.random((count, 3)), "simplices"),
        ("ConvexHull", f"{count // 5} points on a sphere", ball, "simplices"),
        ("ConvexHull", "10 points", rng.random((10, 2)), "simplices"),
        ("ConvexHull", "10 points in space", rng.random((10, 3)), "simplices"),
    )
    for kind, what, points, part in sets:
        yield (
            f"{kind}, {what}",
            "scipy",
            lambda: getattr(getattr(theirs, kind)(points), part),
            lambda threads: getattr(getattr(spatial, kind)(points, threads=threads), part),
        )


if __name__ == "__main__":
    main()
