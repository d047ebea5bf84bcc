"""What other programs read of the surfaces for CAD, the web and models of water, and of ASCII grids. Run by hand:

    python python/tests/others/exchange.py PROGRAM

PROGRAM is the program `breakline`. Nothing is fetched: a package or program that is not installed is named, and skipped.
Each file is compared with the PLY of the same surface: corners of all triangles, lines by kind, coordinate system. Exit
code 1 if a reader finds something else.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import json
import math
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Callable

import numpy as np

#: The largest difference of coordinates: none; 32-bit floats, and whole thousandths, over some 100 units.
EXACT, FLOATS, WHOLE = 0.0, 1e-5, 5.1e-4


def of_ply(path: Path) -> "tuple[np.ndarray, np.ndarray]":
    """The vertices and faces of a PLY that breakline wrote without lines."""
    head, _, body = path.read_bytes().partition(b"end_header\n")
    counts = [int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element ")]
    vertices = np.frombuffer(body, "<f8", 3 * counts[0]).reshape(-1, 3)
    row = np.dtype([("n", "u1"), ("v", "<i4", 3)])
    faces = np.frombuffer(body, row, counts[1], 24 * counts[0])["v"]
    return vertices, faces


def corners(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    return np.asarray(vertices)[np.asarray(faces, dtype=int)]


def of_ezdxf(package: Any, path: Path) -> np.ndarray:
    drawing = package.readfile(path)
    assert not drawing.audit().errors
    space = drawing.modelspace()
    names = {line.dxf.layer for line in space.query("POLYLINE")}
    assert names == {"BOUNDARY", "BREAKLINES"}, names
    faces = space.query("3DFACE")
    return np.array([[f.dxf.vtx0.xyz, f.dxf.vtx1.xyz, f.dxf.vtx2.xyz] for f in faces])


def of_lxml(package: Any, path: Path) -> np.ndarray:
    root = package.parse(str(path)).getroot()
    space = "{http://www.landxml.org/schema/LandXML-1.2}"
    assert root.tag == space + "LandXML"
    assert root.find(f"{space}CoordinateSystem").get("epsgCode") == "25832"
    points = {p.get("id"): [float(c) for c in p.text.split()] for p in root.iter(space + "P")}
    assert [line.get("brkType") for line in root.iter(space + "Breakline")] == ["standard"]
    faces = [[points[v] for v in f.text.split()] for f in root.iter(space + "F")]
    return np.array(faces)[:, :, [1, 0, 2]]


def of_trimesh(package: Any, path: Path) -> np.ndarray:
    mesh = package.load(path, process=False, force="mesh")
    assert (mesh.vertex_normals[:, 1] > 0).all(), "normals that point down"
    return corners(np.column_stack([mesh.vertices[:, 0], -mesh.vertices[:, 2], mesh.vertices[:, 1]]), mesh.faces)


def of_pygltflib(package: Any, path: Path) -> np.ndarray:
    gltf = package.GLTF2().load(path)
    extras = gltf.asset.extras["breakline"]
    assert extras["epsg"] == 25832
    blob = gltf.binary_blob()

    def array(number: int, kind: str) -> np.ndarray:
        accessor = gltf.accessors[number]
        start = gltf.bufferViews[accessor.bufferView].byteOffset
        count = accessor.count * (3 if accessor.type == "VEC3" else 1)
        return np.frombuffer(blob, kind, count, start).reshape(-1, 3)

    at = array(0, "<f4").astype(float)
    local = np.column_stack([at[:, 0], -at[:, 2], at[:, 1]])
    return corners(local + extras["origin"], array(3, "<u4"))


def of_netcdf(package: Any, path: Path) -> np.ndarray:
    with package.Dataset(path) as data:
        assert data.data_model == "NETCDF3_64BIT_OFFSET"
        mesh = data[[name for name in data.variables if getattr(data[name], "cf_role", "") == "mesh_topology"][0]]
        names = mesh.node_coordinates.split() + ["mesh2d_node_z"]
        assert data["projected_coordinate_system"].epsg == 25832
        at = np.column_stack([data[name][:] for name in names])
        return corners(at, data[mesh.face_node_connectivity][:])


def of_xarray(package: Any, path: Path) -> np.ndarray:
    with package.open_dataset(path) as data:
        at = np.column_stack([data[f"mesh2d_node_{axis}"].values for axis in "xyz"])
        return corners(at, data["mesh2d_face_nodes"].values)


def of_py2dm(package: Any, path: Path) -> np.ndarray:
    with package.Reader(str(path)) as mesh:
        at = {node.id: node.pos for node in mesh.iter_nodes()}
        return np.array([[at[v] for v in element.nodes] for element in mesh.iter_elements()])


def of_cjio(package: Any, path: Path) -> np.ndarray:
    with path.open() as file:
        data = importlib.import_module("cjio.cityjson").reader(file=file).j
    at = np.array(data["vertices"]) * data["transform"]["scale"] + data["transform"]["translate"]
    (relief,) = data["CityObjects"].values()
    assert relief["type"] == "TINRelief" and data["metadata"]["referenceSystem"].endswith("/25832")
    return corners(at, np.array([ring for (ring,) in relief["geometry"][0]["boundaries"]]))


#: Packages, their names for installers, the file, how they read it, and the largest difference.
READERS: "list[tuple[str, str, str, Callable[[Any, Path], np.ndarray], float]]" = [
    ("ezdxf", "ezdxf", "s.dxf", of_ezdxf, EXACT),
    ("lxml.etree", "lxml", "s.xml", of_lxml, EXACT),
    ("trimesh", "trimesh", "s.glb", of_trimesh, FLOATS),
    ("pygltflib", "pygltflib", "s.glb", of_pygltflib, FLOATS),
    ("netCDF4", "netCDF4", "s.nc", of_netcdf, EXACT),
    ("xarray", "xarray", "s.nc", of_xarray, EXACT),
    ("py2dm", "py2dm", "s.2dm", of_py2dm, EXACT),
    ("cjio", "cjio", "s.cityjson", of_cjio, WHOLE),
]


def run(program: str, folder: Path, *arguments: str) -> None:
    subprocess.run([program, *arguments], cwd=folder, check=True, capture_output=True)


def grids(program: str, folder: Path) -> str:
    """Compares a DEM in .asc with the one in .tif, as GDAL reads both."""
    if not shutil.which("gdal_translate"):
        return "not installed"
    for name in ["d.asc", "d.tif"]:
        run(program, folder, "dem", "s.ply", "--resolution", "0.7", "-o", name)
    for name in ["d.asc", "d.tif"]:
        command = ["gdal_translate", "-q", "-of", "ENVI", "-ot", "Float32", name, f"{name}.raw"]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
    one, other = (np.fromfile(folder / f"{name}.raw", "<f4") for name in ["d.asc", "d.tif"])
    info = [
        json.loads(subprocess.run(["gdalinfo", "-json", name], cwd=folder, check=True, capture_output=True).stdout)
        for name in ["d.asc", "d.tif"]
    ]
    same = np.array_equal(one, other) and np.allclose(info[0]["geoTransform"], info[1]["geoTransform"], rtol=1e-15)
    return "reads the same" if same and "UTM zone 32N" in info[0]["coordinateSystem"]["wkt"] else "differs"


def main() -> int:
    program = str(Path(sys.argv[1]).resolve())
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        dice = random.Random(7)
        points = [(500000 + 90 * dice.random(), 5400000 + 70 * dice.random()) for _ in range(400)]
        rows = [f"{x!r} {y!r} {100 + 5 * math.sin(x / 9) * math.cos(y / 11)!r}" for x, y in points]
        (folder / "p.xyz").write_text("\n".join(rows) + "\n")
        line = [[500005.5, 5400005.5, 100.5], [500080.25, 5400060.75, 101]]
        geometry = {"type": "LineString", "coordinates": line}
        feature = {"type": "Feature", "properties": {}, "geometry": geometry}
        (folder / "l.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
        build = ["tin", "p.xyz", "--a-srs", "EPSG:25832", "--breaklines", "l.geojson"]
        run(program, folder, *build, "-o", "s.ply")
        run(program, folder, *build, "--plain", "-o", "plain.ply")
        expected = corners(*of_ply(folder / "plain.ply"))
        for file in sorted({reader[2] for reader in READERS}):
            run(program, folder, *build, "-o", file)
        for module, package, file, read, tolerance in READERS:
            try:
                found = importlib.import_module(module)
            except ImportError:
                print(f"{package:10} not installed")
                continue
            version = importlib.metadata.version(package)
            try:
                read_back = read(found, folder / file)
                difference = float(np.abs(read_back - expected).max())
                verdict = f"{len(read_back)} triangles, differ by {difference:.1e}"
                bad += difference > tolerance
            except Exception as error:  # noqa: BLE001 - whatever a package throws is its verdict
                verdict, bad = f"failed: {error!r}", bad + 1
            print(f"{package:10} {version:14} {file:12} {verdict}")
        verdict = grids(program, folder)
        bad += verdict == "differs"
        print(f"{'GDAL':10} {'':14} {'d.asc':12} {verdict}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
