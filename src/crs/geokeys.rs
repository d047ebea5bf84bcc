use super::definition::{Datum, Definition, Ellipsoid};
use super::projection::{Measure, Method, Param, Projection, ROWS};
use super::wkt_write::{self, Dialect};
use super::{Crs, CrsKind, Unit, registry};
use crate::error::{Error, Result};

/// The GeoTIFF tags of a coordinate system, as in a TIFF file or the VLRs of a LAS file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GeoKeys {
    /// GeoKeyDirectoryTag (34735).
    pub directory: Vec<u16>,
    /// GeoDoubleParamsTag (34736).
    pub doubles: Vec<f64>,
    /// GeoAsciiParamsTag (34737).
    pub ascii: String,
}

/// The point of a pixel to which coordinates refer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RasterType {
    /// The outer corner of a pixel.
    PixelIsArea,
    /// The center of a pixel.
    PixelIsPoint,
}

const DOUBLES: u16 = 34736;
const ASCII: u16 = 34737;
const DIRECTORY: u16 = 34735;
/// The value for "not in the registry, see other keys"; it is larger than all codes.
const USER_DEFINED: u16 = 32767;

mod key {
    pub(super) const MODEL_TYPE: u16 = 1024;
    pub(super) const RASTER_TYPE: u16 = 1025;
    pub(super) const CITATION: u16 = 1026;
    pub(super) const GEODETIC: u16 = 2048;
    pub(super) const GEODETIC_CITATION: u16 = 2049;
    pub(super) const DATUM: u16 = 2050;
    pub(super) const GEODETIC_LENGTH: u16 = 2052;
    pub(super) const ANGLE: u16 = 2054;
    pub(super) const ANGLE_SIZE: u16 = 2055;
    pub(super) const SEMI_MAJOR: u16 = 2057;
    pub(super) const SEMI_MINOR: u16 = 2058;
    pub(super) const INVERSE_FLATTENING: u16 = 2059;
    pub(super) const MERIDIAN: u16 = 2061;
    pub(super) const PROJECTED: u16 = 3072;
    pub(super) const PROJECTED_CITATION: u16 = 3073;
    pub(super) const CONVERSION: u16 = 3074;
    pub(super) const METHOD: u16 = 3075;
    pub(super) const LENGTH: u16 = 3076;
    pub(super) const LENGTH_SIZE: u16 = 3077;
    pub(super) const VERTICAL: u16 = 4096;
    pub(super) const VERTICAL_CITATION: u16 = 4097;
    pub(super) const VERTICAL_LENGTH: u16 = 4099;
}

/// The prefix of a definition that GDAL stores as text because keys cannot represent it.
const PE_STRING: &str = "ESRI PE String = ";

impl GeoKeys {
    /// Returns the coordinate system that the keys state; `None` if they state none.
    ///
    /// A code takes precedence over all other keys, with one exception: if the keys also state a
    /// different unit, the coordinates are in that unit (as GDAL and Esri read it). Without a code,
    /// the system is built from the parameters of the projection, as WKT. If these are missing as
    /// well, its name is that of the citation.
    ///
    /// # Errors
    /// If the directory is damaged.
    pub fn crs(&self) -> Result<Option<Crs>> {
        let keys = Entries::read(self)?;
        let Some(mut crs) = keys.horizontal()? else {
            return Ok(None);
        };
        keys.add_vertical(&mut crs);
        Ok(Some(crs))
    }

    /// Returns what coordinates refer to; [`PixelIsArea`](RasterType::PixelIsArea) if it is not
    /// stated.
    pub fn raster_type(&self) -> RasterType {
        let keys = Entries::read(self);
        match keys.is_ok_and(|keys| keys.short(key::RASTER_TYPE) == Some(2)) {
            true => RasterType::PixelIsPoint,
            false => RasterType::PixelIsArea,
        }
    }

