//! The formats that a run may write: ours, and those of GDAL's drivers.

use std::borrow::Cow;
use std::path::Path;

use crate::error::{Error, Result, Setting, wording};
use crate::io::formats::{self, Product};
use crate::io::gdal::{self, DriverContent};
#[cfg(feature = "cli")]
use crate::io::profiles;
use crate::io::{self, DriverOptions};

/// The format of tables.
pub(crate) const TABLES: &[Format<()>] = &[Format::named("csv", &[])];

/// The formats of profiles, see [`profiles`](crate::io::profiles).
#[cfg(feature = "cli")]
pub(crate) const PROFILES: &[Format<()>] = &[of_profiles(0), of_profiles(1), of_profiles(2)];

#[cfg(feature = "cli")]
const fn of_profiles(number: usize) -> Format<()> {
    Format::named(profiles::EXTENSIONS[number], &[])
}

/// A file format that a verb can write.
#[derive(Debug, Clone)]
pub(crate) struct Format<F: 'static> {
    pub(crate) extension: &'static str,
    pub(crate) kind: F,
    /// Extensions of the files that are written with it.
    pub(crate) companions: &'static [&'static str],
    /// GDAL's names for it.
    pub(crate) gdal_names: &'static [&'static str],
    /// Creation options of GDAL that say what is written anyway.
    pub(crate) as_written: &'static [&'static str],
}

impl Format<()> {
    /// A format that GDAL does not write instead, with the extensions of files beside it.
    pub(crate) const fn named(
        extension: &'static str,
        companions: &'static [&'static str],
    ) -> Self {
        Format {
            extension,
            kind: (),
            companions,
            gdal_names: &[],
            as_written: &[],
        }
    }
}

/// The formats that a run may write.
pub(crate) struct Formats<'a, F: Clone + 'static> {
    /// Those of this crate.
    pub(crate) all: Cow<'a, [Format<F>]>,
    /// The driver of GDAL that was asked for.
    pub(crate) driver: Option<&'a DriverOptions>,
    /// What drivers of GDAL may write, and its kind.
    pub(crate) of_gdal: Option<(DriverContent, F)>,
}

impl<'a, F: Clone> From<&'a [Format<F>]> for Formats<'a, F> {
    /// Only formats of this crate.
    fn from(all: &'a [Format<F>]) -> Self {
        Formats {
            all: Cow::Borrowed(all),
            driver: None,
            of_gdal: None,
        }
    }
}

impl<'a> Formats<'a, ()> {
    /// Returns the formats of a product: those of this crate, and those of GDAL's drivers if they
    /// write such data.
    pub(crate) fn of_product(product: Product, driver: &'a DriverOptions) -> Self {
        Formats {
            all: formats_of(product, |_| ()).into(),
            driver: Some(driver),
            of_gdal: gdal_content(product).map(|content| (content, ())),
        }
    }
}

impl<F: Copy> Formats<'_, F> {
    /// Returns the format of an output, and the driver that writes it unless this crate does.
    ///
    /// # Errors
    /// If there is none, or an option of the driver is not known.
    pub(super) fn choose(&self, path: &Path) -> Result<(Format<F>, Option<DriverOptions>)> {
        let usual = DriverOptions::default();
        let options = self.driver.unwrap_or(&usual);
        self.require_table_or_file(path)?;
        let own = match &options.name {
            _ if gdal::is_name(path) => None,
            Some(name) => self.own(name, path)?,
            None => find(path, &self.all).ok(),
        };
        if let Some(format) = own {
            require_as_written(format, options).map_err(|error| error.in_file(path))?;
            return Ok((format.clone(), None));
        }
        let by_gdal = match self.of_gdal {
            Some((content, kind)) => gdal::find_driver(options, path, content)
                .map_err(|error| error.in_file(path))?
                .map(|name| (name, kind)),
            None => None,
        };
        let Some((name, kind)) = by_gdal else {
            return find(path, &self.all).map(|format| (format.clone(), None));
        };
        let format = Format {
            extension: "",
            kind,
            companions: &[],
            gdal_names: &[],
            as_written: &[],
        };
        let driver = DriverOptions {
            name: Some(name),
            ..options.clone()
        };
        Ok((format, Some(driver)))
    }

    /// Returns an error for a name that only GDAL can open, unless it is that of a database, and
    /// there are shapes for it.
    fn require_table_or_file(&self, path: &Path) -> Result<()> {
        let has_shapes = matches!(self.of_gdal, Some((DriverContent::Shapes, _)));
        let is_table = || has_shapes && gdal::is_connection(path);
        match gdal::is_name(path) && !is_table() {
            true => Err(
                Error::usage("outputs are files, or for lines also tables of databases")
                    .in_file(path)
                    .cure("write it to a file, and copy that"),
            ),
            false => Ok(()),
        }
    }

    /// Returns the format of this crate that GDAL has under a name, if there is one.
    ///
    /// # Errors
    /// If the extension of the output is that of another one.
    fn own(&self, name: &str, path: &Path) -> Result<Option<&Format<F>>> {
        let is_named = |format: &&Format<F>| {
            format
                .gdal_names
                .iter()
                .any(|known| known.eq_ignore_ascii_case(name))
        };
        let mut named = self.all.iter().filter(is_named).peekable();
        let Some(&first) = named.peek() else {
            return Ok(None);
        };
        let by_path = find(path, &self.all).ok();
        match by_path {
            Some(other) if !is_named(&other) => Err(Error::usage(wording![
                Setting::Driver.text(name),
                format!(
                    ": the extension of the output is that of another format, .{}",
                    other.extension
                )
            ])
            .in_file(path)
            .cure(wording![
                "leave out ",
                Setting::Driver,
                format!(", or give the output the extension .{}", first.extension)
            ])),
            Some(format) => Ok(Some(format)),
            None => Ok(Some(first)),
        }
    }
}

