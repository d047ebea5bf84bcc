//! What rows of the table of formats have in common: rows of which they override a few fields.

use super::format::{
    Content, Format, FormatReader, Holding, KnownBy, Magic, NOT_WRITTEN, PointWriter, Sink,
    WriteContours, WriteLines, WriteSurface, Writers,
};
use crate::data::PointInfo;
use crate::error::{Command, Feature, Wording, wording};
use crate::io::bytes::output::Destination;
use crate::io::codec::las::{Detail, Rounding};
use crate::io::codec::{gpkg, las, tetgen, text, triangle};

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

pub(super) const LIDAR: FormatReader = FormatReader::Points {
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

pub(super) const fn lidar_writer(
    create: for<'a> fn(Destination<'a>, &[&PointInfo], Rounding) -> Sink<'a>,
) -> Writers {
    Writers {
        points: Some(PointWriter {
            detail: Detail::Records,
            create,
        }),
        ..NOT_WRITTEN
    }
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

pub(super) const fn raster(
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
        content: Content::Raster,
        holds: &[Holding::Raster],
        cure: AS_RASTER,
        ..ROW
    }
}

pub(super) const fn vector(
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
        content: Content::Layer,
        holds: SHAPES,
        ..ROW
    }
}

pub(super) const fn mesh(
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
        content: Content::Mesh,
        holds: SURFACE,
        cure: AS_MESH,
        ..ROW
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
        name,
        noun,
        extensions,
        content: Content::Plane,
        reader: FormatReader::Own,
        writers: Writers {
            plane: Some(triangle::write),
            ..NOT_WRITTEN
        },
        cure: AS_PLANE,
        help,
        ..ROW
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
        name,
        noun,
        extensions,
        reader: FormatReader::Unread,
        writers: Writers {
            space: Some(tetgen::write),
            ..NOT_WRITTEN
        },
        cure: AS_SPACE,
        ..ROW
    }
}
