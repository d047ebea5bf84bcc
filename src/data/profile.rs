/// A point of a line on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinePoint {
    /// Its distance from the start of the line, along the line in plan.
    pub along: f64,
    /// Its position, with the height of the surface.
    pub at: [f64; 3],
}

/// A part of a line that is on a surface, from one end to the other: points in order, between which
/// the surface is straight.
pub type Stretch = Vec<LinePoint>;

/// The heights of one or several surfaces along a line.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Profile {
    /// The record of the line, counted from 1.
    pub record: usize,
    /// The part of the record, counted from 1, if it has several.
    pub part: Option<usize>,
    /// Where on its axis a cross-section is; `None` for a profile along the line itself.
    pub station: Option<Station>,
    /// The distances at which the line starts and ends: 0 and its length, or to both sides of the
    /// axis of a cross-section, negative to the left.
    pub range: [f64; 2],
    /// The parts of the line on each surface, in the order of [`Profiles::surfaces`].
    pub stretches: Vec<Vec<Stretch>>,
}

/// A distance along an axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Station {
    /// The distance, counted from what the axis starts with.
    pub at: f64,
    /// The distance as it is written, such as `0+050`.
    pub text: String,
}

/// The heights of surfaces along lines.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Profiles {
    /// What each surface is called.
    pub surfaces: Vec<String>,
    /// The profiles, in the order of the lines, and along an axis.
    pub list: Vec<Profile>,
    /// The symbols of the units of distances and of heights, such as `m`, if they are known.
    pub units: [Option<String>; 2],
    /// The length of a unit of heights in units of distances.
    pub height_unit: f64,
}

impl Profiles {
    /// Returns what a profile is of, for a title: `record 3, part 1`; of sections `station 0+050`,
    /// or `record 3, station 0+050` if they are across several lines.
    pub fn title(&self, profile: &Profile) -> String {
        let of = |profile: &Profile| (profile.record, profile.part);
        // The profiles are in the order of the lines.
        let is_one_line = self.list.first().map(of) == self.list.last().map(of);
        let line = match profile.part {
            Some(part) => format!("record {}, part {part}", profile.record),
            None => format!("record {}", profile.record),
        };
        match &profile.station {
            Some(station) if is_one_line => format!("station {}", station.text),
            Some(station) => format!("{line}, station {}", station.text),
            None => line,
        }
    }
}

impl Profile {
    /// Returns all its points, on all surfaces.
    pub fn points(&self) -> impl Iterator<Item = &LinePoint> {
        self.stretches.iter().flatten().flatten()
    }

    /// Returns the lowest and the highest height; `None` if nothing is on a surface.
    pub fn heights(&self) -> Option<[f64; 2]> {
        self.points().map(|p| p.at[2]).fold(None, |range, z| {
            let [low, high] = range.unwrap_or([z, z]);
            Some([low.min(z), high.max(z)])
        })
    }
}
