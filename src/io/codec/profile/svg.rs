//! Profiles as plots, one below the other.

use std::fmt::Write as _;

use super::layout::{Axes, Layout};
use crate::data::{Profile, Profiles};
use crate::io::codec::xml;

/// The width of the drawing area of the longest line, in pixels.
const WIDTH: f64 = 880.0;
/// What is to the left and to the right of it.
const MARGINS: [f64; 2] = [80.0, 40.0];
/// What is above and below each plot: its title; its numbers and what they are.
const AROUND: [f64; 2] = [34.0, 56.0];
/// The height of a line of text.
const LINE: f64 = 20.0;

/// Colors that color-blind people can distinguish, too (Okabe and Ito 2008); the darker ones first.
const COLORS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#56b4e9", "#e69f00",
];
/// Dashes of surfaces after those with a color of their own.
const DASHES: [&str; 4] = ["", "8 4", "2 4", "10 4 2 4"];

const STYLE: &str = "text{font:12px sans-serif;fill:#222}.title{font-size:18px;font-weight:bold}\
.name{font-size:14px;font-weight:bold}.note{fill:#555}.grid{stroke:#ddd}.axis{stroke:#444;fill:none}\
.zero{stroke:#888;stroke-dasharray:6 3}.ground{fill:none;stroke-width:1.6;stroke-linejoin:round}";

/// Returns a drawing with the plot of each profile.
pub(super) fn drawing(profiles: &Profiles, layout: &Layout, title: Option<&str>) -> String {
    let mut body = String::new();
    let mut y = 16.0;
    if let Some(title) = title {
        y += 14.0;
        text(&mut body, "title", [MARGINS[0], y], "start", title);
        y += 16.0;
    }
    for (number, surface) in profiles.surfaces.iter().enumerate() {
        y += 4.0;
        let (from, to) = (MARGINS[0], MARGINS[0] + 36.0);
        let look = look(number);
        let _ = writeln!(
            body,
            "<line class=\"ground\" x1=\"{from}\" y1=\"{y:.1}\" x2=\"{to}\" y2=\"{y:.1}\"{look}/>"
        );
        text(&mut body, "legend", [to + 8.0, y + 4.0], "start", surface);
        y += LINE - 4.0;
    }
    for profile in &profiles.list {
        y += AROUND[0];
        y += plot(&mut body, profiles, profile, layout, y);
        y += AROUND[1];
    }
    let width = MARGINS[0] + WIDTH + MARGINS[1];
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{y:.0}\" viewBox=\"0 0 {width} {y:.0}\">\n\
         <style>{STYLE}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{body}</svg>\n"
    )
}

/// Draws a plot below a position, and returns its height.
fn plot(
    body: &mut String,
    profiles: &Profiles,
    profile: &Profile,
    layout: &Layout,
    top: f64,
) -> f64 {
    let title = profiles.title(profile);
    let title_at = [MARGINS[0], top - 10.0];
    if profile.heights().is_none() {
        let title = format!("{title}: not on a surface");
        text(body, "name", title_at, "start", &title);
        return 0.0;
    }
    let plot = Plot {
        axes: layout.axes(profile),
        layout,
        top,
    };
    text(body, "name", title_at, "start", &title);
    let note = layout.note(&plot.axes, profiles.units[1].as_deref());
    let note_at = [MARGINS[0] + WIDTH, top - 10.0];
    text(body, "note", note_at, "end", &note);
    plot.draw_grid(body, profile);
    plot.draw_surfaces(body, profile);
    plot.draw_names(body, profiles, profile);
    plot.height()
}

/// A plot: maps distances and heights to positions in the drawing.
struct Plot<'a> {
    layout: &'a Layout,
    axes: Axes,
    top: f64,
}

