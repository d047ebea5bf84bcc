"""Times of whole programs, from a file to a finished file: breakline beside the others, in turn.

    benches/programs.py FOLDER TILE.laz LINES.shp [--breakline PROGRAM] [--pdal COMMAND] [--runs 5] [--only NAME]

Outputs and temporary files go to FOLDER. `PROGRAM` and `COMMAND` are split at spaces: `--pdal "chroot DEBIAN pdal"`
works if FOLDER and the tile have the same paths there. Needs PDAL, the programs of GDAL, and laspy, triangle, pyogrio
and shapely for Python; the row of a route whose program is missing has the error. Rows that begin with a DEM need that
of the row "LAZ to 1 m DEM" in FOLDER.

A row of the table that is printed: the medians of elapsed seconds, of processor seconds and of the peak in MiB, first
of breakline, then of the other, and the median ratio of elapsed times of consecutive runs: above 1 breakline is faster.
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import statistics
import subprocess
import sys
import time
from pathlib import Path


def main():
    if sys.argv[1:2] == ["--triangle"]:
        return triangle_mesh(*sys.argv[2:])
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("tile")
    parser.add_argument("lines")
    parser.add_argument("--breakline", default="breakline")
    parser.add_argument("--pdal", default="pdal")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--only", default="", help="rows whose name contains this")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}, medians of {options.runs}\n")
    print("| | breakline | other | its figures | ratio |\n|---|---|---|---|---|")
    for name, ours, other, theirs in routes(options):
        if options.only in name:
            row(name, ours, other, theirs, options.runs)


def row(name, ours, other, theirs, runs):
    """Print the row of one route: two lists of commands in turn, the first run of each not counted."""
    try:
        taken = [(measured(ours), measured(theirs)) for _ in range(runs + 1)][1:]
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"| {name} | | {other} | {error} | |", flush=True)
        return
    figures = [[statistics.median(column) for column in zip(*(pair[k] for pair in taken))] for k in (0, 1)]
    shown = ["{:.2f} / {:.2f} / {:.0f}".format(*medians) for medians in figures]
    ratio = statistics.median(pair[1][0] / pair[0][0] for pair in taken)
    print(f"| {name} | {shown[0]} | {other} | {shown[1]} | {ratio:.2f} |", flush=True)


def measured(commands):
    """Return the elapsed seconds and the processor seconds of all commands, and the highest peak in MiB."""
    elapsed = processor = peak = 0.0
    for command in commands:
        start = time.perf_counter()
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode:
            raise subprocess.CalledProcessError(child.returncode, shlex.join(command))
        elapsed += time.perf_counter() - start
        processor += used.ru_utime + used.ru_stime
        peak = max(peak, used.ru_maxrss / 1024)
    return elapsed, processor, peak


def routes(options):
    """Yield the name of a route, our commands, the name of the other, and its commands."""
    folder, tile = options.folder.resolve(), str(Path(options.tile).resolve())

    def breakline(verb, *arguments):
        return [[*shlex.split(options.breakline), verb, *arguments, "-q", "--overwrite"]]

    def pdal(name, *stages):
        pipeline = folder / f"{name}.json"
        pipeline.write_text(json.dumps([tile, {"type": "filters.range", "limits": "Classification[2:2]"}, *stages]))
        return [*shlex.split(options.pdal), "pipeline", str(pipeline)]

    def out(name):
        return str(folder / name)

    delaunay = {"type": "filters.delaunay"}
    ply = {"type": "writers.ply", "filename": out("pdal.ply"), "faces": True, "storage_mode": "little endian"}
    raster = {"type": "writers.raster", "filename": out("pdal.tif"), "data_type": "float", "nodata": -9999}
    mesh = pdal("mesh", delaunay, ply)
    dem = pdal("dem", delaunay, {"type": "filters.faceraster", "resolution": 1.0}, raster)
    python = [sys.executable, str(Path(__file__).resolve()), "--triangle", tile]
    triangle = "laspy, Triangle"

    ours = breakline("tin", tile, "-o", out("mesh.ply"))
    yield "LAZ to PLY mesh", ours, "PDAL", [mesh]
    yield "LAZ to PLY mesh", ours, triangle, [[*python, out("triangle.ply")]]
    with_lines = breakline("tin", tile, "--breaklines", options.lines, "-o", out("lines.ply"))
    yield "the same with breaklines", with_lines, triangle, [[*python, out("triangle.ply"), options.lines]]
    yield "LAZ to 1 m DEM", breakline("dem", tile, "-o", out("dem.tif")), "PDAL", [dem]

    def gdal_contour(raster, interval, *options):
        return ["gdal_contour", "-q", *options, "-a", "ELEV", "-i", interval, out(raster), out("gdal.shp")]

    contour = breakline("contour", tile, "-o", out("contours.shp"))
    yield "LAZ to 1 m contours", contour, "PDAL, gdal_contour", [dem, gdal_contour("pdal.tif", "1")]
    for interval in ("10", "1", "0.02"):
        contour = breakline("contour", out("dem.tif"), "--interval", interval, "-o", out("contours.shp"))
        theirs = [gdal_contour("dem.tif", interval, "-3d")]
        yield f"DEM to contours every {interval} m", contour, "gdal_contour", theirs
    shaded = ["gdaldem", "hillshade", "-q", "-compute_edges", out("dem.tif"), out("gdal_shaded.tif")]
    yield "DEM to hillshade", breakline("hillshade", out("dem.tif"), "-o", out("shaded.tif")), "gdaldem", [shaded]
    selected = breakline("points", tile, "--class", "2", "-o", out("ground.laz"))
    laz = {"type": "writers.las", "filename": out("pdal.laz"), "compression": "laszip", "forward": "all"}
    yield "LAZ to LAZ of one class", selected, "PDAL", [pdal("points", laz)]


def triangle_mesh(tile, output, lines=None):
    """Triangulate a tile with laspy and package triangle, with lines constrained, and write a binary PLY."""
    import laspy
    import numpy as np
    import triangle

    points = laspy.read(tile).points
    points = points[points.classification == 2]
    vertices = np.column_stack([points.x, points.y, points.z])
    origin = vertices[:, :2].min(axis=0)
    if lines is None:
        found = triangle.triangulate({"vertices": vertices[:, :2] - origin}, "Q")
    else:
        import pyogrio.raw
        import shapely

        segments = []
        for line in shapely.from_wkb(pyogrio.raw.read(lines)[2]):
            corners = shapely.get_coordinates(line, include_z=True)
            numbers = len(vertices) + np.arange(len(corners))
            if np.array_equal(corners[0], corners[-1]):
                corners, numbers[-1] = corners[:-1], numbers[0]
            segments.append(np.column_stack([numbers[:-1], numbers[1:]]))
            vertices = np.vstack([vertices, corners])
        graph = {"vertices": vertices[:, :2] - origin, "segments": np.vstack(segments)}
        found = triangle.triangulate(graph, "pcQ")
        # Vertices where lines cross have no height: this route leaves them without one.
        added = found["vertices"][len(vertices) :] + origin
        vertices = np.vstack([vertices, np.column_stack([added, np.full(len(added), np.nan)])])
    faces = np.empty(len(found["triangles"]), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, found["triangles"]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property double {axis}" for axis in "xyz"]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    with open(output, "wb") as file:
        file.write("\n".join(header).encode())
        file.write(vertices.astype("<f8").tobytes())
        file.write(faces.tobytes())


if __name__ == "__main__":
    main()
