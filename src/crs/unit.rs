use std::f64::consts::PI;

/// A unit of length or angle.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Unit {
    /// The name, such as "metre", "US survey foot", "degree".
    pub name: String,
    /// Meters (or radians) in one unit.
    pub factor: f64,
}

/// EPSG code, name, factor.
const LENGTHS: &[(u16, &str, f64)] = &[
    (9001, "metre", 1.0),
    (9002, "foot", 0.3048),
    (9003, "US survey foot", 12.0 / 39.37),
    (9036, "kilometre", 1000.0),
    (1025, "millimetre", 0.001),
    (1033, "centimetre", 0.01),
    (9005, "Clarke's foot", 0.3047972654),
    (9095, "British foot (1936)", 0.3048007491),
    (9041, "British foot (Sears 1922)", 12.0 / 39.370147),
    (9051, "British foot (Benoit 1895 A)", 0.9143992 / 3.0),
    (9094, "Gold Coast foot", 6378300.0 / 20926201.0),
    (9080, "Indian foot", 12.0 / 39.370142),
    (9081, "Indian foot (1937)", 0.30479841),
    (9082, "Indian foot (1962)", 0.3047996),
    (9083, "Indian foot (1975)", 0.3047995),
    (9096, "yard", 0.9144),
    (9040, "British yard (Sears 1922)", 36.0 / 39.370147),
    (9084, "Indian yard", 36.0 / 39.370142),
    (9037, "Clarke's yard", 0.9143917962),
    (9097, "chain", 20.1168),
    (9033, "US survey chain", 792.0 / 39.37),
    (9042, "British chain (Sears 1922)", 792.0 / 39.370147),
    (9062, "British chain (Benoit 1895 B)", 792.0 / 39.370113),
    (9301, "British chain (Sears 1922 truncated)", 20.116756),
    (9038, "Clarke's chain", 20.1166195164),
    (9098, "link", 0.201168),
    (9034, "US survey link", 7.92 / 39.37),
    (9039, "Clarke's link", 0.201166195164),
    (9030, "nautical mile", 1852.0),
    (9093, "mile", 1609.344),
    (9035, "US survey mile", 63360.0 / 39.37),
    (9014, "fathom", 1.8288),
    (9031, "German legal metre", 1.0000135965),
];

const ANGLES: &[(u16, &str, f64)] = &[
    (9122, "degree", PI / 180.0),
    (9102, "degree", PI / 180.0),
    (9101, "radian", 1.0),
    (9105, "grad", PI / 200.0),
    (9106, "gon", PI / 200.0),
    (9103, "arc-minute", PI / 10800.0),
    (9104, "arc-second", PI / 648000.0),
    (9109, "microradian", 1e-6),
];

/// Names in formats for the units of the tables above, in lower case and with letters only.
const ALIASES: &[(&str, u16)] = &[
    ("m", 9001),
    ("meter", 9001),
    ("metres", 9001),
    ("meters", 9001),
    ("ft", 9002),
    ("feet", 9002),
    ("intlfoot", 9002),
    ("footinternational", 9002),
    ("internationalfoot", 9002),
    ("internationalfeet", 9002),
    ("footus", 9003),
    ("ftus", 9003),
    ("usft", 9003),
    ("ussurveyft", 9003),
    ("ussurveyfeet", 9003),
    ("surveyfoot", 9003),
    ("surveyfeet", 9003),
    ("footussurvey", 9003),
    ("kilometer", 9036),
    ("km", 9036),
    ("footclarke", 9005),
    ("clarkefoot", 9005),
    ("footsears", 9041),
    ("yardsears", 9040),
    ("chainsears", 9042),
    ("deg", 9122),
    ("degrees", 9122),
    ("decimaldegree", 9122),
    ("rad", 9101),
    ("grads", 9105),
];

/// The largest difference of the factors of equal units: smaller than the 2e-6 between the two
/// feet, larger than the rounding to the registry's 12 digits.
const SAME_FACTOR: f64 = 1e-10;

impl Unit {
    /// Creates a unit from a name and a factor.
    pub fn new(name: &str, factor: f64) -> Self {
        Unit {
            name: name.to_owned(),
            factor,
        }
    }

    /// Returns the meter.
    pub fn metre() -> Self {
        Self::new("metre", 1.0)
    }

