"""Contours that become those of a map."""

from __future__ import annotations

from typing import Any

from . import _inputs
from ._errors import usage

#: Parameters of contours for maps, and their defaults.
MAP: "dict[str, Any]" = {
    "preset": None, "smooth": None, "simplify": None, "min_length": None, "min_area": None, "keep_depressions": False,
    "index_every": None, "bands": False, "in_plane": False, "labels_output": None, "labels": "readable", "label_height": None,
}  # fmt: skip

#: Those of files: contours in memory have levels and points alone.
_OF_FILES = ("index_every", "bands", "in_plane", "labels_output", "label_height")


def map_of(own: "dict[str, Any]") -> "dict[str, Any]":
    """Return how contours become those of a map, as the library takes it."""
    smooth, every = own["smooth"], own["index_every"]
    is_number = smooth is not None and not isinstance(smooth, bool)
    lengths = ("simplify", "min_length", "min_area", "label_height")
    if own["labels_output"] is None and own["labels"] != MAP["labels"]:
        raise usage("labels are written to a file, and none is named", own["labels"], "name it: labels_output='l.shp'")
    if every is not None:
        (every,) = _inputs.whole_numbers([every], "index_every", 2**32 - 1)
    return {
        "preset": None if own["preset"] is None else _inputs.name(own["preset"], "preset"),
        "smooth": is_number or smooth is True,
        "tolerance": _inputs.number(smooth, "smooth") if is_number else None,
        **{name: _inputs.optional_number(own[name], name) for name in lengths},
        "keep_depressions": bool(own["keep_depressions"]),
        "index_every": every,
        "bands": bool(own["bands"]),
        "in_plane": bool(own["in_plane"]),
        "labels": None if own["labels_output"] is None else _inputs.name(own["labels"], "labels"),
    }


def refuse_files(own: "dict[str, Any]") -> None:
    """Refuse what only files have, where contours are in memory."""
    for name in _OF_FILES:
        if own[name] is not None and own[name] is not False:
            message = f"{name} is for a file that is made of files"
            raise usage(message, own[name], "name files of points or a surface in a file, and output='contours.shp'")
