//! Where plots of profiles have their axes and their grid.

use crate::data::{Profile, Profiles};
use crate::error::{Error, Result, Setting, wording};
use crate::io::options::plot::PlotOptions;

/// The height of the plot of the largest relief, as a part of the width of the longest line.
const RELIEF: f64 = 0.28;

/// The height of a plot, in widths, at most.
const TALLEST: f64 = 5.0;

/// The plots of a file, at most.
const MOST_PLOTS: usize = 1000;

/// The relief that counts as none, as a part of the largest height.
const LEVEL: f64 = 1e-9;

/// The distance of grid lines in height, at least, as a part of the largest height.
const FINEST: f64 = 1e-12;

/// The distance of grid lines, at least, in widths.
const GRID: [f64; 2] = [0.09, 0.03];

/// What all plots of a file have in common. A width is that of the longest line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    /// By how much heights are drawn larger than distances.
    pub(super) exaggeration: f64,
    /// The length of the longest line.
    pub(super) width: f64,
    /// How large a unit of heights is drawn, in units of distances.
    pub(super) height_scale: f64,
    /// The distances between lines of the grid, along the line and in height.
    pub(super) grid: [f64; 2],
    datum: Option<f64>,
}

/// The axes of a plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axes {
    /// The heights at the lower and the upper border.
    pub(super) heights: [f64; 2],
    /// The distances at the left and the right border.
    pub(super) range: [f64; 2],
}

impl Layout {
    /// Returns the layout for some profiles.
    ///
    /// # Errors
    /// If there are no profiles or too many, the exaggeration is not a number above zero, the datum
    /// is above a height, or a plot would be much higher than it is wide.
    pub(super) fn new(profiles: &Profiles, options: &PlotOptions) -> Result<Self> {
        if profiles.list.len() > MOST_PLOTS {
            return Err(Error::limit(format!(
                "{} profiles: at most {MOST_PLOTS} are drawn in a file",
                profiles.list.len()
            ))
            .cure("write a table (.csv), or draw fewer"));
        }
        let length = |profile: &Profile| profile.range[1] - profile.range[0];
        let width = profiles.list.iter().map(length).fold(0.0, f64::max);
        // What is not on a surface has no plot.
        let heights = || profiles.list.iter().filter_map(Profile::heights);
        let relief = |[low, high]: [f64; 2]| high - options.datum.unwrap_or(low).min(high);
        let relief = heights().map(relief).fold(0.0, f64::max);
        let highest = heights().flatten().map(f64::abs).fold(0.0, f64::max);
        if !(width > 0.0 && width.is_finite() && relief.is_finite()) {
            return Err(Error::usage("there is no profile to draw"));
        }
        let exaggeration = match options.exaggeration {
            Some(factor) if factor > 0.0 && factor.is_finite() => factor,
            Some(factor) => {
                return Err(Error::usage(format!(
                    "an exaggeration of {factor}: expected a number above zero"
                )));
            }
            // What is level but for rounding errors stays level.
            None if relief > LEVEL * highest => {
                let relief = relief * profiles.height_unit;
                let fits = at_most(RELIEF * width / relief);
                // Heights are not flattened unless a plot would be a tower.
                let least = if relief <= width { 1.0 } else { fits };
                fits.max(least)
            }
            None => 1.0,
        };
        let height_scale = exaggeration * profiles.height_unit;
        let layout = Layout {
            exaggeration,
            width,
            height_scale,
            grid: [
                at_least(GRID[0] * width),
                at_least(GRID[1] * width / height_scale),
            ],
            datum: options.datum,
        };
        let tallest = relief * height_scale / width;
        if tallest.is_nan() || tallest > TALLEST {
            return Err(Error::usage(format!(
                "heights over {relief} exaggerated {exaggeration} times: a plot would be {tallest:.0} times as high as it is wide"
            ))
            .cure(wording![
                "choose a smaller ",
                Setting::Exaggeration,
                ", or a higher ",
                Setting::Datum
            ]));
        }
        // So that all lines of the grid are at heights of their own, and finite.
        let finest = FINEST * highest.max(options.datum.map_or(0.0, f64::abs));
        if !(layout.grid[1] > finest && layout.grid[1].is_finite()) {
            return Err(Error::usage(format!(
                "heights up to {highest} exaggerated {exaggeration} times: the grid of a plot would be finer than numbers are"
            ))
            .cure(wording!["choose another ", Setting::Exaggeration]));
        }
        profiles
            .list
            .iter()
            .try_for_each(|profile| layout.check_datum(profiles, profile))?;
        Ok(layout)
    }

