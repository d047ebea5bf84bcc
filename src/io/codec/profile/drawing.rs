//! Profiles as a DXF drawing: plots one below the other, in units of distances.

use std::collections::BTreeSet;
use std::io::{Result, Write};

use super::layout::{Axes, Layout};
use crate::data::{Bounds, Profile, Profiles};
use crate::io::codec::dxf::{Align, Dxf, DxfLayer};

/// The height of texts, and the distance between plots, in widths of the longest line.
const TEXT: f64 = 0.012;
const BETWEEN: f64 = 0.1;

/// The layers before those of the surfaces.
const FRAME: usize = 0;
const GRID: usize = 1;
const TEXTS: usize = 2;
const SURFACES: usize = 3;

/// The colors of surfaces: blue, red, green, magenta, cyan, yellow.
const COLORS: [u8; 6] = [5, 1, 3, 6, 4, 2];

/// Writes the plots. Distances are x from 0 on, heights are y above the datum, exaggerated; z is 0.
pub(super) fn write(
    out: &mut dyn Write,
    profiles: &Profiles,
    layout: &Layout,
    title: Option<&str>,
) -> Result<()> {
    let mut taken = BTreeSet::new();
    let fixed = [("FRAME", 7), ("GRID", 8), ("TEXT", 7)];
    let mut layers = fixed
        .map(|(name, color)| DxfLayer::new(name, color, &mut taken))
        .to_vec();
    for (number, surface) in profiles.surfaces.iter().enumerate() {
        let color = COLORS[number % COLORS.len()];
        layers.push(DxfLayer::new(surface, color, &mut taken));
    }
    let height = |profile: &Profile| {
        let [low, high] = layout.axes(profile).heights;
        profile
            .heights()
            .map_or(0.0, |_| (high - low) * layout.height_scale)
    };
    let between = BETWEEN * layout.width;
    let all: f64 = profiles
        .list
        .iter()
        .map(|profile| height(profile) + between)
        .sum();
    let bounds = Bounds {
        min: [-between, -all, 0.0],
        max: [layout.width, between, 0.0],
    };
    let mut drawing = Dxf::begin(out, layers, &bounds)?;
    let size = TEXT * layout.width;
    if let Some(title) = title {
        let at = [0.0, 3.0 * size, 0.0];
        drawing.text(TEXTS, at, 1.5 * size, Align::Left, title)?;
    }
    let mut top = 0.0;
    for profile in &profiles.list {
        plot(&mut drawing, profiles, profile, layout, top)?;
        top -= height(profile) + between;
    }
    drawing.end()
}

/// Draws a plot below a height of the drawing.
fn plot(
    drawing: &mut Dxf<'_>,
    profiles: &Profiles,
    profile: &Profile,
    layout: &Layout,
    top: f64,
) -> Result<()> {
    let size = TEXT * layout.width;
    let title_at = [0.0, top + 0.5 * size, 0.0];
    if profile.heights().is_none() {
        let title = format!("{}: not on a surface", profiles.title(profile));
        return drawing.text(TEXTS, title_at, size, Align::Left, &title);
    }
    let axes = layout.axes(profile);
    let Axes { heights, range } = axes;
    let x = |along: f64| along - range[0];
    let y = |z: f64| top - (heights[1] - z) * layout.height_scale;
    let (right, bottom) = (x(range[1]), y(heights[0]));
    let note = layout.note(&axes, profiles.units[1].as_deref());
    let name = format!("{}, {note}", profiles.title(profile));
    drawing.text(TEXTS, title_at, size, Align::Left, &name)?;
    for z in layout.lines(1, heights) {
        drawing.line(GRID, [[0.0, y(z), 0.0], [right, y(z), 0.0]])?;
        let at = [-0.5 * size, y(z) - 0.4 * size, 0.0];
        drawing.text(TEXTS, at, 0.8 * size, Align::Right, &layout.label(1, z))?;
    }
    for along in layout.lines(0, range) {
        drawing.line(GRID, [[x(along), bottom, 0.0], [x(along), top, 0.0]])?;
        let at = [x(along), bottom - 1.5 * size, 0.0];
        drawing.text(
            TEXTS,
            at,
            0.8 * size,
            Align::Center,
            &layout.label(0, along),
        )?;
    }
    let corners = [
        [0.0, bottom],
        [right, bottom],
        [right, top],
        [0.0, top],
        [0.0, bottom],
    ];
    drawing.polyline(FRAME, corners.map(|[x, y]| [x, y, 0.0]))?;
    for (number, stretches) in profile.stretches.iter().enumerate() {
        for stretch in stretches {
            let points = stretch
                .iter()
                .map(|point| [x(point.along), y(point.at[2]), 0.0]);
            drawing.polyline(SURFACES + number, points)?;
        }
    }
    Ok(())
}
