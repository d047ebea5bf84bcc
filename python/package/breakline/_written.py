"""Surfaces to files: in one piece, or in tiles if memory is short."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Optional

import numpy as np

from . import _breakline, _inputs, _masked
from ._call import Progress, call
from ._errors import ArgumentTypeError, usage
from ._points import _read, _systems
from ._maps import MAP, map_of
from ._pictures import missing
from ._results import frame_of, light
from ._surface import DEFAULTS, FOR_ANY, Building, refuse_building, surface_arguments


@dataclass(frozen=True)
class Written:
    """A file that was written. It is a path: ``open(written)`` works.

    Attributes
    ----------
    path : pathlib.Path
        The file.
    report : dict
        What it was made of, and what is in it. ``in_tiles`` says how it was made; ``has_holes`` if files were skipped.
    """

    path: Path
    report: "dict[str, Any]"

    def __fspath__(self) -> str:
        return os.fspath(self.path)

    def to_xarray(self, **options: Any) -> Any:
        """Return a raster as an ``xarray.DataArray`` whose blocks are read when they are needed.

        ``options`` are those of ``rioxarray.open_rasterio``.

        Examples
        --------
        >>> import breakline
        >>> written = breakline.dem("valley.laz", resolution=5, output="dem.tif", overwrite=True)
        >>> written.to_xarray().rio.nodata  # doctest: +SKIP
        """
        try:
            import rioxarray
        except ImportError:
            raise missing("rioxarray", "to_xarray") from None
        return rioxarray.open_rasterio(self.path, **{"chunks": True, **options})


class Task(NamedTuple):
    """A task of a job.

    ``needs`` are the numbers of the tasks that must be done before; ``stage`` is higher than that of each of them.
    ``input`` is the file of points that it reads, ``has_read`` that file's size and time as it has read it. ``worker`` is
    the process that does it now, as ``"host:process"``, if several share the job.
    """

    number: int
    name: str
    stage: int
    needs: "list[int]"
    input: Optional[str]
    has_read: "Optional[tuple[int, int]]"
    done: bool
    worker: Optional[str]


class Job:
    """A job in a folder: a surface in tiles, whose tasks can be done one by one, by any process that sees the folder.

    ``breakline job plan`` makes one, and so does :meth:`plan`. A ``Job`` stands for the job that was in the folder when
    it was opened: if that is removed, or another one takes its place, the methods raise an :class:`OtherJobError`. Only
    :meth:`update` may plan it again, and :meth:`write`, when files that were skipped are repaired; it then stands for
    the new job.

    Parameters
    ----------
    folder : path
        The folder of the job.
    """

    def __init__(self, folder: Any) -> None:
        self._job = _breakline.Job.open(_inputs.path(folder, "folder"))

    def __reduce__(self) -> Any:
        return Job, (self.folder,)

    @classmethod
    def plan(
        cls, verb: str, points: Any, output: Any, *, job: Any = None, headers_only: bool = False, **options: Any
    ) -> Job:
        """Plan a job, or open the one in the folder if it is that of the same call.

        Parameters
        ----------
        verb : str
            ``"dem"``, ``"hillshade"``, ``"color_relief"``, ``"slope"``, ``"aspect"``, ``"curvature"``, ``"roughness"``,
            ``"tri"``, ``"tpi"``, ``"contour"`` or ``"tin"``.
        points : path or list of paths
            Files of points.
        output : path
            The file to write.
        job : path, optional
            The folder of the job; by default the output's name with ``.job``.
        headers_only : bool
            Read only headers, where they state number and extent: points are taken to be spread evenly over the files.
        **options
            Parameters of the function of the verb, such as ``resolution=0.5``, ``tiles="8x8"``, ``skip_bad=True``.

        Raises
        ------
        OtherJobError
            If the folder has the job of another call; the message says what differs.

        Examples
        --------
        >>> import breakline
        >>> job = breakline.Job.plan("dem", "valley.laz", "dem.tif", resolution=5, overwrite=True)
        >>> job.folder.name
        'dem.tif.job'
        """
        if "resume" in options:
            raise usage("resume is for a verb; Job.plan opens the job that is there", None, "leave resume out")
        if "update" in options:
            raise usage("update is for a verb", None, "call Job.update, or leave update out")
        how = {"output": output, "job": job}
        return cls._begin(verb, _inputs.points(points), options, how, headers_only=bool(headers_only))

    @classmethod
    def _begin(
        cls, verb: str, inputs: "list[Any]", options: "dict[str, Any]", how: "dict[str, Any]", **planning: Any
    ) -> Job:
        """Plan a job for inputs of points, or open it. ``planning`` are ``headers_only`` and ``task_memory``."""
        threads, progress = options.pop("threads", None), options.pop("progress", None)
        asked = {**_request(verb, inputs, options, how), **planning}
        planned = cls.__new__(cls)
        with call(threads, progress) as running:
            planned._job = _breakline.Job.begin(asked, running)
        return planned

    @property
    def folder(self) -> Path:
        """The folder of the job."""
        return Path(self._job.folder)

    @property
    def output(self) -> Path:
        """The file that the last task writes, as an absolute path."""
        return Path(self._job.output)

    @property
    def has_holes(self) -> bool:
        """True if files were skipped, so that the output has holes."""
        return self._job.has_holes

    def tasks(self) -> "list[Task]":
        """Return all tasks, each after those that it needs; the last one writes the output.

        Examples
        --------
        >>> import breakline
        >>> job = breakline.Job.plan("dem", "valley.laz", "dem.tif", resolution=5, overwrite=True)
        >>> [task.stage for task in job.tasks()] == sorted(task.stage for task in job.tasks())
        True
        """
        return [Task(**task) for task in self._job.tasks()]

    def verify(self, *, threads: Optional[int] = None, progress: Progress = None) -> None:
        """Read the files of the tasks, and remove those that are damaged: their tasks are then done again.

        Examples
        --------
        >>> import breakline
        >>> job = breakline.Job.plan("dem", "valley.laz", "dem.tif", resolution=5, overwrite=True)
        >>> job.verify()
        """
        with call(threads, progress) as running:
            self._job.verify(running)

    def _check_inputs(self, tasks: "list[Task]") -> None:
        """Raise an error if a file that one of the tasks reads has changed; one that was read may be missing."""
        self._job.check_inputs([task.number for task in tasks])

    def run_task(self, number: int, *, threads: Optional[int] = None, progress: Progress = None) -> "Optional[Written]":
        """Do a task, unless it is done. The last one writes the output, and returns it.

        Raises
        ------
        NotYetError
            If a task that it needs is not done.

        Examples
        --------
        >>> import breakline
        >>> job = breakline.Job.plan("dem", "valley.laz", "dem.tif", resolution=5, overwrite=True)
        >>> for task in job.tasks():
        ...     written = job.run_task(task.number)
        >>> written.path.name
        'dem.tif'
        """
        if isinstance(number, bool) or not hasattr(number, "__index__") or number.__index__() < 0:
            raise usage("number is not that of a task", number, "pass the number of one of Job.tasks()")
        with call(threads, progress) as running:
            report = self._job.run_task(number.__index__(), running)
        return None if report is None else Written(self.output, report)

    def write(
        self, *, overwrite: Optional[bool] = None, threads: Optional[int] = None, progress: Progress = None
    ) -> Written:
        """Do all tasks that are left, write the output, and return it.

        An output that is there as the job has written it stays; if it has holes, the files that were skipped are tried
        again, and it is replaced. Another file is replaced if the job was planned with ``overwrite=True``, or with that
        here.

        Examples
        --------
        >>> import breakline
        >>> job = breakline.Job.plan("dem", "valley.laz", "dem.tif", resolution=5, overwrite=True)
        >>> job.write().path.name
        'dem.tif'
        """
        with call(threads, progress) as running:
            report = self._job.write(None if overwrite is None else bool(overwrite), running)
        return Written(self.output, report)

    def update(self, *, threads: Optional[int] = None, progress: Progress = None) -> Written:
        """Do again what is reached by inputs that have changed since the job was planned, and return the output.

        The output is replaced if it is as the job has written it; it stays if nothing has changed. For other files than
        those that the job was planned with, call the function of the verb with ``update=True``.

        Examples
        --------
        >>> import breakline
        >>> job = breakline.Job.plan("dem", "valley.laz", "dem.tif", resolution=5, overwrite=True)
        >>> job.write().path.name
        'dem.tif'
        >>> job.update().path.name
        'dem.tif'
        """
        with call(threads, progress) as running:
            report = self._job.update(running)
        return Written(self.output, report)

    def work(
        self,
        *,
        memory: Optional[str] = None,
        lease: float = 60.0,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Written:
        """Do tasks together with other processes, on any number of hosts, until all are done; return the output.

        Each process that calls this, or runs ``breakline job work``, takes the tasks that are free; one of them writes
        the output. They need nothing in common but the folder of the job, and the inputs, under the same names. A process
        may begin, end or be killed at any time: the others do its tasks.

        Parameters
        ----------
        memory : str, optional
            Memory to use, such as ``"16GB"``: as many tasks are done at a time as have room in it, but at least one, and
            at most one on each thread. What is free by default.
        lease : float
            Seconds. A process that gives no sign of life for so long loses its tasks to others.

        Examples
        --------
        >>> import breakline
        >>> job = breakline.Job.plan("dem", "valley.laz", "dem.tif", resolution=5, overwrite=True)
        >>> breakline.Job(job.folder).work().path.name  # on each host
        'dem.tif'
        """
        memory, lease = None if memory is None else str(memory), _inputs.number(lease, "lease")
        with call(threads, progress) as running:
            report = self._job.work(memory, lease, running)
        return Written(self.output, report)

    def clean(self) -> None:
        """Remove the files that the job has written, except the output.

        Examples
        --------
        >>> import breakline
        >>> job = breakline.Job.plan("dem", "valley.laz", "dem.tif", resolution=5, overwrite=True)
        >>> job.clean()
        >>> job.folder.exists()
        False
        """
        self._job.clean()


class Writing(Building, total=False):
    """The parameters beside ``output`` of verbs that write files, for type checkers."""

    overwrite: bool
    memory: Any
    tiles: Optional[str]
    job: "Optional[_inputs.PathLike]"
    resume: bool
    update: bool
    skip_bad: bool
    threads: Optional[int]
    progress: Progress


#: Parameters that say how files are written, and what they are if nobody says.
HOW = {
    "output": None, "overwrite": False, "tiles": None, "memory": None, "job": None, "resume": False, "update": False,
    "skip_bad": False,
}  # fmt: skip

#: Parameters of verbs that compute a quantity in cells, other than those of all of them.
_QUANTITIES: "dict[str, dict[str, Any]]" = {
    "slope": {"percent": False, "formula": "horn", "z_factor": None},
    "aspect": {"formula": "horn", "z_factor": None},
    "curvature": {"formula": "profile", "z_factor": None},
    "roughness": {},
    "tri": {"formula": "riley"},
    "tpi": {},
}

#: Parameters of the cells in which a surface is drawn.
_CELLS: "dict[str, Any]" = {"resolution": None, "extent": None, "align_to": None, "method": "linear"}

#: Parameters of verbs other than those of a surface, and their defaults.
_OF_VERBS: "dict[str, dict[str, Any]]" = {
    "dem": {**_CELLS, "overviews": "auto"},
    "hillshade": {
        **_CELLS, "shading": "standard", "azimuth": None, "altitude": None, "z_factor": None, "overviews": "auto",
    },
    "color_relief": {**_CELLS, "ramp": "elevation", "match": "linear"},
    **{verb: {**_CELLS, "overviews": "auto", **own} for verb, own in _QUANTITIES.items()},
    "contour": {"interval": None, "base": 0.0, "levels": (), **MAP},
    "tin": {},
}  # fmt: skip


def refuse_how(how: "dict[str, Any]") -> None:
    """Refuse parameters that say how a file is written where none is."""
    for name in _given(how):
        raise usage(f"{name} is for writing a file", how[name], "name it: output='dem.tif'")


def write_made(
    make: "Callable[..., Any]", how: "dict[str, Any]", running: "dict[str, Any]", of_file: "dict[str, Any]"
) -> Written:
    """Write what is made of a surface in memory, which is in one piece."""
    for name in _given(how):
        if name != "overwrite":
            message = f"{name} is for files of points: a surface in memory is in one piece"
            raise usage(message, how[name], f"leave {name} out")
    output = _inputs.path(how["output"], "output")
    make(**running).write(output, overwrite=how["overwrite"], **of_file, **running)
    return Written(Path(output), {"in_tiles": False, "has_holes": False})


def _given(how: "dict[str, Any]") -> "list[str]":
    """Return the names of those parameters beside ``output`` that have another value than by default."""
    return [name for name in HOW if name != "output" and how[name] is not HOW[name] and how[name] != HOW[name]]


def write(verb: str, points: Any, options: "dict[str, Any]", how: "dict[str, Any]") -> Written:
    """Write what a verb makes of points, or of a surface in a file."""
    threads, progress = options.pop("threads", None), options.pop("progress", None)
    asked = _request(verb, _inputs.points(points), options, how)
    with call(threads, progress) as running:
        return Written(Path(asked["output"]), _breakline.write(asked, running))


def _request(verb: str, inputs: "list[Any]", options: "dict[str, Any]", how: "dict[str, Any]") -> "dict[str, Any]":
    """Return the request of the library for a verb of inputs of points, and for how it is written."""
    if verb not in _OF_VERBS:
        raise usage("there is no such verb", verb, f"use one of {', '.join(_OF_VERBS)}")
    own = {name: options.pop(name, default) for name, default in _OF_VERBS[verb].items()}
    how = {**HOW, **{name: options.pop(name) for name in HOW if name in options}, **how}
    given = dict(options)
    unknown = next((name for name in given if name not in DEFAULTS and name not in FOR_ANY), None)
    if unknown is not None:
        raise usage(f"{verb} has no parameter {unknown}", None, f"leave {unknown} out", ArgumentTypeError)
    if options.get("flat_points"):
        cure = "leave it out, or write the Tin: tin(..., flat_points=True).write(path)"
        raise usage("flat_points is for Tin.replaced_points, but a file is written", True, cure)
    if how["resume"] and how["update"]:
        raise usage("resume and update are given", None, "use one of them")
    systems = _systems(options)
    read = _read(options.pop("columns", None), options.pop("partial", False))
    labels = own.get("labels_output")
    kind = "points"
    if len(inputs) == 1 and isinstance(inputs[0], str):
        kind = _breakline.kind_of(inputs[0])
        if kind != "points":
            refuse_building(inputs[0], given)
    return {
        "kind": kind,
        "points": inputs,
        "read": read,
        "systems": systems,
        "surface": surface_arguments({**DEFAULTS, **options}),
        "verb": verb,
        "product": _product(verb, own),
        "output": _inputs.path(how["output"], "output"),
        "labels_output": _inputs.path(labels, "labels_output") if labels is not None else None,
        "overwrite": bool(how["overwrite"]),
        "tiles": None if how["tiles"] is None else _inputs.name(how["tiles"], "tiles"),
        "memory": None if how["memory"] is None else str(how["memory"]),
        "job": None if how["job"] is None else _inputs.path(how["job"], "job"),
        "resume": bool(how["resume"]),
        "update": bool(how["update"]),
        "skip_bad": bool(how["skip_bad"]),
        "headers_only": False,
        "task_memory": None,
    }


def quantity_of(verb: str, own: "dict[str, Any]") -> "tuple[str, str, bool, Optional[float]]":
    """Return what a verb computes in cells: its name, the formula, whether it is in percent, the factor for heights."""
    factor = _inputs.optional_number(own.get("z_factor"), "z_factor")
    return verb, _inputs.name(own.get("formula", ""), "formula"), bool(own.get("percent", False)), factor


def colors_of(ramp: Any, match: Any) -> "tuple[str, str]":
    """Return the colors of heights as the library takes them: a ramp, and how it is applied."""
    return _inputs.path(ramp, "ramp"), _inputs.name(match, "match")


def _product(verb: str, own: "dict[str, Any]") -> "dict[str, Any]":
    if verb == "tin":
        return {"plain": False}
    if verb == "contour":
        (given,) = _masked.rows("levels", np.atleast_1d(_masked.as_array(own["levels"])).ravel())
        heights = [_inputs.number(level, "levels") for level in given]
        interval = _inputs.optional_number(own["interval"], "interval")
        if interval is not None and heights:
            raise usage("interval and levels are given", None, "use one of them")
        levels = (interval, _inputs.number(own["base"], "base"), heights)
        return {"levels": levels, "map": map_of(own)}
    frame = frame_of(own["resolution"], own["extent"], own["align_to"], own.get("overviews", "auto"))
    product: "dict[str, Any]" = {"frame": frame, "method": _inputs.name(own["method"], "method")}
    if verb == "hillshade":
        product["light"] = light(own["shading"], own["azimuth"], own["altitude"], own["z_factor"])
    elif verb == "color_relief":
        product["colors"] = colors_of(own["ramp"], own["match"])
    elif verb != "dem":
        product["quantity"] = quantity_of(verb, own)
    return product
