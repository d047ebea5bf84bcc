"""The examples of the package `triangle`, on `breakline.triangle`. Run by hand:

    python python/tests/others/triangle_examples.py

Nothing is fetched: the graphs are the files in the installed package, and the switches are those of its documentation.
Wherever both give a result, the results are compared; what is refused, and what differs, is listed with the reason.
Exit code 1 if anything else differs.

Without refinement, triangles are the same, unless corners are cocircular: then their number and area are the same, and
the smallest angle. With it, the bounds that were asked for hold, and the number of triangles is at
most half as many again.
"""

from __future__ import annotations

import importlib.metadata
import re
import sys
import warnings
from typing import Any

import numpy as np
import triangle as theirs

from breakline import FormatError, UnsupportedError
from breakline import triangle as ours

#: Graphs of the package, and the switches that its documentation uses with them, or that fit.
EXAMPLES = {
    "A": ["", "p", "pc", "pq30", "pq0", "pqa0.01", "pqa", "pqD", "pen", "v"],
    "bbox.1": ["rpa"],
    "box": ["", "p", "pc", "pq", "pqa0.2", "penA"],
    "box.2": ["rpa0.2"],
    "diamond_02_00009": ["", "e", "q", "qa0.5", "D"],
    "dots": ["", "c", "en", "qa0.1"],
    "double_hex": ["p", "pq", "pq30", "pqs"],
    "double_hex2": ["p", "pq", "pqY"],
    "double_hex3": ["p", "pq"],
    "ell": ["", "r"],
    "face": ["", "p", "pq", "pq0", "pq30", "pqa0.3", "pqD"],
    "greenland": ["", "e"],
    "la": ["", "pc", "pq", "pqa"],
    "spiral": ["", "q", "qa0.2", "c", "e", "n"],
    "square_circle_hole": ["p", "pq", "pqS10"],
}

#: What is not offered, by switches, and what differs, by graph and switches; patterns, with the reasons.
NOT_OFFERED = {
    "r": "an earlier mesh cannot be refined",
    "D": "meshes are constrained Delaunay",
    "s": "segments are never split merely to recover them",
    "Y": "no rule forbids vertices on the boundary",
}
DIFFERS = {
    r"box (p|pq|pqa0.2|penA)": "nothing encloses the holes: an error here, a dict without triangles there",
    r"la pqa?": "segments meet at 4 to 14 degrees, where neither reaches 20: 5 more of these here, 10 fewer in all",
}


def corners(mesh: dict[str, Any]) -> np.ndarray:
    return np.asarray(mesh["vertices"])[mesh["triangles"]]


def areas(mesh: dict[str, Any]) -> np.ndarray:
    u, v = (corners(mesh)[:, k] - corners(mesh)[:, 0] for k in (1, 2))
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def angles(mesh: dict[str, Any]) -> np.ndarray:
    """Return the smallest angle of each triangle, in degrees."""
    at = corners(mesh)
    smallest = np.full(len(at), 180.0)
    for k in range(3):
        u, v = at[:, (k + 1) % 3] - at[:, k], at[:, (k + 2) % 3] - at[:, k]
        sine, cosine = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1)
        smallest = np.minimum(smallest, np.degrees(np.arctan2(sine, cosine)))
    return smallest


def sets_of(rows: np.ndarray) -> set[frozenset[int]]:
    return {frozenset(row) for row in np.asarray(rows).tolist()}


def flaw_of_same(mine: dict[str, Any], other: dict[str, Any]) -> str:
    """Return what differs in a mesh without added vertices."""
    if not np.array_equal(mine["vertices"], other["vertices"]):
        return "vertices"
    for name in ("vertex_markers", "neighbors", "segments", "edges", "triangle_attributes"):
        if (name in mine) != (name in other) or np.shape(mine.get(name)) != np.shape(other.get(name)):
            return f"{name}: {np.shape(mine.get(name))}, not {np.shape(other.get(name))}"
    if sets_of(mine["triangles"]) == sets_of(other["triangles"]):
        return ""
    if len(mine["triangles"]) != len(other["triangles"]) or not np.isclose(areas(mine).sum(), areas(other).sum()):
        return f"{len(mine['triangles'])} triangles of area {areas(mine).sum()}, not {areas(other).sum()}"
    # A tie: of all triangulations, the smallest angle of a Delaunay triangulation is the largest.
    smallest = [np.sort(angles(mesh)) for mesh in (mine, other)]
    return "" if smallest[0][0] >= smallest[1][0] - 1e-9 else f"the smallest angle is {smallest[0][0]}"


def flaw_of_refined(mine: dict[str, Any], other: dict[str, Any], switches: str) -> str:
    """Return what differs in a mesh with added vertices."""
    if not np.isclose(areas(mine).sum(), areas(other).sum(), rtol=1e-9):
        return f"the area is {areas(mine).sum()}, not {areas(other).sum()}"
    found = re.search(r"q([\d.]+)?", switches)
    if found and "S" not in switches:
        least = float(found[1] or 20)
        small = [(angles(mesh) < least - 1e-6).sum() for mesh in (mine, other)]
        if small[0] > small[1]:
            return f"{small[0]} triangles with an angle below {least}, not {small[1]}"
    found = re.search(r"a([\d.]+)", switches)
    if found and areas(mine).max() > float(found[1]) * (1 + 1e-9):
        return f"an area of {areas(mine).max()}"
    counts = [len(mesh["triangles"]) for mesh in (mine, other)]
    return "" if 2 * counts[0] <= 3 * counts[1] + 20 else f"{counts[0]} triangles, not {counts[1]}"


def compared(name: str, switches: str) -> str:
    """Return what differs."""
    graph = theirs.get_data(name)
    other = theirs.triangulate(graph, switches)
    try:
        mine = ours.triangulate(graph, switches)
    except UnsupportedError as error:
        reasons = [reason for switch, reason in NOT_OFFERED.items() if switch in switches]
        return f"not offered: {reasons[0]}" if reasons else f"FAILED: {error}"
    except FormatError as error:
        if "triangles" in other:
            return f"FAILED: {error}"
        flaw = str(error.message)
    else:
        is_refined = "q" in switches or "a" in switches
        flaw = flaw_of_refined(mine, other, switches) if is_refined else flaw_of_same(mine, other)
        if not flaw:
            return f"passes: {len(mine['triangles'])} triangles, {len(other['triangles'])} in the package"
    known = [reason for pattern, reason in DIFFERS.items() if re.fullmatch(pattern, f"{name} {switches}")]
    return f"differs: {known[0]} ({flaw})" if known else f"FAILED: {flaw}"


def main() -> int:
    warnings.simplefilter("ignore")
    print(f"triangle {importlib.metadata.version('triangle')}, breakline {importlib.metadata.version('breakline')}")
    outcomes = []
    for name, all_switches in EXAMPLES.items():
        for switches in all_switches:
            try:
                outcome = compared(name, switches)
            except Exception as error:  # whatever either raises
                outcome = f"FAILED: {type(error).__name__}: {error}"
            outcomes.append(outcome.split(":")[0])
            print(f"{name:20} {switches or '-':8} {outcome}")
    for kind in ("passes", "not offered", "differs", "FAILED"):
        print(f"{kind}: {outcomes.count(kind)}")
    return min(outcomes.count("FAILED"), 1)


if __name__ == "__main__":
    sys.exit(main())
