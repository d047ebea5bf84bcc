//! What a task finds out: the facts at the end of its file.

use serde::{Deserialize, Serialize};

use super::planned_file::FileState;
use crate::data::Bounds;
use crate::error::Wording;
use crate::run::context::notice::{Notice, Severity};
use crate::terrain::{LostAtRim, LostCaps};

/// The facts of a task. Tasks of one kind have some of them; the others have their defaults.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct TaskFacts {
    /// What was assumed and what looks wrong.
    pub(super) notices: Vec<TaskNotice>,
    /// The file of points that the task reads, if it reads one.
    pub(super) file: Option<FileFacts>,
    /// Edges on lines.
    pub(super) line_edges: u64,
    /// Points merged into another one at the same site.
    pub(super) duplicates: u64,
    /// Points replaced by the vertex of a line at the same site.
    pub(super) points_on_breaklines: u64,
    /// The largest coordinates of points on both axes, without their signs.
    pub(super) reach: [f64; 2],
    /// The extents of files that were skipped, as far as the task knows.
    pub(super) holes: Vec<Hole>,
    /// Vertices that were handed up.
    pub(super) handed_up: u64,
    /// Triangles that wait for the decision about the rim, and the groups of these.
    pub(super) waiting: u64,
    pub(super) groups: u32,
    /// Triangles that were removed at the rim.
    pub(super) removed: u64,
    /// What the surface loses at its rim, as the task of the rim finds it.
    pub(super) lost_at_rim: Option<LostAtRimFacts>,
    /// Triangles that were left out because they reach into the extents of skipped files.
    pub(super) over_skipped: u64,
    /// The triangles that stay.
    pub(super) kept: KeptFacts,
    /// Triangles that clip lines cut or leave out, and those that draped lines meet.
    pub(super) met: u64,
    pub(super) draped: u64,
}

/// What a surface loses at its rim: the share of the hull; and with caps: their number, their share
/// of the area, and the number of vertices.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct LostAtRimFacts(f64, u64, f64, u64);

impl From<LostAtRim> for LostAtRimFacts {
    fn from(LostAtRim { share, caps }: LostAtRim) -> Self {
        LostAtRimFacts(share, caps.faces, caps.share, caps.vertices)
    }
}

impl From<LostAtRimFacts> for LostAtRim {
    fn from(LostAtRimFacts(share, faces, of_caps, vertices): LostAtRimFacts) -> Self {
        let caps = LostCaps {
            faces,
            share: of_caps,
            vertices,
        };
        LostAtRim { share, caps }
    }
}

/// The corners of a box in plan.
pub(super) type Hole = [[f64; 2]; 2];

/// A file of points, as a task has found it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) enum FileFacts {
    /// It was read.
    Read(ReadFacts),
    /// It is skipped, and why.
    Skipped(String),
}

/// What the points of a file say.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct ReadFacts {
    /// The file, as it was read.
    pub(super) state: FileState,
    /// Points that were read and used, and those that were left out.
    pub(super) read: u64,
    pub(super) used: u64,
    pub(super) withheld: u64,
    pub(super) other_return: u64,
    pub(super) other_class: u64,
    /// Points without a return, if only some returns are used.
    pub(super) without_return: u64,
    /// Those of the used ones that water and walls replace.
    pub(super) replaced: u64,
    /// Points without a class.
    pub(super) without_class: u64,
    /// The classes that some point has.
    pub(super) classes: Vec<u8>,
    /// The box around the points that are used.
    pub(super) extent: Extent,
    /// The warnings of the transform that reprojects them.
    pub(super) of_transform: Vec<String>,
    /// Lines that may be shores: their numbers, how many points within have other heights, and the
    /// largest difference.
    pub(super) rings: Vec<(usize, u64, f64)>,
}

/// What stays of the triangles of a task.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct KeptFacts {
    /// The number of triangles.
    pub(super) triangles: u64,
    /// Triangles that no clip line comes near and that were left out.
    pub(super) clipped: u64,
    /// The area in plan; `None` if it is not finite.
    pub(super) area: Option<f64>,
    /// The box around the triangles.
    pub(super) extent: Extent,
    /// The number of edges of contours.
    pub(super) contour_edges: u64,
}

/// The corners of a box; `None` if it is empty.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Extent(Option<[[f64; 3]; 2]>);

impl Extent {
    pub(super) fn of(bounds: &Bounds) -> Self {
        Extent((!bounds.is_empty()).then_some([bounds.min, bounds.max]))
    }

    /// Extends a box by this one.
    pub(super) fn add_to(self, bounds: &mut Bounds) {
        self.0
            .into_iter()
            .flatten()
            .for_each(|corner| bounds.add(corner));
    }
}

impl TaskFacts {
    /// Returns what the points of a file say, if the task has read one.
    pub(super) fn read(&self) -> Option<&ReadFacts> {
        match &self.file {
            Some(FileFacts::Read(read)) => Some(read),
            Some(FileFacts::Skipped(_)) | None => None,
        }
    }

    /// Returns why the task has skipped its file of points, if it has.
    pub(super) fn skipped(&self) -> Option<&str> {
        match &self.file {
            Some(FileFacts::Skipped(why)) => Some(why),
            Some(FileFacts::Read(_)) | None => None,
        }
    }
}

/// A notice as the file of a task keeps it: its level, its text and its details.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct TaskNotice(usize, Wording, Vec<Wording>);

/// The levels of notices by their numbers in the file of a task.
const SEVERITIES: [Severity; 3] = [Severity::Detail, Severity::Note, Severity::Warning];

impl TaskNotice {
    pub(super) fn of(notice: &Notice) -> Self {
        let level = SEVERITIES
            .iter()
            .position(|severity| *severity == notice.severity());
        TaskNotice(level.unwrap_or_default(), notice.text(), notice.details())
    }

    /// Returns the notice; `None` if the number of its severity is not known.
    pub(super) fn notice(&self) -> Option<Notice> {
        let TaskNotice(level, text, details) = self;
        let severity = *SEVERITIES.get(*level)?;
        Some(Notice::OfTask {
            severity,
            text: text.clone(),
            details: details.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_come_back_as_they_were() {
        let mut bounds = Bounds::default();
        bounds.add([0.1, -2e300, 5.0]);
        let read = ReadFacts {
            state: FileState {
                size: u64::MAX,
                modified: 7,
                beside: 0,
            },
            classes: vec![2, 255],
            extent: Extent::of(&bounds),
            rings: vec![(3, 4, 0.1 + 0.2)],
            ..ReadFacts::default()
        };
        let note = Notice::NoEdgeLimit;
        let facts = [
            TaskFacts::default(),
            TaskFacts {
                file: Some(FileFacts::Read(read)),
                notices: vec![TaskNotice::of(&note)],
                ..TaskFacts::default()
            },
            TaskFacts {
                file: Some(FileFacts::Skipped("why".to_owned())),
                holes: vec![[[0.0; 2]; 2]],
                ..TaskFacts::default()
            },
        ];
        for facts in facts {
            let text = serde_json::to_string(&facts).unwrap();
            assert_eq!(serde_json::from_str::<TaskFacts>(&text).unwrap(), facts);
        }
        assert_eq!(
            TaskNotice::of(&note).notice().unwrap().to_string(),
            note.to_string()
        );
        assert!(
            serde_json::from_str::<TaskFacts>(r#"{"handed_down": 1}"#).is_err(),
            "a fact that nobody knows"
        );
        let mut again = Bounds::default();
        Extent::of(&bounds).add_to(&mut again);
        Extent::of(&Bounds::default()).add_to(&mut again);
        assert_eq!(again, bounds);
    }
}
