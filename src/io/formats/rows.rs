//! What rows of the table of formats have in common: rows of which they override a few fields.

use super::format::{
    Content, Format, FormatReader, Holding, KnownBy, Magic, NOT_WRITTEN, PointWriter, Sink,
    WriteContours, WriteLines, WriteSurface, Writers,
};
use crate::data::PointInfo;
use crate::error::{Command, Feature, Wording, wording};
use crate::io::bytes::output::Destination;
use crate::io::codec::las::{Detail, Packing, Rounding};
use crate::io::codec::{gpkg, las, tetgen, text, triangle};

const LIDAR_POINTS: &[Holding] = &[Holding::Points, Holding::Attributes, Holding::Crs];
pub(super) const PACKED_LIDAR_POINTS: &[Holding] = &[
    Holding::Points,
    Holding::Attributes,
    Holding::Crs,
    Holding::Compression,
];
pub(super) const SHAPES: &[Holding] = &[Holding::Points, Holding::Lines, Holding::Polygons];
pub(super) const SHAPES_AND_CRS: &[Holding] = &[
    Holding::Points,
    Holding::Lines,
    Holding::Polygons,
    Holding::Crs,
];
pub(super) const SURFACE: &[Holding] = &[Holding::Mesh, Holding::Crs];
pub(super) const SURFACE_AND_LINES: &[Holding] = &[Holding::Mesh, Holding::Edges, Holding::Crs];

pub(crate) fn with_gdal() -> Wording {
    wording!["to read it, build with ", Feature::Gdal]
}

pub(super) const AS_RASTER: fn() -> Wording =
    || "this is a raster: points are expected here".into();
pub(super) const AS_PLANE: fn() -> Wording = || {
    wording![
        Command::Triangulate,
        " reads it and writes its triangulation, to .ele, .ply or .obj"
    ]
};
pub(super) const AS_SPACE: fn() -> Wording =
    || wording!["it is written only, by ", Command::TriangulateInSpace];
pub(super) const AS_MESH: fn() -> Wording = || "save its vertices as text or LAS".into();
pub(super) const UNPACK: fn() -> Wording = || "unpack it".into();

/// A format that only GDAL may read; rows of the table override what differs.
pub(super) const ROW: Format = Format {
    name: "",
    noun: "",
    extensions: &[],
    magic: &[],
    known_by: KnownBy::NameAlone,
    content: Content::Points,
    holds: &[],
    beside: &[],
    parts: &[],
    read_along: &[],
    gdal_names: &[],
    as_written: &[],
    reader: FormatReader::Gdal,
    writers: NOT_WRITTEN,
    cure: with_gdal,
    help: "",
};

const LIDAR: FormatReader = FormatReader::Points {
    file: |path, options| Ok(Box::new(las::open_with(path, options.las())?)),
    stream: |stream, name, options| {
        Ok(Box::new(las::from_stream_with(
            stream,
            name,
            options.las(),
        )?))
    },
};

pub(super) const TEXT: FormatReader = FormatReader::Points {
    file: |path, options| Ok(Box::new(text::open(path, options)?)),
    stream: |stream, name, options| Ok(Box::new(text::from_stream(stream, name, options)?)),
};

/// GeoPackage is left to GDAL by a build that does not read it itself.
pub(super) const DATABASE: FormatReader = match gpkg::IS_AVAILABLE {
    true => FormatReader::Layers(gpkg::read_layer_with),
    false => FormatReader::Gdal,
};

/// Creates a writer of lidar points.
///
/// # Errors
/// Those of [`las::create`].
pub(super) fn lidar_sink<'a>(
    target: Destination<'a>,
    sources: &[&PointInfo],
    rounding: Rounding,
    packing: Packing,
) -> Sink<'a> {
    Ok(Box::new(las::create(target, sources, packing, rounding)?))
}

pub(super) const fn layer_writers(contours: WriteContours, lines: WriteLines) -> Writers {
    Writers {
        contours: Some(contours),
        lines: Some(lines),
        ..NOT_WRITTEN
    }
}

pub(super) const fn surface_writer(write: WriteSurface) -> Writers {
    Writers {
        surface: Some(write),
        ..NOT_WRITTEN
    }
}

/// Returns a row with names and first bytes.
const fn named(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    magic: &'static [Magic],
) -> Format {
    Format {
        name,
        noun,
        extensions,
        magic,
        ..ROW
    }
}

/// Returns the row for uncompressed lidar points, whose writer `create` makes.
pub(super) const fn lidar(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    create: for<'a> fn(Destination<'a>, &[&PointInfo], Rounding) -> Sink<'a>,
) -> Format {
    Format {
        known_by: KnownBy::Bytes,
        holds: LIDAR_POINTS,
        reader: LIDAR,
        writers: Writers {
            points: Some(PointWriter {
                detail: Detail::Records,
                create,
            }),
            ..NOT_WRITTEN
        },
        ..named(name, noun, extensions, &[Magic::At(0, b"LASF")])
    }
}

pub(super) const fn raster(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    magic: &'static [Magic],
) -> Format {
    Format {
        content: Content::Raster,
        holds: &[Holding::Raster],
        cure: AS_RASTER,
        ..named(name, noun, extensions, magic)
    }
}

pub(super) const fn vector(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    magic: &'static [Magic],
) -> Format {
    Format {
        content: Content::Layer,
        holds: SHAPES,
        ..named(name, noun, extensions, magic)
    }
}

pub(super) const fn mesh(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    magic: &'static [Magic],
) -> Format {
    Format {
        content: Content::Mesh,
        holds: SURFACE,
        cure: AS_MESH,
        ..named(name, noun, extensions, magic)
    }
}

/// Returns the row for one of Triangle's files.
pub(super) const fn plane(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    help: &'static str,
) -> Format {
    Format {
        content: Content::Plane,
        reader: FormatReader::Own,
        writers: Writers {
            plane: Some(triangle::write),
            ..NOT_WRITTEN
        },
        cure: AS_PLANE,
        help,
        ..named(name, noun, extensions, &[])
    }
}

/// The writers of the formats that Triangle and TetGen share.
pub(super) const PLANE_OR_SPACE: Writers = Writers {
    plane: Some(triangle::write),
    space: Some(tetgen::write),
    ..NOT_WRITTEN
};

/// Returns the row for a file of a triangulation in space.
pub(super) const fn space(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
) -> Format {
    Format {
        reader: FormatReader::Unread,
        writers: Writers {
            space: Some(tetgen::write),
            ..NOT_WRITTEN
        },
        cure: AS_SPACE,
        ..named(name, noun, extensions, &[])
    }
}
