//! From points and lines to the finished surface.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use super::sites::Sites;
use super::{Overlaps, TinBuilder};
use crate::data::{AT_ONCE, Bounds, EdgeKind};
use crate::error::{Error, Result, Setting, wording};
use crate::terrain::admitted::refused;
use crate::terrain::cancel::go_on;
use crate::terrain::crossings::{Pass, choose_heights, refuse};
use crate::terrain::lines::areas::{self, Leveled};
use crate::terrain::lines::kinds::LineKinds;
use crate::terrain::peel::{finite_faces, peel};
use crate::terrain::ridges::Contoured;
use crate::terrain::tin::Count;
use crate::terrain::window::uncertain;
use crate::terrain::{CrossingRule, Tin, TinReport};
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::{ConstrainedDelaunay, InputError, LineId};

impl TinBuilder {
    /// Builds the TIN.
    ///
    /// # Errors
    /// If a coordinate is not finite or outside of [`RANGE`](crate::triangulation::kernel::RANGE),
    /// there are more points than 32-bit numbers can count, the input does not span an area, lakes
    /// of different heights overlap or touch, or breaklines cross or differ in height where the
    /// rules refuse that.
    ///
    /// # Complexity
    /// O(n log n) in practice; about 80 bytes per point in addition to the input.
    pub fn build(self) -> Result<Tin> {
        self.build_named(&|line| format!("breakline {line}"), &AtomicBool::new(false))
    }

    /// Like [`build`](TinBuilder::build), but can be canceled, and with names for breaklines.
    ///
    /// Building stops once `cancel` is set. `name` returns what errors call a breakline, given its
    /// position among those that were added.
    ///
    /// # Errors
    /// Those of [`build`](TinBuilder::build), and one of kind
    /// [`Canceled`](crate::error::Kind::Canceled).
    pub fn build_named(
        mut self,
        name: &dyn Fn(usize) -> String,
        cancel: &AtomicBool,
    ) -> Result<Tin> {
        self.mark_overlaps();
        self.end_waters_at_points();
        let given = self.line_count();
        let overlaps = self.overlaps.take().unwrap_or_else(|| Overlaps {
            given,
            ..Overlaps::default()
        });
        let report = TinReport {
            points: self.points.len(),
            breaklines: overlaps.given,
            ..Default::default()
        };
        let mut build = Build {
            builder: self,
            overlaps,
            report,
            name,
            cancel,
        };
        build.check_coordinates()?;
        build.leave_out_replaced();
        let given = build.builder.given_heights();
        let (mut triangulation, disputed) = build.triangulate_with_ridges()?;
        build.choose_crossing_heights(&mut triangulation, disputed);
        let is_water = build.level_waters(&mut triangulation, given)?;
        go_on(cancel)?;
        let kinds = LineKinds::new(std::mem::take(&mut build.builder.line_kinds));
        let tin = Tin::new(triangulation, kinds, build.builder.crs.take());
        build.delimit(tin, &is_water)
    }

    /// The heights of the edges of walls and of the lines around waters.
    fn given_heights(&self) -> GivenHeights {
        GivenHeights {
            walls: self.walls(),
            rims: self.rims(),
        }
    }

    /// The numbers of the edges of walls, with the heights of their vertices; none if there is no
    /// water.
    fn walls(&self) -> Vec<(usize, Vec<f64>)> {
        let is_wall = |line: &usize| self.line_kinds[*line] == EdgeKind::Wall;
        if self.waters.is_empty() {
            Vec::new()
        } else {
            self.heights_of((0..self.line_count()).filter(is_wall))
        }
    }

    /// The numbers of the lines around waters, with the heights of their vertices.
    fn rims(&self) -> Vec<(usize, Vec<f64>)> {
        self.heights_of(
            self.waters
                .iter()
                .flat_map(|water| water.rim.iter().copied()),
        )
    }

    fn heights_of(&self, lines: impl Iterator<Item = usize>) -> Vec<(usize, Vec<f64>)> {
        lines
            .map(|line| (line, self.line(line).iter().map(|p| p[2]).collect()))
            .collect()
    }
}

/// The heights that some lines were given with, at each of their vertices, by the numbers of the
/// lines.
struct GivenHeights {
    /// The edges of walls. Empty without water: nothing else changes their heights.
    walls: Vec<(usize, Vec<f64>)>,
    /// The lines around waters.
    rims: Vec<(usize, Vec<f64>)>,
}

/// A surface that is being built.
struct Build<'a> {
    /// What is to be built; its points and lines move into the triangulation.
    builder: TinBuilder,
    overlaps: Overlaps,
    /// What is known so far.
    report: TinReport,
    /// What errors call a line that was added.
    name: &'a dyn Fn(usize) -> String,
    cancel: &'a AtomicBool,
}

