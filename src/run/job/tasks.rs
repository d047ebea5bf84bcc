//! What each task does: files in, one file out.

use super::bytes::{self, NumberReader, put_block, put_u32};
use super::done::Sources;
use super::holes::Holes;
use super::lines::{JobLines, LinesOfTile};
use super::planned_file::{require_folder, require_state, state_of};
use super::raster::Drawing;
use super::surface::PartFaces;
use super::task_facts::{Extent, FileFacts, KeptFacts, ReadFacts, TaskFacts, TaskNotice};
use super::task_file::{TaskFile, TaskWriter};
use super::{Job, Task};
use super::{contours, lines, notes};
use crate::data::{Bounds, EdgeKind, PointBatch, area_of};
use crate::error::{Error, Result};
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal};
use crate::run::lines::notes::LevelRings;
use crate::run::sources::open;
use crate::run::verbs::Keeps;
use crate::terrain::contour::parts::{ContourCollector, LevelParts};
use crate::terrain::tiles::{
    self, AtRim, ClipSide, Rim, TileClip, TileTriangle, TileVertex, TinPart, Work, has_long_edge,
};
use crate::terrain::{Classes, LeftOutAtRim, PartCell, RimRule, Selection, deciding, one_per_site};

/// Points that are read before they are divided among tiles: 24 bytes each, and as much again while
/// they are sorted.
const DIVIDED_AT_ONCE: u64 = 1 << 20;

/// Bytes per point that is read before it is divided: the lists of points and of tiles, and what is
/// written.
const BYTES_A_DIVIDED_POINT: u64 = 120;

/// Bytes per point that is triangulated to find the rim of the points.
const BYTES_A_POINT_AT_RIM: u64 = 130;

impl Job {
    /// Does a task and writes its file, which gets its name unless `confirm` fails: another process
    /// may have the task meanwhile.
    pub(super) fn do_task(
        &self,
        number: usize,
        confirm: &dyn Fn() -> Result<()>,
        context: &Context,
    ) -> Result<()> {
        let mut writer = TaskWriter::create(self.task_file(number))?;
        let sources = Sources::new(self, number);
        let journal = Journal::new(context);
        let mut facts = match self.task(number) {
            Task::Divide(file) => self.divide(file, &mut writer, &journal)?,
            Task::Lines => self.arrange(&sources, &mut writer, &journal)?,
            Task::Triangulate(step) => match &self.steps[step].work {
                Work::Leaf(tile) => self.leaf(step, *tile, &sources, &mut writer, &journal)?,
                Work::Merge(parts) => self.merge(step, parts, &sources, &mut writer, context)?,
            },
            Task::Rim => self.rim(&sources, &mut writer, context)?,
            Task::Cut => self.cut(&sources, &mut writer, context)?,
        };
        context.check()?;
        facts.notices = journal.take().iter().map(TaskNotice::of).collect();
        writer.finish(&facts, sources.sum(self.needs(number))?, confirm)
    }

