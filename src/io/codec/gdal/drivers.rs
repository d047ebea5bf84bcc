//! The drivers of GDAL that write: found by name or by extension, and what options they have.

use std::path::Path;

use gdal::{Driver, DriverManager, DriverType, Metadata};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use strsim::osa_distance;

use super::{DriverContent, messages};
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::output::DriverOptions;

/// The drivers that are meant if several write an extension.
const PREFERRED: &[&str] = &["netCDF", "LIBKML", "OpenFileGDB"];

/// Drivers whose outputs are missing or useless once the program has ended, and why.
const NOT_KEPT: &[(&str, &str)] = &[
    ("VRT", "refers to another file"),
    ("MEM", "keeps nothing"),
    ("Memory", "keeps nothing"),
    ("WMS", "refers to a service"),
    ("WMTS", "refers to a service"),
];

/// The cure if a driver cannot store a raster.
pub(super) const AS_GEOTIFF: &str = "write a GeoTIFF (.tif)";

/// Returns the name of the driver that writes an output: the one that is named, else the one for
/// the extension or the beginning of the path; `None` if there is none.
///
/// # Errors
/// If no driver has that name, it does not write such data, or several drivers write the
/// extension; if an option is not one of the driver's.
pub fn find_driver(
    options: &DriverOptions,
    path: &Path,
    content: DriverContent,
) -> Result<Option<String>> {
    messages::listen();
    let driver = match &options.name {
        Some(name) => named(name, content)?,
        None => match by_path(path, content)? {
            Some(driver) => driver,
            None => return Ok(None),
        },
    };
    let name = driver.short_name();
    if let Some((_, why)) = NOT_KEPT.iter().find(|(known, _)| *known == name) {
        return Err(Error::usage(format!("what the driver {name} writes {why}"))
            .cure(wording!["choose another one: ", Setting::Driver]));
    }
    let lists = [
        (
            &options.creation,
            "DMD_CREATIONOPTIONLIST",
            Setting::CreationOptions,
        ),
        (
            &options.layer,
            "DS_LAYER_CREATIONOPTIONLIST",
            Setting::LayerOptions,
        ),
    ];
    for (given, list, setting) in lists {
        let known = match setting == Setting::LayerOptions && content != DriverContent::Shapes {
            // A raster has no layer.
            true => Some(Vec::new()),
            false => driver.metadata_item(list, "").map(|xml| listed(&xml)),
        };
        given
            .iter()
            .try_for_each(|option| check(option, known.as_deref(), &name, setting))?;
    }
    Ok(Some(name))
}

/// Returns the driver with this name.
pub(super) fn get(name: &str) -> Result<Driver> {
    DriverManager::get_driver_by_name(name)
        .map_err(|_| Error::unsupported(format!("this GDAL has no driver {name}")))
}

fn named(name: &str, content: DriverContent) -> Result<Driver> {
    let Ok(driver) = DriverManager::get_driver_by_name(name) else {
        let all: Vec<String> = DriverManager::all()
            .filter(|driver| writes(driver, content))
            .map(|driver| driver.short_name())
            .collect();
        let error = Error::usage(wording![
            "GDAL has no driver ",
            name.to_owned(),
            " (",
            Setting::Driver,
            ")"
        ]);
        return Err(error.cure(did_you_mean(name, &all)));
    };
    match writes(&driver, content) {
        true => Ok(driver),
        false => Err(Error::usage(format!(
            "the driver {} of GDAL does not write {}",
            driver.short_name(),
            match content {
                DriverContent::Shapes => "vector layers",
                _ => "rasters",
            }
        ))
        .cure(wording!["choose another one: ", Setting::Driver])),
    }
}

