"""Surfaces to files: in one piece, or in tiles if memory is short."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Optional

import numpy as np

from . import _breakline, _inputs, _masked
from ._call import Progress, call
from ._errors import ArgumentTypeError, usage
from ._points import _read, _systems
from ._results import light, missing
from ._surface import DEFAULTS, FOR_ANY, refuse_building, surface_arguments


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
        """
        try:
            import rioxarray
        except ImportError:
            raise missing("rioxarray", "to_xarray") from None
        return rioxarray.open_rasterio(self.path, **{"chunks": True, **options})


class Task(NamedTuple):
    """A task of a job.

    ``needs`` are the numbers of the tasks that must be done before; ``stage`` is higher than that of each of them.
    ``input`` is the file of points that it reads, ``has_read`` that file's size and time as it has read it.
    """

    number: int
    name: str
    stage: int
    needs: "list[int]"
    input: Optional[str]
    has_read: "Optional[tuple[int, int]]"
    done: bool


class Job:
    """A job in a folder: a surface in tiles, whose tasks can be done one by one, by any process that sees the folder.

    ``breakline job plan`` makes one, and so does :meth:`plan`.

    Parameters
    ----------
    folder : path
        The folder of the job.
    """

    def __init__(self, folder: Any) -> None:
        self._job = _breakline.Job.open(_inputs.path(folder, "folder"))

    @classmethod
    def plan(cls, verb: str, points: Any, output: Any, *, job: Any, headers_only: bool = False, **options: Any) -> Job:
        """Plan a job, or open the one in the folder if it is that of the same request.

        Parameters
        ----------
        verb : str
            ``"dem"``, ``"hillshade"``, ``"contour"`` or ``"tin"``.
        points : path or list of paths
            Files of points.
        output : path
            The file to write.
        job : path
            The folder of the job.
        headers_only : bool
            Read only headers, where they state number and extent: points are taken to be spread evenly over the files.
        **options
            Parameters of the function of the verb.

        Raises
        ------
        UsageError
            If the folder has a job of another request.
        """
        threads, progress = options.pop("threads", None), options.pop("progress", None)
        asked = request(verb, points, options, {"output": output, "job": job})
        words = [verb, *asked["points"], "-o", asked["output"]]
        planned = cls.__new__(cls)
        with call(threads, progress) as running:
            planned._job = _breakline.Job.begin(asked, bool(headers_only), list(map(str, words)), running)
        return planned

    @property
    def folder(self) -> Path:
        """The folder of the job."""
        return Path(self._job.folder)

    @property
    def output(self) -> Path:
        """The file that the last task writes."""
        return Path(self._job.output)

    @property
    def has_holes(self) -> bool:
        """True if files were skipped, so that the output has holes."""
        return self._job.has_holes

    def tasks(self) -> "list[Task]":
        """Return all tasks, each after those that it needs; the last one writes the output."""
        return [Task(**task) for task in self._job.tasks()]

    def verify(self, *, threads: Optional[int] = None, progress: Progress = None) -> None:
        """Read the files of the tasks, and remove those that are damaged: their tasks are then done again."""
        with call(threads, progress) as running:
            self._job.verify(running)

    def run_task(self, number: int, *, threads: Optional[int] = 1, progress: Progress = None) -> None:
        """Do a task, unless it is done. The last one writes the output.

        Raises
        ------
        NotYetError
            If a task that it needs is not done.
        """
        with call(threads, progress) as running:
            self._job.run_task(int(number), running)

    def write(self, *, overwrite: bool = False, threads: Optional[int] = None, progress: Progress = None) -> Written:
        """Do all tasks that are left, write the output, and return it."""
        with call(threads, progress) as running:
            report = self._job.write(bool(overwrite), running)
        return Written(self.output, report)

    def clean(self) -> None:
        """Remove the files that the job has written, except the output."""
        self._job.clean()


#: Parameters that say how files are written, and what they are if nobody says.
HOW = {
    "output": None, "overwrite": False, "tiles": None, "memory": None, "job": None, "resume": False, "skip_bad": False,
}  # fmt: skip