    /// Returns the keys of a coordinate system, with PixelIsArea.
    pub fn from_crs(crs: &Crs) -> Self {
        let mut writer = Writer::default();
        writer.short(key::RASTER_TYPE, 1);
        writer.text(key::CITATION, &crs.name);
        let code = crs
            .epsg
            .and_then(|code| u16::try_from(code).ok())
            .filter(|&code| code < USER_DEFINED);
        match crs.kind {
            CrsKind::Projected => {
                writer.unit(&crs.unit, (key::LENGTH, key::LENGTH_SIZE));
                match code {
                    Some(code) => {
                        writer.short(key::MODEL_TYPE, 1);
                        writer.short(key::PROJECTED, code);
                    }
                    None => writer.user_defined_projected(crs),
                }
            }
            CrsKind::Geographic => {
                writer.short(key::MODEL_TYPE, 2);
                writer.unit(&crs.unit, (key::ANGLE, key::ANGLE_SIZE));
                match (code, crs.definition()) {
                    (Some(code), _) => writer.short(key::GEODETIC, code),
                    (None, Some(definition)) => writer.user_defined_datum(&definition),
                    (None, None) => writer.short(key::GEODETIC, USER_DEFINED),
                }
            }
            CrsKind::Geocentric => {
                writer.short(key::MODEL_TYPE, 3);
                writer.short(key::GEODETIC, code.unwrap_or(USER_DEFINED));
                writer.short(
                    key::GEODETIC_LENGTH,
                    crs.unit.code().unwrap_or(USER_DEFINED),
                );
            }
            CrsKind::Local => {
                writer.short(key::MODEL_TYPE, USER_DEFINED);
                writer.unit(&crs.unit, (key::LENGTH, key::LENGTH_SIZE));
            }
        }
        if let (Some(unit), true) = (&crs.vertical_unit, crs.kind != CrsKind::Geocentric) {
            if let Some(code) = crs.vertical_epsg.and_then(|code| u16::try_from(code).ok()) {
                writer.short(key::VERTICAL, code);
                if let Some(found) = registry::find_vertical(u32::from(code)) {
                    writer.text(key::VERTICAL_CITATION, &found.name);
                }
            }
            if let Some(code) = unit.code() {
                writer.short(key::VERTICAL_LENGTH, code);
            }
        }
        writer.finish()
    }
}

enum Value {
    Short(u16),
    Doubles(Vec<f64>),
    Text(String),
}

/// The entries of the directory, with their values.
struct Entries {
    entries: Vec<(u16, Value)>,
}

impl Entries {
    fn read(keys: &GeoKeys) -> Result<Self> {
        let mut entries = Vec::new();
        let (header, rest) = match keys.directory.split_at_checked(4) {
            Some(parts) => parts,
            None if keys.directory.iter().all(|&short| short == 0) => {
                return Ok(Entries { entries });
            }
            None => {
                let found = keys.directory.len();
                return Err(Error::format(format!(
                    "GeoKey directory of {found} values, expected at least 4"
                )));
            }
        };
        let (count, room) = (usize::from(header[3]), rest.len() / 4);
        if count > room {
            return Err(Error::format(format!(
                "GeoKey directory states {count} keys, but holds {room}"
            )));
        }
        for entry in rest.chunks_exact(4).take(count) {
            let (id, tag, length, offset) = (
                entry[0],
                entry[1],
                usize::from(entry[2]),
                usize::from(entry[3]),
            );
            let outside = |what: &str, held: usize| {
                let end = offset + length;
                Error::format(format!(
                    "GeoKey {id} uses {what} {offset} to {end}, but there are {held}"
                ))
            };
            let value = match tag {
                // Some writers leave unused entries, all zero.
                _ if id == 0 => continue,
                0 => Value::Short(entry[3]),
                DIRECTORY => {
                    let held = keys.directory.len();
                    Value::Short(
                        *keys
                            .directory
                            .get(offset)
                            .ok_or_else(|| outside("directory values", held))?,
                    )
                }
                DOUBLES => {
                    let held = keys.doubles.len();
                    let values = keys.doubles.get(offset..offset + length);
                    Value::Doubles(values.ok_or_else(|| outside("numbers", held))?.to_vec())
                }
                // A truncated name is still a name.
                ASCII => {
                    let bytes = keys.ascii.as_bytes();
                    let end = (offset + length).min(bytes.len());
                    let text = String::from_utf8_lossy(bytes.get(offset..end).unwrap_or_default());
                    Value::Text(text.trim_end_matches(['|', '\0', ' ']).to_owned())
                }
                tag => {
                    let tags = format!("0, {DIRECTORY}, {DOUBLES} or {ASCII}");
                    return Err(Error::format(format!(
                        "GeoKey {id} lies in tag {tag}, expected {tags}"
                    )));
                }
            };
            entries.push((id, value));
        }
        Ok(Entries { entries })
    }

