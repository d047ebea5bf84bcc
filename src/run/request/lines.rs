//! Lines and areas of all kinds: what can be asked for.

use std::path::PathBuf;

use crate::data::{EdgeKind, Layer};
use crate::error::Setting;
use crate::terrain::HighSide;

use super::input::Input;

/// Lines and areas besides breaklines and the boundary. Where kinds meet, the first of these
/// counts: holes, flats, rivers, walls, breaklines, soft lines.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct LineRequest {
    /// Lines with heights whose edges are in the surface, but that smooth methods of interpolation
    /// pass over.
    pub soft: Vec<Input<Layer>>,
    /// Lines that get their heights from the finished surface.
    pub draped: Vec<Input<Layer>>,
    /// The upper edges of walls, with heights. A record with two parts is one wall: its upper and
    /// its lower edge, where they are drawn.
    pub walls: Vec<Input<Layer>>,
    /// Options of walls.
    pub wall: WallOptions,
    /// Areas without data: they are left out of the finished surface.
    pub holes: Vec<Input<Layer>>,
    /// Level water: polygons, or lines that close, each with one height.
    pub flats: Vec<Input<Layer>>,
    /// Options of level water.
    pub flat: FlatOptions,
    /// Rivers: a record with two parts is one river between two banks; otherwise each record is a
    /// bank, and two consecutive ones are one river.
    pub rivers: Vec<Input<Layer>>,
    /// The width of rivers: if it is given, each line runs along the middle of one.
    pub river_width: Option<PerRecord>,
    /// The largest distance in plan between vertices of breaklines and soft lines; more are added.
    pub densify: Option<f64>,
    /// Adds vertices on ridges and valleys, where triangles between contours would be flat.
    pub add_ridges: bool,
}

/// A number for all records, in units of the result, or the attribute that has one for each, in
/// units of its layer.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum PerRecord {
    /// This number.
    Number(f64),
    /// The numbers of this attribute.
    Field(String),
}

/// How the lower edge of a wall follows from the upper one, and where it lies.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WallOptions {
    /// The heights of the lower edge; `None` if each record has both edges.
    pub lower: Option<LowerEdge>,
    /// The distance between the edges in plan, in units of the coordinate system. `None` is 0.01
    /// metres.
    pub width: Option<f64>,
    /// The side of the line on which the ground is higher.
    pub high: HighSide,
}

/// The height of the lower edge of a wall.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum LowerEdge {
    /// The height itself.
    Height(PerRecord),
    /// How far it is below the upper edge.
    Drop(PerRecord),
}

/// The height of level water, and which points it replaces.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FlatOptions {
    /// The height.
    pub height: FlatRule,
    /// The largest difference between the heights of a shore that counts as level. `None` is 0.3
    /// metres, or 0.3 units if the unit is not known; rivers are then reported from 0.01 on.
    pub tolerance: Option<f64>,
    /// Points up to this distance outside of the shore are left out, too.
    pub buffer: f64,
}

/// Which height level water has.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum FlatRule {
    /// The lowest of its shore, which must be level within the tolerance.
    #[default]
    OfShore,
    /// The lowest of its shore.
    Lowest,
    /// The mean of the vertices of its shore.
    Mean,
    /// A number, or that of an attribute.
    Given(PerRecord),
}

/// What lines of a layer are used as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LineRole {
    /// Hard breaklines.
    Breaklines,
    /// Soft lines.
    Soft,
    /// Walls.
    Walls,
    /// Level water.
    Flats,
    /// Rivers.
    Rivers,
    /// Draped lines.
    Draped,
    /// Areas without data.
    Holes,
    /// The boundary.
    Boundary,
}

impl LineRole {
    /// Returns the setting that takes such lines.
    pub fn setting(self) -> Setting {
        match self {
            LineRole::Breaklines => Setting::Breaklines,
            LineRole::Soft => Setting::SoftLines,
            LineRole::Walls => Setting::Walls,
            LineRole::Flats => Setting::Flat,
            LineRole::Rivers => Setting::Rivers,
            LineRole::Draped => Setting::DrapedLines,
            LineRole::Holes => Setting::Holes,
            LineRole::Boundary => Setting::Boundary,
        }
    }

    /// Returns the kind of edges that such lines become; `None` for areas to clip to.
    pub(crate) fn edges(self) -> Option<EdgeKind> {
        match self {
            LineRole::Breaklines => Some(EdgeKind::Breakline),
            LineRole::Soft => Some(EdgeKind::Soft),
            LineRole::Walls => Some(EdgeKind::Wall),
            LineRole::Flats => Some(EdgeKind::Shore),
            LineRole::Rivers => Some(EdgeKind::Bank),
            LineRole::Draped => Some(EdgeKind::Draped),
            LineRole::Holes | LineRole::Boundary => None,
        }
    }
}

impl LineRequest {
    /// Returns true if there are lakes or rivers.
    pub(crate) fn has_water(&self) -> bool {
        !(self.flats.is_empty() && self.rivers.is_empty())
    }

    /// Returns the inputs with what they are used as.
    pub(crate) fn inputs(&self) -> [(LineRole, &[Input<Layer>]); 6] {
        [
            (LineRole::Soft, &self.soft),
            (LineRole::Walls, &self.walls),
            (LineRole::Flats, &self.flats),
            (LineRole::Rivers, &self.rivers),
            (LineRole::Draped, &self.draped),
            (LineRole::Holes, &self.holes),
        ]
    }

    /// Calls a function with the name of each file of lines.
    pub(crate) fn each_file(&mut self, visit: &mut dyn FnMut(&mut PathBuf)) {
        // Whoever adds files has to name them here.
        let LineRequest {
            soft,
            draped,
            walls,
            wall: _,
            holes,
            flats,
            flat: _,
            rivers,
            river_width: _,
            densify: _,
            add_ridges: _,
        } = self;
        for layers in [soft, draped, walls, holes, flats, rivers] {
            Input::each_file(layers, visit);
        }
    }

    /// Returns the attribute that is needed of each record.
    pub(crate) fn column(&self, role: LineRole) -> Option<&str> {
        let number = match role {
            LineRole::Walls => match self.wall.lower.as_ref()? {
                LowerEdge::Height(number) | LowerEdge::Drop(number) => number,
            },
            LineRole::Flats => match &self.flat.height {
                FlatRule::Given(number) => number,
                FlatRule::OfShore | FlatRule::Lowest | FlatRule::Mean => return None,
            },
            LineRole::Rivers => self.river_width.as_ref()?,
            _ => return None,
        };
        match number {
            PerRecord::Field(name) => Some(name),
            PerRecord::Number(_) => None,
        }
    }
}

impl PerRecord {
    /// Returns the number of a record, by its position in the layer; NaN if it has none.
    pub(crate) fn of(&self, layer: &Layer, at: usize) -> f64 {
        match self {
            PerRecord::Number(number) => *number,
            PerRecord::Field(name) => layer
                .column(name)
                .and_then(|column| column.values.get(at))
                .copied()
                .unwrap_or(f64::NAN),
        }
    }
}
