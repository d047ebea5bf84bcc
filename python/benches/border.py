"""What crossing the border between Python and Rust costs: threads, signals, memory, contours beside matplotlib.

    python border.py [millions of points]

Prints one line for each figure, medians of 7 where times are compared.
"""

import os
import resource
import signal
import statistics
import sys
import threading
import time

import breakline
import numpy as np

MILLIONS = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
COUNT = int(MILLIONS * 1_000_000)


def median_of(function, *arguments, times=7, **named):
    """Return the median of the seconds that a function takes, and what it returned last."""
    seconds = []
    for _ in range(times):
        start = time.perf_counter()
        result = function(*arguments, **named)
        seconds.append(time.perf_counter() - start)
    return statistics.median(seconds), result


def resident():
    """Return the megabytes of memory in use."""
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def interrupt(sent):
    """Send Ctrl-C to this process, and add the time to a list."""
    sent.append(time.perf_counter())
    os.kill(os.getpid(), signal.SIGINT)


def points(count):
    """Return points on a hilly surface, in a square of a kilometer."""
    random = np.random.default_rng(1)
    xy = 1000 * random.random((count, 2))
    return np.column_stack([xy, 20 * np.sin(xy[:, 0] / 90) + 15 * np.cos(xy[:, 1] / 70)])


def main():
    """Print the figures."""
    cloud = points(COUNT)
    for threads in (1, 2):
        seconds, tin = median_of(breakline.tin, cloud, threads=threads)
        print(f"tin of {COUNT} points, threads={threads}: {seconds:.3f} s")
    queries = 1000 * np.random.default_rng(2).random((1_000_000, 2))
    for threads in (1, 2):
        seconds, _ = median_of(tin.elevation, queries, threads=threads)
        print(f"elevation of 1 M positions, threads={threads}: {seconds:.3f} s")
    seconds, _ = median_of(lambda: [tin.elevation(queries[:1]) for _ in range(1000)])
    print(f"elevation of one position: {seconds * 1e3:.1f} us")

    def many(count):
        workers = [threading.Thread(target=tin.elevation, args=(queries,), kwargs={"threads": 1}) for _ in range(count)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()

    def alone():
        for _ in range(4):
            tin.elevation(queries, threads=1)

    together, _ = median_of(lambda: many(4))
    one, _ = median_of(alone)
    print(
        f"4 threads of Python, a query of 1 M positions each: {one / together:.2f} times as fast as one after the other"
    )

    seconds, contours = median_of(lambda: tin.contours(1.0, threads=1))
    print(f"contours, threads=1: {seconds:.3f} s, {len(contours)} lines")
    try:
        import matplotlib

        matplotlib.use("agg")
        from matplotlib import pyplot

        triangulation = tin.to_matplotlib()
        heights = tin.vertices[:, 2]
        levels = np.arange(np.ceil(heights.min()), heights.max())
        figure, axes = pyplot.subplots()
        theirs, _ = median_of(lambda: axes.tricontour(triangulation, heights, levels), times=3)
        print(f"contours by matplotlib: {theirs:.3f} s, {theirs / seconds:.1f} times as long")
    except ImportError:
        print("contours by matplotlib: not installed")

    large = points(10_000_000)
    before = resident()
    start = time.perf_counter()
    breakline.tin(large)
    whole = time.perf_counter() - start
    print(f"tin of 10 M points: {whole:.1f} s, peak {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB")
    worst, kept = 0.0, 0.0
    for part in range(1, 10):
        sent = []
        timer = threading.Timer(whole * part / 10, interrupt, args=(sent,))
        timer.start()
        try:
            breakline.tin(large)
        except KeyboardInterrupt:
            worst = max(worst, time.perf_counter() - sent[0])
        timer.join()
        kept = max(kept, resident() - before)
    print(f"Ctrl-C within 10 M points, at 9 times: ends after {worst:.2f} s at most, memory then {kept:+.0f} MB")


if __name__ == "__main__":
    main()
