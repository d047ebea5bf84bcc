"""Several products of one surface: the verb ``run``."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping, Optional, Union

from . import _breakline, _inputs
from ._call import Progress, call
from ._errors import ArgumentTypeError, usage


def _plain(value: Any) -> Any:
    """Return a path or a number of numpy as JSON has it."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    raise usage(
        f"path: {type(value).__name__} is not a value of a run file",
        value,
        "pass texts, numbers, paths, or lists of them",
        kind=ArgumentTypeError,
    )


def run(
    path: "Union[str, os.PathLike[str], Mapping[str, Any]]",
    *,
    overwrite: bool = False,
    memory: Any = None,
    dry_run: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> "dict[str, Any]":
    """Make several products of one surface, which is built once. All files appear at the end, or none.

    Parameters
    ----------
    path : path or mapping
        A run file (TOML), or its tables: ``input`` with the options of the surface, ``product`` with a list of
        mappings, each with a ``verb`` and its options. Keys are the options of the command line without dashes;
        ``_`` is read as ``-``. Paths are relative to the file, or to the working directory.
    overwrite : bool
        Replace files that exist.
    memory : str or int, optional
        Memory for surfaces of points, such as ``"2GB"``; half of what is free by default. Points that need more become
        a TIN in parts first, once.
    dry_run : bool
        Make nothing, and return what would be made, with the single commands.
    threads : int, optional
        Number of threads; one per core by default.
    progress : bool or callable, optional
        True for a bar of tqdm, or a function that is called with the stage, the items done and their number.

    Returns
    -------
    dict
        ``surfaces``, ``products`` with ``verb``, ``files`` and ``report``, and all ``files``; as
        ``breakline run --json`` prints it.

    Raises
    ------
    UsageError
        If a key is not an option, or two products write one file.
    BreaklineError
        If a product cannot be made. No file is written then.

    Examples
    --------
    >>> import breakline
    >>> report = breakline.run({
    ...     "input": {"files": "valley.laz"},
    ...     "product": [{"verb": "dem", "output": "all.tif"}, {"verb": "volume", "plane": 840}],
    ... })
    >>> [product["verb"] for product in report["products"]]
    ['dem', 'volume']
    """
    is_mapping = isinstance(path, Mapping)
    file = None if is_mapping else _inputs.path(path, "path")
    tables = json.dumps(path, default=_plain) if is_mapping else None
    with call(threads, progress) as request:
        report: "dict[str, Any]" = json.loads(
            _breakline.run(
                file, tables, bool(overwrite), None if memory is None else str(memory), bool(dry_run), request
            )
        )
    return report
