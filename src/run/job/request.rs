//! What a job was planned for, option by option: another command must not go on with it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use super::{TileOptions, TiledProduct};
use crate::io::points;
use crate::run::cells::{DemOptions, HillshadeOptions, LightOptions};
use crate::run::checksum::checksum;
use crate::run::contour::ContourOptions;
use crate::run::frame::FrameOptions;
use crate::run::line_request::{FlatOptions, LineRequest, WallOptions};
use crate::run::systems::SystemOptions;
use crate::run::tin::TinRequest;

/// The name of what decides which other options there are.
const VERB: &str = "the verb";

/// Options by their names on the command line, each with a sum of its value.
pub(super) type Options = BTreeMap<String, String>;

/// Returns the options of a request.
pub(super) fn options_of(
    request: &TinRequest,
    systems: &SystemOptions,
    product: &TiledProduct,
    tiles: &TileOptions,
) -> Options {
    let mut options = Listed(Options::new());
    options.add(VERB, &product.name());
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
    options.add("the inputs", points);
    options.add("--columns or --parse", &(columns, detail));
    options.add("--partial", cut);
    options.add("--class", classes);
    options.add("--breaklines", breaklines);
    options.add("--boundary", boundary);
    options.add("--bounds", bounds);
    options.add("--max-edge", max_edge);
    options.add("--max-edge-inside", max_edge_inside);
    options.add("--flat-points", replaced);
    options.add("--duplicates", duplicates);
    options.add("--on-crossing", on_crossing);
    options.add("--crossing-z", crossing_heights);
    options.add("--crossing-tolerance", crossing_tolerance);
    options.add_lines(lines);
    let SystemOptions { assign, target, degrees } = systems;
    options.add("--a-srs", assign);
    options.add("--t-srs", target);
    options.add("--force-degrees", degrees);
    options.add_product(product);
    options.add("--tiles", &tiles.division);
    options.add("--memory", &tiles.memory);
    options.0
}

/// Returns the names of the options that differ, for a sentence.
pub(super) fn differing(planned: &Options, now: &Options) -> String {
    // That of another verb has other options in any case.
    if planned.get(VERB) != now.get(VERB) {
        return VERB.to_owned();
    }
    let names = planned.keys().chain(now.keys()).filter(|name| planned.get(*name) != now.get(*name));
    let names: BTreeSet<&str> = names.map(String::as_str).collect();
    names.into_iter().collect::<Vec<_>>().join(", ")
}

/// A list that grows.
struct Listed(Options);

impl Listed {
    fn add(&mut self, name: &str, value: &dyn Debug) {
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
        self.add("--soft-lines", soft);
        self.add("--draped-lines", draped);
        self.add("--walls", walls);
        self.add("--wall-bottom or --wall-drop", lower);
        self.add("--wall-width", width);
        self.add("--wall-high", high);
        self.add("--holes", holes);
        self.add("--flat", flats);
        self.add("--flat-height", height);
        self.add("--flat-tolerance", tolerance);
        self.add("--flat-buffer", buffer);
        self.add("--rivers", rivers);
        self.add("--river-width", river_width);
        self.add("--densify", densify);
    }

    fn add_product(&mut self, product: &TiledProduct) {
        match product {
            TiledProduct::Heights(DemOptions { frame, method }) => {
                self.add_frame(frame);
                self.add("--method", method);
            }
            TiledProduct::Shades(HillshadeOptions { frame, method, light }) => {
                let LightOptions { azimuth, altitude, z_factor } = light;
                self.add_frame(frame);
                self.add("--method", method);
                self.add("--azimuth", azimuth);
                self.add("--altitude", altitude);
                self.add("--z-factor", z_factor);
            }
            TiledProduct::Contours(ContourOptions { interval, base, levels }) => {
                self.add("--interval", interval);
                self.add("--base", base);
                self.add("--levels", levels);
            }
            TiledProduct::Surface => {}
        }
    }

    fn add_frame(&mut self, FrameOptions { resolution, extent, align_to }: &FrameOptions) {
        self.add("--resolution", resolution);
        self.add("--te", extent);
        self.add("--align-to", align_to);
    }
}
