"""What laspy reads of files before and after `breakline ground`: every byte but the class has to be the same. By hand:

    python python/tests/others/ground_bytes.py PROGRAM FILE...

PROGRAM is the program `breakline`; a FILE may be a folder. Each file is classified to LAS and to LAZ, and if it can be
read, laspy must read the same header, records and points. A file that laspy cannot read is named, and compared by the
header and the records alone; one that breakline refuses is named with the reason. Exit code 1 if something differs.
"""

from __future__ import annotations

import struct
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Iterator, Optional

import laspy
import numpy as np

#: Fields of the header that state where things are, and how many records there are: positions and lengths.
PLACES = [(96, 4), (100, 4), (227, 8), (235, 8), (243, 4)]
FORMAT = 104


def header_of(data: bytes) -> bytes:
    """The header without what may differ: places, and the bit for compression."""
    header = bytearray(data[: struct.unpack_from("<H", data, 94)[0]])
    for at, length in PLACES:
        if at < 227 or data[25] >= 4 or (data[25] == 3 and at == 227):
            header[at : at + length] = bytes(length)
    header[FORMAT] &= 0x7F
    return bytes(header)


def records_of(data: bytes) -> "tuple[list[bytes], list[bytes]]":
    """All records, without those of LASzip and COPC."""

    def read(at: int, count: int, size: int, long: bool) -> "Iterator[bytes]":
        for _ in range(count):
            length = struct.unpack_from("<Q" if long else "<H", data, at + 20)[0]
            record = data[at : at + size + length]
            assert len(record) == size + length, "a record is cut"
            at += size + length
            if record[2:18].rstrip(b"\0") not in (b"laszip encoded", b"copc"):
                yield record

    start, (count,) = struct.unpack_from("<H", data, 94)[0], struct.unpack_from("<I", data, 100)
    late = (0, 0) if data[25] < 4 else struct.unpack_from("<QI", data, 235)
    return list(read(start, count, 54, False)), list(read(late[0], late[1], 60, True))


def waveforms_of(data: bytes) -> bytes:
    """Packets of waveforms that are in the file, to its end (LAS 1.3) or to the end of their record (LAS 1.4)."""
    start = 0 if data[25] < 3 else struct.unpack_from("<Q", data, 227)[0]
    return data[start:] if start and data[25] == 3 else b""


def points_of(path: Path) -> "tuple[np.ndarray, int]":
    """The records of all points, a row each, and the point format."""
    # COPC is LAZ, too.
    with laspy.LasReader(path.open("rb"), laz_backend=laspy.LazBackend.LazrsParallel) as reader:
        points, head = reader.read(), reader.header
    raw = np.frombuffer(points.points.array.tobytes(), np.uint8)
    return raw.reshape(len(points.points), -1) if len(points.points) else raw.reshape(0, 1), head.point_format.id


def differences(source: Path, copy: Path) -> "Iterator[str]":
    before, after = source.read_bytes(), copy.read_bytes()
    if header_of(before) != header_of(after):
        yield "header"
    try:
        records = records_of(before)
    except AssertionError:
        # A damaged record is kept as it is.
        records = records_of(after) if after[: len(before)] == before else None
    if records != records_of(after):
        yield "records"
    if waveforms_of(before) != waveforms_of(after):
        yield "waveforms"
    try:
        points, point_format = points_of(source)
    except Exception as error:  # whatever laspy cannot read
        print(f"    laspy: {type(error).__name__}: {error}")
        return
    written, _ = points_of(copy)
    if points.shape != written.shape:
        yield f"{len(written)} points instead of {len(points)}"
        return
    if len(points) == 0:
        return
    at, kept = (15, 0xE0) if point_format < 6 else (16, 0)
    changed = np.count_nonzero(points[:, at] != written[:, at])
    points, written = points.copy(), written.copy()
    for rows in (points, written):
        rows[:, at] &= kept
    differ = np.flatnonzero((points != written).any(axis=1))
    if len(differ):
        yield f"{len(differ)} points, the first of them number {differ[0]}"
    print(f"    {len(points)} points of format {point_format}, {changed} classes changed")


def classified(program: str, source: Path, copy: Path) -> Optional[str]:
    """Classifies a file; returns why that is refused."""
    words = [program, "ground", source, "-o", copy, "--noise", "--from-class", "0-255", "--quiet"]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode == 0:
        return None
    assert not copy.exists(), f"{copy} is left although {source} is refused"
    return done.stderr.strip().splitlines()[0]


def files(named: "list[str]") -> "Iterator[Path]":
    for path in map(Path, named):
        inside = sorted(path.rglob("*")) if path.is_dir() else [path]
        yield from (file for file in inside if file.suffix.lower() in (".las", ".laz"))


def main(program: str, named: "list[str]") -> int:
    bad = same = refused = 0
    for source in files(named):
        print(source.name)
        for extension in ("las", "laz"):
            with tempfile.TemporaryDirectory() as folder:
                copy = Path(folder) / f"copy.{extension}"
                reason = classified(program, source, copy)
                if reason:
                    refused += 1
                    print(f"    refused: {reason}")
                    break
                found = list(differences(source, copy))
                for what in found:
                    print(f"    DIFFERS, {extension}: {what}")
                bad += bool(found)
                same += not found
    print(f"{same} copies are the same, {bad} differ, {refused} files are refused")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
