//! The file formats: how each is recognized, what it can contain, and which functions read and
//! write it.
//!
//! [`FORMATS`] is the only table of formats. The readers that accept any format, the verbs' lists
//! of outputs, the help of the program and the table in `docs/formats.md` are derived from it. To
//! add a format, add a row to `table.rs` and a file or folder in `codec`; see
//! `docs/how-to-add-a-format.md`.

mod format;
mod rows;
mod table;

use std::fmt::Write;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use self::format::KnownBy;
pub use self::format::{Content, Format, Holding, Product};
pub(crate) use self::format::{FormatReader, PointWriter, WriteHeights, Writers};
pub(crate) use self::rows::with_gdal;
pub use self::table::FORMATS;
use crate::error::{Error, Result};
use crate::io::bytes::appended::appended;

/// Returns the format for writing a product, by the extension of the target.
pub fn for_output(path: &Path, product: Product) -> Option<&'static Format> {
    FORMATS
        .iter()
        .find(|format| format.writes(product) && format.has_extension(path))
}

/// Number of bytes that suffice to recognize a file.
pub(crate) const HEAD: usize = 1024;

/// Returns the format that a file's extension names, whether it can be read or not. Formats that
/// share their extension with another are not returned.
pub fn of_name(path: &Path) -> Option<&'static Format> {
    FORMATS.iter().find(|format| {
        !matches!(format.known_by, KnownBy::Rest | KnownBy::NameAndBytes)
            && format.has_extension(path)
    })
}

/// Returns the format that a file is to be read as, by its first bytes (1024 are enough) and its
/// name.
///
/// Returns `None` for a binary file whose first bytes are unknown, and for a format whose first
/// bytes only serve to name it.
pub fn detect(head: &[u8], path: &Path) -> Option<&'static Format> {
    let find = |rule: KnownBy, matches: &dyn Fn(&Format) -> bool| {
        FORMATS
            .iter()
            .find(|format| format.known_by == rule && matches(format))
    };
    find(KnownBy::Bytes, &|format| format.begins_like(head))
        .or_else(|| {
            find(KnownBy::NameAndBytes, &|format| {
                format.has_extension(path) && format.begins_like(head)
            })
        })
        .or_else(|| of_name(path))
        .or_else(|| find(KnownBy::Name, &|format| format.begins_like(head)))
        .or_else(|| {
            find(KnownBy::Rest, &|_| {
                !is_binary(head) && of_bytes(head).is_none()
            })
        })
}

/// Like [`detect`], but opens the file. Input that cannot be read twice (a pipe) is not opened, and
/// recognized by its name only.
///
/// # Errors
/// If the file does not exist or cannot be opened.
pub fn detect_file(path: &Path) -> Result<Option<&'static Format>> {
    let read = || -> std::io::Result<Vec<u8>> {
        let mut head = Vec::new();
        // Opening a pipe takes its writer, who would not write again.
        if std::fs::metadata(path)?.is_file() {
            File::open(path)?.take(HEAD as u64).read_to_end(&mut head)?;
        }
        Ok(head)
    };
    let head = read().map_err(|error| Error::from(error).in_file(path))?;
    Ok(detect(&head, path))
}

/// Returns the format that matches the first bytes, even if they alone do not decide.
pub(crate) fn of_bytes(head: &[u8]) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.begins_like(head))
}

/// Returns the format that the first bytes or the name suggest, for use in a message.
pub(crate) fn named(head: &[u8], path: &Path) -> Option<&'static Format> {
    of_bytes(head).or_else(|| of_name(path))
}

/// Returns the format of the layer that a file is only part of, and the extension that shows it,
/// such as `.dbf`.
pub(crate) fn format_of_part(path: &Path) -> Option<(&'static Format, &'static str)> {
    let extension = path.extension()?;
    FORMATS
        .iter()
        .filter(|format| matches!(format.reader, FormatReader::Layer(_)))
        .find_map(|format| {
            let part = format
                .parts
                .iter()
                .find(|part| extension.eq_ignore_ascii_case(part))?;
            Some((format, *part))
        })
}

/// Returns true if the bytes are not text. UTF-16 contains zeros too; the text reader refuses it by
/// name.
fn is_binary(head: &[u8]) -> bool {
    let is_utf16 = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    head.contains(&0) && !is_utf16
}

/// Returns the extensions in which a product can be written.
pub fn extensions(product: Product) -> Vec<&'static str> {
    FORMATS
        .iter()
        .filter(|format| format.writes(product))
        .flat_map(|format| format.extensions)
        .copied()
        .collect()
}

/// Returns the extensions in which a product can be written, for a sentence: ".shp, .geojson or
/// .json".
pub(crate) fn extensions_or(product: Product) -> String {
    let all: Vec<String> = extensions(product)
        .iter()
        .map(|extension| format!(".{extension}"))
        .collect();
    match &all[..] {
        [most @ .., last] if !most.is_empty() => format!("{} or {last}", most.join(", ")),
        _ => all.join(", "),
    }
}

