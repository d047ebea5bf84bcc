//! Names of data sets that are not files: databases, services, parts of files, and files in
//! archives or on servers.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// How the names of databases and services begin, in any case; the names of a layer and of an
/// attribute may follow.
const SERVICES: &[&str] = &[
    "AmigoCloud",
    "CAD",
    "Carto",
    "CSW",
    "DB2ODBC",
    "Elastic",
    "ES",
    "FGDB",
    "HANA",
    "IDB",
    "Ingres",
    "MongoDBv3",
    "MSSQL",
    "MVT",
    "MySQL",
    "NGW",
    "OAPIF",
    "OCI",
    "ODBC",
    "PG",
    "PGeo",
    "PLScenes",
    "WFS",
    "WFS3",
    "WKT",
];

/// How the names of parts of a file begin, and of rasters of services: they are used as they are.
const PARTS: &[&str] = &[
    "ADRG",
    "BAG",
    "COASP",
    "CPG",
    "DAAS",
    "DERIVED_SUBDATASET",
    "EEDA",
    "EEDAI",
    "ENVISAT",
    "ESRIC",
    "GMLAS",
    "GPKG",
    "GRIB",
    "GTIFF_DIR",
    "GTIFF_RAW",
    "HDF4_EOS",
    "HDF4_SDS",
    "HDF5",
    "HDF5_IMAGE",
    "IRIS",
    "JPEG_SUBFILE",
    "JPIP",
    "KEA",
    "L1B",
    "L1BGCPS",
    "MRF",
    "NETCDF",
    "NITF_IM",
    "NITF_TOC_ENTRY",
    "OZI",
    "PDF",
    "PDF_IMAGE",
    "PLMOSAIC",
    "PostGISRaster",
    "RADARSAT_2_CALIB",
    "RASTERLITE",
    "RDA",
    "RS2_CALIB",
    "S57",
    "SENTINEL2_L1B",
    "SENTINEL2_L1C",
    "SENTINEL2_L2A",
    "SQLITE",
    "STACIT",
    "STACTA",
    "TILEDB",
    "TILEDB_ARRAY",
    "WCS",
    "WMS",
    "WMTS",
    "XODR",
    "ZARR",
];

/// Returns true if a name is one that only GDAL can open: a virtual path such as
/// `/vsizip/a.zip/b.shp`, a connection such as `PG:dbname=gis`, or a part of a file such as
/// `NETCDF:file.nc:z`; and no file has that name.
pub fn is_name(path: impl AsRef<Path>) -> bool {
    let path = path.as_ref();
    path.to_str().is_some_and(|text| start(text) > 0) && !path.exists()
}

/// Returns true if a name is that of a database or a service.
pub(crate) fn is_connection(path: &Path) -> bool {
    is_name(path)
        && path
            .to_str()
            .is_some_and(|text| prefix(text, SERVICES).is_some())
}

/// Returns the bytes of a name that show that it is one for GDAL; 0 if it is not.
fn start(text: &str) -> usize {
    virtual_path(text)
        .or_else(|| prefix(text, SERVICES))
        .or_else(|| prefix(text, PARTS))
        .unwrap_or(0)
}

/// Returns the bytes of the first part of a path such as `/vsizip/a.zip/b.shp`.
fn virtual_path(text: &str) -> Option<usize> {
    let kind = text.strip_prefix("/vsi")?;
    let end = kind.find(['/', '?'])?;
    let is_kind = end > 0
        && kind[..end]
            .bytes()
            .all(|b| b.is_ascii_alphanumeric() || b == b'_');
    is_kind.then_some("/vsi".len() + end)
}

/// Returns the bytes of one of these words with its colon.
fn prefix(text: &str, known: &[&str]) -> Option<usize> {
    let (word, _) = text.split_once(':')?;
    let is_known = known.iter().any(|known| word.eq_ignore_ascii_case(known));
    is_known.then_some(word.len() + 1)
}

/// Splits a name for GDAL into that of the data set and the names of a layer and an attribute that
/// may follow after a colon.
pub(crate) fn split(text: &str) -> (&Path, Option<&str>) {
    let whole = (Path::new(text), None);
    if prefix(text, PARTS).is_some() {
        return whole;
    }
    let separator = text.rfind(['/', '\\']);
    let first = start(text).max(separator.map_or(0, |at| at + 1));
    // `http://server:80`
    let is_host = text[..first].ends_with("//");
    let mut quote = None;
    for (at, c) in text[first..].char_indices().map(|(at, c)| (first + at, c)) {
        match (c, quote) {
            ('\'' | '"', None) => quote = Some(c),
            (_, Some(open)) if open == c => quote = None,
            (':', None) => {
                let rest = &text[at + 1..];
                let is_port = is_host && rest.bytes().all(|b| b.is_ascii_digit());
                if !is_port {
                    return (Path::new(&text[..at]), Some(rest));
                }
            }
            _ => {}
        }
    }
    whole
}