    /// Divides the points of a file among the tiles.
    fn divide(&self, file: usize, writer: &mut TaskWriter, journal: &Journal) -> Result<TaskFacts> {
        let mut table = Vec::new();
        writer.begin("points");
        let mut waiting: Vec<[f64; 3]> = Vec::new();
        let layout = &self.plan.layout;
        let lines = if self.plan.has_lines {
            self.known(&journal.context)?.lines.as_ref()
        } else {
            None
        };
        let rings = lines.and_then(|lines| lines.rings.as_ref());
        let mut near = Vec::new();
        let mut replaced = 0;
        let needs_rim = lines.is_some_and(JobLines::need_rim);
        let limit = self.plan.max_edge;
        let mut at_rim = Vec::new();
        let mut of_rings = rings.map(LevelRings::none_found).unwrap_or_default();
        let mut write_run = |points: &mut Vec<[f64; 3]>| -> Result<()> {
            if let Some(rings) = rings {
                rings.count(points, &mut of_rings);
            }
            if needs_rim {
                at_rim.append(&mut deciding(points.clone(), limit));
            }
            if let Some(lines) = lines {
                replaced += lines.take_replaced(points) as u64;
                near.append(&mut lines.near(points));
            }
            let mut own = Vec::new();
            let mut tiles: Vec<(u32, u32)> = (0..)
                .zip(points.iter())
                .map(|(i, &[x, y, _])| (layout.tile_of([x, y]), i))
                .collect();
            // By tiles, and within each in the order of the file.
            tiles.sort_unstable();
            for of_tile in tiles.chunk_by(|a, b| a.0 == b.0) {
                own.clear();
                own.extend(of_tile.iter().map(|(_, i)| points[*i as usize]));
                let block = writer.put_block(&bytes::of_points(&own))?;
                put_u32(&mut table, of_tile[0].0);
                put_block(&mut table, block);
            }
            points.clear();
            Ok(())
        };
        let bytes = BYTES_A_DIVIDED_POINT + u64::from(needs_rim) * BYTES_A_POINT_AT_RIM;
        let most = (self.plan.task_memory / bytes).clamp(1 << 14, DIVIDED_AT_ONCE) as usize;
        let mut written = Ok(());
        let read = self.read_file(file, journal, &mut |mut points| {
            if waiting.is_empty() {
                waiting = points
            } else {
                waiting.append(&mut points)
            }
            if written.is_ok() && waiting.len() >= most {
                written = write_run(&mut waiting);
            }
        });
        written.and_then(|()| write_run(&mut waiting))?;
        // Of a bad file, nothing counts.
        let mut of_file = self.facts_of_file(file, read)?;
        match &mut of_file {
            FileFacts::Skipped(_) => {
                table.clear();
                near.clear();
                at_rim.clear();
            }
            FileFacts::Read(points) => {
                points.rings = notes::rings_found(&of_rings);
                points.replaced = replaced;
            }
        }
        writer.begin("table");
        writer.put(&table)?;
        writer.begin("near");
        writer.put(&bytes::of_points(&near))?;
        writer.begin("rim");
        writer.put(&bytes::of_points(&deciding(at_rim, limit)))?;
        Ok(TaskFacts {
            file: Some(of_file),
            ..TaskFacts::default()
        })
    }

    /// Arranges the lines, with the points next to them from all files.
    fn arrange(
        &self,
        sources: &Sources,
        writer: &mut TaskWriter,
        journal: &Journal,
    ) -> Result<TaskFacts> {
        let crs = self.plan.crs.as_ref();
        let Some(lines) = &self.known(&journal.context)?.lines else {
            return Ok(TaskFacts::default());
        };
        let (mut near, mut at_rim) = (Vec::new(), Vec::new());
        let mut extent = Bounds::default();
        for (task, &file) in self.readers.divided.iter().enumerate() {
            let mut divided = sources.open(task)?;
            let file = &self.plan.files[file];
            for (section, points) in [("near", &mut near), ("rim", &mut at_rim)] {
                let bytes = divided.section(section)?;
                bytes::add_points(&bytes, points).ok_or_else(|| divided.damaged())?;
            }
            [file.min, file.max]
                .into_iter()
                .for_each(|[x, y]| extent.add([x, y, 0.0]));
        }
        let tin = lines.build(near, (at_rim, self.plan.max_edge), &extent, crs, journal)?;
        let edges = lines::write(&tin, &self.plan.layout, writer)?;
        let report = tin.report();
        Ok(TaskFacts {
            line_edges: edges as u64,
            duplicates: report.duplicates as u64,
            points_on_breaklines: report.points_on_breaklines as u64,
            ..TaskFacts::default()
        })
    }