#: Parameters of verbs other than those of a surface, and their defaults.
_OF_VERBS: "dict[str, dict[str, Any]]" = {
    "dem": {"resolution": None, "extent": None, "align_to": None, "method": "linear"},
    "hillshade": {
        "resolution": None, "extent": None, "align_to": None, "method": "linear",
        "azimuth": 315.0, "altitude": 45.0, "z_factor": None,
    },
    "contour": {"interval": None, "base": 0.0, "levels": ()},
    "tin": {},
}  # fmt: skip


def refuse_how(how: "dict[str, Any]") -> None:
    """Refuse parameters that say how a file is written where none is."""
    for name, value in how.items():
        if name != "output" and value is not HOW[name] and value != HOW[name]:
            raise usage(f"{name} is for writing a file", value, "name it: output='dem.tif'")


def write(verb: str, points: Any, options: "dict[str, Any]", how: "dict[str, Any]") -> Written:
    """Write what a verb makes of points, or of a surface in a file."""
    threads, progress = options.pop("threads", None), options.pop("progress", None)
    asked = request(verb, points, options, how)
    with call(threads, progress) as running:
        return Written(Path(asked["output"]), _breakline.write(asked, running))


def request(verb: str, points: Any, options: "dict[str, Any]", how: "dict[str, Any]") -> "dict[str, Any]":
    """Return the request of the library for a verb of points, and for how it is written."""
    if verb not in _OF_VERBS:
        raise usage("there is no such verb", verb, f"use one of {', '.join(_OF_VERBS)}")
    own = {name: options.pop(name, default) for name, default in _OF_VERBS[verb].items()}
    how = {**HOW, **{name: options.pop(name) for name in HOW if name in options}, **how}
    given = dict(options)
    unknown = next((name for name in given if name not in DEFAULTS and name not in FOR_ANY), None)
    if unknown is not None:
        raise usage(f"{verb} has no parameter {unknown}", None, f"leave {unknown} out", ArgumentTypeError)
    systems = _systems(options.pop("crs", None), options.pop("to_crs", None), options.pop("force_degrees", False))
    read = _read(options.pop("columns", None), options.pop("partial", False))
    found = _inputs.points(points)
    if len(found) == 1 and isinstance(found[0], str) and _breakline.is_surface(found[0]):
        refuse_building(found[0], given)
    return {
        "points": found,
        "read": read,
        "systems": systems,
        "surface": surface_arguments({**DEFAULTS, **options}),
        "verb": verb,
        "product": _product(verb, own),
        "output": _inputs.path(how["output"], "output"),
        "overwrite": bool(how["overwrite"]),
        "tiles": None if how["tiles"] is None else _inputs.name(how["tiles"], "tiles"),
        "memory": None if how["memory"] is None else str(how["memory"]),
        "job": None if how["job"] is None else _inputs.path(how["job"], "job"),
        "resume": bool(how["resume"]),
        "skip_bad": bool(how["skip_bad"]),
    }


def _product(verb: str, own: "dict[str, Any]") -> "dict[str, Any]":
    if verb == "tin":
        return {}
    if verb == "contour":
        (levels,) = _masked.rows("levels", np.atleast_1d(_masked.as_array(own["levels"])).ravel())
        levels = [_inputs.number(level, "levels") for level in levels]
        interval = _inputs.optional_number(own["interval"], "interval")
        if interval is not None and levels:
            raise usage("interval and levels are given", None, "use one of them")
        return {"levels": (interval, _inputs.number(own["base"], "base"), levels)}
    frame = {
        "resolution": _inputs.optional_number(own["resolution"], "resolution"),
        "bounds": _inputs.bounds(own["extent"], "extent"),
        "align_to": None if own["align_to"] is None else _inputs.path(own["align_to"], "align_to"),
    }
    product = {"frame": frame, "method": _inputs.name(own["method"], "method")}
    if verb == "hillshade":
        product["light"] = light(own["azimuth"], own["altitude"], own["z_factor"])
    return product