impl Build<'_> {
    /// What errors call a line, given or added where waters overlap.
    fn name(&self, line: usize) -> String {
        (self.name)(self.overlaps.named(line))
    }

    /// Returns an error if a point or a vertex of a line has a coordinate that is not admitted.
    fn check_coordinates(&self) -> Result<()> {
        let TinBuilder {
            points,
            line_points,
            line_ends,
            ..
        } = &self.builder;
        let geometry: Terrain = Terrain::default();
        let bad = |p: &[f64; 3]| !geometry.admits(p) || !p[2].is_finite();
        let points_at_once = points.par_iter().with_min_len(AT_ONCE);
        if let Some(at) = points_at_once.position_first(bad) {
            return Err(refused(points[at]).at(format!("point {at}")));
        }
        if let Some(at) = line_points.iter().position(bad) {
            let line = line_ends.partition_point(|&end| end <= at);
            return Err(refused(line_points[at]).at(self.name(line)));
        }
        Ok(())
    }

    /// Removes the points in water and between the edges of walls, and reports where waters
    /// overlap.
    fn leave_out_replaced(&mut self) {
        let Build {
            builder,
            overlaps,
            report,
            ..
        } = self;
        if let Some(ended) = &builder.ended {
            report.waters_ended.clone_from(&ended.first_lines);
        }
        report.water_overlaps.clone_from(&overlaps.found);
        report
            .water_overlaps
            .retain(|overlap| overlap.step > builder.crossing_tolerance);
        builder.take_replaced_points();
        report.points_replaced = builder.replaced_points.len();
    }

    /// Triangulates all sites and lines, and once more with vertices on ridges and valleys if these
    /// are wanted.
    ///
    /// # Errors
    /// Those of [`triangulate`](Self::triangulate).
    fn triangulate_with_ridges(&mut self) -> Result<(ConstrainedDelaunay<Terrain>, Vec<Pass>)> {
        if !self.builder.add_ridges {
            return self.triangulate();
        }
        let (builder, report) = (self.builder.clone(), self.report.clone());
        let (flat, disputed) = self.triangulate()?;
        let mut inside = finite_faces(&flat);
        peel(&flat, &mut inside, builder.rim_rule());
        let kind_of = |line: LineId| builder.line_kinds.get(line.index()).copied();
        let vertices = Contoured::new(&flat, &inside, kind_of).ridge_vertices();
        go_on(self.cancel)?;
        if vertices.is_empty() {
            return Ok((flat, disputed));
        }
        (self.builder, self.report) = (builder, report);
        self.report.ridge_vertices = vertices.len();
        self.builder.points.extend(vertices);
        self.triangulate()
    }

    /// Triangulates all sites and lines. Returns also the lines at sites where their vertices have
    /// different heights.
    ///
    /// # Errors
    /// If lines cross where that is refused, or the sites do not span an area.
    fn triangulate(&mut self) -> Result<(ConstrainedDelaunay<Terrain>, Vec<Pass>)> {
        let cancel = self.cancel;
        // One vertex per site, in spatial order.
        let Sites {
            vertices,
            line_vertices,
            mut disputed,
        } = self.builder.merge(&mut self.report, &|| go_on(cancel))?;
        go_on(cancel)?;
        let lines = lines_of(&line_vertices, &self.builder.line_ends);
        let (triangulation, renumbered) = ConstrainedDelaunay::from_sorted_lines(
            Terrain::default(),
            vertices,
            &lines,
            self.builder.on_crossing,
            cancel,
        )
        .map_err(|error| not_built(error, &|line| self.name(line)))?;
        if let Some(renumbered) = renumbered {
            disputed
                .iter_mut()
                .for_each(|pass| pass.vertex = renumbered[pass.vertex.index()]);
        }
        if triangulation.dimension() < 2 {
            return Err(no_surface(triangulation.vertex_count()));
        }
        Ok((triangulation, disputed))
    }

    /// Gives the vertices at which lines cross their heights, and reports where these differ.
    fn choose_crossing_heights(
        &mut self,
        triangulation: &mut ConstrainedDelaunay<Terrain>,
        disputed: Vec<Pass>,
    ) {
        self.report.crossings = triangulation.crossings().len();
        self.report.rounding = triangulation.rounding();
        self.report.crossing_heights = choose_heights(
            triangulation,
            &self.builder.precedences,
            disputed,
            self.builder.crossing_heights,
            self.builder.crossing_tolerance,
        );
        if let Some(bounds) = self.judged() {
            self.report
                .crossing_heights
                .retain(|crossing| bounds.holds(crossing.site[0], crossing.site[1]));
        }
    }

    /// The box within which crossings and walls are judged.
    fn judged(&self) -> Option<Bounds> {
        self.builder.bounds.or(self.builder.judged)
    }

    /// Gives the vertices in water its height. Returns for each cell number true if the cell lies
    /// in water; empty if there is none.
    ///
    /// # Errors
    /// If lakes of different heights meet, or lines differ in height where that is refused.
    fn level_waters(
        &mut self,
        triangulation: &mut ConstrainedDelaunay<Terrain>,
        given: GivenHeights,
    ) -> Result<Vec<bool>> {
        let Leveled {
            is_water,
            sites,
            joined,
        } = areas::level(
            triangulation,
            &self.builder.waters,
            &given.rims,
            &self.overlaps.pairs,
            &|line| self.name(line),
        )?;
        let judged = self.judged();
        for (line, heights) in given.walls {
            let vertices = triangulation
                .line_vertices(LineId::new(line))
                .iter()
                .zip(heights);
            let at = vertices.map(|(vertex, height)| (*triangulation.point(*vertex), height));
            let flooded = at.filter(|([x, y, z], height)| {
                z != height
                    && sites.contains(&[x.to_bits(), y.to_bits()])
                    && judged.as_ref().is_none_or(|bounds| bounds.holds(*x, *y))
            });
            self.report
                .walls_in_water
                .extend(flooded.map(|([x, y, _], _)| (line, [x, y])));
        }
        self.report.lakes_joined = joined;
        // In water, no line decides.
        let Build {
            overlaps, report, ..
        } = self;
        report
            .crossing_heights
            .retain(|crossing| !sites.contains(&crossing.site.map(f64::to_bits)));
        report
            .crossing_heights
            .iter_mut()
            .flat_map(|crossing| &mut crossing.heights)
            .for_each(|(line, _)| {
                *line = overlaps.named(*line);
            });
        if self.builder.crossing_heights == CrossingRule::Refuse {
            let name = |line| self.name(line);
            refuse(
                &self.report.crossing_heights,
                self.builder.crossing_tolerance,
                &name,
            )?;
        }
        Ok(is_water)
    }

    /// Leaves out the faces with long edges and outside of what the surface is clipped to, and
    /// reports what is left.
    fn delimit(mut self, mut tin: Tin, is_water: &[bool]) -> Result<Tin> {
        let clip = self.builder.take_clip();
        let Build {
            builder,
            mut report,
            cancel,
            ..
        } = self;
        let all = tin.triangulation.vertex_count();
        (report.faces_beyond_max_edge, report.lost_at_rim) = tin.peel(builder.rim_rule());
        if let Some(limit) = builder.max_edge_inside {
            report.faces_with_long_edges = tin.leave_out_long(limit, is_water);
        }
        if report.points < report.breakline_vertices {
            (report.flat_triangles, report.flat_share) = tin.flat_share();
        }
        let is_whole = report.faces_beyond_max_edge + report.faces_with_long_edges == 0;
        // Counted only if it does not follow from the final counts.
        let mut left = None;
        if !clip.is_everything() {
            left = Some(if is_whole {
                all
            } else {
                tin.count().old_vertices
            });
            (report.faces_clipped, report.faces_cut) = clip.apply(&mut tin)?;
        }
        go_on(cancel)?;
        if let (Some(bounds), Some(window)) = (&builder.bounds, &builder.window) {
            report.uncertain = uncertain(
                &tin.triangulation,
                bounds,
                window,
                builder.rim_rule(),
                tin.replaced(),
            );
            report.uncertain += builder.ended.map_or(0, |ended| ended.uncertain);
        }
        let Count {
            old_vertices,
            vertices,
            faces,
            extent,
        } = tin.count();
        let left = left.unwrap_or(old_vertices);
        report.vertices_beyond_max_edge = all - left;
        report.vertices_clipped = left - old_vertices;
        report.vertices_cut = vertices - old_vertices;
        if report.breaklines > 0 || !clip.is_everything() {
            report.edges = tin.count_lines();
        }
        (report.vertices, report.triangles, report.extent) = (vertices, faces, extent);
        tin.report = report;
        Ok(tin)
    }
}

