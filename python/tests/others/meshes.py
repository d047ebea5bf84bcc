"""What other programs read of the meshes that breakline writes. Run by hand:

    python python/tests/others/meshes.py

Nothing is fetched: a package that is not installed is named, and skipped. Each file is read back and compared with the
surface: the number of triangles, and the box around the vertices. Exit code 1 if a program that should read a file
does not.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import sys
import tempfile
from pathlib import Path
from typing import Any, Callable

import breakline
import numpy as np

FIXTURES = Path(__file__).resolve().parents[3] / "fixtures"

#: What does not work, and why.
KNOWN = {("meshio", "lines.ply"): "it reads no binary PLY with values of faces: tin --plain, or write(plain=True)"}


def of_meshio(package: Any, path: Path) -> "tuple[np.ndarray, int]":
    mesh = package.read(path)
    return mesh.points, sum(len(block.data) for block in mesh.cells)


def of_trimesh(package: Any, path: Path) -> "tuple[np.ndarray, int]":
    mesh = package.load(path, process=False)
    return mesh.vertices, len(mesh.faces)


def of_pyvista(package: Any, path: Path) -> "tuple[np.ndarray, int]":
    mesh = package.read(path)
    return mesh.points, mesh.n_cells


def of_open3d(package: Any, path: Path) -> "tuple[np.ndarray, int]":
    mesh = package.io.read_triangle_mesh(str(path))
    return np.asarray(mesh.vertices), len(mesh.triangles)


def of_assimp(package: Any, path: Path) -> "tuple[np.ndarray, int]":
    (mesh,) = package.import_file(str(path), 0).meshes
    return np.reshape(mesh.vertices, (-1, 3)), np.size(mesh.indices) // 3


#: Packages, their names for installers, and how they read a file.
READERS: "list[tuple[str, str, Callable[[Any, Path], tuple[np.ndarray, int]]]]" = [
    ("meshio", "meshio", of_meshio),
    ("trimesh", "trimesh", of_trimesh),
    ("pyvista", "pyvista", of_pyvista),
    ("open3d", "open3d", of_open3d),
    ("assimp_py", "assimp-py", of_assimp),
]


def written(folder: Path) -> "tuple[list[Path], breakline.Tin]":
    """Write a surface with lines in all formats, and as a plain PLY."""
    tin = breakline.tin(FIXTURES / "valley.laz", breaklines=FIXTURES / "breaklines.shp")
    files = [folder / f"lines.{extension}" for extension in ("ply", "obj", "off", "stl")]
    for path in files:
        tin.write(path)
    plain = folder / "plain.ply"
    tin.write(plain, plain=True)
    return [*files, plain], tin


def flaw(path: Path, read: "tuple[np.ndarray, int]", tin: breakline.Tin) -> str:
    """Return what differs from the surface; an empty text if nothing does."""
    vertices, faces = read
    if faces != len(tin.triangles):
        return f"{faces} triangles, not {len(tin.triangles)}"
    found = np.array([np.min(vertices, axis=0), np.max(vertices, axis=0)], dtype=float)
    expected = np.array([tin.vertices.min(axis=0), tin.vertices.max(axis=0)])
    if path.suffix == ".stl":  # relative to an origin
        found, expected = np.diff(found, axis=0), np.diff(expected, axis=0)
    # Some keep coordinates as 32-bit floats: half a meter of a northing.
    return "" if np.allclose(found, expected, rtol=0, atol=0.6) else f"the box is {found.tolist()}"


def main() -> int:
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        files, tin = written(Path(folder))
        print(f"breakline {breakline.__version__}: {len(tin.triangles)} triangles")
        for name, distribution, read in READERS:
            try:
                package = importlib.import_module(name)
            except ImportError as error:
                print(f"{distribution}: skipped ({error})")
                continue
            print(f"{distribution} {importlib.metadata.version(distribution)}")
            for path in files:
                try:
                    problem = flaw(path, read(package, path), tin)
                except Exception as error:  # whatever they raise
                    problem = f"{type(error).__name__}: {error}"
                known = KNOWN.get((name, path.name))
                failed += bool(problem) and known is None
                print(f"  {path.name:10} {'read' if not problem else known or problem}")
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(main())
