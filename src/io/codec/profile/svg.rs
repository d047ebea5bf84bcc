//! Profiles as plots, one below the other.

use std::fmt::Write as _;

use super::layout::{Axes, Layout};
use crate::data::{Profile, Profiles};

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
    if profile.heights().is_none() {
        let at = [MARGINS[0], top - 10.0];
        text(
            body,
            "name",
            at,
            "start",
            &format!("{}: not on a surface", profiles.title(profile)),
        );
        return 0.0;
    }
    let axes = layout.axes(profile);
    let Axes { heights, range } = axes;
    let scale = WIDTH / layout.width;
    let height = (heights[1] - heights[0]) * layout.height_scale * scale;
    let x = |along: f64| MARGINS[0] + (along - range[0]) * scale;
    let y = |z: f64| top + (heights[1] - z) * layout.height_scale * scale;
    let (left, right, bottom) = (x(range[0]), x(range[1]), top + height);
    let [plan_unit, height_unit] = profiles.units.each_ref().map(Option::as_deref);

    text(
        body,
        "name",
        [left, top - 10.0],
        "start",
        &profiles.title(profile),
    );
    let note = layout.note(&axes, height_unit);
    text(body, "note", [MARGINS[0] + WIDTH, top - 10.0], "end", &note);
    for z in layout.lines(1, heights) {
        line(body, "grid", [left, y(z)], [right, y(z)]);
        text(
            body,
            "number",
            [left - 8.0, y(z) + 4.0],
            "end",
            &layout.label(1, z),
        );
    }
    for along in layout.lines(0, range) {
        let is_axis = profile.station.is_some() && along == 0.0;
        let class = if is_axis { "zero" } else { "grid" };
        line(body, class, [x(along), top], [x(along), bottom]);
        text(
            body,
            "number",
            [x(along), bottom + 17.0],
            "middle",
            &layout.label(0, along),
        );
    }
    let (width, down) = (right - left, bottom - top);
    let _ = writeln!(
        body,
        "<rect class=\"axis\" x=\"{left:.2}\" y=\"{top:.2}\" width=\"{width:.2}\" height=\"{down:.2}\"/>"
    );
    for (number, stretches) in profile.stretches.iter().enumerate() {
        let look = look(number);
        for stretch in stretches {
            let mut points = String::new();
            for point in stretch {
                let _ = write!(points, "{:.2},{:.2} ", x(point.along), y(point.at[2]));
            }
            let points = points.trim_end();
            let _ = writeln!(
                body,
                "<polyline class=\"ground\"{look} points=\"{points}\"/>"
            );
        }
    }
    let what = match profile.station {
        Some(_) => "distance from the axis, negative to the left",
        None => "distance along the line",
    };
    text(
        body,
        "what",
        [(left + right) / 2.0, bottom + 36.0],
        "middle",
        &with_unit(what, plan_unit),
    );
    let (x, y) = (left - 62.0, (top + bottom) / 2.0);
    let _ = writeln!(
        body,
        "<text text-anchor=\"middle\" transform=\"translate({x:.2} {y:.2}) rotate(-90)\">{}</text>",
        escaped(&with_unit("height", height_unit))
    );
    height
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
    let mut found = String::new();
    for c in text.chars() {
        match c {
            '&' => found += "&amp;",
            '<' => found += "&lt;",
            '>' => found += "&gt;",
            '"' => found += "&quot;",
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => found.push(c),
        }
    }
    found
}