    /// Returns the facts of a file that was read; of one that is bad, why it is skipped.
    fn facts_of_file(&self, file: usize, read: Result<ReadFacts>) -> Result<FileFacts> {
        let path = &self.plan.files[file].path;
        match read {
            Err(error) if self.bad.skips(&error) => {
                require_folder(path, &self.request)?;
                Ok(FileFacts::Skipped(error.in_file(path).to_string()))
            }
            read => read.map(FileFacts::Read).map_err(|e| e.in_file(path)),
        }
    }

    /// Reads the points of a file that are used, some at a time.
    pub(super) fn read_file(
        &self,
        number: usize,
        journal: &Journal,
        take: &mut dyn FnMut(Vec<[f64; 3]>),
    ) -> Result<ReadFacts> {
        self.plan
            .require_same_points(number, &self.request, &self.folder)?;
        let file = &self.plan.files[number];
        let state = state_of(&file.path)?;
        let mut source = open::points(
            &self.request.points[file.input],
            self.request.read,
            &journal.context,
        )?;
        self.plan
            .require_system(number, source.info().crs.as_ref(), &self.folder)?;
        let mut selection = Selection::new(Classes::Only(self.plan.classes.clone()), None)
            .with_returns(self.request.returns.clone());
        let transforms = file.transforms(self.plan.target_system(), &journal.context)?;
        let mut batch = PointBatch::default();
        let mut extent = Bounds::default();
        loop {
            source.read(&mut batch)?;
            if batch.is_empty() {
                require_state(&file.path, state, &self.folder)?;
                let report = selection.finish().1;
                self.plan
                    .require_classes(&report, &self.request, &self.folder)?;
                journal.add(Notice::PointsRead(file.path.clone(), report.read));
                journal.add_warnings(&file.path, source.warnings());
                return Ok(ReadFacts {
                    state,
                    read: report.read,
                    used: report.used,
                    withheld: report.withheld,
                    other_return: report.other_return,
                    without_return: report.without_return,
                    other_class: report.other_class,
                    without_class: report.without_class,
                    classes: report.by_class.keys().copied().collect(),
                    extent: Extent::of(&extent),
                    of_transform: transforms.warnings().collect(),
                    ..ReadFacts::default()
                });
            }
            transforms.of_file(0).apply_to_batch(&mut batch)?;
            selection.add(&batch)?;
            let points = selection.take_points();
            file.require_within(&points)?;
            points.iter().for_each(|point| extent.add(*point));
            take(points);
            journal.context.check()?;
        }
    }

    /// Triangulates the points of a tile.
    fn leaf(
        &self,
        step: usize,
        tile: u32,
        sources: &Sources,
        writer: &mut TaskWriter,
        journal: &Journal,
    ) -> Result<TaskFacts> {
        let mut holes = Holes::default();
        let (points, file) = self.points_of(tile, sources, &mut holes, journal)?;
        let lines = match self.lines_task() {
            Some(task) => lines::read(&mut sources.open(task)?, tile)?,
            None => LinesOfTile::default(),
        };
        let mut points = lines.without_their_sites(points);
        let count = points.len();
        points = one_per_site(&points, self.request.duplicates)?;
        // The task of the lines counts those at its own sites.
        let duplicates = (count - points.len()) as u64;
        points.extend_from_slice(&lines.vertices);
        let constraints = lines.constraints;
        let rectangle = &self.steps[step].tile;
        let tight = self.tight(&journal.context)?;
        let facts = TaskFacts {
            file,
            duplicates,
            reach: reach_of(&points),
            ..TaskFacts::default()
        };
        self.emitting(writer, &journal.context, &holes, facts, |emit| {
            match self.verb.keeps() {
                Keeps::Triangles => {
                    tiles::leaf_with_part(rectangle, tile, &points, &constraints, tight, emit)
                }
                _ => tiles::leaf(rectangle, tile, &points, &constraints, tight, emit)
                    .map(|residual| (residual, None)),
            }
        })
        .map_err(|error| {
            let error = error.within(format_args!("tile {tile}"));
            match self.files_of(tile) {
                [file] if self.readers.task_of(*file).is_none() => {
                    error.in_file(&self.plan.files[*file].path)
                }
                _ => error,
            }
        })
    }

