//! The expected result of a cut, computed from the definition in exact numbers.
//!
//! - *Area*: by slabs between all sites where sides of rings and of the surface end or cross. In a
//!   slab the sides have one order from bottom to top, and the even-odd rule decides what is kept
//!   between each two of them.
//! - *Rim*: each side without a neighbor lies along the boundary of that area, so there is no
//!   crack. Between two lines less than a rounding error apart, a sliver may extend beyond their
//!   end: its sides lie along one of the two, and outside.
//! - *Heights*: each vertex, and the middle of each face, has the height of the triangle of the
//!   uncut surface there.
//! - *Fragments*: each has an area, and none has a vertex of another one inside a side.

use breakline::terrain::{Tin, surface_flaws};
use dashu_ratio::RBig;

use crate::found::{Exact, Found, exact, turn};
use crate::scene::Scene;

/// How far a cut may move points, in units in the last place of the largest coordinate of the
/// surface and of the rings; coordinates of rings count up to twice the surface's.
const UNITS: f64 = 2.0;

/// Judges the clipped surface of a scene; returns the number of its faces.
pub(crate) fn judge(scene: &Scene) -> Result<usize, String> {
    let uncut = match scene.builder().build() {
        Ok(tin) if tin.report().triangles > 0 => tin,
        _ => return Ok(0), // nothing to cut
    };
    let mut builder = scene.builder();
    scene
        .polygons
        .iter()
        .for_each(|rings| builder.add_boundary(rings));
    builder.bounds = scene.bounds;
    let tin = builder.build().map_err(|error| error.to_string())?;
    let (before, after) = (Found::new(&uncut)?, Found::new(&tin)?);
    let region = Region::new(scene, &before);
    judge_fragments(&after)?;
    judge_area(&region, &after)?;
    judge_rim(scene, &region, &after)?;
    judge_heights(&region, &before, &after)?;
    judge_uncut(&uncut, &tin)?;
    match surface_flaws(&tin).first() {
        Some(flaw) => Err(format!("check: {flaw}")),
        None => Ok(after.faces.len()),
    }
}

fn judge_fragments(after: &Found) -> Result<(), String> {
    for &face in &after.faces {
        let [a, b, c] = after.corners(face);
        if turn(a, b, c) <= RBig::ZERO {
            return Err(format!("face {face:?} has no area"));
        }
    }
    for &[from, to] in &after.rim {
        let (p, q) = (after.at(from), after.at(to));
        for vertex in after
            .faces
            .as_flattened()
            .iter()
            .filter(|&&v| v != from && v != to)
        {
            let v = after.at(*vertex);
            let along = (&v[0] - &p[0]) * (&q[0] - &p[0]) + (&v[1] - &p[1]) * (&q[1] - &p[1]);
            let length = (&q[0] - &p[0]) * (&q[0] - &p[0]) + (&q[1] - &p[1]) * (&q[1] - &p[1]);
            if turn(p, q, v) == RBig::ZERO && along > RBig::ZERO && along < length {
                return Err(format!(
                    "vertex {vertex} lies in the middle of the side {from} {to}"
                ));
            }
        }
    }
    Ok(())
}

fn judge_area(region: &Region, after: &Found) -> Result<(), String> {
    let twice = after.faces.iter().fold(RBig::ZERO, |sum, &face| {
        let [a, b, c] = after.corners(face);
        sum + turn(a, b, c)
    });
    let off = (twice / exact(2.0) - &region.area).to_f64().value();
    let tolerance = UNITS * region.unit * region.perimeter;
    if off.abs() > tolerance {
        let area = region.area.to_f64().value();
        return Err(format!(
            "the area is off by {off}, tolerance {tolerance}, expected {area}"
        ));
    }
    Ok(())
}

fn judge_rim(scene: &Scene, region: &Region, after: &Found) -> Result<(), String> {
    for &[from, to] in &after.rim {
        let (p, q) = (after.at(from), after.at(to));
        let exactly = [0, 1].map(|k| (&p[k] + &q[k]) / exact(2.0));
        let middle = [0, 1].map(|k| (&exactly[k] - &region.origin[k]).to_f64().value());
        let is_near_rim = region
            .rim
            .iter()
            .any(|&side| distance(side, middle) <= UNITS * region.unit);
        if !is_near_rim && (region.holds(scene, &exactly) || !region.is_along_a_line(&exactly)) {
            return Err(format!(
                "a crack: nothing bounds the surface along {from} {to}, at {middle:?} from its corner"
            ));
        }
    }
    Ok(())
}