    fn get(&self, id: u16) -> Option<&Value> {
        self.entries
            .iter()
            .find(|entry| entry.0 == id)
            .map(|entry| &entry.1)
    }

    fn short(&self, id: u16) -> Option<u16> {
        match self.get(id)? {
            Value::Short(value) => Some(*value),
            _ => None,
        }
    }

    /// A code of the registry, which is neither 0 (undefined) nor user-defined.
    fn code(&self, id: u16) -> Option<u32> {
        self.short(id)
            .filter(|&code| code > 0 && code < USER_DEFINED)
            .map(u32::from)
    }

    fn number(&self, id: u16) -> Option<f64> {
        match self.get(id)? {
            Value::Doubles(values) => values.first().copied().filter(|value| value.is_finite()),
            // Some files have this for whole degrees.
            Value::Short(value) => Some(f64::from(*value)),
            Value::Text(_) => None,
        }
    }

    fn text(&self, id: u16) -> Option<&str> {
        match self.get(id)? {
            Value::Text(text) => Some(text.as_str()).filter(|text| !text.is_empty()),
            _ => None,
        }
    }

    /// The name in a citation, which may be a list: "PCS Name = NAD83 / Nebraska|..".
    fn name(&self) -> Option<String> {
        let ids = [
            key::PROJECTED_CITATION,
            key::CITATION,
            key::GEODETIC_CITATION,
        ];
        // The citation of ERDAS is about the software.
        let is_name = |text: &&str| {
            !text.starts_with(PE_STRING) && !text.starts_with("IMAGINE GeoTIFF Support")
        };
        let text = ids.iter().filter_map(|&id| self.text(id)).find(is_name)?;
        let named = |label: &str| {
            text.split('|')
                .find_map(|part| part.trim().strip_prefix(label))
        };
        let name = named("PCS Name = ")
            .or_else(|| named("GCS Name = "))
            .or_else(|| text.split('|').next());
        Some(name.unwrap_or(text).trim().to_owned())
    }

    fn unit(
        &self,
        (code, size): (u16, u16),
        table: fn(u16) -> Option<Unit>,
        custom: fn(f64) -> Unit,
    ) -> Option<Unit> {
        match self.short(code)? {
            USER_DEFINED => self.number(size).filter(|&size| size > 0.0).map(custom),
            code => table(code),
        }
    }

    fn length(&self) -> Option<Unit> {
        self.unit(
            (key::LENGTH, key::LENGTH_SIZE),
            Unit::length_from_code,
            Unit::length,
        )
    }

    fn angle(&self) -> Option<Unit> {
        self.unit(
            (key::ANGLE, key::ANGLE_SIZE),
            Unit::angle_from_code,
            Unit::angle,
        )
    }

    fn horizontal(&self) -> Result<Option<Crs>> {
        let citation = self
            .text(key::PROJECTED_CITATION)
            .or_else(|| self.text(key::CITATION));
        if let Some(wkt) = citation.and_then(|text| text.strip_prefix(PE_STRING)) {
            return Crs::from_wkt(wkt).map(Some);
        }
        let code = |id: u16| self.code(id).filter(|&code| code >= 1024);
        let (projected, geodetic) = (code(key::PROJECTED), code(key::GEODETIC));
        let kind = match self.short(key::MODEL_TYPE) {
            _ if projected.is_some() => CrsKind::Projected,
            Some(1) => CrsKind::Projected,
            Some(2) => CrsKind::Geographic,
            Some(3) => CrsKind::Geocentric,
            None if self.get(key::GEODETIC).is_some() => CrsKind::Geographic,
            Some(_) if self.text(key::CITATION).is_some() => CrsKind::Local,
            _ => return Ok(None),
        };
        let found = match (kind, projected, geodetic) {
            (CrsKind::Projected, Some(code), _) => Some(self.coded(code, kind, self.length())),
            (CrsKind::Geographic | CrsKind::Geocentric, _, Some(code)) => {
                Some(self.coded(code, kind, None))
            }
            _ => None,
        };
        Ok(found.or_else(|| self.user_defined(kind)).or_else(|| {
            // Only a name: enough to print it and to distinguish it from others.
            let unit = if kind == CrsKind::Geographic {
                self.angle().unwrap_or_else(Unit::degree)
            } else {
                self.length().unwrap_or_else(Unit::metre)
            };
            self.name().map(|name| plain(name, None, kind, unit))
        }))
    }

