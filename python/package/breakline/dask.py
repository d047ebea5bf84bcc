"""Write surfaces of points that do not fit into memory, with the workers of a Dask cluster.

>>> import breakline.dask
>>> breakline.dask.dem("tiles/*.laz", "/data/dem.tif", resolution=1, client=client)  # doctest: +SKIP
PosixPath('/data/dem.tif')

The work is a :class:`breakline.Job`: a folder with a file for each task that is done. Inputs, output
and that folder must have the same paths on all workers. Points may also be objects in a store that ``fsspec`` knows
(``s3://bucket/tiles/*.laz``): a worker copies an object when a task reads it, and removes the copy afterwards. The
result is the same, byte for byte, as on one machine: tasks may be repeated, and a task that was done before is not
done again. Workers may be lost: what they were doing is repeated, what they have done is kept.
"""

from __future__ import annotations

import contextlib
import os
import uuid
import warnings
from collections import Counter, defaultdict
from collections.abc import Sequence
from concurrent.futures import CancelledError
from pathlib import Path
from typing import Any, Union

from . import _breakline, _inputs
from ._errors import BreaklineError, BreaklineWarning, usage
from ._inputs import PathLike
from ._objects import Objects, StoredObject, is_url
from ._written import Job, Task

__all__ = ["contour", "dem", "hillshade", "tin"]

#: How often a task is submitted again after Dask gave it up because its workers died.
_AGAIN = 20

#: What to do when that was not enough, for the job in a folder.
_LOST = (
    "see the logs of the workers. If they lack memory, give them more, or fewer threads: the same call goes on with "
    "what is done. Or plan smaller tasks: breakline.Job({!r}).clean(), and pass memory="
)

#: The part of a worker's memory that its tasks may take: Python and Dask are there, too, and a tile may have more
#: points than others.
_FOR_TASKS = 0.5

#: What to do when the cluster has ended.
_ENDED = "start the cluster again: tasks that are done are kept, and the same call goes on"


def dem(
    inputs: "Union[PathLike, Sequence[PathLike]]",
    output: PathLike,
    *,
    client: Any,
    job: "Union[PathLike, None]" = None,
    retries: int = 3,
    scratch: "Union[PathLike, None]" = None,
    storage_options: "Union[dict[str, Any], None]" = None,
    **options: Any,
) -> Path:
    """Write a DEM of points, with the workers of a Dask cluster.

    Parameters
    ----------
    inputs : path or URL, or list of them
        Files of points, or objects; globs are understood.
    output : path
        The GeoTIFF to write.
    client : dask.distributed.Client
        The cluster.
    job : path, optional
        The folder for the files of the tasks, which then stays; by default the output's name with ``.job``, and it goes
        when the output is written. If it has the job of the same call already, that goes on.
    retries : int
        How often a task that fails with an error is repeated. Tasks that lose their worker do not count here: Dask
        repeats such a task as often as its setting ``distributed.scheduler.allowed-failures`` says, and when it gives
        the task up, the task is submitted again, up to 20 times.
    scratch : path, optional
        A folder for copies of objects, with the same path on the workers and here; by default one of the user in the
        system's folder for temporary files. On each worker it has as many copies as the worker has threads.
    storage_options : dict, optional
        What ``fsspec`` needs to open objects, such as keys and endpoints.
    **options
        The other parameters of :func:`breakline.dem`, such as ``resolution=0.5``, ``tiles="8x8"``, ``max_edge=50``.
        Lines and areas are files. Without ``memory``, a task takes at most half of what the smallest worker has for
        each of its threads; with it, that memory divided by the number of threads of this process.

    Returns
    -------
    pathlib.Path
        The output, as an absolute path. ``rioxarray.open_rasterio(path, chunks=True)`` opens it as a Dask array.

    Raises
    ------
    OtherJobError
        If the folder has the job of another call: of other parameters, or of another output.
    BreaklineError
        If the job cannot be planned, if a file has changed since a task has read it, if a task fails, or loses its
        workers, more often than it is repeated, or if the scheduler is lost. The tasks that wait are canceled then, as
        they are by Ctrl-C; those that are done are kept, and the same call goes on.

    Warns
    -----
    BreaklineWarning
        If files were skipped (``skip_bad=True``), so that the output has holes. The folder of the job is kept then.
    """
    where: "dict[str, Any]" = {"job": job, "scratch": scratch, "storage_options": storage_options}
    return _run("dem", inputs, output, client=client, retries=retries, **where, **options)


