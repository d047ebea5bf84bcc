"""Parameters of building a surface, as the library takes them."""

from __future__ import annotations

from typing import Any, Optional, TypedDict

from . import _inputs
from ._errors import usage
from ._names import CrossingHeight, EdgeLimit, Height, OnCrossing, Side

#: Parameters that take lines or areas, and those of them whose arrays are rings.
LINES = {"breaklines", "boundary", "soft_lines", "draped_lines", "walls", "holes", "flat", "rivers"}
_AREAS = {"boundary", "holes", "flat"}
#: Parameters that take numbers, names of choices, or both.
_NUMBERS = {"max_edge_inside", "crossing_tolerance", "wall_width", "flat_tolerance", "densify"}
_NAMES = {"duplicates", "on_crossing", "crossing_z", "wall_high"}
_NUMBERS_OR_NAMES = {"max_edge", "wall_bottom", "wall_drop", "flat_height", "river_width"}
#: Parameters that mean something for a surface that exists already.
FOR_ANY = {"points", "crs", "force_degrees", "threads", "progress"}
#: What the others are if nobody says, as in the signature of ``tin``.
DEFAULTS: "dict[str, Any]" = {
    "breaklines": None,
    "boundary": None,
    "bounds": None,
    "max_edge": None,
    "max_edge_inside": None,
    "classes": None,
    "returns": None,
    "ground": False,
    "to_crs": None,
    "require_grids": False,
    "epoch": None,
    "duplicates": "lowest",
    "on_crossing": "split",
    "crossing_z": "lowest",
    "crossing_tolerance": None,
    "soft_lines": None,
    "draped_lines": None,
    "walls": None,
    "wall_bottom": None,
    "wall_drop": None,
    "wall_width": None,
    "wall_high": "left",
    "holes": None,
    "flat": None,
    "flat_height": None,
    "flat_tolerance": None,
    "flat_buffer": 0.0,
    "flat_points": False,
    "rivers": None,
    "river_width": None,
    "densify": None,
    "add_ridges": False,
    "columns": None,
    "partial": False,
}


class Building(TypedDict, total=False):
    """The parameters of ``tin`` that say how a surface is built, for type checkers."""

    breaklines: Any
    boundary: Any
    bounds: Any
    max_edge: EdgeLimit
    max_edge_inside: Optional[float]
    classes: Any
    returns: Any
    ground: bool
    crs: Any
    to_crs: Any
    require_grids: bool
    epoch: Optional[float]
    force_degrees: bool
    duplicates: Height
    on_crossing: OnCrossing
    crossing_z: CrossingHeight
    crossing_tolerance: Optional[float]
    soft_lines: Any
    draped_lines: Any
    walls: Any
    wall_bottom: Any
    wall_drop: Any
    wall_width: Optional[float]
    wall_high: Side
    holes: Any
    flat: Any
    flat_height: Any
    flat_tolerance: Optional[float]
    flat_buffer: float
    flat_points: bool
    rivers: Any
    river_width: Any
    densify: Optional[float]
    add_ridges: bool
    columns: Any
    partial: bool


def surface_arguments(options: "dict[str, Any]") -> "dict[str, Any]":
    """Return the options of building a TIN as the library takes them."""
    return {
        **{name: _inputs.layers(options[name], name, name in _AREAS) for name in LINES},
        "bounds": _inputs.bounds(options["bounds"]),
        **{name: _inputs.number_or_name(options[name], name) for name in _NUMBERS_OR_NAMES},
        **{name: _inputs.optional_number(options[name], name) for name in _NUMBERS},
        **{name: _inputs.name(options[name], name) for name in _NAMES},
        "classes": _inputs.classes(options["classes"]),
        "returns": _inputs.returns(options["returns"]),
        "ground": bool(options["ground"]),
        "flat_buffer": _inputs.number(options["flat_buffer"], "flat_buffer"),
        "flat_points": bool(options["flat_points"]),
        "add_ridges": bool(options["add_ridges"]),
    }


def refuse_building(file: str, options: "dict[str, Any]") -> None:
    """Refuse options that are only for building a surface."""
    for name, value in options.items():
        if name in FOR_ANY:
            continue
        default = DEFAULTS[name]
        if not (value is default or isinstance(value, (str, float)) and value == default):
            raise usage(f"{name} is for building a TIN, but {file} is a surface already", value, f"leave {name} out")
