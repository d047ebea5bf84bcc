"""Drop-ins for `scipy.spatial` and the scattered-data interpolators of `scipy.interpolate`, in 2D and 3D.

===============================  ==========================================
`Delaunay`                       `scipy.spatial.Delaunay`
`Voronoi`                        `scipy.spatial.Voronoi`
`ConvexHull`                     `scipy.spatial.ConvexHull`
`LinearNDInterpolator`           `scipy.interpolate.LinearNDInterpolator`
`CloughTocher2DInterpolator`     `scipy.interpolate.CloughTocher2DInterpolator`
`NearestNDInterpolator`          `scipy.interpolate.NearestNDInterpolator`
`NaturalNeighborInterpolator`    no counterpart: Sibson's interpolation
`tsearch`                        `scipy.spatial.tsearch`
===============================  ==========================================

Signatures, attributes, shapes and dtypes are those of scipy; ``threads`` is added. All decisions are
exact, so that no input is too degenerate to be triangulated. What differs is listed in
``docs/python-drop-ins.md``. What is absent raises, with the reason.
"""

from __future__ import annotations

from typing import NoReturn

from ._common import ClosedError, QhullError
from ._delaunay import Delaunay, tsearch
from ._hull import ConvexHull
from ._interpolators import (
    CloughTocher2DInterpolator,
    GradientEstimationWarning,
    LinearNDInterpolator,
    NaturalNeighborInterpolator,
    NearestNDInterpolator,
)
from ._voronoi import Voronoi

__all__ = [
    "ClosedError",
    "CloughTocher2DInterpolator",
    "ConvexHull",
    "Delaunay",
    "GradientEstimationWarning",
    "LinearNDInterpolator",
    "NaturalNeighborInterpolator",
    "NearestNDInterpolator",
    "QhullError",
    "Voronoi",
    "tsearch",
]

#: What `scipy.spatial` has and this package has not, with the reason.
_ABSENT = {
    "HalfspaceIntersection": "it is no triangulation: use scipy",
    "KDTree": "use NearestNDInterpolator for the nearest point, or scipy",
    "SphericalVoronoi": "it is no triangulation: use scipy",
    "cKDTree": "use NearestNDInterpolator for the nearest point, or scipy",
}


def __getattr__(name: str) -> NoReturn:
    if name in _ABSENT:
        raise AttributeError(f"breakline.spatial has no {name}: {_ABSENT[name]}")
    raise AttributeError(f"module 'breakline.spatial' has no attribute {name!r}")