/// What stands for a password in names of data sets.
const HIDDEN: &str = "***";

/// The names with the passwords that this process was given, by the names without them.
static SECRETS: Mutex<Option<HashMap<String, String>>> = Mutex::new(None);

/// Returns the name of a data set without its passwords, with which it can be opened as long as
/// this process runs: so no message, no output and no file of a job can contain them. Other names
/// are returned as they are.
pub fn without_secrets(text: &str) -> Cow<'_, str> {
    if start(text) == 0 {
        return Cow::Borrowed(text);
    }
    let shown = hidden(text);
    if let Cow::Owned(shown) = &shown {
        // Names of layers may follow, and differ.
        let (name, _) = split(shown);
        let name = name.to_string_lossy().into_owned();
        let names = shown.len() - name.len();
        let secret = text[..text.len() - names].to_owned();
        let mut secrets = SECRETS.lock().unwrap_or_else(PoisonError::into_inner);
        secrets.get_or_insert_default().insert(name, secret);
    }
    shown
}

/// Returns a name of a data set as messages show it.
pub(super) fn shown(path: &Path) -> Cow<'_, Path> {
    match path.to_str().map(without_secrets) {
        Some(Cow::Owned(text)) => Cow::Owned(text.into()),
        _ => Cow::Borrowed(path),
    }
}

/// Returns the name with which GDAL opens a data set: the passwords are put back.
#[cfg(feature = "gdal")]
pub(super) fn with_secrets(path: &Path) -> Cow<'_, Path> {
    let secrets = SECRETS.lock().unwrap_or_else(PoisonError::into_inner);
    let known = secrets.as_ref().zip(path.to_str());
    match known.and_then(|(secrets, text)| secrets.get(text)) {
        Some(secret) => Cow::Owned(secret.into()),
        None => Cow::Borrowed(path),
    }
}

/// The keys of passwords in connections, in lower case.
const KEYS: &[&str] = &[
    "password",
    "pwd",
    "passwd",
    "sslpassword",
    "userpwd",
    "apikey",
    "api_key",
    "token",
];

/// Returns a text in which passwords are replaced: values of keys such as `password=`, and what is
/// between a user and a host in `scheme://user:password@host`.
pub(crate) fn hidden(text: &str) -> Cow<'_, str> {
    let mut found: Vec<(usize, usize)> = Vec::new();
    let lower = text.to_ascii_lowercase();
    let bytes = text.as_bytes();
    for (equals, _) in lower.match_indices('=') {
        let before = lower[..equals].trim_end();
        let is_key = |key: &&str| {
            let rest = before.strip_suffix(*key);
            rest.is_some_and(|rest| !rest.ends_with(|c: char| c.is_alphanumeric()))
        };
        if !KEYS.iter().any(is_key) {
            continue;
        }
        let blanks = lower[equals + 1..].len() - lower[equals + 1..].trim_start().len();
        let start = equals + 1 + blanks;
        found.push((start, end_of_value(bytes, start)));
    }
    for (at, _) in lower.match_indices("://") {
        let start = at + "://".len();
        let end = text[start..]
            .find(['/', ' ', '?', '\'', '"'])
            .map_or(text.len(), |end| start + end);
        if let Some(host) = text[start..end].rfind('@')
            && let Some(colon) = text[start..start + host].find(':')
        {
            found.push((start + colon + 1, start + host));
        }
    }
    found.retain(|(start, end)| start < end && &text[*start..*end] != HIDDEN);
    if found.is_empty() {
        return Cow::Borrowed(text);
    }
    found.sort_unstable();
    let (mut shown, mut done) = (String::new(), 0);
    for (start, end) in found {
        if start < done {
            continue;
        }
        shown.push_str(&text[done..start]);
        shown.push_str(HIDDEN);
        done = end;
    }
    shown.push_str(&text[done..]);
    Cow::Owned(shown)
}