    /// Returns the points of a tile, in the order of their files, and what the file says that is
    /// the tile, if one is. Adds the extents of files that are skipped.
    fn points_of(
        &self,
        tile: u32,
        sources: &Sources,
        holes: &mut Holes,
        journal: &Journal,
    ) -> Result<(Vec<[f64; 3]>, Option<FileFacts>)> {
        let mut all: Vec<[f64; 3]> = Vec::new();
        let mut of_file = None;
        for &file in self.files_of(tile) {
            let Some(task) = self.readers.task_of(file) else {
                let before = all.len();
                let read = self.read_file(file, journal, &mut |mut points| {
                    if all.is_empty() {
                        all = points
                    } else {
                        all.append(&mut points)
                    }
                });
                let facts = self.facts_of_file(file, read);
                let facts = facts.map_err(|e| e.within(format_args!("tile {tile}")))?;
                if matches!(facts, FileFacts::Skipped(_)) {
                    all.truncate(before);
                    holes.add_file(self, file);
                }
                of_file = Some(facts);
                continue;
            };
            let mut divided = sources.open(task)?;
            if divided.facts.skipped().is_some() {
                holes.add_file(self, file);
            }
            add_points_of_tile(tile, &mut divided, &mut all)?;
        }
        Ok((all, of_file))
    }

    fn merge(
        &self,
        step: usize,
        parts: &[usize],
        sources: &Sources,
        writer: &mut TaskWriter,
        context: &Context,
    ) -> Result<TaskFacts> {
        let mut residuals = Vec::new();
        let mut holes = Holes::default();
        for &part in parts {
            let mut file = sources.open(self.task_of_step(part))?;
            let bytes = file.section("residual")?;
            residuals.push(bytes::to_residual(&bytes).ok_or_else(|| file.damaged())?);
            holes.add_known(&file.facts);
        }
        let tile = &self.steps[step].tile;
        let tight = self.tight(context)?;
        self.emitting(
            writer,
            context,
            &holes,
            TaskFacts::default(),
            |emit| match self.verb.keeps() {
                Keeps::Triangles => tiles::merge_with_part(tile, &residuals, tight, emit),
                _ => tiles::merge(tile, &residuals, tight, emit).map(|residual| (residual, None)),
            },
        )
        .map_err(|e| e.within(format_args!("merge {step}")))
    }

    /// Runs a step and writes what becomes of its triangles: what is made of those that are certain
    /// to stay, and the triangles that wait for the decision about the rim.
    fn emitting(
        &self,
        writer: &mut TaskWriter,
        context: &Context,
        holes: &Holes,
        mut facts: TaskFacts,
        run: impl FnOnce(&mut dyn FnMut(TileTriangle)) -> Result<(tiles::Residual, Option<TinPart>)>,
    ) -> Result<TaskFacts> {
        let mut kept = KeptTriangles::new(self, writer, self.clip(context)?)?;
        let mut at_rim = self.rim_rule().map(AtRim::new);
        let mut failed = Ok(());
        let mut over_skipped = 0_u64;
        let (residual, part) = run(&mut |triangle| {
            if holes.meet(triangle.corners.map(|corner| corner.position)) {
                over_skipped += 1;
                kept.add_removed(&triangle);
                at_rim.iter_mut().for_each(|rim| rim.add_outside(&triangle));
            } else if at_rim.as_mut().is_some_and(|rim| rim.take(&triangle)) {
                kept.wait();
            } else if failed.is_ok() {
                failed = kept.add(&triangle, writer);
            }
        })?;
        failed?;
        facts.kept = kept.finish(part, writer)?;
        facts.holes = holes.known();
        facts.over_skipped = over_skipped;
        writer.begin("residual");
        writer.put(&bytes::of_residual(&residual))?;
        facts.handed_up = residual.vertices.len() as u64;
        if let Some(at_rim) = at_rim {
            let waiting = at_rim.finish();
            let [gates, triangles] = bytes::of_waiting(&waiting);
            writer.begin("gates");
            writer.put(&gates)?;
            writer.begin("waiting");
            writer.put(&triangles)?;
            facts.groups = waiting.groups;
            facts.waiting = waiting.triangles.len() as u64;
        }
        Ok(facts)
    }

