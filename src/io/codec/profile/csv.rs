//! Profiles as a table: a row for each point.

use std::io::{Result, Write};

use crate::data::{Profiles, Stretch};
use crate::io::csv_field;
use crate::triangulation::num::unsigned_zero;

/// Writes the points of profiles: each with the record and the part of its line, the station of a
/// cross-section, the surface, the number of the stretch without a gap, the distance along the
/// line, and its position. Numbers read back as the same numbers.
pub(super) fn write(out: &mut dyn Write, profiles: &Profiles) -> Result<()> {
    writeln!(out, "record,part,station,surface,stretch,distance,x,y,z")?;
    for profile in &profiles.list {
        let part = profile.part.map_or(String::new(), |part| part.to_string());
        let station = profile.station.as_ref();
        let station = station.map_or(String::new(), |station| {
            unsigned_zero(station.at).to_string()
        });
        for (surface, stretches) in profiles.surfaces.iter().zip(&profile.stretches) {
            let start = format!("{},{part},{station},{}", profile.record, csv_field(surface));
            for (number, stretch) in (1..).zip(stretches) {
                rows(out, &format!("{start},{number}"), stretch)?;
            }
        }
    }
    Ok(())
}

fn rows(out: &mut dyn Write, start: &str, stretch: &Stretch) -> Result<()> {
    stretch.iter().try_for_each(|point| {
        let [x, y, z] = point.at.map(unsigned_zero);
        writeln!(out, "{start},{},{x},{y},{z}", unsigned_zero(point.along))
    })
}
