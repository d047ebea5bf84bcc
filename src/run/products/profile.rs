//! Heights of surfaces along lines, and across them.

use std::path::{Path, PathBuf};

use super::followed::{
    Coverage, PlanLine, Vertices, check_lengths, check_step, coverage, follow, in_plan, length,
    lines_of, no_line,
};
use super::station_format::StationFormat;
use super::surface::SurfaceProduct;
use super::together::common_system;
use crate::crs::Crs;
use crate::data::{Layer, Multiples, Profile, Profiles, Station, Stretch};
use crate::error::{Error, Result, Setting, wording};
use crate::io::profiles::{self, PlotOptions};
use crate::io::{Destination, OnDamage};
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Context, Journal};
use crate::run::lines::layers;
use crate::run::lines::shapes::{self, Drawn};
use crate::run::request::input::Input;
use crate::run::sources::systems::reproject_first;
use crate::terrain::{SectionWidths, crossing_pairs, sections, vertices_along};

/// The cross-sections of a run, at most.
const MOST_SECTIONS: f64 = 1e5;

/// The largest multiple of an interval that is used: up to about 2^53, all are different numbers.
const MOST_MULTIPLES: f64 = 9e15;

/// The pairs of crossing sections that are counted, and those that are listed.
const MOST_PAIRS: usize = 1000;
const LISTED_PAIRS: usize = 5;

/// Which profiles are computed, and how.
#[derive(Debug, Clone)]
pub struct ProfileOptions {
    /// The lines to follow, or polygons, whose rings are lines.
    pub along: Input<Layer>,
    /// The coordinate system of the lines, whatever their file states.
    pub assign: Option<Crs>,
    /// The distance of points along a line. Without one, there is a point at each edge of a
    /// triangle that the line crosses, and the profile is exact everywhere.
    pub step: Option<f64>,
    /// Cross-sections of the lines instead of profiles along them.
    pub sections: Option<SectionOptions>,
    /// What the surfaces are called, such as the names of their files.
    pub names: Vec<PathBuf>,
}

/// Where cross-sections are, and how they lie.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionOptions {
    /// Where along each line.
    pub at: SectionStations,
    /// The station at which each line starts.
    pub start: f64,
    /// The lengths to the left and to the right of the line, seen along it.
    pub widths: [f64; 2],
    /// The angle in degrees from the direction of the line to the left half of a section; 90 is
    /// square to the line.
    pub angle: f64,
    /// How stations are written.
    pub format: StationFormat,
}

/// At which stations cross-sections are.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionStations {
    /// At all multiples of a distance.
    Every(f64),
    /// At these, which have to be on each line.
    At(Vec<f64>),
}

