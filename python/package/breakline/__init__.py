"""Lidar and breaklines to TIN, DEM, contours and meshes: exact, fast, with numpy arrays in and out.

>>> import breakline
>>> tin = breakline.tin([[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3]])
>>> tin.elevation([[5, 5], [20, 20]])
array([ 2., nan])

==================  ==================================================
what                function
==================  ==================================================
points to columns   :func:`read_points`
points to a file    :func:`points`
the ground          :func:`ground`
a surface           :func:`tin`, which returns a :class:`Tin`
a lighter one       :func:`simplify`
heights             :meth:`Tin.elevation`
a raster            :meth:`Tin.dem`, :func:`dem`
contours            :meth:`Tin.contours`, :func:`contour`
a picture           :meth:`Tin.hillshade`, :func:`hillshade`, :func:`color_relief`
slopes              :func:`slope`, :func:`aspect`, :func:`curvature`
ruggedness          :func:`roughness`, :func:`tri`, :func:`tpi`
cut and fill        :func:`volume`
a difference        :func:`compare`
along lines         :func:`profile`, :func:`drape`
web globes          :func:`terrain_tiles`
heights at points   :func:`sample`
accuracy            :func:`accuracy`
flaws               :meth:`Tin.check`, :func:`check`
facts about a file  :func:`info`
coordinate systems  :func:`crs`
a layer of a file   :func:`layer`
Triangle's files    :func:`triangulate`
large data          ``output=`` of a verb, :class:`Job`
==================  ==================================================

Lengths and heights are in the units of the coordinate system. Errors are :class:`BreaklineError`; what looks wrong is
a :class:`BreaklineWarning`.
"""

from ._breakline import __version__
from ._columns import Points
from ._differences import ChangedArea, Comparison, compare
from ._errors import (
    ArgumentTypeError,
    BreaklineError,
    BreaklineWarning,
    CanceledError,
    FileError,
    FileKeptError,
    FileMissingError,
    FormatError,
    InternalError,
    LimitError,
    NotYetError,
    OtherJobError,
    UnsupportedError,
    UsageError,
)
from ._ground import ground
from ._layer import layer
from ._points import points, read_points
from ._profiles import Profile, drape, profile
from ._quantities import aspect, curvature, roughness, slope, tpi, tri
from ._relief import Relief, color_relief
from ._results import Contour, Contours, Raster
from ._runs import run
from ._samples import Accuracy, SetAccuracy, accuracy, sample
from ._terrain import TerrainLevel, terrain_tiles
from ._tin import EDGE_KINDS, Flaw, Notice, Tin, tin
from ._verbs import (
    SpaceTriangulation,
    Triangulation,
    Volume,
    check,
    contour,
    crs,
    dem,
    describe,
    hillshade,
    info,
    simplify,
    triangulate,
    volume,
)
from ._written import Job, Task, Written

__all__ = [
    "EDGE_KINDS",
    "Accuracy",
    "ArgumentTypeError",
    "BreaklineError",
    "BreaklineWarning",
    "CanceledError",
    "ChangedArea",
    "Comparison",
    "Contour",
    "Contours",
    "FileError",
    "FileKeptError",
    "FileMissingError",
    "Flaw",
    "FormatError",
    "InternalError",
    "Job",
    "LimitError",
    "NotYetError",
    "Notice",
    "OtherJobError",
    "Points",
    "Profile",
    "Raster",
    "Relief",
    "SetAccuracy",
    "SpaceTriangulation",
    "Task",
    "TerrainLevel",
    "Tin",
    "Triangulation",
    "UnsupportedError",
    "UsageError",
    "Volume",
    "Written",
    "__version__",
    "accuracy",
    "aspect",
    "check",
    "color_relief",
    "compare",
    "contour",
    "crs",
    "curvature",
    "dem",
    "describe",
    "drape",
    "ground",
    "hillshade",
    "info",
    "layer",
    "points",
    "profile",
    "read_points",
    "roughness",
    "run",
    "sample",
    "simplify",
    "slope",
    "terrain_tiles",
    "tin",
    "tpi",
    "tri",
    "triangulate",
    "volume",
]
