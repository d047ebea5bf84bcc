"""The compiled module: what the package is made of. Use the package."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Callable, List, Literal, Optional, Union, overload

import numpy as np
from numpy.typing import NDArray

__version__: str

#: The number of threads, and the function that progress is reported to.
_Call = tuple[Optional[int], Optional[Callable[[str, int, Optional[int]], Any]]]
_Raster = tuple[NDArray[Any], tuple[float, float, float, float, float, float], Optional[str]]
#: Positions of shape (q, d), or an array of shape (q,) for each axis.
_Positions = Union[NDArray[np.float64], list[NDArray[np.float64]]]
#: Where each list begins, and what they contain.
_Lists = tuple[NDArray[np.int64], NDArray[np.int32]]
_Hull = tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.float64], float, float]
_Flaws = list[tuple[str, list[tuple[float, float]]]]
_Severity = Literal["detail", "note", "warning"]

def settings() -> list[tuple[str, Optional[str]]]: ...

class Surface:
    @staticmethod
    def build(
        points: list[Any],
        read: dict[str, Any],
        systems: dict[str, Any],
        options: dict[str, Any],
        method: str,
        call: _Call,
    ) -> Surface: ...
    @staticmethod
    def ask(
        points: list[Any],
        read: dict[str, Any],
        systems: dict[str, Any],
        options: dict[str, Any],
        method: str,
        call: _Call,
        memory: Optional[str],
        count: int,
    ) -> Surface: ...
    @staticmethod
    def open(file: str, systems: dict[str, Any], call: _Call) -> Optional[Surface]: ...
    @staticmethod
    def of_cells(cells: NDArray[np.float64], transform: list[float], crs: Optional[str]) -> Surface: ...
    @staticmethod
    def of_bytes(bytes: bytes) -> Surface: ...
    def to_bytes(self, call: _Call) -> bytes: ...
    @property
    def kind(self) -> str: ...
    @property
    def crs(self) -> Optional[tuple[str, str, Optional[int]]]: ...
    @property
    def extent(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...
    @property
    def notices(self) -> list[tuple[_Severity, str]]: ...
    def report(self) -> dict[str, Any]: ...
    def replaced_points(self) -> NDArray[np.float64]: ...
    def list(self, call: _Call) -> tuple[NDArray[np.float64], NDArray[np.int32]]: ...
    def edges(self, call: _Call) -> tuple[NDArray[np.int32], NDArray[np.uint8]]: ...
    def elevations(self, positions: NDArray[np.float64], method: str, call: _Call) -> NDArray[np.float64]: ...
    def simplify(
        self, max_error: Optional[float], target: Optional[int], line_tolerance: Optional[float], call: _Call
    ) -> Surface: ...
    def dem(self, frame: dict[str, Any], method: str, call: _Call) -> _Raster: ...
    def quantity(
        self, frame: dict[str, Any], method: str, quantity: tuple[str, str, bool, Optional[float]], call: _Call
    ) -> _Raster: ...
    def hillshade(
        self,
        frame: dict[str, Any],
        method: str,
        light: tuple[str, Optional[float], Optional[float], Optional[float]],
        call: _Call,
    ) -> _Raster: ...
    def color_relief(self, asked: tuple[dict[str, Any], str, tuple[str, str]], call: _Call) -> _Raster: ...
    def write_color_relief(
        self, asked: tuple[dict[str, Any], str, tuple[str, str]], file: str, overwrite: bool, call: _Call
    ) -> None: ...
    def samples(
        self, positions: NDArray[np.float64], add: List[str], prefix: str, method: str, call: _Call
    ) -> tuple[List[str], NDArray[np.float64]]: ...
    def contours(
        self, interval: Optional[float], base: float, levels: List[float], map: dict[str, Any], call: _Call
    ) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]: ...
    def check(self, call: _Call) -> _Flaws: ...
    def write(self, file: str, plain: bool, overwrite: bool, call: _Call) -> None: ...

def accuracy(
    surface: Surface,
    checkpoints: Any,
    read: dict[str, Any],
    assign: Optional[str],
    groups: tuple[Optional[str], list[str], list[str]],
    accuracy_class: Union[float, str, None],
    checkpoint_error: Union[float, str, None],
    method: str,
    name: str,
    call: _Call,
) -> dict[str, Any]: ...
def volume(
    surface: Surface,
    base: Optional[Surface],
    levels: Optional[list[float]],
    within: Any,
    name_by: Optional[str],
    assign: Optional[str],
    unit: Optional[str],
    bulking: Optional[list[float]],
    names: list[str],
    call: _Call,
) -> tuple[
    list[
        tuple[
            Optional[int],
            Optional[float],
            tuple[float, float, float, float, float, float, float, float, float, float],
            tuple[Optional[float], Optional[float], Optional[float]],
            Optional[str],
            Optional[float],
        ]
    ],
    Optional[str],
]: ...
def compare(
    first: Surface,
    second: Surface,
    frame: dict[str, Any],
    method: str,
    worst: int,
    changed: Optional[float],
    min_area: Optional[float],
    names: list[str],
    call: _Call,
) -> tuple[
    _Raster,
    int,
    tuple[float, float, float, float, float, float, float, float, float],
    NDArray[np.float64],
    Optional[tuple[int, int]],
    Optional[
        tuple[
            list[tuple[bool, list[NDArray[np.float64]], tuple[float, float, float, float, float]]],
            Optional[str],
            int,
        ]
    ],
]: ...
def profile(
    surfaces: list[Surface],
    along: Any,
    assign: Optional[str],
    step: Optional[float],
    sections: Optional[tuple[Optional[float], list[float], float, list[float], float, str]],
    plot: tuple[Optional[float], Optional[float], Optional[str]],
    names: list[str],
    output: tuple[list[str], bool],
    call: _Call,
) -> tuple[
    list[
        tuple[
            int,
            Optional[int],
            Optional[float],
            Optional[str],
            tuple[float, float],
            list[list[NDArray[np.float64]]],
        ]
    ],
    list[str],
    tuple[Optional[str], Optional[str]],
]: ...
def drape(
    surface: Surface,
    lines: Any,
    assign: Optional[str],
    step: Optional[float],
    name: str,
    output: tuple[list[str], bool],
    call: _Call,
) -> list[list[NDArray[np.float64]]]: ...
def terrain_tiles(
    surface: Surface,
    given: dict[str, Any],
    folder: tuple[str, bool],
    call: _Call,
) -> list[tuple[int, tuple[float, float, float], tuple[int, int, int, int, int, int]]]: ...
def check_file(file: str, call: _Call) -> _Flaws: ...
def check_space(file: str, weighted: bool, call: _Call) -> list[str]: ...
def class_numbers(name: str) -> list[int]: ...
def describe() -> str: ...
def edge_kinds() -> list[str]: ...
def crs(
    from_crs: str, to: Optional[str], at: Optional[list[float]], options: tuple[bool, Optional[float]], call: _Call
) -> str: ...
def info(file: str, read: dict[str, Any], call: _Call) -> str: ...
def is_of_space(file: str) -> bool: ...
def main(arguments: list[str]) -> int: ...
def read_points(
    files: list[str], read: dict[str, Any], systems: dict[str, Any], selection: dict[str, Any], call: _Call
) -> dict[str, Any]: ...
def run(
    file: Optional[str], tables: Optional[str], overwrite: bool, memory: Optional[str], dry_run: bool, call: _Call
) -> str: ...
def ground_classes(points: NDArray[np.float64], ground: dict[str, Any], call: _Call) -> NDArray[np.uint8]: ...
def write_ground(
    files: list[str],
    chosen: tuple[Optional[list[int]], Optional[list[str]]],
    ground: dict[str, Any],
    output: tuple[str, bool, Optional[str]],
    call: _Call,
) -> dict[str, Any]: ...
def write_points(
    files: list[str],
    read: dict[str, Any],
    systems: dict[str, Any],
    selection: dict[str, Any],
    output: str,
    tiles: Optional[tuple[str, Optional[str], bool]],
    overwrite: bool,
    call: _Call,
) -> dict[str, Any]: ...
def triangulate(
    file: str, options: dict[str, Any], outputs: list[str], overwrite: bool, call: _Call
) -> dict[str, Any]: ...
def triangulate_space(
    file: str,
    weighted: bool,
    alpha: Union[float, str, None],
    kernel: str,
    outputs: list[str],
    overwrite: bool,
    call: _Call,
) -> dict[str, Any]: ...
def write_cells(
    cells: NDArray[np.float64],
    transform: list[float],
    crs: Optional[str],
    shades: bool,
    target: dict[str, Any],
    call: _Call,
) -> None: ...
def write_contours(
    points: NDArray[np.float64],
    starts: NDArray[np.int64],
    levels: NDArray[np.float64],
    crs: Optional[str],
    file: str,
    overwrite: bool,
    call: _Call,
) -> None: ...

def kind_of(file: str) -> str: ...
def job_folder(output: str) -> str: ...
def write(asked: dict[str, Any], call: _Call) -> dict[str, Any]: ...

class Job:
    @staticmethod
    def begin(asked: dict[str, Any], call: _Call) -> Job: ...
    @staticmethod
    def open(folder: str) -> Job: ...
    @property
    def folder(self) -> Path: ...
    @property
    def output(self) -> Path: ...
    @property
    def has_holes(self) -> bool: ...
    def tasks(self) -> list[dict[str, Any]]: ...
    def verify(self, call: _Call) -> None: ...
    def check_inputs(self, tasks: list[int]) -> None: ...
    def run_task(self, number: int, call: _Call) -> Optional[dict[str, Any]]: ...
    def write(self, overwrite: Optional[bool], call: _Call) -> dict[str, Any]: ...
    def update(self, call: _Call) -> dict[str, Any]: ...
    def work(self, most: Optional[str], seconds: float, call: _Call) -> dict[str, Any]: ...
    def clean(self) -> None: ...

class Tessellation:
    def __init__(self, points: NDArray[np.float64], call: _Call) -> None: ...
    def add(self, points: NDArray[np.float64], call: _Call) -> None: ...
    def simplex_count(self) -> int: ...
    def has_no_simplices(self) -> bool: ...
    def tables(self, call: _Call) -> list[NDArray[np.int32]]: ...
    def transforms(self, call: _Call) -> NDArray[np.float64]: ...
    def hull(self, call: _Call) -> NDArray[np.int32]: ...
    def coplanar(self, call: _Call) -> NDArray[np.int32]: ...
    def simplex_at(self, call: _Call) -> NDArray[np.int32]: ...
    def neighbor_points(self, call: _Call) -> list[NDArray[np.int32]]: ...
    def voronoi(
        self, call: _Call
    ) -> tuple[NDArray[np.float64], NDArray[np.int32], _Lists, _Lists, NDArray[np.int64]]: ...
    def find(self, positions: _Positions, tolerance: float, call: _Call) -> NDArray[np.int32]: ...
    def find_plain(self, positions: Any, tolerance: float, call: _Call) -> Optional[NDArray[np.int32]]: ...
    def nearest(self, positions: _Positions, values: int, call: _Call) -> NDArray[np.int32]: ...

def convex_hull(points: NDArray[np.float64], accepted: int, call: _Call) -> Optional[_Hull]: ...
def nested_lists(starts: NDArray[np.int64], items: NDArray[np.int32]) -> list[list[int]]: ...

class Values:
    def __init__(
        self,
        tessellation: Tessellation,
        values: NDArray[np.float64],
        outside: list[float],
        tolerance: float,
        call: _Call,
    ) -> None: ...
    def linear(self, positions: _Positions, call: _Call) -> NDArray[np.float64]: ...
    def natural(self, positions: _Positions, call: _Call) -> NDArray[np.float64]: ...

class CubicValues:
    def __init__(self, values: Values, tolerance: float, rounds: int, call: _Call) -> None: ...
    @property
    def has_converged(self) -> bool: ...
    def gradients(self, call: _Call) -> NDArray[np.float64]: ...
    def at(self, positions: _Positions, call: _Call) -> NDArray[np.float64]: ...

class TriangleSwitches:
    def __init__(self, switches: dict[str, Any]) -> None: ...

@overload
def triangulate_arrays(
    tri: dict[str, NDArray[Any]], switches: TriangleSwitches, call: _Call
) -> tuple[dict[str, NDArray[Any]], int]: ...
@overload
def triangulate_arrays(
    tri: Mapping[str, Any], switches: TriangleSwitches, call: _Call
) -> Optional[tuple[dict[str, NDArray[Any]], int]]: ...