/// Heights of surfaces along lines.
#[derive(Debug)]
#[non_exhaustive]
pub struct ProfileProduct {
    /// The profiles.
    pub profiles: Profiles,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// A line with what its profile is called.
type Asked = (PlanLine, Profile);

/// Computes the heights of surfaces along lines, or along sections across them: exactly, at every
/// edge of a triangle. A raster is a surface between the centers of its cells.
///
/// # Errors
/// If there are no lines or none is on any of the surfaces, a coordinate is not finite, a length is
/// not above zero, a station is beyond its line, the coordinate systems differ or are in degrees
/// where sections are asked for, a file is damaged, and if the run is canceled.
///
/// # Complexity
/// That of [`Locator::new`](crate::terrain::Locator::new) for each surface, and of
/// [`Locator::along`](crate::terrain::Locator::along) for each line, on all threads.
pub fn profile(
    surfaces: &[&SurfaceProduct],
    options: &ProfileOptions,
    context: &Context,
) -> Result<ProfileProduct> {
    let journal = Journal::new(context);
    context.check()?;
    let along = std::slice::from_ref(&options.along);
    let layers = layers::read(along, &[], OnDamage::Refuse, &journal)?;
    let Some((path, layer)) = layers.first() else {
        return Err(Error::usage("there is no line"));
    };
    let name = |number: usize| {
        let unnamed = || PathBuf::from(format!("surface {}", number + 1));
        options.names.get(number).cloned().unwrap_or_else(unnamed)
    };
    let names: Vec<PathBuf> = (0..surfaces.len()).map(name).collect();
    let crs = common_system(
        names
            .iter()
            .map(PathBuf::as_path)
            .zip(surfaces.iter().copied()),
        (*path, &**layer),
        options.assign.as_ref(),
        &journal,
    )?;
    let units = Units::of(crs.as_ref());
    if options.sections.is_some() && units.is_angular() {
        return Err(
            Error::unsupported("the coordinates are in degrees: sections need lengths")
                .cure(reproject_first()),
        );
    }
    let drawn = lines_of(layer, path, Setting::Along)?;
    let asked = match &options.sections {
        None => drawn.iter().map(along_line).collect(),
        Some(sections) => across(&drawn, sections, path, &journal)?,
    };
    let (lines, list): (Vec<PlanLine>, Vec<Profile>) = asked.into_iter().unzip();
    let mut profiles = Profiles {
        surfaces: short_names(&names),
        list,
        units: units.symbols(),
        height_unit: units
            .in_metres()
            .map_or(1.0, |[plan, height]| height / plan),
    };
    let title = |line: usize| profiles.title(&profiles.list[line]);
    check_lengths(&lines, path, title, &journal)?;
    check_step(options.step, &lines)?;
    let step = options.step.map(|step| (step, Vertices::LeftOut));
    let count = |line: usize, stretch: &mut Stretch| {
        if let Some(sections) = &options.sections {
            count_from_axis(stretch, &lines[line], sections.widths);
        }
    };
    let mut any = false;
    for (surface, name) in surfaces.iter().zip(&names) {
        let found = follow(surface, &lines, count, step, context)?;
        any |= found.iter().any(|stretches| !stretches.is_empty());
        note_coverage(&lines, &found, &profiles, [path, name], &journal);
        for (stretches, profile) in found.into_iter().zip(&mut profiles.list) {
            profile.stretches.push(stretches);
        }
    }
    if !any {
        return Err(no_line(path, &names));
    }
    Ok(ProfileProduct {
        profiles,
        notices: journal.take(),
    })
}

/// Returns names of files without their folders, unless two would be equal.
fn short_names(names: &[PathBuf]) -> Vec<String> {
    let short = |name: &PathBuf| {
        let name = name.file_name().unwrap_or(name.as_os_str());
        name.to_string_lossy().into_owned()
    };
    let all: Vec<String> = names.iter().map(short).collect();
    let is_one = |name: &String| all.iter().filter(|other| *other == name).count() == 1;
    match all.iter().all(is_one) {
        true => all,
        false => names
            .iter()
            .map(|name| name.display().to_string())
            .collect(),
    }
}

/// Returns the line for a profile along itself.
fn along_line(drawn: &Drawn) -> Asked {
    let line = in_plan(std::slice::from_ref(drawn)).concat();
    let profile = Profile {
        record: drawn.record,
        part: drawn.part,
        range: [0.0, length(&line)],
        ..Profile::default()
    };
    (line, profile)
}

/// Returns the sections across lines.
fn across(
    drawn: &[Drawn],
    options: &SectionOptions,
    path: &Path,
    journal: &Journal,
) -> Result<Vec<Asked>> {
    check_sections(options)?;
    let across = SectionWidths {
        widths: options.widths,
        angle: options.angle,
    };
    let mut asked = Vec::new();
    for drawn in drawn {
        let axis = in_plan(std::slice::from_ref(drawn)).concat();
        let stations =
            stations(&axis, options).map_err(|e| shapes::at_record(e, path, drawn.record))?;
        // The difference of a station on the line can be beyond it by a rounding error.
        let length = length(&axis);
        let distance = |at: &f64| (at - options.start).max(0.0).min(length);
        let distances: Vec<f64> = stations.iter().map(distance).collect();
        let found = sections(&axis, &distances, &across);
        let lines: Vec<([[f64; 2]; 3], f64)> = found
            .into_iter()
            .zip(stations)
            .filter_map(|(line, at)| Some((line?, at)))
            .collect();
        note_crossings(&lines, options.format, (path, drawn.record), journal);
        asked.extend(lines.into_iter().map(|(line, at)| {
            let profile = Profile {
                record: drawn.record,
                part: drawn.part,
                station: Some(Station {
                    at,
                    text: options.format.text(at),
                }),
                range: [-options.widths[0], options.widths[1]],
                ..Profile::default()
            };
            (line.to_vec(), profile)
        }));
    }
    if asked.is_empty() {
        return Err(Error::usage("no line has a station at which a section is")
            .in_file(path)
            .cure(wording!["choose a shorter ", Setting::Interval]));
    }
    Ok(asked)
}

/// Adds a notice if sections across a line cross, which are given with their stations.
fn note_crossings(
    lines: &[([[f64; 2]; 3], f64)],
    format: StationFormat,
    (path, record): (&Path, usize),
    journal: &Journal,
) {
    let ends = lines.iter().map(|([left, _, right], _)| [*left, *right]);
    let pairs = crossing_pairs(&ends.collect::<Vec<_>>(), MOST_PAIRS);
    let counted = pairs.len().min(MOST_PAIRS);
    let listed = &pairs[..counted.min(LISTED_PAIRS)];
    if !listed.is_empty() {
        let text = |line: usize| format.text(lines[line].1);
        journal.add(Notice::SectionsCross {
            path: path.to_path_buf(),
            record,
            first: listed.iter().map(|pair| pair.map(text)).collect(),
            more: counted - listed.len(),
            are_all: pairs.len() == counted,
        });
    }
}

fn check_sections(options: &SectionOptions) -> Result<()> {
    let SectionOptions {
        at,
        start,
        widths: [left, right],
        angle,
        ..
    } = options;
    if !(*left >= 0.0 && *right >= 0.0 && left + right > 0.0 && (left + right).is_finite()) {
        return Err(Error::usage(format!(
            "sections of {left} to the left and {right} to the right: expected lengths, one of them above zero"
        )));
    }
    if !(*angle > 0.0 && *angle < 180.0) {
        return Err(Error::usage(format!(
            "an angle of {angle} degrees to the axis: expected one between 0 and 180"
        )));
    }
    let stations = match at {
        SectionStations::Every(interval) if !(*interval > 0.0 && interval.is_finite()) => {
            return Err(Error::usage(format!(
                "an interval of {interval}: expected a length above zero"
            )));
        }
        SectionStations::Every(_) => &[][..],
        SectionStations::At(stations) => stations,
    };
    match stations.iter().chain([start]).find(|at| !at.is_finite()) {
        Some(at) => Err(Error::usage(format!("{at} is not a station"))),
        None => Ok(()),
    }
}

/// Returns the stations of sections across an axis.
///
/// # Errors
/// If one that is asked for is beyond the axis, or there are too many.
fn stations(axis: &[[f64; 2]], options: &SectionOptions) -> Result<Vec<f64>> {
    let length = length(axis);
    let [first, last] = [options.start, options.start + length];
    match &options.at {
        SectionStations::At(stations) => {
            let is_beyond = |at: &&f64| !(first <= **at && **at <= last);
            match stations.iter().find(is_beyond) {
                Some(at) => Err(Error::usage(format!(
                    "station {} is beyond the line, which has {} to {}",
                    options.format.text(*at),
                    options.format.text(first),
                    options.format.text(last)
                ))
                .cure(wording![
                    "choose ",
                    Setting::Stations,
                    " on the line, or the ",
                    Setting::Start,
                    " at which it begins"
                ])),
                None => Ok(stations.clone()),
            }
        }
        SectionStations::Every(interval) => {
            let count = length / interval;
            if count.is_nan() || count > MOST_SECTIONS {
                return Err(Error::limit(format!(
                    "{:.0} sections along a line of {length}: at most {MOST_SECTIONS} are computed",
                    count
                ))
                .cure(wording!["choose a longer ", Setting::Interval]));
            }
            if first.abs().max(last.abs()) / interval > MOST_MULTIPLES {
                return Err(Error::usage(format!(
                    "stations from {first} on are not told apart at an interval of {interval}"
                ))
                .cure(wording![
                    "choose a ",
                    Setting::Start,
                    " nearer to zero, or a longer ",
                    Setting::Interval
                ]));
            }
            let number = (first / interval).ceil();
            // One more, as the first may be below by a rounding error.
            Ok((0..=count as u32 + 1)
                .map(|count| Multiples::of(*interval).at(number + f64::from(count)))
                .skip_while(|at| *at < first)
                .take_while(|at| *at <= last)
                .collect())
        }
    }
}

/// Counts the distances along a section from its axis, negative to the left. Its ends have its
/// widths as their distances, whatever the rounding errors of their positions.
fn count_from_axis(stretch: &mut Stretch, section: &PlanLine, [left, right]: [f64; 2]) {
    let [_, axis, end] = vertices_along(section)[..] else {
        return;
    };
    for point in stretch {
        point.along = match point.along {
            at if at <= 0.0 => 0.0 - left,
            at if at <= axis => (at - axis).max(-left),
            at if at >= end => right,
            at => (at - axis).min(right),
        };
    }
}

/// Adds notices about lines that are not on a surface, or only in part.
fn note_coverage(
    lines: &[PlanLine],
    found: &[Vec<Stretch>],
    profiles: &Profiles,
    [path, name]: [&Path; 2],
    journal: &Journal,
) {
    let titles = |wanted: Coverage| {
        let each = lines.iter().zip(found).zip(&profiles.list);
        let of = each.filter(|((line, stretches), _)| coverage(line, stretches) == wanted);
        of.map(|(_, profile)| profiles.title(profile))
            .collect::<Vec<String>>()
    };
    let (off, partly) = (titles(Coverage::Nothing), titles(Coverage::Part));
    let (path, name) = (path.to_path_buf(), name.display().to_string());
    if !off.is_empty() {
        journal.add(Notice::LinesOff(path.clone(), name.clone(), off));
    }
    if !partly.is_empty() {
        journal.add(Notice::LinesPartlyOff(path, name, partly));
    }
}

impl ProfileProduct {
    /// Writes the profiles in the format that the extension of `target` names: a table (.csv), a
    /// picture (.svg) or a drawing (.dxf).
    ///
    /// # Errors
    /// Those of [`profiles::write`].
    pub fn write(&self, target: Destination, plot: &PlotOptions) -> Result<()> {
        target.put_whole(|target| profiles::write(target, &self.profiles, plot))
    }
}