    /// The system of a code, in the unit that the keys state.
    fn coded(&self, code: u32, kind: CrsKind, stated: Option<Unit>) -> Crs {
        let name = || self.name().unwrap_or_default();
        let Some(found) =
            registry::find(code).filter(|found| found.kind == kind || kind == CrsKind::Geocentric)
        else {
            let unit = match kind {
                CrsKind::Geographic => Unit::degree(),
                _ => stated.unwrap_or_else(Unit::metre),
            };
            return plain(name(), Some(code), kind, unit);
        };
        let differs = stated.filter(|unit| !unit.is_same(&found.unit));
        match (found.definition, differs) {
            (Some(mut definition), Some(unit)) => {
                // The false origin keeps its position, and is measured in the new unit.
                definition.unit = unit;
                if let Some(datum) = self
                    .code(key::GEODETIC)
                    .and_then(registry::find)
                    .and_then(|base| base.definition)
                {
                    definition.datum = datum.datum;
                    definition.geographic = datum.geographic;
                }
                defined(&definition, &name())
            }
            (Some(mut definition), None) if found.kind != kind => {
                definition.kind = kind;
                definition.unit = Unit::metre();
                defined(&definition, &found.name)
            }
            // The code is registered, so this cannot fail; if it does, the code is still kept.
            _ => {
                Crs::from_epsg(code).unwrap_or_else(|_| plain(name(), Some(code), kind, found.unit))
            }
        }
    }

    fn user_defined(&self, kind: CrsKind) -> Option<Crs> {
        let angle = self.angle().unwrap_or_else(Unit::degree);
        let base = self
            .code(key::GEODETIC)
            .and_then(registry::find)
            .and_then(|found| found.definition);
        let (datum, geographic) = match base {
            Some(base) => (base.datum, base.geographic),
            None => {
                let name = self.geodetic_name();
                (self.datum(&name)?, (name, None))
            }
        };
        let unit = match kind {
            CrsKind::Geographic => angle.clone(),
            _ => self.length().unwrap_or_else(Unit::metre),
        };
        let projection = match kind {
            CrsKind::Projected => Some(self.projection(&angle, &unit)?),
            _ => None,
        };
        let name = self.name().unwrap_or_default();
        Some(defined(
            &Definition {
                kind,
                datum,
                geographic,
                angle,
                projection,
                unit,
            },
            &name,
        ))
    }

    /// The name in a citation: "GCS Name = NAD83(HARN)|Primem = Greenwich" or a plain name.
    fn geodetic_name(&self) -> String {
        let text = self.text(key::GEODETIC_CITATION).unwrap_or("unknown");
        let first = text.split('|').next().unwrap_or(text).trim();
        first
            .strip_prefix("GCS Name = ")
            .unwrap_or(first)
            .to_owned()
    }

    fn datum(&self, geographic: &str) -> Option<Datum> {
        let stated = self.text(key::GEODETIC_CITATION).unwrap_or_default();
        let part = |label: &str| {
            stated
                .split('|')
                .find_map(|part| part.trim().strip_prefix(label))
                .map(str::to_owned)
        };
        let name = part("Datum = ");
        let code = self
            .code(key::DATUM)
            .or_else(|| registry::datum_code(name.as_deref().unwrap_or_default(), geographic));
        let a = self.number(key::SEMI_MAJOR);
        let rf = self.number(key::INVERSE_FLATTENING).or_else(|| {
            let (a, b) = (a?, self.number(key::SEMI_MINOR)?);
            Some(if a == b { 0.0 } else { a / (a - b) })
        });
        let meridian = self.number(key::MERIDIAN).unwrap_or(0.0);
        let ellipsoid = match (a, rf) {
            (Some(a), Some(rf)) if a > 0.0 && rf >= 0.0 => Some(Ellipsoid {
                name: part("Ellipsoid = ").unwrap_or_else(|| "unknown".into()),
                code: None,
                a,
                rf,
            }),
            _ => None,
        };
        let known = code.and_then(registry::datum).filter(|known| {
            (known.meridian - meridian).abs() < 1e-6
                && ellipsoid
                    .as_ref()
                    .is_none_or(|ellipsoid| known.ellipsoid.is_same(ellipsoid))
        });
        known.or_else(|| {
            Some(Datum {
                name: name.unwrap_or_else(|| geographic.to_owned()),
                code: None,
                ellipsoid: ellipsoid?,
                meridian,
            })
        })
    }

