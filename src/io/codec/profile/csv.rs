//! Profiles as a table: a row for each point.

use std::io::{Result, Write};

use crate::data::Profiles;
use crate::io::bytes::lines::write_lines;
use crate::io::{Output, csv_field};
use crate::triangulation::num::unsigned_zero;

/// Writes the points of profiles: each with the record and the part of its line, the station of a
/// cross-section, the surface, the number of the stretch without a gap, the distance along the
/// line, and its position. Numbers read back as the same numbers.
pub(super) fn write(output: &mut Output, profiles: &Profiles) -> Result<()> {
    writeln!(output, "record,part,station,surface,stretch,distance,x,y,z")?;
    let mut stretches = Vec::new();
    for profile in &profiles.list {
        let part = profile.part.map_or(String::new(), |part| part.to_string());
        let station = profile.station.as_ref();
        let station = station.map_or(String::new(), |station| {
            unsigned_zero(station.at).to_string()
        });
        for (surface, of_surface) in profiles.surfaces.iter().zip(&profile.stretches) {
            let start = format!("{},{part},{station},{}", profile.record, csv_field(surface));
            let numbered = (1..).zip(of_surface);
            stretches
                .extend(numbered.map(|(number, stretch)| (format!("{start},{number}"), stretch)));
        }
    }
    let rows = stretches
        .iter()
        .flat_map(|(start, stretch)| stretch.iter().map(move |point| (start.as_str(), point)));
    write_lines(output, rows, |text, (start, point)| {
        let [x, y, z] = point.at.map(unsigned_zero);
        let along = unsigned_zero(point.along);
        writeln!(text, "{start},{along},{x},{y},{z}")
    })
}