    /// Decides which of the triangles that wait are removed at the rim, and draws the others.
    fn rim(
        &self,
        sources: &Sources,
        writer: &mut TaskWriter,
        context: &Context,
    ) -> Result<TaskFacts> {
        let mut rim = Rim::default();
        let rule = self.rim_rule().unwrap_or_default();
        let mut left_out = LeftOutAtRim::new(rule.max_edge);
        for step in 0..self.steps.len() {
            let mut file = sources.open(self.task_of_step(step))?;
            let bytes = file.section("gates")?;
            let groups = file.facts.groups;
            let gates = bytes::to_gates(&bytes, groups);
            rim.add(groups, &gates.ok_or_else(|| file.damaged())?);
            if self.steps[step].tile.is_plane() {
                let root = bytes::to_residual(&file.section("residual")?);
                let root = root.ok_or_else(|| file.damaged())?;
                rim.add_outside(&root);
                root.hull().for_each(|ends: [TileVertex; 2]| {
                    left_out.add_hull(ends.map(|end| end.key()), ends.map(|end| end.position));
                });
            }
        }
        let mut removed = 0_u64;
        let mut kept = KeptTriangles::new(self, writer, self.clip(context)?)?;
        for (step, is_removed) in rim.removed().into_iter().enumerate() {
            let mut file = sources.open(self.task_of_step(step))?;
            for bytes in file.section("waiting")?.chunks(bytes::WAITING_BYTES) {
                let waiting = bytes::to_waiting(bytes);
                let (triangle, group) = waiting.ok_or_else(|| file.damaged())?;
                match is_removed.get(group as usize) {
                    Some(true) => {
                        removed += 1;
                        kept.add_removed(&triangle);
                        let corners = triangle.corners;
                        left_out.add(corners.map(|c| c.key()), corners.map(|c| c.position));
                    }
                    Some(false) => kept.add(&triangle, writer)?,
                    None => return Err(file.damaged()),
                }
            }
            context.check()?;
        }
        Ok(TaskFacts {
            kept: kept.finish(None, writer)?,
            removed,
            lost_at_rim: Some(left_out.lost().into()),
            ..TaskFacts::default()
        })
    }

    /// The rule of the rim; `None` if nothing is left out there.
    fn rim_rule(&self) -> Option<RimRule> {
        self.plan.max_edge.map(|limit| RimRule {
            max_edge: Some(limit),
            opens_caps: self.request.max_edge.leaves_out_caps(),
        })
    }

    /// What the surface is cut along, if it is.
    fn clip(&self, context: &Context) -> Result<Option<&TileClip>> {
        if self.plan.has_clip {
            Ok(self.known(context)?.clip.as_ref())
        } else {
            Ok(None)
        }
    }

    /// The width of triangles at which a cut may bend an edge; zero without a clip.
    fn tight(&self, context: &Context) -> Result<f64> {
        Ok(self.clip(context)?.map_or(0.0, TileClip::tight))
    }

