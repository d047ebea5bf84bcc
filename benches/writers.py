"""Writers beside those of other programs: lines by ogr2ogr, surfaces by trimesh and meshio.

    python benches/writers.py FOLDER LINES.fgb SURFACE.ply POINTS.laz

Needs `cargo build --release --features bench --example bench_writers`; trimesh and meshio for surfaces. Outputs go to
the folder. Each time is the shortest of three. Those of breakline and of the packages are of writing alone, from memory;
those of ogr2ogr are printed with and without the time that GDAL needs to read the lines.
"""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from typing import Callable

OURS = Path(__file__).resolve().parents[1] / "target/release/examples/bench_writers"

DRIVERS = {"shp": "ESRI Shapefile", "gpkg": "GPKG", "geojson": "GeoJSON", "fgb": "FlatGeobuf"}


def shortest(work: "Callable[[], object]") -> float:
    times = []
    for _ in range(3):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def run(folder: Path, *command: "str | Path") -> None:
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def ours(folder: Path, file: Path, *extensions: str) -> None:
    done = subprocess.run([OURS, file, *extensions], cwd=folder, check=True, capture_output=True, text=True)
    print(done.stdout)


def by_gdal(folder: Path, lines: Path) -> None:
    def read() -> None:
        run(folder, "ogr2ogr", "-f", "Memory", "unused", lines)

    reading = shortest(read)
    print(f"ogr2ogr: to memory {reading:.2f} s")
    for extension, driver in DRIVERS.items():
        target = folder / f"g.{extension}"

        def write() -> None:
            for old in folder.glob("g.*"):
                old.unlink()
            run(folder, "ogr2ogr", "-f", driver, target, lines)

        whole = shortest(write)
        print(f"ogr2ogr {extension:8} {whole:.2f} s, without reading {whole - reading:.2f} s")
    # DXF has no attributes.
    drawing = ["ogr2ogr", "-f", "DXF", folder / "g.dxf", lines, "-select", "", "-nln", "entities"]

    def draw() -> None:
        (folder / "g.dxf").unlink(missing_ok=True)
        run(folder, *drawing)

    whole = shortest(draw)
    print(f"ogr2ogr dxf      {whole:.2f} s, without reading {whole - reading:.2f} s\n")


def by_packages(folder: Path, surface: Path) -> None:
    import meshio
    import trimesh

    mesh = trimesh.load(surface, process=False)
    other = meshio.Mesh(mesh.vertices, [("triangle", mesh.faces)])
    for extension in ("ply", "obj", "off", "stl", "glb"):
        print(f"trimesh {extension:4} {shortest(lambda: mesh.export(folder / f't.{extension}')):.2f} s")
    for extension in ("ply", "obj", "off", "stl"):
        print(f"meshio {extension:4} {shortest(lambda: other.write(folder / f'm.{extension}')):.2f} s")
    print()


def main() -> None:
    folder, lines, surface, points = (Path(argument).resolve() for argument in sys.argv[1:])
    ours(folder, lines)
    by_gdal(folder, lines)
    ours(folder, surface)
    by_packages(folder, surface)
    ours(folder, points, "laz", "copc.laz")


if __name__ == "__main__":
    main()
