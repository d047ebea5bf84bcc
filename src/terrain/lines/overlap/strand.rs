//! Lines of waters that get more vertices.

use super::scene::Scene;
use crate::terrain::lines::areas::WaterLevel;
use crate::terrain::nearest::nearest_part;
use crate::triangulation::num::unsigned_zero;

/// A line of a water, with the vertices that are to be inserted.
#[derive(Debug, Clone)]
pub(super) struct Strand {
    /// The number of the water whose heights it has.
    pub(super) water: usize,
    /// The number of the line; `None` if it is new.
    pub(super) line: Option<usize>,
    /// True if it is a part of the border of its water.
    pub(super) is_border: bool,
    pub(super) points: Vec<[f64; 3]>,
    /// True if vertices were inserted.
    pub(super) is_changed: bool,
    /// Vertices to insert, each with the number of its segment.
    wanted: Vec<(usize, [f64; 2])>,
}

impl Strand {
    /// A line that was given, with its number.
    pub(super) fn given(water: usize, line: usize, points: Vec<[f64; 3]>, is_border: bool) -> Self {
        Strand {
            water,
            line: Some(line),
            is_border,
            points,
            is_changed: false,
            wanted: Vec::new(),
        }
    }

    /// A new line.
    pub(super) fn new(water: usize, ends: [[f64; 3]; 2]) -> Self {
        let points = ends.to_vec();
        Strand {
            water,
            line: None,
            is_border: false,
            points,
            is_changed: false,
            wanted: Vec::new(),
        }
    }

    /// The segments, with their numbers.
    pub(super) fn segments(&self) -> impl Iterator<Item = (usize, [[f64; 3]; 2])> + '_ {
        self.points
            .windows(2)
            .map(|pair| [pair[0], pair[1]])
            .enumerate()
            .filter(|(_, [a, b])| a[..2] != b[..2])
    }

    /// Asks for a vertex on a segment.
    pub(super) fn want(&mut self, segment: usize, at: [f64; 2]) {
        self.wanted.push((segment, at.map(unsigned_zero)));
    }

    /// Inserts all vertices that were asked for, with the heights of the water.
    pub(super) fn insert(&mut self, scene: &Scene) {
        if self.wanted.is_empty() {
            return;
        }
        let part = |(segment, at): &(usize, [f64; 2])| {
            nearest_part(
                [0, 1].map(|end| [self.points[segment + end][0], self.points[segment + end][1]]),
                *at,
            )
        };
        let mut wanted: Vec<(usize, f64, [f64; 2])> = self
            .wanted
            .iter()
            .map(|wanted| (wanted.0, part(wanted), wanted.1))
            .collect();
        wanted.sort_by(|p, q| {
            (p.0.cmp(&q.0))
                .then(p.1.total_cmp(&q.1))
                .then(p.2[0].total_cmp(&q.2[0]))
                .then(p.2[1].total_cmp(&q.2[1]))
        });
        self.wanted.clear();
        let mut points: Vec<[f64; 3]> = Vec::with_capacity(self.points.len() + wanted.len());
        let mut wanted = wanted.into_iter().peekable();
        for (segment, &point) in self.points.iter().enumerate() {
            points.push(point);
            let next = self.points.get(segment + 1);
            let first = points.len();
            while let Some((_, _, at)) = wanted.next_if(|wanted| wanted.0 == segment) {
                let is_there = [Some(&point), next]
                    .into_iter()
                    .flatten()
                    .any(|p| p[..2] == at)
                    || points[first..].last().is_some_and(|p| p[..2] == at);
                if !is_there {
                    points.push([at[0], at[1], scene.height(self.water, at)]);
                    self.is_changed = true;
                }
            }
        }
        self.points = points;
    }
}

impl Scene<'_> {
    /// The edges between the triangles of each stretch that takes part.
    pub(super) fn diagonals(&self) -> Vec<Strand> {
        let mut diagonals = Vec::new();
        for &[water, stretch] in &self.meetings.stretches {
            if let WaterLevel::River(river) = &self.waters[water].level {
                diagonals.extend(
                    river
                        .diagonals(stretch)
                        .into_iter()
                        .map(|ends| Strand::new(water, ends)),
                );
            }
        }
        diagonals
    }
}