    /// Cuts the triangles of all tasks that clip lines come near.
    fn cut(
        &self,
        sources: &Sources,
        writer: &mut TaskWriter,
        context: &Context,
    ) -> Result<TaskFacts> {
        let mut triangles = Vec::new();
        let mut reach = [0.0_f64; 2];
        for task in self.first_step()..self.after_steps() + usize::from(self.rim_task().is_some()) {
            let mut file = sources.open(task)?;
            for bytes in file.section(NEAR_CLIP)?.chunks(bytes::WAITING_BYTES) {
                let (triangle, is_inside) =
                    bytes::to_waiting(bytes).ok_or_else(|| file.damaged())?;
                triangles.push((triangle, is_inside == 1));
            }
            reach = [0, 1].map(|k| reach[k].max(file.facts.reach[k]));
        }
        context.check()?;
        let mut kept = KeptTriangles::new(self, writer, None)?;
        let part = match self.clip(context)? {
            Some(clip) => clip.cut(&triangles, reach)?,
            None => None,
        };
        let inside = triangles.iter().filter(|(_, is_inside)| *is_inside).count() as u64;
        drop(triangles);
        let (mut whole, mut draped) = (0_u64, 0_u64);
        for triangle in part.iter().flat_map(TinPart::triangles) {
            whole += u64::from(triangle.corners.iter().all(|corner| !corner.is_added()));
            draped += u64::from(triangle.edges.contains(&EdgeKind::Draped));
            kept.keep(&triangle, writer)?;
        }
        let met = inside.saturating_sub(whole);
        Ok(TaskFacts {
            met,
            draped,
            kept: kept.finish(part, writer)?,
            ..TaskFacts::default()
        })
    }
}

/// Adds the points that a divided file has in a tile.
fn add_points_of_tile(tile: u32, divided: &mut TaskFile, all: &mut Vec<[f64; 3]>) -> Result<()> {
    let mut bytes = Vec::new();
    let table = divided.section("table")?;
    let mut entries = NumberReader::new(&table);
    while !entries.is_empty() {
        let (Some(of_tile), Some(block)) = (entries.u32(), entries.block()) else {
            return Err(divided.damaged());
        };
        if of_tile == tile {
            divided.read(block, &mut bytes)?;
            bytes::add_points(&bytes, all).ok_or_else(|| divided.damaged())?;
        }
    }
    Ok(())
}

/// What triangles become.
enum Drawn {
    Cells(Drawing<f32>),
    Gradients(Drawing<[f64; 2]>),
    Contours(ContourCollector),
    /// Faces of the triangulation.
    Faces(PartFaces),
}

/// The name of the section of triangles that clip lines come near, each with whether it is in the
/// surface.
const NEAR_CLIP: &str = "clip";

/// The triangles of a task that stay in the surface: drawn and counted.
struct KeptTriangles<'a> {
    drawn: Drawn,
    clip: Option<&'a TileClip>,
    /// The bytes of the triangles that clip lines come near.
    near_clip: Vec<u8>,
    clipped: u64,
    max_edge_inside: Option<f64>,
    triangles: u64,
    area: f64,
    extent: Bounds,
}

impl<'a> KeptTriangles<'a> {
    fn new(job: &Job, writer: &mut TaskWriter, clip: Option<&'a TileClip>) -> Result<Self> {
        let drawn = match (job.verb.keeps(), job.plan.frame) {
            (Keeps::Contours(options), _) => {
                Drawn::Contours(ContourCollector::new(&options.to_levels()?))
            }
            (Keeps::Triangles, _) => Drawn::Faces(PartFaces::default()),
            (Keeps::Heights(_), Some(frame)) => {
                Drawn::Cells(Drawing::new(frame, job.plan.blocks_before, writer)?)
            }
            (Keeps::Gradients(_), Some(frame)) => {
                Drawn::Gradients(Drawing::new(frame, job.plan.blocks_before, writer)?)
            }
            (Keeps::Heights(_) | Keeps::Gradients(_), None) => {
                return Err(Error::format(
                    "the plan of the job lacks the frame of the raster",
                ));
            }
        };
        Ok(KeptTriangles {
            drawn,
            clip,
            near_clip: Vec::new(),
            clipped: 0,
            max_edge_inside: job.request.max_edge_inside,
            triangles: 0,
            area: 0.0,
            extent: Bounds::default(),
        })
    }