/// Each vertex and the middle of each face against the planes of the triangles there.
fn judge_heights(region: &Region, before: &Found, after: &Found) -> Result<(), String> {
    let vertices = (0..)
        .zip(&after.vertices)
        .filter_map(|(i, p)| Some((format!("vertex {i}"), p.clone()?)));
    let middle = |&face: &[usize; 3]| {
        let [a, b, c] = after.corners(face);
        let corners = [a, b, c].map(|p| [0, 1, 2].map(|k| p[k].to_f64().value()));
        (
            format!("the middle of {face:?}, {corners:?}"),
            [0, 1, 2].map(|k| (&a[k] + &b[k] + &c[k]) / exact(3.0)),
        )
    };
    for (what, p) in vertices.chain(after.faces.iter().map(middle)) {
        let here = before
            .faces
            .iter()
            .map(|&face| before.corners(face))
            .filter(|face| is_near(face, &p, region.unit));
        let off: Vec<(f64, f64)> = here.map(|face| off_plane(face, &p, region.unit)).collect();
        if !off.iter().any(|(off, tolerance)| off <= tolerance) {
            let site = [0, 1, 2].map(|k| p[k].to_f64().value());
            return Err(format!(
                "{what}, at {site:?}, is off by and may be by {off:?}"
            ));
        }
    }
    Ok(())
}

/// Returns true if a triangle is within the distance of a site by which a cut may move it.
fn is_near([a, b, c]: &[&Exact; 3], p: &Exact, unit: f64) -> bool {
    // Rounding loses far less than this, and most triangles are farther away.
    const FAR: f64 = 1e-3;
    let [at, corners] = [[p, p, p], [*a, *b, *c]]
        .map(|points| points.map(|p| [0, 1].map(|k| p[k].to_f64().value())));
    let is_far = |k: usize| {
        let [u, v, w] = corners.map(|corner| corner[k] - at[0][k]);
        u.min(v).min(w) > FAR || u.max(v).max(w) < -FAR
    };
    if is_far(0) || is_far(1) {
        return false;
    }
    [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
        let length = [0, 1].map(|k| (&to[k] - &from[k]).to_f64().value());
        turn(*from, *to, p).to_f64().value() >= -UNITS * unit * length[0].hypot(length[1])
    })
}

/// The distance of a point from the plane of a triangle, and the allowed one.
fn off_plane([a, b, c]: [&Exact; 3], p: &Exact, unit: f64) -> (f64, f64) {
    let size = turn(a, b, c);
    let (at_b, at_c) = (turn(a, p, c) / &size, turn(a, b, p) / &size);
    let [up_b, up_c] = [&b[2] - &a[2], &c[2] - &a[2]];
    let off = (&p[2] - &a[2] - at_b * &up_b - at_c * &up_c)
        .to_f64()
        .value();
    let slope = [(1, &up_b, &up_c), (0, &up_b, &up_c)].map(|(k, up_b, up_c)| {
        (((&c[k] - &a[k]) * up_b - (&b[k] - &a[k]) * up_c) / &size)
            .to_f64()
            .value()
    });
    let highest = [a, b, c]
        .map(|q| q[2].to_f64().value().abs())
        .into_iter()
        .fold(0.0, f64::max);
    (
        off.abs(),
        UNITS * unit * slope[0].hypot(slope[1]) + 1e-12 * highest,
    )
}

/// Checks that the triangulation underneath is that of the uncut surface.
fn judge_uncut(uncut: &Tin, tin: &Tin) -> Result<(), String> {
    let all = |tin: &Tin| {
        let t = tin.triangulation();
        t.finite_cells()
            .map(|cell| t.tds().corners(cell).map(|v| t.point(v).map(f64::to_bits)))
            .collect::<Vec<_>>()
    };
    if all(uncut) == all(tin) {
        Ok(())
    } else {
        Err("the triangulation beneath has changed".to_owned())
    }
}

/// The part of the surface that is to be kept.
struct Region {
    area: RBig,
    /// The parts of what bounds it, from the origin.
    rim: Vec<[[f64; 2]; 2]>,
    origin: [RBig; 2],
    /// Of the rings and of the surface.
    perimeter: f64,
    /// The last place of the largest coordinate.
    unit: f64,
    /// The surface's number among the domains.
    surface: usize,
    lines: Vec<Line>,
}

