"""Lidar and breaklines to TIN, DEM, contours and meshes."""

from ._breakline import __version__

__all__ = ["__version__"]
