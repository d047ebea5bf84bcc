"""Write rasters of points that do not fit into memory, with the workers of a Dask cluster.

>>> import breakline.dask
>>> breakline.dask.dem("tiles/*.laz", "dem.tif", resolution=1, client=client)  # doctest: +SKIP
PosixPath('dem.tif')

The work is the job that ``breakline job plan`` makes: a folder with a file for each task that is done. Inputs, output and
that folder must have the same paths on all workers. The result is the same, byte for byte, as on one machine: tasks
may be repeated, and a task that was done before is not done again.
"""

from __future__ import annotations

import glob
import json
import os
import subprocess
import sys
import uuid
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Union

from ._errors import RENAMED, BreaklineError, usage

__all__ = ["dem", "hillshade"]

PathLike = Union[str, "os.PathLike[str]"]

#: Parameters here, and the options of the program that they stand for.
_OPTIONS = {parameter: option for option, parameter in RENAMED.items()}
_OPTIONS["extent"] = "te"


#: Options that take several values in one word; others are repeated.
_IN_ONE_WORD = {"--class", "--te", "--levels"}


def dem(
    inputs: "Union[PathLike, Sequence[PathLike]]",
    output: PathLike,
    *,
    client: Any,
    job: "Union[PathLike, None]" = None,
    retries: int = 3,
    **options: Any,
) -> Path:
    """Write a DEM of points, with the workers of a Dask cluster.

    Parameters
    ----------
    inputs : path or list of paths
        Files of points; globs are understood.
    output : path
        The GeoTIFF to write.
    client : dask.distributed.Client
        The cluster.
    job : path, optional
        The folder for the files of the tasks; by default the output's name with ``.job``. If it has the job of the same
        call already, that goes on.
    retries : int
        How often a task that fails is repeated.
    **options
        The other options of ``breakline dem`` by their names, such as ``resolution=0.5``, ``tiles="8x8"``,
        ``max_edge=50``.

    Returns
    -------
    pathlib.Path
        The output. ``rioxarray.open_rasterio(path, chunks=True)`` opens it as a Dask array.

    Raises
    ------
    BreaklineError
        If the job cannot be planned, or a task fails more often than it is repeated.
    """
    return _run("dem", inputs, output, client, job, retries, options)


def hillshade(
    inputs: "Union[PathLike, Sequence[PathLike]]",
    output: PathLike,
    *,
    client: Any,
    job: "Union[PathLike, None]" = None,
    retries: int = 3,
    **options: Any,
) -> Path:
    """Write a hillshade of points, with the workers of a Dask cluster; see :func:`dem`."""
    return _run("hillshade", inputs, output, client, job, retries, options)


def _run(
    verb: str,
    inputs: "Union[PathLike, Sequence[PathLike]]",
    output: PathLike,
    client: Any,
    job: "Union[PathLike, None]",
    retries: int,
    options: "dict[str, Any]",
) -> Path:
    if not hasattr(client, "submit"):
        raise usage("client is not a client of dask.distributed", client, "pass dask.distributed.Client()")
    files = [inputs] if isinstance(inputs, (str, os.PathLike)) else list(inputs)
    command = [verb, *(_path(found) for file in files for found in _found(file)), "-o", _path(output), *_words(options)]
    folder = _path(f"{os.fspath(output)}.job" if job is None else job)
    if not os.path.exists(os.path.join(folder, "plan.json")):
        _program("job", "plan", folder, "--", *command)
    # What is there is verified: a task that is done is not repeated.
    status = json.loads(_program("job", "status", folder, "--json", "--verify"))
    if status["command"] != command:
        raise usage(f"the job in {folder} is that of another call", folder, "pass another job, or remove the folder")
    # New in each call: a scheduler keeps what failed under its key.
    name = f"{verb}-{uuid.uuid4().hex[:8]}"
    futures: "dict[int, Any]" = {}
    for number, task in enumerate(status["tasks"]):
        if task["done"]:
            continue
        needs = [futures[needed] for needed in task["needs"] if needed in futures]
        # "tile 17, a.laz" becomes "tile-17-...": the dashboard groups tasks by the first word.
        title = "-".join(task["name"].split(",")[0].split(" ")[:2]).replace(os.sep, "_")
        # Later tasks first: merges come soon after what they merge.
        futures[number] = client.submit(
            _task, folder, number, _threads(task), needs, key=f"{title}-{name}-{number}", priority=number, retries=retries, pure=False
        )
    if futures:
        futures[max(futures)].result()
    if job is None:
        _program("job", "clean", folder)
    return Path(output)


def _threads(task: "dict[str, Any]") -> "list[str]":
    """Return the option for the threads of a task: one, unless it runs alone."""
    return [] if task["name"] == "output" else ["--threads", "1"]


def _task(folder: str, number: int, threads: "list[str]", needs: "list[int]") -> int:
    """Do a task on a worker."""
    _program("job", "run", folder, "--task", str(number), *threads)
    return number


def _found(file: PathLike) -> "list[str]":
    """Return the files that a glob stands for now: a file that comes later belongs to no job that began before."""
    text = os.fspath(file)
    return sorted(glob.glob(text)) or [text]


def _program(*words: str) -> str:
    """Run the program and return what it prints."""
    ran = subprocess.run([sys.executable, "-m", "breakline", *words], capture_output=True, text=True)
    if ran.returncode != 0:
        lines = ran.stderr.splitlines()
        said = [line.removeprefix("error: ") for line in lines if line.startswith("error: ")]
        cures = [line.removeprefix("hint: ") for line in lines if line.startswith("hint: ")]
        error = BreaklineError()
        error.message = said[0] if said else ran.stderr.strip()
        error.cure = cures[0] if cures else None
        raise error
    return ran.stdout


def _path(path: PathLike) -> str:
    return os.path.abspath(os.fspath(path))


def _words(options: "dict[str, Any]") -> "list[str]":
    words: "list[str]" = []
    for parameter, value in options.items():
        option = "--" + _OPTIONS.get(parameter, parameter).replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
        elif isinstance(value, (list, tuple)) and option in _IN_ONE_WORD:
            words.append(f"{option}={','.join(map(str, value))}")
        elif isinstance(value, (list, tuple)):
            words.extend(f"{option}={one}" for one in value)
        else:
            words.append(f"{option}={value}")
    return words
