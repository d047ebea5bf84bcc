"""Names that parameters take, for type checkers."""

from __future__ import annotations

from typing import Literal, Union

#: How heights between vertices are computed.
Method = Literal["linear", "nearest", "natural", "laplace", "smooth", "idw"]
#: Which of several heights is used.
Height = Literal["lowest", "highest", "mean", "first", "last"]
#: Which height is used where breaklines cross.
CrossingHeight = Literal["lowest", "highest", "mean", "first", "last", "error"]
#: What is done with lines that cross between their vertices.
OnCrossing = Literal["split", "reject"]
#: A side of a line.
Side = Literal["left", "right"]
#: A longest edge.
EdgeLimit = Union[float, Literal["auto", "none"], None]
#: Arithmetic of predicates.
Kernel = Literal["adaptive", "exact", "fast"]
#: A verb that writes files.
Verb = Literal[
    "dem", "hillshade", "color_relief", "slope", "aspect", "curvature", "roughness", "tri", "tpi", "contour", "tin"
]  # fmt: skip

#: How shades follow from slopes.
Shading = Literal["standard", "combined", "multidirectional", "igor"]
#: Rules for contours of maps that belong together.
Preset = Literal["cartographic"]
#: Where the tops of labels are.
Labels = Literal["readable", "uphill"]
#: The colors of heights between those of a ramp.
Match = Literal["linear", "nearest", "exact"]
#: From which cells a gradient is computed.
Gradient = Literal["horn", "zevenbergen-thorne", "faces"]
#: Smaller images of a raster in its file.
Overviews = Literal["auto", "none"]
#: Whether bridges are ground.
Bridges = Literal["off", "ground"]
#: How much a notice matters.
Severity = Literal["detail", "note", "warning"]