def hillshade(inputs: "Union[PathLike, Sequence[PathLike]]", output: PathLike, *, client: Any, **options: Any) -> Path:
    """Write a hillshade of points, with the workers of a Dask cluster; parameters as for :func:`dem`."""
    return _run("hillshade", inputs, output, client=client, **options)


def contour(inputs: "Union[PathLike, Sequence[PathLike]]", output: PathLike, *, client: Any, **options: Any) -> Path:
    """Write contours of points, with the workers of a Dask cluster; parameters as for :func:`dem`."""
    return _run("contour", inputs, output, client=client, **options)


def tin(inputs: "Union[PathLike, Sequence[PathLike]]", output: PathLike, *, client: Any, **options: Any) -> Path:
    """Write a TIN of points in parts (``.tins``), with the workers of a Dask cluster; parameters as for :func:`dem`."""
    return _run("tin", inputs, output, client=client, **options)


def _run(
    verb: str,
    inputs: "Union[PathLike, Sequence[PathLike]]",
    output: PathLike,
    *,
    client: Any,
    job: "Union[PathLike, None]" = None,
    retries: int = 3,
    scratch: "Union[PathLike, None]" = None,
    storage_options: "Union[dict[str, Any], None]" = None,
    **options: Any,
) -> Path:
    if not hasattr(client, "submit"):
        raise usage("client is not a client of dask.distributed", client, "pass dask.distributed.Client()")
    for name, path in [("output", output), ("job", job)]:
        if path is not None and is_url(os.fspath(path)):
            raise usage(f"{name} is an object in a store", path, "name a path that all workers share")
    if "resume" in options:
        raise usage("resume is not needed: the same call goes on with what is done", None, "leave resume out")
    if "update" in options:
        raise usage("update is for one process", None, "call breakline.Job.update, or leave update out")
    files = [inputs] if isinstance(inputs, (str, os.PathLike)) else list(inputs)
    texts = [_inputs.path(file, "inputs") for file in files]
    urls = [text for text in texts if is_url(text)]
    if urls and options.get("classes") is None and options.get("returns") is None:
        cure = "pass classes=2 for ground: else points would be read to find out"
        raise usage("of objects, only the headers are read to plan", urls[0], cure)
    folder = _breakline.job_folder(_path(output)) if job is None else _path(job)
    objects = Objects(urls, None if scratch is None else _path(scratch), storage_options, folder)
    paths = _inputs.once(path for text in texts for path in _paths(text, objects))
    there = os.path.exists(os.path.join(folder, "plan.json"))
    with contextlib.nullcontext() if there else objects.headers():
        how = {"output": _path(output), "job": folder}
        # What the caller says counts more than what workers have.
        of_workers = _memory_of_tasks(client) if options.get("memory") is None else None
        planning = {"headers_only": bool(urls), "task_memory": of_workers}
        begun = Job._begin(verb, paths, options, how, **planning)
    # What is there is verified: a task that is done is not repeated.
    begun.verify()
    tasks = begun.tasks()
    for task in tasks:
        read = objects.at.get(task.input or "")
        if read is not None and task.has_read not in (None, (read.size, read.time)):
            raise usage("the object has changed since the job has read it", read.url, "remove the job, and begin anew")
    begun._check_inputs([task for task in tasks if task.input not in objects.at])
    # New in each call: a scheduler keeps what failed under its key.
    name = f"{verb}-{uuid.uuid4().hex[:8]}"
    cluster = _Cluster(client, folder, tasks, objects.at, name, retries)
    try:
        _finish(cluster, tasks)
    except (CancelledError, OSError, TimeoutError) as error:
        raise _error("the scheduler of the cluster was lost, or canceled the tasks", _ENDED) from error
    finally:
        cluster.release()
    if begun.has_holes:
        cure = f"repair them, then `breakline job run {folder}` goes on"
        text = f"files were skipped, so that {os.fspath(output)} has holes: {cure}"
        warnings.warn(text, BreaklineWarning, stacklevel=3)
    elif job is None:
        begun.clean()
    return begun.output