/// Returns an error unless creation options describe what this crate writes anyway.
fn require_as_written<F>(format: &Format<F>, options: &DriverOptions) -> Result<()> {
    let is_written = |option: &&String| {
        format
            .as_written
            .iter()
            .any(|known| known.eq_ignore_ascii_case(option))
    };
    let refused = options.creation.iter().find(|option| !is_written(option));
    let refused = refused.map(|option| Setting::CreationOptions.text(option.as_str()));
    let of_layer = options.layer.first();
    let of_layer = of_layer.map(|option| Setting::LayerOptions.text(option.as_str()));
    let Some(option) = refused.or(of_layer) else {
        return Ok(());
    };
    let error = wording![
        option,
        ": this format is not written by GDAL, and has no such options"
    ];
    Err(Error::usage(error).cure(match format.as_written {
        [] => "leave it out; `ogr2ogr` and `gdal_translate` convert the file".into(),
        _ => wording![
            "leave it out: a GeoTIFF is tiled, with overviews (unless ",
            Setting::Overviews.text("none"),
            "), DEFLATE with predictor 3, BigTIFF if necessary; `gdal_translate -co` converts it"
        ],
    }))
}

/// Returns what drivers of GDAL write of a product; `None` if they write nothing of it.
fn gdal_content(product: Product) -> Option<DriverContent> {
    match product {
        Product::Heights => Some(DriverContent::Heights),
        Product::Shades => Some(DriverContent::Shades),
        Product::Colors => Some(DriverContent::Colors),
        Product::Contours | Product::Lines => Some(DriverContent::Shapes),
        Product::Points | Product::Surface | Product::Plane | Product::Space => None,
    }
}

/// Returns the formats that a product can be written in, one for each extension.
pub(crate) fn formats_of<F>(
    product: Product,
    kind: impl Fn(&formats::Format) -> F,
) -> Vec<Format<F>> {
    let formats = formats::FORMATS
        .iter()
        .filter(|format| format.writes(product));
    let by_extension = formats.flat_map(|format| {
        format
            .extensions
            .iter()
            .map(move |extension| (format, extension))
    });
    by_extension
        .map(|(format, extension)| Format {
            extension,
            kind: kind(format),
            companions: format.beside,
            gdal_names: format.gdal_names,
            as_written: format.as_written,
        })
        .collect()
}

/// Returns the format that the extension of an output names.
///
/// # Errors
/// If it names none of them.
pub(super) fn find<'a, F>(path: &Path, formats: &'a [Format<F>]) -> Result<&'a Format<F>> {
    let extension = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or_default();
    let named = |format: &&Format<F>| format.extension.eq_ignore_ascii_case(extension);
    // `/dev/stdout` names no format.
    let is_nameless = extension.is_empty() && io::is_stream(path);
    let default = || {
        formats
            .iter()
            .find(|format| is_nameless && format.companions.is_empty())
    };
    formats.iter().find(named).or_else(default).ok_or_else(|| {
        let known: Vec<String> = formats
            .iter()
            .map(|format| format!(".{}", format.extension))
            .collect();
        let found = match extension {
            "" => "the output has no extension, which would select its format".to_owned(),
            _ => format!("`.{extension}` is not a format that can be written here"),
        };
        Error::usage(found)
            .in_file(path)
            .cure(format!("use one of {}", known.join(", ")))
    })
}
