//! Shapefiles in ZIP archives (`.zip`, `.shz`): each is a layer, as in GDAL. They are unpacked into
//! a folder of their own, which is removed again.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use super::shapefile;
use crate::data::Layer;
use crate::error::{Error, Result};
use crate::io::bytes::output::Temporary;
use crate::io::bytes::watch::Watch;
use crate::io::bytes::zip::{Archive, Member};
use crate::io::options::layer::Options;

/// The files of a shapefile that are read.
const PARTS: [&str; 5] = ["shp", "shx", "dbf", "prj", "cpg"];

/// Limit for the bytes of a member: that of the longest shapefile and of the longest table.
const LARGEST: u64 = 1 << 33;

/// Reads a shapefile in an archive, watched. If there are several, one must be named, without its
/// extension and with its folder if two have the same name.
///
/// Its files are unpacked into the system's folder for temporary files, and removed at the end.
///
/// # Errors
/// If the archive is damaged, is encrypted or is packed by another method than Deflate; if it has
/// no such shapefile; those of [`shapefile::read_layer_with`] and of the watch.
pub(crate) fn read_layer_with(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    read(path, options, watch).map_err(|error| error.in_file(path))
}

fn read(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    let mut archive = Archive::open(File::open(path)?)?;
    let stems: Vec<String> = archive
        .members
        .iter()
        .filter_map(stem_of_shapefile)
        .collect();
    if stems.is_empty() {
        let count = archive.members.len();
        let error = format!("there is no shapefile among the {count} members of the archive");
        return Err(Error::unsupported(error).cure("unpack it, and name what is in it"));
    }
    let (at, height_field) = options.choose(&names(&stems), |_| false)?;
    let stem = &stems[at];
    let folder = Temporary::folder_in(&std::env::temp_dir())?;
    let unpacked = folder.path().join("layer.shp");
    let members: Vec<(Member, &str)> = archive
        .members
        .iter()
        .filter_map(|member| Some((member.clone(), part_of(member, stem)?)))
        .collect();
    for (member, extension) in members {
        if member.size > LARGEST {
            let size = member.size as f64 / 1e9;
            return Err(
                Error::limit(format!("{size:.1} GB, more than a shapefile can have"))
                    .at(member.name),
            );
        }
        let mut out = BufWriter::new(File::create(unpacked.with_extension(extension))?);
        archive.unpack(&member, &mut out, watch)?;
        out.into_inner().map_err(|error| error.into_error())?;
    }
    let options = Options {
        layer: None,
        height_field: height_field.as_deref(),
        ..*options
    };
    let layer = shapefile::read_layer_with(&unpacked, &options, watch)
        .map_err(|error| error.moved(path, format!("{stem}.shp")))?;
    Ok(Layer {
        format: format!("zipped {}", layer.format),
        ..layer
    })
}

/// Returns the name of a shapefile with its folder and without its extension; `None` for another
/// member.
fn stem_of_shapefile(member: &Member) -> Option<String> {
    // macOS keeps attributes of its own in files with the same names.
    let is_copy = member.name.starts_with("__MACOSX/");
    let (stem, extension) = member.name.rsplit_once('.')?;
    (!is_copy && extension.eq_ignore_ascii_case("shp")).then(|| stem.to_owned())
}

/// Returns the extension of a member that belongs to a shapefile with this name.
fn part_of(member: &Member, stem: &str) -> Option<&'static str> {
    let (own, extension) = member.name.rsplit_once('.')?;
    let known = PARTS
        .into_iter()
        .find(|part| extension.eq_ignore_ascii_case(part));
    known.filter(|_| own.eq_ignore_ascii_case(stem))
}