def _memory_of_tasks(client: Any) -> "Union[int, None]":
    """Return the bytes that a task may take on all workers that there are; None if they have no limits."""
    try:
        workers = client.scheduler_info(n_workers=-1)["workers"]
    except TypeError:  # before version 2025.4, which returns all
        workers = client.scheduler_info()["workers"]
    shares = [worker["memory_limit"] / worker["nthreads"] for worker in workers.values() if worker["memory_limit"]]
    return int(min(shares) * _FOR_TASKS) if shares else None


def _paths(text: str, objects: Objects) -> "list[str]":
    """Return the paths that a task finds files or copies of objects at."""
    return objects.paths(text) if is_url(text) else list(map(_path, _inputs.files(text, "inputs")))


def _finish(cluster: "_Cluster", tasks: "list[Task]") -> None:
    """Start each task that is left when those that it needs are done, until all are done."""
    left = {number for number, task in enumerate(tasks) if not task.done}
    missing = {number: left.intersection(tasks[number].needs) for number in left}
    users: "dict[int, list[int]]" = defaultdict(list)
    for number in sorted(left):
        for needed in missing[number]:
            users[needed].append(number)
        if not missing[number]:
            cluster.start(number)
    while left:
        done = cluster.wait()
        left.remove(done)
        for number in users[done]:
            missing[number].remove(done)
            if not missing[number]:
                cluster.start(number)


class _Cluster:
    """The tasks that the cluster has.

    A future is dropped as soon as its task is done. What is done is in its file, but what Dask keeps, it computes again
    when it loses the worker.
    """

    def __init__(
        self,
        client: Any,
        folder: str,
        tasks: "list[Task]",
        objects: "dict[str, StoredObject]",
        name: str,
        retries: int,
    ) -> None:
        from distributed import as_completed

        self._client, self._folder, self._name, self._retries = client, folder, name, retries
        self._tasks, self._objects = tasks, objects
        self._completed: Any = as_completed(loop=client.loop)  # type: ignore[no-untyped-call]
        self._numbers: "dict[Any, int]" = {}
        self._deaths: "Counter[int]" = Counter()

    def start(self, number: int) -> None:
        """Submit a task, of which all that it needs is done."""
        task = self._tasks[number]
        # "tile 17, a.laz" becomes "tile-17-...": the dashboard groups tasks by the first word.
        title = "-".join(task.name.split(",")[0].split(" ")[:2]).replace(os.sep, "_")
        key = f"{title}-{self._name}-{number}-{self._deaths[number]}"
        # The last one runs alone, with the threads of the worker.
        threads = None if number == len(self._tasks) - 1 else 1
        words = [self._folder, number, threads, self._objects.get(task.input or "")]
        # Later tasks first: merges come soon after what they merge.
        future = self._client.submit(_task, *words, key=key, priority=number, retries=self._retries, pure=False)
        self._numbers[future] = number
        self._completed.add(future)

    def wait(self) -> int:
        """Wait until a task is done, and return its number. Tasks whose workers died are started again."""
        from distributed import KilledWorker

        while True:
            future = next(self._completed)
            number = self._numbers[future]
            try:
                future.result()
            except KilledWorker as killed:
                self._restart(number, killed)
                del self._numbers[future]
            else:
                del self._numbers[future]
                return number

    def release(self) -> None:
        """Let the scheduler forget all tasks: those that no worker has begun are canceled."""
        for future in self._numbers:
            future.release()

    def _restart(self, number: int, killed: Exception) -> None:
        if self._deaths[number] == _AGAIN:
            name, cure = self._tasks[number].name, _LOST.format(self._folder)
            raise _error(f"{name}: the workers that did this task died ({_AGAIN + 1} times)", cure) from killed
        self._deaths[number] += 1
        self.start(number)


def _task(folder: str, number: int, threads: "Union[int, None]", read: "Union[StoredObject, None]") -> None:
    """Do a task in the process of a worker, by default on all its threads; copy the object that the task reads."""
    from distributed import get_worker

    with contextlib.nullcontext() if read is None else read.copied():
        Job(folder).run_task(number, threads=threads or get_worker().state.nthreads)


def _error(message: str, cure: "Union[str, None]") -> BreaklineError:
    error = BreaklineError()
    error.message, error.cure = message, cure
    return error


def _path(path: PathLike) -> str:
    return os.path.abspath(os.fspath(path))