#[cold]
fn no_surface(vertices: usize) -> Error {
    let what = match vertices {
        0 | 1 => "fewer than two distinct points do".to_owned(),
        count => format!("{count} distinct points on one line do"),
    };
    Error::format(format!("{what} not span a surface")).cure(wording![
        "check the inputs, the classes (",
        Setting::Class,
        ") and the bounds"
    ])
}

/// The vertices of each line.
fn lines_of<'a>(vertices: &'a [u32], line_ends: &[usize]) -> Vec<&'a [u32]> {
    let starts = std::iter::once(&0).chain(line_ends);
    starts
        .zip(line_ends)
        .map(|(&start, &end)| &vertices[start..end])
        .collect()
}

#[cold]
fn not_built(error: InputError, name: &dyn Fn(usize) -> String) -> Error {
    match error {
        InputError::Crossing {
            segments: [(line, _), (other, _)],
            at: [x, y],
        } => {
            let (line, other) = (name(line), name(other));
            Error::format(format!(
                "{line} and {other} cross at {x} {y} without a common vertex"
            ))
            .cure(wording![
                "fix the lines, or split them there with ",
                Setting::OnCrossing.text("split")
            ])
        }
        InputError::Canceled => Error::canceled(),
        error => Error::limit(error.to_string()),
    }
}
