"""Exceptions and warnings."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from types import FrameType
from typing import Any, Optional


class BreaklineError(Exception):
    """The base of all errors of this package.

    Attributes
    ----------
    message : str
        What was found, without file and location.
    file : str or None
        The file that the error is about.
    location : str or None
        Where in the file or in the argument, such as ``"record 12"`` or ``"row 3"``.
    value : str or None
        The offending value of an argument, as ``repr`` shows it. For an error in a file the value is part of the
        message.
    cure : str or None
        What can be done about it.
    causes : list of str
        What the error was caused by, outermost first.
    """

    message: str = ""
    file: Optional[str] = None
    location: Optional[str] = None
    value: Optional[str] = None
    cure: Optional[str] = None
    causes: "Sequence[str]" = ()

    def __str__(self) -> str:
        text = ": ".join(part for part in (self.file, self.location, self.message) if part)
        return f"{text}\n  cure: {self.cure}" if self.cure else text

    def __reduce__(self) -> Any:
        attributes = ("message", "file", "location", "value", "cure", "causes", "errno")
        return _restore, (type(self), {name: getattr(self, name, None) for name in attributes})


class FormatError(BreaklineError, ValueError):
    """The data breaks the rules of its format, or cannot form a surface."""


class UnsupportedError(BreaklineError, NotImplementedError):
    """The data is valid, but cannot be read or written here; or what was asked for does not exist."""


class UsageError(BreaklineError, ValueError):
    """An argument makes no sense."""


class ArgumentTypeError(UsageError, TypeError):
    """An argument has a type that is not understood."""


class LimitError(BreaklineError, ValueError):
    """A documented limit was exceeded."""


class FileError(BreaklineError, OSError):
    """The operating system failed. ``errno`` is its number, if it gave one."""


class FileMissingError(FileError, FileNotFoundError):
    """A file does not exist."""


class FileKeptError(FileError, FileExistsError):
    """A file exists, and was not to be replaced."""


class NotYetError(BreaklineError):
    """A task of a job needs others that are not done: the same may work later."""


class OtherJobError(UsageError):
    """The folder of a job has another job than the one that was meant."""


class CanceledError(BreaklineError):
    """The work was canceled."""


class InternalError(BreaklineError, RuntimeError):
    """A defect of breakline. Nothing was changed, and other calls work."""


class BreaklineWarning(UserWarning):
    """Something is probably not as intended."""


_BY_ERRNO = {2: FileMissingError, 17: FileKeptError}


def create(parts: "dict[str, Any]") -> BreaklineError:
    """Return the exception for an error of the library."""
    parts = dict(parts)
    kind = globals()[parts.pop("class")]
    if kind is FileError:
        kind = _BY_ERRNO.get(parts["errno"], FileError)
    return _restore(kind, parts)


def _restore(kind: "type[BreaklineError]", attributes: "dict[str, Any]") -> BreaklineError:
    error = kind(attributes["message"])
    errno = attributes.pop("errno", None)
    for name, value in attributes.items():
        setattr(error, name, value)
    if isinstance(error, OSError) and errno is not None:
        error.errno, error.filename = errno, attributes["file"]
    return error


def usage(
    message: str, value: object = None, cure: Optional[str] = None, kind: "type[UsageError]" = UsageError
) -> UsageError:
    """Return an error about an argument."""
    error = kind(message)
    error.message, error.cure = message, cure
    error.value = None if value is None else repr(value)[:60]
    return error


def warn(texts: "Sequence[str]", kind: "type[BreaklineWarning]" = BreaklineWarning) -> None:
    """Issue warnings that point to the first caller outside of this package."""
    folder = os.path.dirname(__file__)
    level = 1
    frame: "Optional[FrameType]" = sys._getframe()
    while frame is not None and frame.f_code.co_filename.startswith(folder):
        level, frame = level + 1, frame.f_back
    for text in texts:
        warnings.warn(text, kind, stacklevel=level)