/// A side of a ring, of which domain; sheared, so that it is not upright.
struct Line {
    domain: usize,
    from: [RBig; 2],
    to: [RBig; 2],
    slope: RBig,
    /// Rounded: the ends and the slope.
    about: [[f64; 2]; 2],
    about_slope: f64,
    doubt: f64,
}

/// Far more than a rounding error in numbers of the size of a scene; relative for others.
const DOUBT: f64 = 1e-6;
const RELATIVE_DOUBT: f64 = 1e-12;

impl Line {
    fn new(domain: usize, from: [RBig; 2], to: [RBig; 2]) -> Self {
        assert!(from[0] < to[0], "a side is upright when sheared");
        let slope = (&to[1] - &from[1]) / (&to[0] - &from[0]);
        let about = [&from, &to].map(|p| [0, 1].map(|k| p[k].to_f64().value()));
        let largest = about
            .as_flattened()
            .iter()
            .fold(0.0, |sum: f64, x| sum.max(x.abs()));
        let doubt = DOUBT + RELATIVE_DOUBT * largest;
        Line {
            domain,
            from,
            to,
            about_slope: slope.to_f64().value(),
            slope,
            about,
            doubt,
        }
    }

    fn height(&self, x: &RBig) -> RBig {
        &self.from[1] + (x - &self.from[0]) * &self.slope
    }

    /// The height, rounded, and its largest error.
    fn about(&self, x: f64) -> (f64, f64) {
        (
            self.about[0][1] + (x - self.about[0][0]) * self.about_slope,
            self.doubt * (1.0 + self.about_slope.abs()),
        )
    }

    fn is_apart(&self, other: &Line) -> bool {
        (0..2).any(|k| {
            let low = |line: &Line| line.about[0][k].min(line.about[1][k]) - line.doubt;
            let high = |line: &Line| line.about[0][k].max(line.about[1][k]) + line.doubt;
            low(self) > high(other) || low(other) > high(self)
        })
    }

    /// Where it crosses another line, along x, if they are not parallel.
    fn crossing(&self, other: &Line) -> Option<RBig> {
        if self.is_apart(other) || self.slope == other.slope {
            return None;
        }
        let x =
            (other.height(&RBig::ZERO) - self.height(&RBig::ZERO)) / (&self.slope - &other.slope);
        let is_within = |line: &Line| line.from[0] < x && x < line.to[0];
        (is_within(self) && is_within(other)).then_some(x)
    }
}

impl Region {
    fn new(scene: &Scene, before: &Found) -> Self {
        let curves = scene.curves();
        let origin = before.at(before.faces[0][0]);
        let origin = [origin[0].clone(), origin[1].clone()];
        // The surface is one more domain.
        let surface = scene.polygons.len() + 1;
        let sheared = |p: &[RBig]| sheared(&origin, p);
        let mut sides: Vec<(usize, [[RBig; 2]; 2])> = Vec::new();
        for (domain, ring) in &curves {
            let next = ring.iter().cycle().skip(1);
            sides.extend(
                ring.iter()
                    .zip(next)
                    .map(|(p, q)| (*domain, [p, q].map(|p| sheared(&p.map(exact))))),
            );
        }
        sides.extend(
            before
                .rim
                .iter()
                .map(|ends| (surface, ends.map(|end| sheared(before.at(end))))),
        );
        sides.retain(|(_, [p, q])| p != q);
        let length = |[p, q]: &[[RBig; 2]; 2]| {
            let [x, y] = [0, 1].map(|k| (&q[k] - &p[k]).to_f64().value());
            x.hypot(y)
        };
        // No side runs further through the surface than the sum of the rim's sides.
        let around: f64 = sides
            .iter()
            .filter(|(domain, _)| *domain == surface)
            .map(|(_, side)| length(side))
            .sum();
        let perimeter = sides.iter().map(|(_, side)| length(side).min(around)).sum();
        let coordinates = before.vertices.iter().flatten().flat_map(|p| &p[..2]);
        let of_surface = coordinates.fold(0.0, |sum: f64, x| sum.max(x.to_f64().value().abs()));
        let of_curves = curves.iter().flat_map(|(_, ring)| ring.as_flattened());
        let largest = of_curves
            .fold(of_surface, |sum, x| sum.max(x.abs()))
            .min(2.0 * of_surface);
        let lines: Vec<Line> = sides
            .into_iter()
            .map(|(domain, [p, q])| {
                let (from, to) = if p[0] < q[0] { (p, q) } else { (q, p) };
                Line::new(domain, from, to)
            })
            .collect();
        let unit = largest.next_up() - largest;
        let mut region = Region {
            area: RBig::ZERO,
            rim: Vec::new(),
            origin,
            perimeter,
            unit,
            surface,
            lines: Vec::new(),
        };
        let mut at: Vec<RBig> = lines
            .iter()
            .flat_map(|line| [line.from[0].clone(), line.to[0].clone()])
            .collect();
        for (i, line) in lines.iter().enumerate() {
            at.extend(lines[..i].iter().filter_map(|other| line.crossing(other)));
        }
        at.sort();
        at.dedup();
        for slab in at.windows(2) {
            region.add_slab(scene, surface, &lines, &slab[0], &slab[1]);
        }
        region.lines = lines;
        region
    }

