use std::fmt::{self, Write};

use crate::geometry::Coordinates;
use crate::tds::CellId;
use crate::triangulation::Triangulation;

/// Something that a [picture](Triangulation::svg) shows in addition to edges and vertices.
#[derive(Debug, Clone, Copy)]
pub enum Mark<'a> {
    /// Finite cells, filled, such as those of a conflict zone. Infinite and nonexistent cells are
    /// left out.
    Cells(&'a [CellId]),
    /// Edges, bold, given as in [`Tds::edges`](crate::tds::Tds::edges). Edges with the infinite
    /// vertex and nonexistent edges are left out: the border of a conflict zone on a line has no
    /// edges.
    Edges(&'a [(CellId, usize)]),
    /// A polygon, filled, such as a Voronoi cell.
    Polygon(&'a [[f64; 2]]),
    /// A line through points, such as the path of a walk. A single point is drawn as a dot.
    Line(&'a [[f64; 2]]),
}

/// The side of the drawing, in the unit of the picture.
const SIZE: f64 = 1000.0;
const MARGIN: f64 = 30.0;

/// Vertices are numbered if there are at most this many.
const MOST_NUMBERED: usize = 400;

/// The styles apply to pictures of this class only, because a page may have styles of its own.
const STYLE: &str = "\
    .tri{background:#fff}.tri line{stroke:#777;stroke-width:1}.tri .edge{stroke:#c33;stroke-width:4}\
    .tri .cell{fill:#fc6;fill-opacity:.6}.tri .polygon{fill:#6cf;fill-opacity:.5;stroke:#36c}\
    .tri .line{fill:none;stroke:#36c;stroke-width:3}.tri .dot{fill:#36c}.tri text{font:14px sans-serif}";

/// Maps coordinates to the picture: y runs upward, and both axes have the same unit.
struct PictureFrame {
    low: [f64; 2],
    /// Half of the longer side. (The whole might overflow.)
    half: f64,
}

impl PictureFrame {
    fn around(sites: impl Iterator<Item = [f64; 2]>) -> Self {
        let none = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (low, high) = sites.fold(none, |(low, high), p| {
            (
                [0, 1].map(|k| p[k].min(low[k])),
                [0, 1].map(|k| p[k].max(high[k])),
            )
        });
        let half = (0..2)
            .map(|k| high[k] / 2.0 - low[k] / 2.0)
            .fold(0.0, f64::max);
        PictureFrame {
            low,
            half: if half > 0.0 { half } else { 1.0 },
        }
    }

    fn pixel(&self, p: [f64; 2]) -> [f64; 2] {
        let [x, y] = [0, 1].map(|k| (p[k] / 2.0 - self.low[k] / 2.0) / self.half * SIZE + MARGIN);
        [x, SIZE + 2.0 * MARGIN - y]
    }

    /// Returns points as SVG lists them.
    fn list(&self, sites: impl Iterator<Item = [f64; 2]>) -> String {
        sites
            .map(|p| self.pixel(p))
            .map(|[x, y]| format!("{x:.2},{y:.2} "))
            .collect()
    }
}

/// Returns the points that can be drawn: those with finite coordinates.
fn finite<'a>(sites: impl IntoIterator<Item = &'a [f64; 2]>) -> impl Iterator<Item = [f64; 2]> {
    sites
        .into_iter()
        .copied()
        .filter(|p| p.iter().all(|x| x.is_finite()))
}

impl<G: Coordinates<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns a picture of the finite edges and vertices, as the text of an SVG file. Vertices are
    /// numbered if there are few. Marks are drawn below, the first one lowest; their points that
    /// are not finite are left out.
    ///
    /// For viewing: coordinates have two decimals of a thousandth of the longer side.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay, Mark};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]];
    /// let (t, _) = Delaunay::from_points(Plane::new(), &points)?;
    /// let zone = t.conflict_zone(&[2.0, 2.0], None).expect("it is inside");
    /// let svg = t.svg(&[Mark::Cells(&zone.cells), Mark::Edges(&zone.border), Mark::Line(&[[2.0, 2.0]])]);
    /// assert_eq!((svg.matches("class=\"cell\"").count(), svg.matches("class=\"edge\"").count()), (2, 4));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn svg(&self, marks: &[Mark<'_>]) -> String {
        let mut svg = String::new();
        // Writing to a string does not fail.
        let _ = self.draw(&mut svg, marks);
        svg
    }

    fn draw(&self, svg: &mut String, marks: &[Mark<'_>]) -> fmt::Result {
        let drawn = marks.iter().flat_map(|mark| match mark {
            Mark::Polygon(sites) | Mark::Line(sites) => *sites,
            Mark::Cells(_) | Mark::Edges(_) => &[],
        });
        let frame = PictureFrame::around(
            self.tds
                .vertices()
                .map(|v| self.site(v))
                .chain(finite(drawn)),
        );
        let side = SIZE + 2.0 * MARGIN;
        writeln!(
            svg,
            r#"<svg xmlns="http://www.w3.org/2000/svg" class="tri" viewBox="0 0 {side} {side}">"#
        )?;
        writeln!(svg, "<style>{STYLE}</style>")?;
        for mark in marks {
            match *mark {
                Mark::Cells(cells) => {
                    let is_finite =
                        |cell: CellId| self.tds.is_used(cell) && !self.tds.is_infinite(cell);
                    for &cell in cells.iter().filter(|&&cell| is_finite(cell)) {
                        let corners = self.tds.cell_vertices(cell).iter().map(|&v| self.site(v));
                        writeln!(
                            svg,
                            r#"<polygon class="cell" points="{}"/>"#,
                            frame.list(corners)
                        )?;
                    }
                }
                Mark::Edges(edges) => {
                    self.draw_edges(svg, &frame, "edge", edges.iter().copied())?
                }
                Mark::Polygon(sites) => {
                    let corners = frame.list(finite(sites));
                    writeln!(svg, r#"<polygon class="polygon" points="{corners}"/>"#)?;
                }
                Mark::Line(dot @ &[_]) => {
                    for [x, y] in finite(dot).map(|p| frame.pixel(p)) {
                        writeln!(
                            svg,
                            r#"<circle class="dot" cx="{x:.2}" cy="{y:.2}" r="7"/>"#
                        )?;
                    }
                }
                Mark::Line(sites) => {
                    let sites = frame.list(finite(sites));
                    writeln!(svg, r#"<polyline class="line" points="{sites}"/>"#)?;
                }
            }
        }
        self.draw_edges(svg, &frame, "plain", self.tds.finite_edges())?;
        for v in self.tds.vertices() {
            let [x, y] = frame.pixel(self.site(v));
            writeln!(svg, r#"<circle cx="{x:.2}" cy="{y:.2}" r="3"/>"#)?;
            if self.vertex_count() <= MOST_NUMBERED {
                writeln!(
                    svg,
                    r#"<text x="{:.2}" y="{:.2}">{}</text>"#,
                    x + 5.0,
                    y - 5.0,
                    v.index()
                )?;
            }
        }
        writeln!(svg, "</svg>")
    }

    fn draw_edges(
        &self,
        svg: &mut String,
        frame: &PictureFrame,
        class: &str,
        edges: impl Iterator<Item = (CellId, usize)>,
    ) -> fmt::Result {
        for ends in edges.filter_map(|(cell, i)| self.finite_edge(cell, i)) {
            let [[x1, y1], [x2, y2]] = ends.map(|v| frame.pixel(self.site(v)));
            writeln!(
                svg,
                r#"<line class="{class}" x1="{x1:.2}" y1="{y1:.2}" x2="{x2:.2}" y2="{y2:.2}"/>"#
            )?;
        }
        Ok(())
    }
}