/// Returns the names of layers: those of the files, with their folders where two are the same.
fn names(stems: &[String]) -> Vec<String> {
    let short = |stem: &str| stem.rsplit('/').next().unwrap_or(stem).to_owned();
    let all: Vec<String> = stems.iter().map(|stem| short(stem)).collect();
    let is_alone = |name: &String| all.iter().filter(|other| *other == name).count() == 1;
    let names = stems.iter().zip(&all);
    names
        .map(|(stem, name)| if is_alone(name) { name } else { stem }.clone())
        .collect()
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::DeflateEncoder;
    use testkit::random::Random;

    use super::*;
    use crate::crs::Crs;
    use crate::data::{Attributes, Shape, Value};
    use crate::io::bytes::watch::unwatched;

    /// Packs members into an archive; those of odd numbers are stored as they are.
    fn packed(members: &[(String, Vec<u8>)]) -> Vec<u8> {
        let (mut bytes, mut list) = (Vec::new(), Vec::new());
        for (number, (name, content)) in members.iter().enumerate() {
            let (method, data) = match number % 2 {
                0 => {
                    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
                    encoder.write_all(content).unwrap();
                    (8_u16, encoder.finish().unwrap())
                }
                _ => (0, content.clone()),
            };
            let mut checksum = flate2::Crc::new();
            checksum.update(content);
            let mut facts = Vec::new();
            facts.extend([20, 0, 0, 0]);
            facts.extend(method.to_le_bytes());
            facts.extend([0; 4]);
            facts.extend(checksum.sum().to_le_bytes());
            facts.extend((data.len() as u32).to_le_bytes());
            facts.extend((content.len() as u32).to_le_bytes());
            facts.extend((name.len() as u16).to_le_bytes());
            facts.extend([0, 0]);
            list.extend(b"PK\x01\x02\x14\0");
            list.extend(&facts);
            list.extend([0; 10]);
            list.extend((bytes.len() as u32).to_le_bytes());
            list.extend(name.bytes());
            bytes.extend(b"PK\x03\x04");
            bytes.extend(&facts);
            bytes.extend(name.bytes());
            bytes.extend(&data);
        }
        let start = bytes.len() as u32;
        bytes.extend(&list);
        bytes.extend(b"PK\x05\x06\0\0\0\0");
        bytes.extend(
            [members.len() as u16, members.len() as u16]
                .map(u16::to_le_bytes)
                .concat(),
        );
        bytes.extend((list.len() as u32).to_le_bytes());
        bytes.extend(start.to_le_bytes());
        bytes.extend([3, 0]);
        bytes.extend(b"end");
        bytes
    }

    /// The files of a shapefile with this name, with one line at this height.
    fn shapefile_of(name: &str, height: f64) -> Vec<(String, Vec<u8>)> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.shp");
        let layer = Layer {
            shapes: vec![Shape::Lines(vec![vec![
                [1.0, 2.0, height],
                [3.0, 4.0, height],
            ]])],
            crs: Some(Crs::from_epsg(25832).unwrap()),
            attributes: Some(Attributes {
                names: vec!["H".to_owned()],
                rows: vec![vec![Value::Number(height + 100.0)]],
            }),
            ..Layer::default()
        };
        shapefile::write_lines(path.as_path(), &layer).unwrap();
        let file = |part: &str| {
            let bytes = std::fs::read(path.with_extension(part)).unwrap();
            (format!("{name}.{part}"), bytes)
        };
        PARTS.map(file).into()
    }

    fn read_bytes(bytes: &[u8], options: &Options) -> Result<Layer> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.zip");
        std::fs::write(&path, bytes).unwrap();
        read_layer_with(&path, options, &unwatched)
    }

    fn height_of(bytes: &[u8], layer: Option<&str>, height_field: Option<&str>) -> Result<f64> {
        let options = Options {
            layer,
            height_field,
            ..Options::default()
        };
        let layer = read_bytes(bytes, &options)?;
        assert_eq!(layer.crs.unwrap().epsg, Some(25832));
        Ok(layer.shapes[0].vertices().next().unwrap()[2])
    }

    #[test]
    fn shapefiles_are_layers() {
        let one = packed(&shapefile_of("data/Roads", 5.0));
        assert_eq!(height_of(&one, None, None).unwrap(), 5.0);
        assert_eq!(height_of(&one, Some("roads"), None).unwrap(), 5.0);
        assert_eq!(height_of(&one, None, Some("h")).unwrap(), 105.0);
        let several = [
            vec![("readme.txt".to_owned(), b"x".to_vec())],
            shapefile_of("a/roads", 1.0),
            shapefile_of("b/roads", 2.0),
            shapefile_of("RIVERS", 3.0),
            shapefile_of("__MACOSX/._RIVERS", 4.0),
        ];
        let several = packed(&several.concat());
        let error = height_of(&several, None, None).unwrap_err();
        assert!(
            error
                .to_string()
                .ends_with("a.zip: there are 3 layers in it")
        );
        let cure = error.cure_text().unwrap().plain();
        assert!(cure.ends_with("a/roads, b/roads, RIVERS"), "{cure}");
        assert_eq!(height_of(&several, Some("b/roads"), None).unwrap(), 2.0);
        assert_eq!(
            height_of(&several, Some("rivers"), Some("H")).unwrap(),
            103.0
        );
    }

    #[test]
    fn what_is_wrong_names_the_archive_and_the_member() {
        let without = packed(&[("a.txt".to_owned(), Vec::new())]);
        let error = height_of(&without, None, None).unwrap_err().to_string();
        assert!(error.ends_with("a.zip: there is no shapefile among the 1 members of the archive"));
        let mut files = shapefile_of("roads", 5.0);
        files[0].1.truncate(150);
        let error = height_of(&packed(&files), None, None).unwrap_err();
        assert!(error.path().unwrap().ends_with("a.zip"), "{error}");
        assert!(error.to_string().contains("roads.shp"), "{error}");
        let mut encrypted = packed(&shapefile_of("roads", 5.0));
        let list = encrypted
            .windows(4)
            .position(|window| window == b"PK\x01\x02")
            .unwrap();
        encrypted[list + 8] = 1;
        let error = height_of(&encrypted, None, None).unwrap_err().to_string();
        assert!(error.ends_with("roads.shp: it is encrypted"), "{error}");
    }

    #[test]
    fn an_archive_that_unpacks_to_more_than_it_states_is_refused() {
        let mut bytes = packed(&[("a.shp".to_owned(), vec![0; 1 << 22])]);
        let list = bytes
            .windows(4)
            .position(|window| window == b"PK\x01\x02")
            .unwrap();
        for size in [100_u32, u32::MAX - 1] {
            bytes[list + 24..list + 28].copy_from_slice(&size.to_le_bytes());
            let error = height_of(&bytes, None, None).unwrap_err().to_string();
            assert!(
                error.contains("a.shp") && error.contains("byte 0"),
                "{error}"
            );
        }
    }

    #[test]
    fn damaged_archives_are_errors() {
        let bytes = packed(&[shapefile_of("a", 1.0), shapefile_of("b", 2.0)].concat());
        let options = Options {
            layer: Some("a"),
            ..Options::default()
        };
        let random = &mut Random(23);
        let mut errors = 0;
        for _ in 0..500 {
            let mut bad = bytes.clone();
            match random.index(4) {
                0 => bad.truncate(random.index(bytes.len())),
                1 => drop(bad.drain(..random.index(bytes.len()))),
                _ => (0..1 + random.index(3)).for_each(|_| {
                    let at = random.index(bad.len());
                    bad[at] = [0, 0xff, bad[at] ^ (1 << random.index(8))][random.index(3)];
                }),
            }
            if let Err(error) = read_bytes(&bad, &options) {
                errors += 1;
                let text = error.to_string();
                assert!(
                    text.contains("a.zip: ") && !text.contains("layer.shp"),
                    "{text}"
                );
            }
        }
        assert!(errors > 200, "{errors}");
    }
}