    /// Returns true if a site is part of what is kept, by the lines above it.
    fn holds(&self, scene: &Scene, site: &[RBig; 2]) -> bool {
        let [x, y] = sheared(&self.origin, site);
        let mut within = vec![false; self.surface + 1];
        for line in self
            .lines
            .iter()
            .filter(|line| line.from[0] <= x && x < line.to[0])
        {
            within[line.domain] ^= line.height(&x) > y;
        }
        within[self.surface] && scene.is_kept(|domain| within[domain])
    }

    /// Returns true if a site is within the distance of a ring, or of the rim of the uncut surface,
    /// by which a cut may move it.
    fn is_along_a_line(&self, site: &[RBig; 2]) -> bool {
        let [x, y] = sheared(&self.origin, site);
        let reach = UNITS * self.unit;
        self.lines.iter().any(|line| {
            let is_above = line.from[0] <= &x + exact(reach) && &x - exact(reach) <= line.to[0];
            let off = (line.height(&x) - &y).to_f64().value();
            is_above && off.abs() <= reach * 1.0_f64.hypot(line.about_slope)
        })
    }

    fn add_slab(
        &mut self,
        scene: &Scene,
        surface: usize,
        lines: &[Line],
        left: &RBig,
        right: &RBig,
    ) {
        let middle = (left + right) / exact(2.0);
        let here = lines
            .iter()
            .filter(|line| line.from[0] <= *left && *right <= line.to[0]);
        let about = middle.to_f64().value();
        let mut here: Vec<&Line> = here.collect();
        let order = |p: &Line, q: &Line| {
            let ((mine, doubt), (theirs, other)) = (p.about(about), q.about(about));
            if (mine - theirs).abs() > doubt + other {
                return mine.total_cmp(&theirs);
            }
            p.height(&middle).cmp(&q.height(&middle))
        };
        here.sort_by(|p, q| order(p, q));
        let mut within = vec![false; surface + 1];
        let mut is_kept = false;
        let mut start: Option<RBig> = None;
        for same in here.chunk_by(|p, q| order(p, q).is_eq()) {
            same.iter().for_each(|line| within[line.domain] ^= true);
            let now = within[surface] && scene.is_kept(|domain| within[domain]);
            if now == is_kept {
                continue;
            }
            is_kept = now;
            let line = same[0];
            // Undo the shear; far less than a unit is lost.
            let end = |x: &RBig| {
                let y = line.height(x).to_f64().value();
                [x.to_f64().value() - y / 65_537.0, y]
            };
            self.rim.push([end(left), end(right)]);
            match start.take() {
                None => start = Some(line.height(&middle)),
                Some(below) => self.area += (line.height(&middle) - below) * (right - left),
            }
        }
    }
}

/// Relative to the origin, and sheared so that no side is vertical.
fn sheared(origin: &[RBig; 2], p: &[RBig]) -> [RBig; 2] {
    let [x, y] = [0, 1].map(|k| &p[k] - &origin[k]);
    [x + RBig::from_parts(1.into(), 65_537u32.into()) * &y, y]
}

/// The distance of a site from a segment.
fn distance([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    let [ux, uy] = [b[0] - a[0], b[1] - a[1]];
    let [vx, vy] = [p[0] - a[0], p[1] - a[1]];
    let along = ((vx * ux + vy * uy) / (ux * ux + uy * uy)).clamp(0.0, 1.0);
    let along = if along.is_nan() { 0.0 } else { along };
    (vx - along * ux).hypot(vy - along * uy)
}
