"""What formats of layers, lidar and terrain tiles keep, judged by other programs. Run by hand:

    python python/tests/others/layers.py PROGRAM

PROGRAM is the program `breakline`. It prints the tables of `docs/formats.md`, and names packages that are not
installed. Each cell is from two round trips: what breakline writes is read by the judge, and what the judge writes is
read by breakline. Exit code 1 if a judge cannot read what breakline writes, or the other way.
"""

from __future__ import annotations

import gzip
import json
import math
import random
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

#: The judge of layers is GDAL, in pyogrio.
DRIVERS = {
    "shp": "ESRI Shapefile",
    "zip": "ESRI Shapefile",
    "shz": "ESRI Shapefile",
    "geojson": "GeoJSON",
    "geojsonl": "GeoJSONSeq",
    "gpkg": "GPKG",
    "fgb": "FlatGeobuf",
    "dxf": "DXF",
}

NAMES = {
    "shp": "shapefile",
    "zip": "zipped shapefile",
    "shz": "zipped shapefile, `.shz`",
    "geojson": "GeoJSON",
    "geojsonl": "GeoJSON lines",
    "gpkg": "GeoPackage",
    "fgb": "FlatGeobuf",
    "dxf": "DXF",
}

#: Attributes of all kinds, with one that is missing in every second record.
ROWS: "list[dict[str, Any]]" = [
    {"name": f"Höhe {i} \"ä\"", "lanes": i - 2, "width": 0.1 + i / 3, "open": i % 2 == 0, "maybe": i if i % 2 else None}
    for i in range(6)
]


def run(program: str, folder: Path, *arguments: str) -> None:
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError([line for line in done.stderr.splitlines() if line.startswith("error")][0])


def surface() -> str:
    """Points of a wavy surface, at coordinates that need all digits."""
    dice = random.Random(7)
    at = [(500_000 + 90 * dice.random(), 5_400_000 + 70 * dice.random()) for _ in range(200)]
    return "".join(f"{x!r} {y!r} {100 + 5 * math.sin(x / 9) * math.cos(y / 11)!r}\n" for x, y in at)


def collection() -> str:
    """Lines over the surface, with attributes."""
    dice = random.Random(3)

    def feature(row: "dict[str, Any]") -> "dict[str, Any]":
        line = [[500_020 + 50 * dice.random(), 5_400_020 + 30 * dice.random()] for _ in range(4)]
        return {"type": "Feature", "properties": row, "geometry": {"type": "LineString", "coordinates": line}}

    system = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}
    return json.dumps({"type": "FeatureCollection", "crs": system, "features": [feature(row) for row in ROWS]})


def of_json(path: Path) -> "tuple[list[np.ndarray], list[dict[str, Any]]]":
    """The lines and attributes of a GeoJSON that breakline wrote."""
    features = json.loads(path.read_text())["features"]
    return [np.array(f["geometry"]["coordinates"]) for f in features], [f["properties"] for f in features]


def same_lines(one: "list[np.ndarray]", other: "list[np.ndarray]") -> bool:
    return len(one) == len(other) and all(a.shape == b.shape and bool((a == b).all()) for a, b in zip(one, other))


def is_missing(value: Any) -> bool:
    return value is None or isinstance(value, float) and math.isnan(value)


def same_values(found: "list[dict[str, Any]]", tolerance: float = 0.0) -> bool:
    """Whether attributes have the values of `ROWS`; truth may be a whole number, which is what some formats have."""

    def is_same(wanted: Any, value: Any) -> bool:
        if is_missing(wanted) or is_missing(value):
            return is_missing(wanted) and is_missing(value)
        if isinstance(wanted, float):
            return bool(abs(value - wanted) <= tolerance * abs(wanted))
        return isinstance(value, str) == isinstance(wanted, str) and bool(value == wanted)

    rows = [{key.lower(): value for key, value in row.items()} for row in found]
    return len(rows) == len(ROWS) and all(
        name in row and is_same(wanted, row[name]) for row, known in zip(rows, ROWS) for name, wanted in known.items()
    )