fn by_path(path: &Path, content: DriverContent) -> Result<Option<Driver>> {
    let kind = match content {
        DriverContent::Shapes => DriverType::Vector,
        _ => DriverType::Raster,
    };
    let mut found: Vec<Driver> = DriverManager::get_output_drivers_for_dataset_name(path, kind)
        .filter(|driver| writes(driver, content))
        .collect();
    let name = |driver: &Driver| driver.short_name();
    let preferred = found
        .iter()
        .position(|driver| PREFERRED.contains(&name(driver).as_str()));
    match (found.len(), preferred) {
        (0, _) => Ok(None),
        (1, _) => Ok(found.pop()),
        (_, Some(at)) => Ok(Some(found.swap_remove(at))),
        (_, None) => {
            let names: Vec<String> = found.iter().map(name).collect();
            let error = format!(
                "several drivers of GDAL write such a file: {}",
                names.join(", ")
            );
            Err(Error::usage(error).in_file(path).cure(wording![
                "choose one: ",
                Setting::Driver.text(names[0].clone())
            ]))
        }
    }
}

/// Returns true if a driver creates data sets with such data.
fn writes(driver: &Driver, content: DriverContent) -> bool {
    let can = |capability: &str| can(driver, capability);
    match content {
        DriverContent::Shapes => can("DCAP_VECTOR") && can("DCAP_CREATE"),
        _ => can("DCAP_RASTER") && (can("DCAP_CREATE") || can("DCAP_CREATECOPY")),
    }
}

/// Returns true if a driver states a capability.
fn can(driver: &Driver, capability: &str) -> bool {
    driver.metadata_item(capability, "").as_deref() == Some("YES")
}

/// Returns the type of cells by which a driver stores a raster, in GDAL's words: the first that it
/// has of those that suffice, or of whole numbers for heights.
///
/// # Errors
/// If it states that it has none of them.
pub(super) fn cell_type(driver: &Driver, content: DriverContent) -> Result<&'static str> {
    let (what, wanted): (_, &[&str]) = match content {
        DriverContent::Heights => (
            "heights, which have fractions and may be below zero",
            &["Float32", "Float64", "Int32", "Int16"],
        ),
        DriverContent::Shades => (
            "shades, which are bytes",
            &["Byte", "Int16", "UInt16", "Int32", "Float32", "Float64"],
        ),
        DriverContent::Colors | DriverContent::Shapes => ("colors, which are bytes", &["Byte"]),
    };
    let Some(types) = driver.metadata_item("DMD_CREATIONDATATYPES", "") else {
        return Ok(wanted[0]);
    };
    let known: Vec<&str> = types.split_ascii_whitespace().collect();
    let found = wanted.iter().copied().find(|name| known.contains(name));
    found.ok_or_else(|| {
        let error = format!(
            "the driver {} stores {}, and no {what}",
            driver.short_name(),
            known.join(", ")
        );
        Error::usage(error).cure(AS_GEOTIFF)
    })
}

/// Returns true if a driver copies data sets itself, and says what it cannot keep.
pub(super) fn copies_itself(driver: &Driver) -> bool {
    can(driver, "DCAP_CREATECOPY")
}

/// An option of a driver, as its description lists it.
#[derive(Debug, PartialEq)]
struct DriverOption {
    name: String,
    /// The values that it may have; empty for any.
    values: Vec<String>,
}

/// Returns the options in a list of GDAL's:
/// `<OptionList><Option name='A' type='string-select'><Value>X</Value></Option></OptionList>`.
fn listed(xml: &str) -> Vec<DriverOption> {
    let mut reader = Reader::from_str(xml);
    let mut options: Vec<DriverOption> = Vec::new();
    let mut is_value = false;
    let attribute = |element: &BytesStart, wanted: &str| {
        let attribute = element.try_get_attribute(wanted).ok()??;
        Some(attribute.value.into_owned())
    };
    loop {
        match reader.read_event() {
            Ok(Event::Start(element) | Event::Empty(element)) => match element.name().as_ref() {
                "Option" => {
                    let name = attribute(&element, "name").unwrap_or_default();
                    options.push(DriverOption {
                        name,
                        values: Vec::new(),
                    });
                }
                "Value" => {
                    is_value = true;
                    let alias = attribute(&element, "alias").or(attribute(&element, "aliasOf"));
                    if let (Some(option), Some(alias)) = (options.last_mut(), alias) {
                        option.values.push(alias);
                    }
                }
                _ => {}
            },
            Ok(Event::Text(text)) if is_value => {
                is_value = false;
                if let Some(option) = options.last_mut() {
                    option.values.push(text.trim().to_owned());
                }
            }
            Ok(Event::Eof) | Err(_) => return options,
            Ok(_) => {}
        }
    }
}

