"""Files of points in object stores: what a plan needs of them, and copies for the workers.

A job reads files. So each object has a path, the same on all machines. To plan, the client puts files there that have
only the headers, as long as the objects, and removes them. A worker that needs the points of an object copies it there,
and removes the copy afterwards.
"""

from __future__ import annotations

import contextlib
import getpass
import hashlib
import os
import shutil
import struct
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ._errors import usage

#: Smaller objects are copied whole.
_SMALL = 1 << 20

#: The header of the newest LAS, in bytes.
_HEADER = 375

#: Headers of objects that are read at once.
_AT_ONCE = 16

#: What stores call the version of an object: the first of these that is stated tells whether it has changed.
_TIMES = ("mtime", "LastModified", "last_modified", "Last-Modified", "updated")
_VERSIONS = ("ETag", "etag", "content_md5", "md5Hash", *_TIMES)


def is_url(text: str) -> bool:
    """Return true if a name is that of an object in a store, not of a file."""
    return "://" in text


@dataclass(frozen=True)
class StoredObject:
    """An object, and the path of its copies."""

    url: str
    path: str
    size: int
    #: The time of the last change of all copies, in nanoseconds: another one if the object is another one.
    time: int
    #: May have keys, which belong in no log.
    storage_options: "dict[str, Any]" = field(repr=False)

    def place_header(self) -> None:
        """Put a file at the path that can be planned with: of LAS and LAZ, all but the points."""
        store, name = _opened(self.url, self.storage_options)
        with self._placed() as path:
            parts = _parts(store, name, self.size)
            if parts is None:
                store.get_file(name, path)
                return
            with open(path, "wb") as file:
                for start, end in parts:
                    file.seek(start)
                    file.write(store.cat_file(name, start=start, end=end))
                file.truncate(self.size)

    @contextlib.contextmanager
    def copied(self) -> "Iterator[None]":
        """Have a copy of the object at the path."""
        store, name = _opened(self.url, self.storage_options)
        with self._placed() as path:
            store.get_file(name, path)
            # Afterwards: it may have changed meanwhile.
            store.invalidate_cache()
            if _state(store.info(name)) != (self.size, self.time):
                raise usage("the object has changed since the call began", self.url, "repeat the call")
        try:
            yield
        finally:
            Path(self.path).unlink(missing_ok=True)

    @contextlib.contextmanager
    def _placed(self) -> "Iterator[str]":
        """Give a path for a file that then appears, whole, at the path of the copies."""
        folder, path = os.path.dirname(self.path), f"{self.path}.part"
        os.makedirs(folder, mode=0o700, exist_ok=True)
        try:
            yield path
            os.utime(path, ns=(self.time, self.time))
            os.replace(path, self.path)
        finally:
            Path(path).unlink(missing_ok=True)


class Objects:
    """The objects that the URLs of a job stand for."""

    def __init__(
        self, urls: "list[str]", scratch: "str | None", storage_options: "dict[str, Any] | None", job: str
    ) -> None:
        scratch = _default_scratch() if scratch is None else scratch
        self._folder = os.path.join(scratch, hashlib.sha256(job.encode()).hexdigest()[:16])
        self._of_url = {url: _found(url, self._folder, storage_options or {}) for url in urls}
        #: The objects by the paths of their copies.
        self.at = {one.path: one for of_url in self._of_url.values() for one in of_url}

    def paths(self, url: str) -> "list[str]":
        """Return the paths of the copies of what a URL stands for."""
        return [one.path for one in self._of_url[url]]

    @contextlib.contextmanager
    def headers(self) -> "Iterator[None]":
        """Have files with the headers at the paths of all objects."""
        try:
            with ThreadPoolExecutor(_AT_ONCE) as pool:
                list(pool.map(StoredObject.place_header, self.at.values()))
            yield
        finally:
            self.remove()

    def remove(self) -> None:
        """Remove what is at the paths on this machine."""
        if self.at:
            shutil.rmtree(self._folder, ignore_errors=True)


def _default_scratch() -> str:
    """Return a folder of the user in the system's folder for temporary files."""
    user = os.getuid() if hasattr(os, "getuid") else getpass.getuser()
    return os.path.join(tempfile.gettempdir(), f"breakline-{user}")


def _found(url: str, folder: str, storage_options: "dict[str, Any]") -> "list[StoredObject]":
    """Return the objects that a URL with wildcards stands for now; their copies are in a folder."""
    if "::" in url:
        raise usage("URLs of one store within another are not understood", url, "unpack it")
    store, pattern = _opened(url, storage_options)
    # In a URL of the web, a question mark begins the query.
    wild = "*[" if pattern.startswith("http") else "*[?"
    try:
        if any(letter in pattern for letter in wild):
            named = store.glob(pattern, detail=True)
            infos = [info for _, info in sorted(named.items()) if info["type"] == "file"]
        else:
            infos = [store.info(pattern)]
    except FileNotFoundError:
        infos = []
    if not infos:
        raise usage("no object has such a name", url, "check the URL, and storage_options")
    objects = []
    for info in infos:
        whole = store.unstrip_protocol(info["name"])
        base = whole.rsplit("/", 1)[1].split("?")[0]
        if info.get("size") is None:
            raise usage("the store does not state how long the object is", whole, "download it")
        size, time = _state(info)
        path = os.path.join(folder, hashlib.sha256(whole.encode()).hexdigest()[:16], base)
        objects.append(StoredObject(whole, path, size, time, storage_options))
    return objects


def _opened(url: str, storage_options: "dict[str, Any]") -> "tuple[Any, str]":
    from fsspec.core import url_to_fs

    store, name = url_to_fs(url, **storage_options)
    return store, name


def _state(info: "dict[str, Any]") -> "tuple[int, int]":
    """Return the length of an object, and a time that is another one for another version."""
    version = next((str(info[key]) for key in _VERSIONS if info.get(key)), "")
    # Two seconds are the coarsest time that a file system has.
    time = int(hashlib.sha256(version.encode()).hexdigest()[:7], 16) * 2 * 10**9
    return int(info["size"]), time


def _parts(store: Any, name: str, size: int) -> "list[tuple[int, int]] | None":
    """Return the bytes of a LAS or LAZ file that are no points; None if the whole file is needed."""
    if size < _SMALL:
        return None
    head = store.cat_file(name, start=0, end=_HEADER)
    if head[:4] != b"LASF":
        return None
    minor, (points,), is_packed = head[25], struct.unpack_from("<I", head, 96), head[104] & 0x80
    parts = [(0, min(points + 8, size))]
    # Behind the points: records of version 1.4, and where the chunks of LAZ are.
    behind = [size]
    if minor >= 4 and struct.unpack_from("<I", head, 243)[0] > 0:
        behind.append(struct.unpack_from("<Q", head, 235)[0])
    if is_packed:
        # Their place is stated before the points; in a file that was written as a stream, at its end.
        places = [store.cat_file(name, start=points, end=points + 8), store.cat_file(name, start=size - 8, end=size)]
        tables = [struct.unpack("<q", place)[0] for place in places if len(place) == 8]
        good = [table for table in tables if points + 8 <= table < size]
        if not good:
            return None
        behind.append(good[0])
    start = max(min(behind), parts[0][1])
    return [*parts, (start, size)] if start < size else parts