    fn projection(&self, angle: &Unit, unit: &Unit) -> Option<Projection> {
        if let Some(zone) = self.code(key::CONVERSION).and_then(utm_zone) {
            return Some(zone);
        }
        let method = self.short(key::METHOD)?;
        let row = ROWS.iter().find(|row| row.geokey == Some(method))?;
        let value = |param: Param| {
            let own = row
                .params
                .iter()
                .find(|entry| entry.0 == param)
                .map(|entry| entry.3);
            // Writers disagree on which of these keys belongs to which method.
            let others: &[u16] = match param {
                Param::Lat0 => &[3081, 3085, 3089],
                Param::Lon0 => &[3080, 3084, 3088, 3095],
                Param::K0 => &[3092, 3093],
                Param::FalseEasting => &[3082, 3086, 3090],
                Param::FalseNorthing => &[3083, 3087, 3091],
                _ => &[],
            };
            let value = own
                .into_iter()
                .chain(others.iter().copied())
                .find_map(|id| self.number(id))?;
            Some(match param.measure() {
                Measure::Angle => value * angle.factor.to_degrees(),
                Measure::Length => value * unit.factor,
                Measure::Ratio => value,
            })
        };
        Some(Projection::known(row.method, value))
    }

    fn add_vertical(&self, crs: &mut Crs) {
        let unit = self
            .short(key::VERTICAL_LENGTH)
            .and_then(Unit::length_from_code);
        if let Some(code) = self.code(key::VERTICAL) {
            let found = registry::find_vertical(code);
            match (found, &unit) {
                (Some(found), None) => {
                    crs.vertical_epsg = found.code;
                    crs.vertical_unit = Some(found.unit);
                }
                (Some(found), Some(unit)) if found.unit.is_same(unit) => {
                    crs.vertical_epsg = found.code
                }
                // The same heights in a different unit. In old files the code is that of the datum.
                (found, unit) => {
                    let metre = Unit::metre();
                    let datum = found
                        .and_then(|_| registry::vertical_datum(code))
                        .map_or(code, |(_, datum)| datum);
                    crs.vertical_epsg =
                        registry::vertical_of_datum(datum, unit.as_ref().unwrap_or(&metre));
                    if crs.vertical_epsg.is_some() && unit.is_none() {
                        crs.vertical_unit = Some(metre);
                    }
                }
            }
        }
        if unit.is_some() && crs.kind != CrsKind::Geocentric {
            crs.vertical_unit = unit;
        }
    }
}

/// The projection of a UTM conversion code: 16001 to 16060 in the north, 16101 to 16160 in the
/// south.
fn utm_zone(conversion: u32) -> Option<Projection> {
    let (zone, northing) = match conversion {
        16001..=16060 => (conversion - 16000, 0.0),
        16101..=16160 => (conversion - 16100, 10_000_000.0),
        _ => return None,
    };
    Some(Projection::known(
        Method::TransverseMercator,
        |param| match param {
            Param::Lat0 => Some(0.0),
            Param::Lon0 => Some(f64::from(zone) * 6.0 - 183.0),
            Param::K0 => Some(0.9996),
            Param::FalseEasting => Some(500_000.0),
            Param::FalseNorthing => Some(northing),
            _ => None,
        },
    ))
}

fn plain(name: String, epsg: Option<u32>, kind: CrsKind, unit: Unit) -> Crs {
    Crs {
        name,
        epsg,
        vertical_epsg: None,
        kind,
        unit,
        vertical_unit: None,
        wkt: None,
    }
}

/// The system of a definition. If `name` is empty, it gets that of the registry, if any.
fn defined(definition: &Definition, name: &str) -> Crs {
    let epsg = registry::identify(definition, name);
    let known = epsg
        .filter(|_| name.is_empty())
        .and_then(registry::find)
        .map(|found| found.name);
    let name = &known.unwrap_or_else(|| {
        if name.is_empty() {
            "unnamed".into()
        } else {
            name.to_owned()
        }
    });
    let mut crs = plain(name.clone(), epsg, definition.kind, definition.unit.clone());
    crs.wkt = wkt_write::write(definition, name, epsg, Dialect::Gdal);
    if crs.kind == CrsKind::Geocentric {
        crs.vertical_unit = Some(crs.unit.clone());
    }
    crs
}

#[derive(Default)]
struct Writer {
    /// Key, tag, count, value or offset.
    entries: Vec<[u16; 4]>,
    doubles: Vec<f64>,
    ascii: String,
}