def mark(kept: bool) -> str:
    return "yes" if kept else "no"


def judged(path: Path, wanted: "list[np.ndarray]") -> "list[str]":
    """What GDAL finds of a layer: system, coordinates, attributes."""
    import geopandas
    import shapely

    frame = geopandas.read_file(path, engine="pyogrio")
    # FlatGeobuf sorts its records.
    names = [str(row.get("name", row.get("NAME", ""))) for row in frame.drop(columns="geometry").to_dict("records")]
    order = sorted(range(len(names)), key=lambda i: names[i])
    rows = frame.drop(columns="geometry").to_dict("records")
    shapes = [shapely.get_coordinates(shape, include_z=True) for shape in frame.geometry]
    is_known = frame.crs is not None and frame.crs.to_epsg() == 25832
    return [
        mark(is_known),
        mark(same_lines([shapes[i] for i in order], wanted)),
        mark(same_values([rows[i] for i in order])),
    ]


def written_by_gdal(path: Path, driver: str, frame: Any) -> None:
    if path.suffix in (".zip", ".shz"):
        parts = path.with_name("packed.shp")
        frame.to_file(parts, driver=driver, engine="pyogrio")
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for part in ("shp", "shx", "dbf", "prj", "cpg"):
                archive.write(parts.with_suffix(f".{part}"), f"packed.{part}")
    elif driver == "DXF":
        frame[["geometry"]].to_file(path, driver=driver, engine="pyogrio")
    else:
        options = {"COORDINATE_PRECISION": "17"} if driver.startswith("GeoJSON") else {}
        frame.to_file(path, driver=driver, engine="pyogrio", **options)


def layers(program: str, folder: Path) -> int:
    import geopandas
    import pyogrio

    bad = 0
    (folder / "p.xyz").write_text(surface())
    (folder / "l.geojson").write_text(collection())
    drape = ["drape", "p.xyz", "--a-srs", "EPSG:25832", "--overwrite", "--lines"]
    breaklines = ["tin", "p.xyz", "--a-srs", "EPSG:25832", "--overwrite", "--breaklines"]
    run(program, folder, *drape, "l.geojson", "-o", "wanted.geojson")
    wanted, rows = of_json(folder / "wanted.geojson")
    assert same_values(rows), rows
    run(program, folder, *breaklines, "wanted.geojson", "-o", "wanted.ply")
    version = ".".join(map(str, pyogrio.__gdal_version__))
    print(f"GDAL {version} reads what breakline writes, and breakline what GDAL writes:\n")
    print("| format | written | system kept | coordinates exact | attributes kept | read | system | exact | attributes |")
    print("|---|---|---|---|---|---|---|---|---|")
    frame = geopandas.read_file(folder / "wanted.geojson", engine="pyogrio")
    for extension, driver in DRIVERS.items():
        cells = ["no", "-", "-", "-"]
        if extension not in ("zip", "shz"):
            try:
                run(program, folder, *drape, "l.geojson", "-o", f"w.{extension}")
                cells = ["yes", *judged(folder / f"w.{extension}", wanted)]
            except Exception as error:  # noqa: BLE001 - whatever a package throws is its verdict
                cells, bad = [f"failed: {error!r}", "-", "-", "-"], bad + 1
        source = f"g.{extension}"
        if extension == "geojsonl":
            # GDAL writes it in degrees only.
            print(f"| {NAMES[extension]} | " + " | ".join([*cells, "not judged", "-", "-", "-"]) + " |")
            continue
        try:
            written_by_gdal(folder / source, driver, frame)
            run(program, folder, *breaklines, source, "-o", "back.ply")
            exact = (folder / "back.ply").read_bytes() == (folder / "wanted.ply").read_bytes()
            facts = subprocess.run([program, "info", source, "--json"], cwd=folder, capture_output=True, text=True)
            is_known = "25832" in facts.stdout
            run(program, folder, *drape, source, "-o", "back.geojson")
            _, rows = of_json(folder / "back.geojson")
            rows.sort(key=lambda row: str(row.get("name", row.get("NAME", ""))))
            # GDAL writes tables of shapefiles with 15 decimals.
            kept = mark(same_values(rows, 1e-14))
            cells += ["yes", mark(is_known), mark(exact), kept]
        except Exception as error:  # noqa: BLE001
            cells, bad = [*cells, f"failed: {error!r}", "-", "-", "-"], bad + 1
        print(f"| {NAMES[extension]} | " + " | ".join(cells) + " |")
    return bad


