//! What a job was planned for, option by option: another command must not go on with it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;
use std::path::Path;

use super::not_in_tiles::tiled;
use super::tile_options::TileOptions;
use crate::error::{Error, Result, Setting, Wording, wording};
use crate::io::points;
use crate::run::products::tin::TinRequest;
use crate::run::request::lines::{FlatOptions, LineRequest, WallOptions};
use crate::run::request::serialized::in_plan;
use crate::run::sources::checksum::checksum;
use crate::run::sources::proj::TransformOptions;
use crate::run::sources::systems::SystemOptions;
use crate::run::verbs::targets::Targets;
use crate::run::verbs::{Verb, WriteRequest};

/// The name of what decides which other options there are.
const VERB: &str = "the verb";

/// The name of what is read.
const INPUTS: &str = "the inputs";

/// The name of what is written.
const OUTPUT: &str = "the output";

/// The name of the table of replaced points.
const REPLACED: &str = "the table of replaced points";

/// The name under which the file of labels is listed.
const LABELS: &str = "the file of labels";

/// Between the names of settings that have one value.
const OR: &str = " or ";

/// What was asked for, by the names of settings, each with a sum of its value.
pub(super) type Options = BTreeMap<String, String>;

/// Returns what a request asks for, by which its job is known.
pub(super) fn asked(wanted: &WriteRequest, tiles: &TileOptions) -> Result<Options> {
    let (request, systems) = tiled(wanted)?;
    Ok(options_of(request, systems, wanted.verb.as_ref(), tiles))
}

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
        read:
            points::Options {
                columns,
                cut,
                detail,
                resolution,
            },
        classes,
        returns,
        ground,
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
    options.add(&[Setting::CopcResolution], resolution);
    options.add(&[Setting::Partial], cut);
    options.add(&[Setting::Class], classes);
    options.add(&[Setting::Return], returns);
    options.add(&[Setting::Ground], ground);
    options.add(&[Setting::Breaklines], breaklines);
    options.add(&[Setting::Boundary], boundary);
    options.add(&[Setting::Bounds], &bounds.map(in_plan::corners));
    options.add(&[Setting::MaxEdge], max_edge);
    options.add(&[Setting::MaxEdgeInside], max_edge_inside);
    options.add(&[Setting::FlatPoints], replaced);
    options.add(&[Setting::Duplicates], duplicates);
    options.add(&[Setting::OnCrossing], on_crossing);
    options.add(&[Setting::CrossingZ], crossing_heights);
    options.add(&[Setting::CrossingTolerance], crossing_tolerance);
    options.add_lines(lines);
    let SystemOptions {
        assign,
        target,
        degrees,
        transform: TransformOptions {
            require_grids,
            epoch,
        },
    } = systems;
    options.add(&[Setting::Crs], assign);
    options.add(&[Setting::TargetCrs], target);
    options.add(&[Setting::ForceDegrees], degrees);
    options.add(&[Setting::RequireGrids], require_grids);
    options.add(&[Setting::Epoch], epoch);
    verb.list(&mut |setting, value| options.add(&[setting], value));
    options.add(&[Setting::Tiles], &tiles.division);
    options.add(&[Setting::Memory], &tiles.memory);
    options.0
}

/// Takes what is read out of some options.
pub(super) fn leave_out_inputs(options: &mut Options) {
    options.remove(INPUTS);
}

/// Adds what a command says of its outputs, and of files that cannot be read.
pub(super) fn add_targets(options: &mut Options, targets: &Targets, tiles: &TileOptions) {
    let Targets {
        files,
        existing,
        crossings,
        replaced,
        labels,
        also_read: _,
        driver,
    } = targets;
    let mut listed = Listed(std::mem::take(options));
    listed.put(OUTPUT, files);
    listed.add(&[Setting::Overwrite], existing);
    listed.add(&[Setting::CrossingReport], crossings);
    listed.put(REPLACED, replaced);
    // Jobs that began before this option keep their lists.
    if labels.is_some() {
        listed.put(LABELS, labels);
    }
    if !driver.is_default() {
        listed.add(&[Setting::Driver], driver);
    }
    listed.add(&[Setting::SkipBad], &tiles.bad);
    *options = listed.0;
}

/// Returns the error for a folder whose job is that of another command.
#[cold]
pub(super) fn other_command(planned: &Options, now: &Options, folder: &Path) -> Error {
    let what = wording![
        "the job in this folder is that of another command; what differs: ",
        differing(planned, now)
    ];
    Error::other_job(what).in_file(folder).cure(wording![
        "repeat that command, or name another folder (",
        Setting::Job,
        ")"
    ])
}

/// Returns what differs, for a sentence.
pub(super) fn differing(planned: &Options, now: &Options) -> Wording {
    // That of another verb has other options in any case.
    if planned.get(VERB) != now.get(VERB) {
        return VERB.into();
    }
    let names = planned
        .keys()
        .chain(now.keys())
        .filter(|name| planned.get(*name) != now.get(*name));
    let names: BTreeSet<&str> = names.map(String::as_str).collect();
    let mention = |name: &str| Setting::from_name(name).map_or_else(|| name.into(), Wording::from);
    Wording::join(
        names
            .into_iter()
            .map(|names| Wording::join(names.split(OR).map(mention), OR)),
        ", ",
    )
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
        let before = self.0.insert(
            name.to_owned(),
            format!("{:08x}", checksum(format!("{value:?}").as_bytes())),
        );
        debug_assert!(before.is_none(), "{name} is listed twice");
    }

    fn add_lines(&mut self, lines: &LineRequest) {
        let LineRequest {
            soft,
            draped,
            walls,
            wall: WallOptions { lower, width, high },
            holes,
            flats,
            flat:
                FlatOptions {
                    height,
                    tolerance,
                    buffer,
                },
            rivers,
            river_width,
            densify,
            add_ridges,
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
        self.add(&[Setting::AddRidges], add_ridges);
    }
}
