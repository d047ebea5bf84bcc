//! How contours become those of a map.

use std::fmt::Debug;

use crate::error::{Error, Result, Setting};
use crate::terrain::{LabelTops, Levels, MapRules};

/// How contours become those of a map. The default leaves them exact.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct MapOptions {
    /// Where the rules start from; the others replace parts of it.
    pub preset: Option<MapPreset>,
    /// How far lines are smoothed; not at all if it is `None`.
    pub smooth: Option<Smoothing>,
    /// How far a vertex that is left out may be from the line, in the unit of the data.
    pub simplify: Option<f64>,
    /// Shorter lines are left out, with what they enclose; in the unit of the data.
    pub min_length: Option<f64>,
    /// Lines that enclose less, or cut off less at the rim, are left out: see [`MapRules`]. In
    /// squares of the unit of the data.
    pub min_area: Option<f64>,
    /// Keeps depressions, whatever they enclose.
    pub keep_depressions: bool,
    /// Every how many intervals a line is an index contour; the attribute is left out if it is
    /// `None`.
    pub index_every: Option<u32>,
    /// Writes the areas between the lines instead of the lines.
    pub bands: bool,
    /// Writes lines and labels without heights: only their attributes have these.
    pub without_heights: bool,
    /// Places labels on the index contours, or on all lines if none are marked.
    pub labels: Option<LabelTops>,
    /// The height of labels on the ground; two intervals if it is `None`.
    pub label_height: Option<f64>,
}

/// Rules that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum MapPreset {
    /// [`MapRules::cartographic`], and every fifth line is an index contour.
    Cartographic,
}

/// How far smoothed lines may be off the surface, in height.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Smoothing {
    /// Half of the interval: as far as lines can be without meeting those of other levels.
    HalfInterval,
    /// This far, in the unit of heights; a quarter of the interval is the custom for orienteering.
    Within(f64),
}

/// Every how many intervals the preset has an index contour.
const INDEX_EVERY: u32 = 5;

impl MapOptions {
    /// Returns true unless contours are exact, and lines with their heights are all that is wanted.
    pub fn is_asked_for(&self) -> bool {
        *self != MapOptions::default()
    }

    /// Calls a function with the setting and the value of each option that is not left at its
    /// default. The value for the file of labels is `true`: targets list its path.
    pub(crate) fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        let MapOptions {
            preset,
            smooth,
            simplify,
            min_length,
            min_area,
            keep_depressions,
            index_every,
            bands,
            without_heights,
            labels,
            label_height,
        } = self;
        let tops = labels.filter(|&tops| tops != LabelTops::default());
        let given: [(Setting, &dyn Debug, bool); 12] = [
            (Setting::Preset, preset, preset.is_some()),
            (Setting::Smooth, smooth, smooth.is_some()),
            (Setting::Simplify, simplify, simplify.is_some()),
            (Setting::MinLength, min_length, min_length.is_some()),
            (Setting::MinArea, min_area, min_area.is_some()),
            (
                Setting::KeepDepressions,
                keep_depressions,
                *keep_depressions,
            ),
            (Setting::IndexEvery, index_every, index_every.is_some()),
            (Setting::Bands, bands, *bands),
            (Setting::TwoDimensions, without_heights, *without_heights),
            (Setting::Labels, &tops, tops.is_some()),
            (Setting::LabelsOutput, &labels.is_some(), labels.is_some()),
            (Setting::LabelHeight, label_height, label_height.is_some()),
        ];
        for (setting, value, is_given) in given {
            if is_given {
                add(setting, value);
            }
        }
    }

    /// Returns true if lines are not exact: smoothed or simplified.
    pub(super) fn moves_lines(&self) -> bool {
        self.preset.is_some() || self.smooth.is_some() || self.simplify.is_some()
    }

    /// Returns the rules for these levels.
    pub fn to_rules(&self, levels: &Levels) -> MapRules {
        let interval = levels.interval();
        let from = match self.preset {
            Some(MapPreset::Cartographic) => MapRules::cartographic(interval),
            None => MapRules::default(),
        };
        let smooth = self.smooth.map(|smooth| match smooth {
            Smoothing::HalfInterval => 0.5 * interval,
            Smoothing::Within(height) => height,
        });
        MapRules {
            smooth: smooth.or(from.smooth),
            simplify: self.simplify.or(from.simplify),
            min_area: self.min_area.unwrap_or(from.min_area),
            min_length: self.min_length.unwrap_or(from.min_length),
            keep_depressions: self.keep_depressions,
            with_bands: self.bands,
        }
    }

    /// Returns an error if an option has a value that makes no sense.
    ///
    /// # Errors
    /// If index contours are every 0 intervals, or labels have no height.
    pub(crate) fn check(&self) -> Result<()> {
        if self.index_every == Some(0) {
            return Err(
                Error::usage("index contours every 0 levels").cure("mark every fifth, for example")
            );
        }
        match self.label_height {
            Some(height) if !(height.is_finite() && height > 0.0) => Err(Error::usage(format!(
                "the height of labels is {height}, expected a positive number"
            ))),
            _ => Ok(()),
        }
    }

    /// Returns every how many intervals there is an index contour, if any are marked.
    pub(super) fn index_step(&self) -> Option<u32> {
        let of_preset = self.preset.map(|MapPreset::Cartographic| INDEX_EVERY);
        self.index_every.or(of_preset)
    }
}