impl Plot<'_> {
    fn scale(&self) -> f64 {
        WIDTH / self.layout.width
    }

    fn x(&self, along: f64) -> f64 {
        MARGINS[0] + (along - self.axes.range[0]) * self.scale()
    }

    fn y(&self, z: f64) -> f64 {
        self.top + (self.axes.heights[1] - z) * self.layout.height_scale * self.scale()
    }

    fn height(&self) -> f64 {
        let [low, high] = self.axes.heights;
        (high - low) * self.layout.height_scale * self.scale()
    }

    /// Returns the borders: left, right and bottom.
    fn borders(&self) -> [f64; 3] {
        let [left, right] = self.axes.range.map(|along| self.x(along));
        [left, right, self.top + self.height()]
    }

    /// Draws the lines of the grid with their numbers, and the frame over them.
    fn draw_grid(&self, body: &mut String, profile: &Profile) {
        let Plot { layout, axes, top } = self;
        let [left, right, bottom] = self.borders();
        for z in layout.lines(1, axes.heights) {
            let y = self.y(z);
            line(body, "grid", [left, y], [right, y]);
            let at = [left - 8.0, y + 4.0];
            text(body, "number", at, "end", &layout.label(1, z));
        }
        for along in layout.lines(0, axes.range) {
            let x = self.x(along);
            let is_axis = profile.station.is_some() && along == 0.0;
            let class = if is_axis { "zero" } else { "grid" };
            line(body, class, [x, *top], [x, bottom]);
            let at = [x, bottom + 17.0];
            text(body, "number", at, "middle", &layout.label(0, along));
        }
        let (width, down) = (right - left, bottom - top);
        let _ = writeln!(
            body,
            "<rect class=\"axis\" x=\"{left:.2}\" y=\"{top:.2}\" width=\"{width:.2}\" height=\"{down:.2}\"/>"
        );
    }

    /// Draws the stretches of each surface.
    fn draw_surfaces(&self, body: &mut String, profile: &Profile) {
        for (number, stretches) in profile.stretches.iter().enumerate() {
            let look = look(number);
            for stretch in stretches {
                let mut points = String::new();
                for point in stretch {
                    let (x, y) = (self.x(point.along), self.y(point.at[2]));
                    let _ = write!(points, "{x:.2},{y:.2} ");
                }
                let points = points.trim_end();
                let _ = writeln!(
                    body,
                    "<polyline class=\"ground\"{look} points=\"{points}\"/>"
                );
            }
        }
    }

    /// Draws what the numbers at both axes are.
    fn draw_names(&self, body: &mut String, profiles: &Profiles, profile: &Profile) {
        let [left, right, bottom] = self.borders();
        let [plan_unit, height_unit] = profiles.units.each_ref().map(Option::as_deref);
        let what = match profile.station {
            Some(_) => "distance from the axis, negative to the left",
            None => "distance along the line",
        };
        let at = [(left + right) / 2.0, bottom + 36.0];
        text(body, "what", at, "middle", &with_unit(what, plan_unit));
        let (x, y) = (left - 62.0, (self.top + bottom) / 2.0);
        let _ = writeln!(
            body,
            "<text text-anchor=\"middle\" transform=\"translate({x:.2} {y:.2}) rotate(-90)\">{}</text>",
            escaped(&with_unit("height", height_unit))
        );
    }
}

/// Returns the attributes for the line of a surface.
fn look(surface: usize) -> String {
    let color = COLORS[surface % COLORS.len()];
    match DASHES[surface / COLORS.len() % DASHES.len()] {
        "" => format!(" stroke=\"{color}\""),
        dashes => format!(" stroke=\"{color}\" stroke-dasharray=\"{dashes}\""),
    }
}

fn line(body: &mut String, class: &str, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
    let _ = writeln!(
        body,
        "<line class=\"{class}\" x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\"/>"
    );
}

fn text(body: &mut String, class: &str, [x, y]: [f64; 2], anchor: &str, text: &str) {
    let _ = writeln!(
        body,
        "<text class=\"{class}\" x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\">{}</text>",
        escaped(text)
    );
}

fn with_unit(what: &str, unit: Option<&str>) -> String {
    unit.map_or(what.to_owned(), |unit| format!("{what} [{unit}]"))
}

/// Returns a text for XML. Characters that XML does not have are left out.
fn escaped(text: &str) -> String {
    let is_allowed = |c: &char| !(c.is_control() || matches!(*c, '\u{fffe}' | '\u{ffff}'));
    xml::escaped(&text.chars().filter(is_allowed).collect::<String>())
}