    fn check_datum(&self, profiles: &Profiles, profile: &Profile) -> Result<()> {
        match (self.datum, profile.heights()) {
            (Some(datum), Some([low, _])) if datum.is_nan() || datum > low => {
                Err(Error::usage(format!(
                    "a datum of {datum} is above the lowest height of {}, {low}",
                    profiles.title(profile)
                ))
                .cure(wording![
                    "choose a lower ",
                    Setting::Datum,
                    ", or leave it out"
                ]))
            }
            _ => Ok(()),
        }
    }

    /// Returns the axes of a plot: they end at lines of the grid.
    pub(super) fn axes(&self, profile: &Profile) -> Axes {
        let [low, high] = profile.heights().unwrap_or_default();
        let step = self.grid[1];
        let floor = |z: f64| (z / step).floor() * step;
        // Not on the axis itself, where a level line would hardly be seen.
        let below = if floor(low) == low {
            low - step
        } else {
            floor(low)
        };
        let bottom = self.datum.unwrap_or(below);
        let top = floor(high) + step;
        Axes {
            heights: [bottom, top],
            range: profile.range,
        }
    }

    /// Returns the lines of the grid along an axis (0) or in height (1), between two values.
    pub(super) fn lines(&self, axis: usize, [from, to]: [f64; 2]) -> Vec<f64> {
        let step = self.grid[axis];
        let first = (from / step - 1e-9).ceil();
        (0..)
            .map(|number| (first + f64::from(number)) * step)
            .take_while(|at| *at <= to + 1e-9 * step)
            .take(10_000)
            .collect()
    }

    /// Returns a value at a line of the grid as text.
    pub(super) fn label(&self, axis: usize, value: f64) -> String {
        let digits = (-self.grid[axis].log10().floor()).clamp(0.0, 15.0) as usize;
        let text = format!("{:.digits$}", value + 0.0);
        match text
            .trim_start_matches('-')
            .chars()
            .all(|c| matches!(c, '0' | '.'))
        {
            true => text.trim_start_matches('-').to_owned(),
            false => text,
        }
    }

    /// Returns what a plot states of its heights: `vertical exaggeration 5 : 1, datum 120 m`.
    pub(super) fn note(&self, axes: &Axes, unit: Option<&str>) -> String {
        let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
        let datum = number(axes.heights[0]);
        format!(
            "vertical exaggeration {} : 1, datum {datum}{unit}",
            number(self.exaggeration)
        )
    }
}

/// Returns a number with as many digits as it needs, at most nine decimals.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a number.
fn at_most(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let factor = [5.0, 2.0]
        .into_iter()
        .find(|factor| factor * power <= value * (1.0 + 1e-12));
    round(factor.unwrap_or(1.0) * power)
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below a number.
fn at_least(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= value * (1.0 - 1e-12));
    round(factor.unwrap_or(10.0) * power)
}

/// Removes the rounding errors of a power.
fn round(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_numbers_are_next_to_a_number() {
        for (value, below, above) in [
            (1.0, 1.0, 1.0),
            (3.7, 2.0, 5.0),
            (0.07, 0.05, 0.1),
            (9999.0, 5000.0, 10000.0),
            (0.002, 0.002, 0.002),
        ] {
            assert_eq!((at_most(value), at_least(value)), (below, above), "{value}");
        }
    }
}
