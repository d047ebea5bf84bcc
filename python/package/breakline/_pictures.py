"""Pictures: for notebooks, and with matplotlib."""

from __future__ import annotations

import base64
import html
import os
import tempfile
from typing import Any

from ._errors import BreaklineError, UnsupportedError

#: The longer side of a thumbnail, in pixels.
SIDE = 256


def missing(package: str, what: str) -> UnsupportedError:
    """Return the error for a package that is not installed."""
    error = UnsupportedError(f"{what} needs {package}")
    error.message, error.cure = f"{what} needs {package}", f"pip install {package}"
    return error


def axes(ax: Any) -> Any:
    """Return axes of matplotlib with one scale: those that are given, or new ones."""
    try:
        from matplotlib import pyplot
    except ImportError:
        raise missing("matplotlib", "plot") from None
    if ax is None:
        ax = pyplot.subplots()[1]
    ax.set_aspect("equal")
    return ax


def page(lines: "list[str]", shades: Any) -> str:
    """Return what a notebook shows of a result: a thumbnail, if there are shades, above lines of text."""
    texts = "<br>".join(html.escape(line) for line in lines)
    picture = _picture(shades)
    if picture:
        picture = f'<img src="data:image/png;base64,{picture}" style="image-rendering: pixelated"><br>'
    return f"<div>{picture}{texts}</div>"


def _picture(shades: Any) -> str:
    """Return a PNG as base64, or nothing: a notebook shows the text of what has no picture."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "shades.png")
            shades().write(path)
            with open(path, "rb") as file:
                return base64.b64encode(file.read()).decode()
    except (BreaklineError, OSError):
        return ""