/// Returns the end of a value: of one in quotes, behind the closing one, else before a separator.
fn end_of_value(bytes: &[u8], start: usize) -> usize {
    let quote = bytes
        .get(start)
        .copied()
        .filter(|b| matches!(b, b'\'' | b'"' | b'{'));
    let close = quote.map(|quote| if quote == b'{' { b'}' } else { quote });
    let mut at = start + usize::from(close.is_some());
    while at < bytes.len() {
        match (bytes[at], close) {
            (b'\\', Some(_)) => at += 1,
            (b, Some(close)) if b == close => return at + 1,
            (b' ' | b'\t' | b'\n' | b';' | b',' | b'&' | b'\'' | b'"' | b':', None) => return at,
            _ => {}
        }
        at += 1;
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_for_gdal_are_known_and_files_are_not_taken_for_them() {
        for name in [
            "/vsizip/a.zip/b.shp",
            "/vsicurl/http://host/a.tif",
            "/vsis3/bucket/a.tif",
            "/vsicurl?url=http%3A%2F%2Fhost",
            "PG:dbname=gis",
            "pg:service=x",
            "NETCDF:a.nc:z",
            "WFS:https://host/wfs",
        ] {
            assert!(is_name(name), "{name}");
        }
        for name in [
            "a.shp:Z",
            "C:a.shp",
            "/vsi/a",
            "/vsizip",
            "/vsi",
            "roads:PG",
            "/home/vsizip/a",
            "x",
            "",
        ] {
            assert!(!is_name(name), "{name}");
        }
    }

    #[test]
    fn a_layer_and_an_attribute_may_follow() {
        for (text, path, names) in [
            ("/vsizip/a.zip/b.shp:Z", "/vsizip/a.zip/b.shp", Some("Z")),
            (
                "/vsicurl/http://host:80/b.gpkg:l:Z",
                "/vsicurl/http://host:80/b.gpkg",
                Some("l:Z"),
            ),
            ("PG:dbname=gis:lines", "PG:dbname=gis", Some("lines")),
            (
                "PG:dbname='a:b' host=/var/run/pg:lines:Z",
                "PG:dbname='a:b' host=/var/run/pg",
                Some("lines:Z"),
            ),
            (
                "PG:postgresql://u@host:5432/gis:lines",
                "PG:postgresql://u@host:5432/gis",
                Some("lines"),
            ),
            ("WFS:http://host:80", "WFS:http://host:80", None),
            ("PG:dbname=gis", "PG:dbname=gis", None),
            ("NETCDF:a.nc:z", "NETCDF:a.nc:z", None),
        ] {
            assert_eq!(split(text), (Path::new(path), names), "{text}");
        }
    }

    #[test]
    fn passwords_are_hidden_and_nothing_else() {
        for (text, shown) in [
            (
                "PG:dbname=a password=secret user=b",
                "PG:dbname=a password=*** user=b",
            ),
            (r"PG:password='se\'cr et' user=b", "PG:password=*** user=b"),
            ("PG:user=b password = secret", "PG:user=b password = ***"),
            (
                "PG:user=b password=secret:lines:Z",
                "PG:user=b password=***:lines:Z",
            ),
            (
                "MySQL:db,user=me,password=secret,port=1",
                "MySQL:db,user=me,password=***,port=1",
            ),
            (
                "MSSQL:server=x;UID=me;PWD={se;cret};",
                "MSSQL:server=x;UID=me;PWD=***;",
            ),
            (
                "PG:postgresql://me:secret@host:5432/gis",
                "PG:postgresql://me:***@host:5432/gis",
            ),
            (
                "/vsicurl/http://me:s:e@host/a.tif",
                "/vsicurl/http://me:***@host/a.tif",
            ),
            ("PG:dbname=a sslpassword=x", "PG:dbname=a sslpassword=***"),
            ("PG:dbname=a password=***", "PG:dbname=a password=***"),
            ("PG:dbname=nopassword host=x", "PG:dbname=nopassword host=x"),
            ("PG:password=", "PG:password="),
            (
                "unable to connect: 'password=secret'",
                "unable to connect: 'password=***'",
            ),
            ("größe=1 password=", "größe=1 password="),
        ] {
            assert_eq!(hidden(text), shown, "{text}");
        }
        assert_eq!(without_secrets("a.shp:password=x"), "a.shp:password=x");
    }

    #[test]
    #[cfg(feature = "gdal")]
    fn a_password_comes_back_when_the_data_set_is_opened() {
        let typed = "PG:dbname=came_back password=secret:lines:Z";
        let shown = without_secrets(typed);
        assert_eq!(shown, "PG:dbname=came_back password=***:lines:Z");
        let (name, names) = split(&shown);
        assert_eq!(names, Some("lines:Z"));
        assert_eq!(
            with_secrets(name),
            Path::new("PG:dbname=came_back password=secret")
        );
        assert_eq!(with_secrets(Path::new("a.tif")), Path::new("a.tif"));
    }
}