/// Returns an error unless an option is `NAME=VALUE`, and one of the driver's, if these are known.
fn check(
    option: &str,
    known: Option<&[DriverOption]>,
    driver: &str,
    setting: Setting,
) -> Result<()> {
    let Some((name, value)) = option.split_once('=').filter(|(name, _)| !name.is_empty()) else {
        return Err(Error::usage(wording![
            setting.text(option),
            ": not an option and its value"
        ])
        .cure(wording!["write ", setting.text("NAME=VALUE")]));
    };
    let Some(known) = known else {
        return Ok(());
    };
    let Some(of_driver) = known.iter().find(|own| own.name.eq_ignore_ascii_case(name)) else {
        let names: Vec<String> = known.iter().map(|own| own.name.clone()).collect();
        let error = Error::usage(wording![
            setting.text(option),
            format!(": the driver {driver} has no option {name}")
        ]);
        return Err(error.cure(match names.is_empty() {
            true => "it has no options at all: leave it out".to_owned(),
            false => did_you_mean(name, &names),
        }));
    };
    let values = &of_driver.values;
    if values.is_empty() || values.iter().any(|known| known.eq_ignore_ascii_case(value)) {
        return Ok(());
    }
    let error = wording![
        setting.text(option),
        format!(
            ": the driver {driver} has no such value of {}",
            of_driver.name
        )
    ];
    Err(Error::usage(error).cure(did_you_mean(value, values)))
}

/// The names that a cure lists at most.
const MOST_LISTED: usize = 30;

/// Returns a cure that names what was probably meant, or all that is known.
fn did_you_mean(typed: &str, known: &[String]) -> String {
    let upper = typed.to_uppercase();
    let most = typed.chars().count().div_ceil(3);
    let near = known
        .iter()
        .map(|known| (osa_distance(&upper, &known.to_uppercase()), known))
        .filter(|(distance, _)| *distance <= most)
        .min();
    match near {
        Some((_, known)) => format!("did you mean {known}?"),
        None if known.len() > MOST_LISTED => {
            format!(
                "choose one of {} and others",
                known[..MOST_LISTED].join(", ")
            )
        }
        None => format!("choose one of {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_a_driver_are_listed_with_their_values() {
        let xml = "<CreationOptionList>\
            <Option name='COMPRESS' type='string-select' default='NONE'>\
            <Value>NONE</Value><Value alias='FLATE'>DEFLATE</Value></Option>\
            <Option name='ZLEVEL' type='int'/></CreationOptionList>";
        let option = |name: &str, values: &[&str]| DriverOption {
            name: name.to_owned(),
            values: values.iter().map(|&value| value.to_owned()).collect(),
        };
        let known = listed(xml);
        let expected = [
            option("COMPRESS", &["NONE", "FLATE", "DEFLATE"]),
            option("ZLEVEL", &[]),
        ];
        assert_eq!(known, expected);
        let checked = |text: &str| check(text, Some(&known), "X", Setting::CreationOptions);
        for text in ["compress=deflate", "ZLEVEL=9", "COMPRESS=NONE"] {
            checked(text).unwrap();
        }
        for (text, cure) in [
            ("COMPRES=NONE", "did you mean COMPRESS?"),
            ("COMPRESS=DEFLAT", "did you mean DEFLATE?"),
            ("WHATEVER=1", "choose one of COMPRESS, ZLEVEL"),
            ("COMPRESS", "write creation-options NAME=VALUE"),
            ("=1", "write creation-options NAME=VALUE"),
        ] {
            let error = checked(text).unwrap_err();
            assert_eq!(error.cure_text().unwrap().plain(), cure, "{text}");
        }
        check("ANY=1", None, "X", Setting::CreationOptions).unwrap();
        assert!(listed("no list").is_empty());
    }
}