impl Holding {
    const fn name(self) -> &'static str {
        match self {
            Holding::Points => "points",
            Holding::Lines => "lines",
            Holding::Polygons => "polygons",
            Holding::Raster => "cells",
            Holding::Mesh => "triangles",
            Holding::Attributes => "attributes",
            Holding::Edges => "edges on breaklines",
            Holding::Crs => "coordinate system",
            Holding::Compression => "compressed",
        }
    }
}

impl Product {
    const ALL: [Product; 9] = [
        Product::Points,
        Product::Surface,
        Product::Contours,
        Product::Lines,
        Product::Heights,
        Product::Shades,
        Product::Colors,
        Product::Plane,
        Product::Space,
    ];

    const fn name(self) -> &'static str {
        match self {
            Product::Points => "points",
            Product::Surface => "surface",
            Product::Contours => "contours",
            Product::Lines => "lines",
            Product::Heights => "heights",
            Product::Shades => "hillshade",
            Product::Colors => "color relief",
            Product::Plane => "triangulation",
            Product::Space => "triangulation in space",
        }
    }
}

impl FormatReader {
    const fn name(self) -> &'static str {
        match self {
            FormatReader::Points { .. } => "points",
            FormatReader::Layer(_) | FormatReader::Layers(_) => "lines, polygons, points",
            FormatReader::Raster(_) | FormatReader::Grid(_) => "heights",
            FormatReader::Mesh(_)
            | FormatReader::Surfaces(_)
            | FormatReader::Tin(_)
            | FormatReader::Parts(_) => "surface",
            FormatReader::Own => "points and segments",
            FormatReader::Solid(_) | FormatReader::InfoOnly => "by `info` only",
            FormatReader::Gdal => "with `gdal`",
            FormatReader::Unread => "",
        }
    }
}

/// Returns the formats that this crate reads or writes, one per line, for the help of the program.
pub fn help() -> String {
    let mut text = String::from(
        "Formats, by extension (more are read and written with the feature `gdal`):\n",
    );
    for format in FORMATS.iter().filter(|format| format.is_read()) {
        let extensions: Vec<String> = format
            .extensions
            .iter()
            .map(|extension| format!(".{extension}"))
            .collect();
        // Writing to a string does not fail.
        let _ = writeln!(text, "  {:<28} {}", extensions.join(" "), format.help);
    }
    text
}

/// Returns the table of formats in `docs/formats.md`, in Markdown.
pub fn markdown() -> String {
    let mut text = String::from(
        "| format | extensions | read | written | can hold |\n|---|---|---|---|---|\n",
    );
    for format in FORMATS
        .iter()
        .filter(|format| !format.extensions.is_empty())
    {
        let extensions: Vec<String> = format
            .extensions
            .iter()
            .map(|extension| format!("`.{extension}`"))
            .collect();
        let by_gdal = matches!(format.reader, FormatReader::Gdal) && !format.gdal_names.is_empty();
        let written: Vec<_> = Product::ALL
            .into_iter()
            .filter(|&product| format.writes(product))
            .map(Product::name)
            .chain(by_gdal.then_some(format.reader.name()))
            .collect();
        let holds: Vec<_> = format.holds.iter().map(|holding| holding.name()).collect();
        let cells = [
            format.name,
            &extensions.join(", "),
            format.reader.name(),
            &written.join(", "),
            &holds.join(", "),
        ];
        let _ = writeln!(text, "| {} |", cells.join(" | ").replace("|  |", "| |"));
    }
    text
}

/// Returns the paths at which files are read along with a file, if they exist: `roads.dbf` with
/// `roads.shp`. The case of their extensions may differ.
pub fn read_along_with(path: &Path) -> Vec<PathBuf> {
    let format = of_name(path).or_else(|| detect_file(path).ok().flatten());
    let Some(Format {
        extensions: [extension, ..],
        read_along,
        ..
    }) = format
    else {
        return Vec::new();
    };
    let files = with_companions(path, extension, read_along);
    files.into_iter().skip(1).map(|(path, _)| path).collect()
}

/// Returns the files that are there of those that are [read along](read_along_with) with a file.
pub fn found_along_with(path: &Path) -> Vec<PathBuf> {
    let wanted = read_along_with(path);
    if wanted.iter().all(|path| path.exists()) {
        return wanted;
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let is_wanted = |found: &PathBuf| {
        let mut names = wanted.iter().filter_map(|path| path.file_name());
        names.any(|name| {
            found
                .file_name()
                .is_some_and(|own| own.eq_ignore_ascii_case(name))
        })
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(is_wanted)
        .collect();
    found.sort_unstable();
    found
}

/// Returns a file and its companions, each with the extension of its format. `companions` are
/// those of [`Format::beside`].
pub fn with_companions(
    path: &Path,
    extension: &'static str,
    companions: &'static [&'static str],
) -> Vec<(PathBuf, &'static str)> {
    let beside = companions.iter().map(|&companion| {
        let path = match companion.strip_prefix(extension) {
            // Appended to the whole name, whatever its case: `A.PNG.aux.xml`.
            Some(behind) => appended(path, behind),
            None => path.with_extension(companion),
        };
        (path, companion)
    });
    std::iter::once((path.to_path_buf(), extension))
        .chain(beside)
        .collect()
}
