"""What every long call takes: threads and progress."""

from __future__ import annotations

from typing import Any, Callable, Optional, Union

from ._errors import ArgumentTypeError, usage

#: True for a progress bar, or a function that is called with the stage, the items done, and their number or None.
Progress = Union[bool, Callable[[str, int, Optional[int]], Any], None]


#: More threads than any machine has cores only take memory.
_MOST_THREADS = 1024


class _Bar:
    """A bar of tqdm for the stage in progress."""

    def __init__(self) -> None:
        self.stage: Optional[str] = None
        self.bar: Any = None

    def __call__(self, stage: str, done: int, total: Optional[int]) -> None:
        from tqdm.auto import tqdm

        if stage != self.stage:
            self.close()
            self.stage, self.bar = stage, tqdm(desc=stage, total=total, unit_scale=True)
        self.bar.update(done - self.bar.n)

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()


class call:
    """The arguments of a long call, as the value of a `with` block; the progress bar is closed at its end.

    A class, because a generator would take 3 us for each call.
    """

    def __init__(self, threads: Optional[int], progress: Progress) -> None:
        self.threads = checked(threads)
        self.bar = _bar(progress)
        self.progress = self.bar or (progress if callable(progress) else None)

    def __enter__(self) -> "tuple[Optional[int], Any]":
        return self.threads, self.progress

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.close()


def checked(threads: Optional[int]) -> Optional[int]:
    """Return a number of threads, or None for one per core; raise for anything else."""
    if threads is None:
        return None
    if isinstance(threads, bool) or not hasattr(threads, "__index__"):
        raise usage("threads is not a whole number", threads, "pass 1 or more, or None", ArgumentTypeError)
    count = threads.__index__()
    if not 1 <= count <= _MOST_THREADS:
        raise usage(f"threads is {count}", count, f"pass 1 to {_MOST_THREADS}, or None for one per core")
    return count


def _bar(progress: Progress) -> Optional[_Bar]:
    """Return a progress bar if one is asked for."""
    if progress is True:
        try:
            import tqdm.auto  # noqa: F401
        except ImportError:
            raise usage("progress=True needs tqdm", None, "pip install tqdm, or pass a function") from None
        return _Bar()
    if progress is not None and progress is not False and not callable(progress):
        raise usage(
            "progress is no function", progress, "pass True, or a function of three arguments", ArgumentTypeError
        )
    return None