    /// Returns the degree.
    pub fn degree() -> Self {
        Self::new("degree", PI / 180.0)
    }

    /// Returns the unit of length with a number of meters: a known unit with its exact factor, or
    /// an unnamed one.
    pub fn length(factor: f64) -> Self {
        Self::nearest(LENGTHS, factor)
            .unwrap_or_else(|| Self::new(&format!("unit of {factor} m"), factor))
    }

    /// Returns the unit of angle with a number of radians: a known unit with its exact factor, or
    /// an unnamed one.
    pub fn angle(factor: f64) -> Self {
        Self::nearest(ANGLES, factor)
            .unwrap_or_else(|| Self::new(&format!("unit of {factor} rad"), factor))
    }

    /// Returns the unit of length with an EPSG code.
    pub fn length_from_code(code: u16) -> Option<Self> {
        Self::from_code(LENGTHS, code)
    }

    /// Returns the unit of angle with an EPSG code.
    pub fn angle_from_code(code: u16) -> Option<Self> {
        Self::from_code(ANGLES, code)
    }

    /// Returns the unit of length with a name from any format: "Foot_US", "metres", "US survey
    /// foot".
    pub fn length_from_name(name: &str) -> Option<Self> {
        Self::from_name(LENGTHS, name)
    }

    /// Returns the unit of angle with a name from any format.
    pub fn angle_from_name(name: &str) -> Option<Self> {
        Self::from_name(ANGLES, name)
    }

    /// Returns the EPSG code of a known unit.
    pub fn code(&self) -> Option<u16> {
        LENGTHS
            .iter()
            .chain(ANGLES)
            .find(|(_, name, _)| *name == self.name)
            .map(|(code, ..)| *code)
    }

    /// Returns true if both have the same factor; names do not matter.
    pub fn is_same(&self, other: &Unit) -> bool {
        same_factor(self.factor, other.factor)
    }

    /// Returns true for feet of any kind.
    pub fn is_foot(&self) -> bool {
        (0.3047..0.3049).contains(&self.factor)
    }

    /// Returns the symbol to print after a number: "m", "ft", "ftUS", "deg", or the name.
    pub fn symbol(&self) -> &str {
        match self.name.as_str() {
            "metre" => "m",
            "kilometre" => "km",
            "foot" => "ft",
            "US survey foot" => "ftUS",
            "degree" => "deg",
            other => other,
        }
    }

    fn from_code(table: &[(u16, &str, f64)], code: u16) -> Option<Self> {
        table
            .iter()
            .find(|unit| unit.0 == code)
            .map(|&(_, name, factor)| Self::new(name, factor))
    }

    fn nearest(table: &[(u16, &str, f64)], factor: f64) -> Option<Self> {
        table
            .iter()
            .find(|unit| same_factor(unit.2, factor))
            .map(|&(_, name, factor)| Self::new(name, factor))
    }

    fn from_name(table: &[(u16, &str, f64)], name: &str) -> Option<Self> {
        let key = letters(name);
        if let Some(&(_, name, factor)) = table.iter().find(|unit| letters(unit.1) == key) {
            return Some(Self::new(name, factor));
        }
        let code = ALIASES.iter().find(|alias| alias.0 == key)?.1;
        Self::from_code(table, code)
    }
}

fn same_factor(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_FACTOR * a.abs().max(b.abs())
}

fn letters(name: &str) -> String {
    name.chars()
        .filter(char::is_ascii_alphabetic)
        .map(|c| c.to_ascii_lowercase())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::Unit;

    #[test]
    fn the_two_feet_are_told_apart_and_twelve_digits_are_enough() {
        assert_eq!(Unit::length(0.3048).name, "foot");
        for factor in [0.30480060960122, 0.304800609601219, 0.3048006096012192] {
            assert_eq!(Unit::length(factor).name, "US survey foot");
        }
        assert!(!Unit::length(0.3048).is_same(&Unit::length(0.3048006096)));
        assert_eq!(
            Unit::length_from_name("Foot_US").unwrap().code(),
            Some(9003)
        );
        assert_eq!(Unit::length_from_name("metres").unwrap(), Unit::metre());
        assert_eq!(Unit::angle_from_name("Degree").unwrap(), Unit::degree());
        assert_eq!(Unit::length_from_name("Degree"), None);
    }
}
