"""Names of vector layers."""

import os
from typing import Optional, Union


def layer(
    path: "Union[str, os.PathLike[str]]",
    name: Optional[str] = None,
    *,
    field: Optional[str] = None,
    where: Optional[str] = None,
) -> str:
    """Return the name of a layer in a file, for any argument that takes lines or areas.

    Parameters
    ----------
    path
        A vector file of any format.
    name
        The layer; by default the only one.
    field
        The attribute that contains the heights; by default they come from the geometry.
    where
        Which records are read, such as ``"kind = 'toe' AND height > 2.5"``: comparisons of attributes, ``IN``,
        ``BETWEEN``, ``LIKE``, ``IS NULL``, ``AND``, ``OR`` and ``NOT`` as in SQL.

    Examples
    --------
    >>> layer("edges.gpkg", "lines", where="kind = 'toe'")
    "edges.gpkg:lines where kind = 'toe'"
    >>> layer("lakes.shp", field="LEVEL")
    'lakes.shp::LEVEL'
    """
    text = os.fspath(path)
    if name is not None or field is not None:
        text += f":{name or ''}"
    if field is not None:
        text += f":{field}"
    return text if where is None else f"{text} where {where}"