    /// Adds a triangle that is in the surface, unless an edge of it is too long.
    fn add(&mut self, triangle: &TileTriangle, writer: &mut TaskWriter) -> Result<()> {
        let is_long = self
            .max_edge_inside
            .is_some_and(|limit| has_long_edge(triangle, limit));
        match self
            .clip
            .map_or(ClipSide::Kept, |clip| clip.side_of_triangle(triangle))
        {
            ClipSide::Kept if !is_long => self.keep(triangle, writer),
            ClipSide::Kept => {
                self.leave_out();
                Ok(())
            }
            ClipSide::Outside => {
                self.clipped += 1;
                self.leave_out();
                Ok(())
            }
            ClipSide::Near => {
                self.add_near_clip(triangle, !is_long);
                Ok(())
            }
        }
    }

    /// Adds a triangle that is not in the surface: a cut may need it.
    fn add_removed(&mut self, triangle: &TileTriangle) {
        match self.clip.map(|clip| clip.side_of_triangle(triangle)) {
            Some(ClipSide::Near) => self.add_near_clip(triangle, false),
            Some(ClipSide::Kept | ClipSide::Outside) | None => self.leave_out(),
        }
    }

    fn add_near_clip(&mut self, triangle: &TileTriangle, is_inside: bool) {
        bytes::put_waiting(&mut self.near_clip, triangle, u32::from(is_inside));
        self.add_left_out(PartCell::Elsewhere);
    }

    /// Draws and counts a triangle.
    fn keep(&mut self, triangle: &TileTriangle, writer: &mut TaskWriter) -> Result<()> {
        let corners = triangle.corners.map(|corner| corner.position);
        self.triangles += 1;
        self.area += area_of(corners);
        corners
            .into_iter()
            .for_each(|corner| self.extent.add(corner));
        match &mut self.drawn {
            Drawn::Cells(drawing) => drawing.draw(corners, writer),
            Drawn::Gradients(drawing) => drawing.draw(corners, writer),
            Drawn::Contours(collector) => {
                collector.add(triangle);
                Ok(())
            }
            Drawn::Faces(faces) => {
                faces.add(PartCell::Face);
                Ok(())
            }
        }
    }

    /// Leaves out a triangle for good.
    fn leave_out(&mut self) {
        self.add_left_out(PartCell::Under);
    }

    /// Adds a triangle that is not a face of the surface here.
    fn add_left_out(&mut self, decided: PartCell) {
        if let Drawn::Faces(faces) = &mut self.drawn {
            faces.add(decided);
        }
    }

    /// Leaves out a triangle until it is decided about the rim.
    fn wait(&mut self) {
        if let Drawn::Faces(faces) = &mut self.drawn {
            faces.wait();
        }
    }

    /// Writes what the triangles became; `part` is the triangulation that they come from, if they
    /// are those of one.
    fn finish(self, part: Option<TinPart>, writer: &mut TaskWriter) -> Result<KeptFacts> {
        let mut contour_edges = 0;
        match self.drawn {
            Drawn::Cells(drawing) => drawing.finish(writer)?,
            Drawn::Gradients(drawing) => drawing.finish(writer)?,
            Drawn::Faces(faces) => faces.finish(part, writer)?,
            Drawn::Contours(collector) => {
                let parts = collector.finish()?;
                contours::write(&parts, writer)?;
                contour_edges = parts
                    .levels()
                    .iter()
                    .map(LevelParts::edge_count)
                    .sum::<usize>() as u64;
            }
        }
        if self.clip.is_some() {
            writer.begin(NEAR_CLIP);
            writer.put(&self.near_clip)?;
        }
        Ok(KeptFacts {
            triangles: self.triangles,
            clipped: self.clipped,
            area: Some(self.area).filter(|area| area.is_finite()),
            extent: Extent::of(&self.extent),
            contour_edges,
        })
    }
}

/// Returns the largest coordinates of points on both axes, without their signs.
fn reach_of(points: &[[f64; 3]]) -> [f64; 2] {
    points.iter().fold([0.0, 0.0], |most, p| {
        [0, 1].map(|k: usize| f64::max(most[k], p[k].abs()))
    })
}
