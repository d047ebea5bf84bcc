//! What a job was planned for, option by option: another command must not go on with it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use super::TileOptions;
use crate::error::{Setting, Wording};
use crate::io::points;
use crate::run::checksum::checksum;
use crate::run::line_request::{FlatOptions, LineRequest, WallOptions};
use crate::run::systems::SystemOptions;
use crate::run::tin::TinRequest;
use crate::run::verbs::Verb;

/// The name of what decides which other options there are.
const VERB: &str = "the verb";

/// The name of what is read.
const INPUTS: &str = "the inputs";

/// Between the names of settings that have one value.
const OR: &str = " or ";

/// What was asked for, by the names of settings, each with a sum of its value.
pub(super) type Options = BTreeMap<String, String>;

/// Returns the options of a request.
pub(super) fn options_of(
    request: &TinRequest,
    systems: &SystemOptions,
    verb: &dyn Verb,
    tiles: &TileOptions,
) -> Options {
    let mut options = Listed(Options::new());
    options.put(VERB, &verb.name());
    // Whoever adds an option has to name it here.
    let TinRequest {
        points,
        read: points::Options { columns, cut, detail },
        classes,
        breaklines,
        boundary,
        lines,
        bounds,
        max_edge,
        max_edge_inside,
        replaced,
        duplicates,
        on_crossing,
        crossing_heights,
        crossing_tolerance,
    } = request;
    options.put(INPUTS, points);
    options.add(&[Setting::Columns, Setting::Parse], &(columns, detail));
    options.add(&[Setting::Partial], cut);
    options.add(&[Setting::Class], classes);
    options.add(&[Setting::Breaklines], breaklines);
    options.add(&[Setting::Boundary], boundary);
    options.add(&[Setting::Bounds], bounds);
    options.add(&[Setting::MaxEdge], max_edge);
    options.add(&[Setting::MaxEdgeInside], max_edge_inside);
    options.add(&[Setting::FlatPoints], replaced);
    options.add(&[Setting::Duplicates], duplicates);
    options.add(&[Setting::OnCrossing], on_crossing);
    options.add(&[Setting::CrossingZ], crossing_heights);
    options.add(&[Setting::CrossingTolerance], crossing_tolerance);
    options.add_lines(lines);
    let SystemOptions { assign, target, degrees } = systems;
    options.add(&[Setting::Crs], assign);
    options.add(&[Setting::TargetCrs], target);
    options.add(&[Setting::ForceDegrees], degrees);
    verb.list(&mut |setting, value| options.add(&[setting], value));
    options.add(&[Setting::Tiles], &tiles.division);
    options.add(&[Setting::Memory], &tiles.memory);
    options.0
}

/// Returns what differs, for a sentence.
pub(super) fn differing(planned: &Options, now: &Options) -> Wording {
    // That of another verb has other options in any case.
    if planned.get(VERB) != now.get(VERB) {
        return VERB.into();
    }
    let names = planned.keys().chain(now.keys()).filter(|name| planned.get(*name) != now.get(*name));
    let names: BTreeSet<&str> = names.map(String::as_str).collect();
    let mention = |name: &str| Setting::from_name(name).map_or_else(|| name.into(), Wording::from);
    Wording::join(names.into_iter().map(|names| Wording::join(names.split(OR).map(mention), OR)), ", ")
}

/// A list that grows.
struct Listed(Options);

impl Listed {
    /// Adds the value that one of several settings has.
    fn add(&mut self, settings: &[Setting], value: &dyn Debug) {
        let names: Vec<&str> = settings.iter().map(|setting| setting.name()).collect();
        self.put(&names.join(OR), value);
    }

    fn put(&mut self, name: &str, value: &dyn Debug) {
        self.0.insert(name.to_owned(), format!("{:08x}", checksum(format!("{value:?}").as_bytes())));
    }

    fn add_lines(&mut self, lines: &LineRequest) {
        let LineRequest {
            soft,
            draped,
            walls,
            wall: WallOptions { lower, width, high },
            holes,
            flats,
            flat: FlatOptions { height, tolerance, buffer },
            rivers,
            river_width,
            densify,
        } = lines;
        self.add(&[Setting::SoftLines], soft);
        self.add(&[Setting::DrapedLines], draped);
        self.add(&[Setting::Walls], walls);
        self.add(&[Setting::WallBottom, Setting::WallDrop], lower);
        self.add(&[Setting::WallWidth], width);
        self.add(&[Setting::WallHigh], high);
        self.add(&[Setting::Holes], holes);
        self.add(&[Setting::Flat], flats);
        self.add(&[Setting::FlatHeight], height);
        self.add(&[Setting::FlatTolerance], tolerance);
        self.add(&[Setting::FlatBuffer], buffer);
        self.add(&[Setting::Rivers], rivers);
        self.add(&[Setting::RiverWidth], river_width);
        self.add(&[Setting::Densify], densify);
    }
}