def lidar_rows(path: Path) -> "tuple[Any, np.ndarray]":
    """The header of a file, and the raw records of its points with sorted fields, by laspy."""
    import laspy

    with laspy.open(path) as file:
        points = file.read()
        return file.header, points.points.array


def lidar(program: str, folder: Path) -> int:
    import laspy

    bad = 0
    print(f"\nlaspy {laspy.__version__} reads what breakline writes:\n")
    print("| format | written | system kept | coordinates exact | attributes kept |")
    print("|---|---|---|---|---|")
    dice = np.random.default_rng(5)
    count = 120_000
    for number in (1, 3, 6, 7):
        header = laspy.LasHeader(version="1.4", point_format=number)
        header.offsets, header.scales = [500_000, 5_400_000, 0], [0.001] * 3
        import pyproj

        header.add_crs(pyproj.CRS.from_epsg(25832))
        header.add_extra_dim(laspy.ExtraBytesParams(name="height above", type=np.float64))
        source = laspy.LasData(header)
        source.x = 500_000 + dice.random(count) * 800
        source.y = 5_400_000 + dice.random(count) ** 2 * 600
        source.z = 100 + dice.random(count) * 40
        for name in source.point_format.dimension_names:
            if name in ("X", "Y", "Z"):
                continue
            low, high = (-90, 91) if name == "scan_angle_rank" else (0, 2)
            source[name] = dice.integers(low, high, count)
        source.intensity = dice.integers(0, 65_536, count)
        source.gps_time = np.arange(count) + 0.5
        source["height above"] = dice.random(count)
        source.write(folder / "s.las")
        for extension in ("las", "laz", "copc.laz"):
            try:
                run(program, folder, "points", "s.las", "--overwrite", "-o", f"w.{extension}")
                back = laspy.read(folder / f"w.{extension}")
                order = np.argsort(back.gps_time)
                exact = all((np.asarray(back[k])[order] == np.asarray(source[k])).all() for k in "XYZ")
                same = len(back) == count and not (back.header.scales != header.scales).any()
                kept = True
                for name in source.point_format.dimension_names:
                    if name in back.point_format.dimension_names:
                        found = np.asarray(back[name])
                    else:
                        # Degrees became steps of 0.006 degrees.
                        found = np.round(np.asarray(back["scan_angle"]) * 0.006)
                    kept &= bool((found[order] == np.asarray(source[name])).all())
                system = back.header.parse_crs()
                is_known = system is not None and system.to_epsg() == 25832
                if extension == "copc.laz":
                    exact &= of_octree(folder / "w.copc.laz", back)
                cells = ["yes", mark(is_known), mark(exact and same), mark(kept)]
            except Exception as error:  # noqa: BLE001
                cells, bad = [f"failed: {error!r}", "-", "-", "-"], bad + 1
            print(f"| {extension.upper()} of point format {number} | " + " | ".join(cells) + " |")
    return bad