impl Writer {
    fn short(&mut self, id: u16, value: u16) {
        self.entries.push([id, 0, 1, value]);
    }

    fn double(&mut self, id: u16, value: f64) {
        self.entries
            .push([id, DOUBLES, 1, self.doubles.len() as u16]);
        self.doubles.push(value);
    }

    /// Adds a text. All texts share one string of at most 64 kB, separated by bars; a text that
    /// does not fit is dropped.
    fn text(&mut self, id: u16, text: &str) {
        let text: String = text
            .chars()
            .map(|c| {
                if c.is_ascii() && c != '|' && c != '\0' {
                    c
                } else {
                    '?'
                }
            })
            .collect();
        let (Ok(offset), Ok(length)) = (
            u16::try_from(self.ascii.len()),
            u16::try_from(text.len() + 1),
        ) else {
            return;
        };
        if !text.is_empty() {
            self.ascii += &text;
            self.ascii.push('|');
            self.entries.push([id, ASCII, length, offset]);
        }
    }

    fn unit(&mut self, unit: &Unit, (code, size): (u16, u16)) {
        match unit.code() {
            // GDAL uses this code for degrees, and older readers know no other.
            Some(9122) => self.short(code, 9102),
            Some(known) => self.short(code, known),
            None => {
                self.short(code, USER_DEFINED);
                self.double(size, unit.factor);
            }
        }
    }

    fn user_defined_projected(&mut self, crs: &Crs) {
        let definition = crs.definition();
        let known = match definition
            .as_ref()
            .and_then(|definition| definition.projection.as_ref())
        {
            Some(Projection::Known(method, values)) => {
                method.row().geokey.map(|code| (method.row(), code, values))
            }
            _ => None,
        };
        let (Some(definition), Some((row, code, values))) = (&definition, known) else {
            // Like GDAL: no keys for the projection, and the definition as text.
            self.short(key::MODEL_TYPE, USER_DEFINED);
            if definition.is_some() {
                self.text(
                    key::PROJECTED_CITATION,
                    &format!("{PE_STRING}{}", crs.to_prj()),
                );
            }
            return;
        };
        self.short(key::MODEL_TYPE, 1);
        self.short(key::PROJECTED, USER_DEFINED);
        self.user_defined_datum(definition);
        self.unit(&definition.angle, (key::ANGLE, key::ANGLE_SIZE));
        self.text(key::PROJECTED_CITATION, &crs.name);
        self.short(key::CONVERSION, USER_DEFINED);
        self.short(key::METHOD, code);
        for ((param, _, _, id), value) in row.params.iter().zip(values) {
            let value = match param.measure() {
                Measure::Angle => value / definition.angle.factor.to_degrees(),
                Measure::Length => value / definition.unit.factor,
                Measure::Ratio => *value,
            };
            // Its presence would mean a Mercator projection defined by a parallel.
            let is_absent = row.method == Method::Mercator && *param == Param::Lat1 && value == 0.0;
            if is_absent {
                continue;
            }
            self.double(*id, value);
        }
    }

    fn user_defined_datum(&mut self, definition: &Definition) {
        let short = |code: Option<u32>| {
            code.and_then(|code| u16::try_from(code).ok())
                .unwrap_or(USER_DEFINED)
        };
        let geographic = short(definition.geographic.1);
        self.short(key::GEODETIC, geographic);
        if geographic != USER_DEFINED {
            return;
        }
        let datum = &definition.datum;
        self.text(key::GEODETIC_CITATION, &definition.geographic.0);
        self.short(key::DATUM, short(datum.code));
        self.double(key::SEMI_MAJOR, datum.ellipsoid.a);
        self.double(key::INVERSE_FLATTENING, datum.ellipsoid.rf);
        self.double(key::MERIDIAN, datum.meridian);
    }

    fn finish(mut self) -> GeoKeys {
        self.entries.sort_by_key(|entry| entry[0]);
        // Vertical keys need GeoTIFF 1.1: GDAL checks the revision.
        let revision = u16::from(self.entries.iter().any(|entry| entry[0] >= key::VERTICAL));
        let mut directory = vec![1, 1, revision, self.entries.len() as u16];
        directory.extend(self.entries.iter().flatten());
        GeoKeys {
            directory,
            doubles: self.doubles,
            ascii: self.ascii,
        }
    }
}