def of_octree(path: Path, whole: Any) -> bool:
    """Whether queries by laspy and copc-lib agree with the points."""
    import laspy

    with laspy.CopcReader.open(path) as reader:
        low, high = np.array(reader.header.mins), np.array(reader.header.maxs)
        for i in range(8):
            corner = low + (high - low) * [i / 10, (i * 3 % 8) / 10, 0]
            box = laspy.Bounds(corner[:2], corner[:2] + (high - low)[:2] * 0.2)
            found = reader.query(bounds=box)
            x, y = np.asarray(whole.x), np.asarray(whole.y)
            inside = (box.mins[0] <= x) & (x <= box.maxs[0]) & (box.mins[1] <= y) & (y <= box.maxs[1])
            if not np.array_equal(np.sort(np.asarray(found.gps_time)), np.sort(np.asarray(whole.gps_time)[inside])):
                return False
        counts = [len(reader.query(level=range(0, level + 1))) for level in range(4)]
        if not all(a <= b for a, b in zip(counts, counts[1:])) or counts[0] > len(whole) / 2:
            return False
    try:
        import copclib
    except ImportError:
        print("copc-lib not installed")
        return True
    reader = copclib.FileReader(str(path))
    total = sum(len(reader.GetPoints(node)) for node in reader.GetAllNodes())
    return total == len(whole) and reader.ValidateSpatialBounds()


def terrain(program: str, folder: Path) -> int:
    """Terrain tiles: positions and heights by the decoder of quantized-mesh-tile, and of GLB by pygltflib."""
    import pygltflib
    from quantized_mesh_tile import TerrainTile

    rows = [f"{7 + i / 4000} {47 + j / 4000} {400 + 30 * math.sin(i / 5) * math.cos(j / 7)}" for i in range(40) for j in range(40)]
    (folder / "globe.xyz").write_text("\n".join(rows) + "\n")
    command = ["terrain-tiles", "globe.xyz", "--a-srs", "EPSG:4326", "--max-error", "0.5", "--vertical-offset", "0"]
    run(program, folder, *command, "-o", "tiles")
    run(program, folder, *command, "--format", "3dtiles", "-o", "tiles3d")
    finest: "dict[int, list[Path]]" = {}
    for path in (folder / "tiles").rglob("*.terrain"):
        finest.setdefault(int(path.parts[-3]), []).append(path)
    level = max(finest)
    known = {(round(float(x), 7), round(float(y), 7)): float(z) for x, y, z in (row.split() for row in rows)}
    worst, count = 0.0, 0
    for path in finest[level]:
        column, row = int(path.parts[-2]), int(path.stem)
        side = 180 / 2**level
        west, south = -180 + column * side, -90 + row * side
        tile = TerrainTile(west=west, south=south, east=west + side, north=south + side)
        (folder / "plain.terrain").write_bytes(gzip.decompress(path.read_bytes()))
        tile.fromFile(str(folder / "plain.terrain"), hasLighting=True)
        for x, y, z in tile.getVerticesCoordinates():
            near = (round(round((x - 7) * 4000) / 4000 + 7, 7), round(round((y - 47) * 4000) / 4000 + 47, 7))
            if near in known and math.dist(near, (x, y)) < side / 32767:
                worst, count = max(worst, abs(z - known[near])), count + 1
    print(f"\nquantized-mesh-tile reads {sum(map(len, finest.values()))} tiles of {len(finest)} levels; {count} vertices of the finest are measured points, and differ by {worst:.3f} m at most (asked for: 0.5 m)")
    glbs = list((folder / "tiles3d").rglob("*.glb"))
    for path in glbs:
        gltf = pygltflib.GLTF2().load(path)
        assert gltf.accessors[0].count > 0 and gltf.asset.version == "2.0"
    print(f"pygltflib reads {len(glbs)} GLB of 3D Tiles")
    return int(count == 0 or worst > 0.5)


def main() -> int:
    program = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as name:
        return int(sum(judge(program, Path(name)) for judge in (layers, lidar, terrain)) > 0)


if __name__ == "__main__":
    sys.exit(main())
