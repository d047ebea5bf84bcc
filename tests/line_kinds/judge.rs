//! What each kind of line promises, asked of a finished surface, with whole numbers.

use breakline::data::{EdgeKind, Surface};
use breakline::terrain::Tin;
use breakline::triangulation::LineId;

use super::scene::{Ring, SIDE, Scene, WALL, floats};

/// Probes per cell, and their distance from lines.
const PROBES: i64 = 4;

/// Returns what is wrong with the surface of a scene, or how many probes were judged.
///
/// # Errors
/// The first promise that is broken.
pub(crate) fn judge(scene: &Scene) -> Result<usize, String> {
    let tin = match scene.build(0) {
        Ok(tin) => tin,
        Err(error) => return refused(scene, &error.to_string()).map(|()| 0),
    };
    if two_lakes_meet(scene) {
        return Err("lakes of different heights meet, and were accepted".to_owned());
    }
    edges(&tin)?;
    heights_of_lines(scene, &tin)?;
    let without = Scene { draped: Vec::new(), holes: Vec::new(), ..scene.clone() };
    let whole = without.build(0).map_err(|error| format!("without draped lines and holes: {error}"))?;
    let mut judged = 0;
    for i in 0..SIDE * PROBES {
        for j in 0..SIDE * PROBES {
            // Away from all lines of the grid, in units of 1 / 16 cells.
            let [x, y] = [i, j].map(|k| k * (16 / PROBES) + 1);
            judged += usize::from(probe(scene, &tin, &whole, [x, y])?);
        }
    }
    Ok(judged)
}

/// An error is right if lakes of different heights meet, or nothing is left.
fn refused(scene: &Scene, error: &str) -> Result<(), String> {
    if error.starts_with("two lakes meet") && two_lakes_meet(scene) {
        return Ok(());
    }
    Err(format!("refused: {error}"))
}

/// Returns true if two lakes of different heights share a point.
fn two_lakes_meet(scene: &Scene) -> bool {
    let lakes = &scene.lakes;
    (0..lakes.len()).any(|i| (0..i).any(|j| lakes[i].1 != lakes[j].1 && meet(&lakes[i].0, &lakes[j].0)))
}

/// Returns true if two closed rings or their insides share a point.
fn meet(p: &Ring, q: &Ring) -> bool {
    let inside = |ring: &Ring, at: [i64; 2]| position(ring, at, 1) != Position::Outside;
    let crossing = p.windows(2).any(|s| q.windows(2).any(|t| cross([s[0], s[1]], [t[0], t[1]])));
    crossing || inside(p, q[0]) || inside(q, p[0])
}

/// Every edge of every line is in the triangulation, and has the kind that comes first there.
fn edges(tin: &Tin) -> Result<(), String> {
    let triangulation = tin.triangulation();
    for line in triangulation.lines() {
        let kind = tin.line_kind(line.index()).ok_or("a line without a kind")?;
        for pair in triangulation.chain(LineId::new(line.index())).windows(2) {
            let Some((cell, i)) = triangulation.tds().edge(pair[0], pair[1]) else {
                return Err(format!("an edge of line {} is missing", line.index()));
            };
            if !triangulation.is_constrained(cell, i) {
                return Err(format!("an edge of line {} is not constrained", line.index()));
            }
            let face = cell.index() as u32;
            if tin.face(face).is_some() {
                let found = tin.edge_kind(face, i);
                let lines = triangulation.lines_through(pair[0], pair[1]);
                let kinds: Vec<EdgeKind> = lines.filter_map(|line| tin.line_kind(line.index())).collect();
                let first = first_of(&kinds);
                if Some(found) != first || !kinds.contains(&kind) {
                    return Err(format!("an edge on lines of {kinds:?} is {found:?}"));
                }
            }
        }
    }
    Ok(())
}

fn first_of(kinds: &[EdgeKind]) -> Option<EdgeKind> {
    let order = [EdgeKind::Shore, EdgeKind::Bank, EdgeKind::Wall, EdgeKind::Breakline, EdgeKind::Soft];
    order.into_iter().find(|kind| kinds.contains(kind))
}

/// The vertices of a line that meets no line of a kind before it have the heights of that line.
fn heights_of_lines(scene: &Scene, tin: &Tin) -> Result<(), String> {
    let in_water = |[x, y, _]: [f64; 3]| near_water(scene, [(x * 16.0) as i64, (y * 16.0) as i64]);
    let at = |p: [f64; 3]| tin.triangulation().locate(&p, None);
    for line in &scene.hard {
        for p in floats(line) {
            let lowest = scene
                .hard
                .iter()
                .flatten()
                .filter(|q| q[0] as f64 == p[0] && q[1] as f64 == p[1])
                .map(|q| q[2] as f64)
                .fold(f64::INFINITY, f64::min);
            let on_wall = scene.walls.iter().any(|wall| near_line(wall, [p[0], p[1]]));
            let breakline::triangulation::Location::Vertex(vertex) = at(p) else {
                return Err(format!("no vertex at {p:?} of a breakline"));
            };
            let found = tin.triangulation().point(vertex)[2];
            if !on_wall && !in_water(p) && found != lowest {
                return Err(format!("the breakline's vertex {p:?} is at {found}, expected {lowest}"));
            }
        }
    }
    Ok(())
}

/// Judges the height at a position, in units of 1 / 16. Returns false if it is too close to a line
/// to be judged.
fn probe(scene: &Scene, tin: &Tin, whole: &Tin, at: [i64; 2]) -> Result<bool, String> {
    let [x, y] = at.map(|c| c as f64 / 16.0);
    let height = tin.elevation(x, y);
    let before = whole.elevation(x, y);
    // Draped lines and holes change no height.
    let in_hole: Vec<Position> = scene.holes.iter().map(|hole| position(hole, at, 16)).collect();
    if in_hole.contains(&Position::Rim) {
        return Ok(false);
    }
    if in_hole.contains(&Position::Inside) {
        return match height {
            None => Ok(true),
            Some(height) => Err(format!("at {x} {y}, in a hole, the surface is at {height}")),
        };
    }
    let (Some(height), Some(before)) = (height, before) else {
        return Err(format!("at {x} {y} the surface is {height:?}, without draped lines and holes {before:?}"));
    };
    // A cut moves lines by some units in the last place, and the surface by that times its slope,
    // which is 3 / WALL at walls and unlimited where lines cross between grid points.
    if (height - before).abs() > 1e-6 && !near_wall(scene, [x, y]) {
        return Err(format!("at {x} {y} draped lines change the height from {before} to {height}"));
    }
    for (lake, level) in &scene.lakes {
        if position(lake, at, 16) == Position::Inside && height != *level as f64 {
            return Err(format!("at {x} {y}, in a lake at {level}, the surface is at {height}"));
        }
    }
    Ok(true)
}

fn near_wall(scene: &Scene, p: [f64; 2]) -> bool {
    scene.walls.iter().any(|wall| near_line(wall, p))
}

/// Returns true if a position is within a few widths of walls of a line.
fn near_line(line: &[[i64; 3]], [x, y]: [f64; 2]) -> bool {
    floats(line).windows(2).any(|pair| {
        let [a, b] = [pair[0], pair[1]];
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = along[0].hypot(along[1]);
        let part = (((x - a[0]) * along[0] + (y - a[1]) * along[1]) / (length * length)).clamp(0.0, 1.0);
        (a[0] + part * along[0] - x).hypot(a[1] + part * along[1] - y) <= 4.0 * WALL
    })
}

/// Returns true if a position, in units of 1 / 16, lies in a lake or on its shore, or may lie in a
/// river.
fn near_water(scene: &Scene, at: [i64; 2]) -> bool {
    let in_lake = scene.lakes.iter().any(|(lake, _)| position(lake, at, 16) != Position::Outside);
    let [x, y] = at.map(|c| c as f64 / 16.0);
    let near = |line: &Vec<[i64; 3]>| {
        floats(line).windows(2).any(|pair| {
            let [a, b] = [pair[0], pair[1]];
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = along[0].hypot(along[1]);
            let part = (((x - a[0]) * along[0] + (y - a[1]) * along[1]) / (length * length)).clamp(0.0, 1.0);
            (a[0] + part * along[0] - x).hypot(a[1] + part * along[1] - y) <= 1.5
        })
    };
    in_lake || scene.rivers.iter().any(near)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Position {
    Inside,
    Rim,
    Outside,
}

/// The position of a point, in units of 1 / `scale`, relative to a closed ring.
fn position(ring: &Ring, [x, y]: [i64; 2], scale: i64) -> Position {
    let mut is_odd = false;
    for side in ring.windows(2) {
        let [[ax, ay], [bx, by]] = [side[0], side[1]].map(|p| p.map(|c| c * scale));
        let turn = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
        let within = |a: i64, b: i64, c: i64| a.min(b) <= c && c <= a.max(b);
        if turn == 0 && within(ax, bx, x) && within(ay, by, y) {
            return Position::Rim;
        }
        if (ay > y) != (by > y) && (turn > 0) == (by > ay) {
            is_odd = !is_odd;
        }
    }
    if is_odd { Position::Inside } else { Position::Outside }
}

/// Returns true if two segments share a point.
fn cross([a, b]: [[i64; 2]; 2], [c, d]: [[i64; 2]; 2]) -> bool {
    let turn = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
        ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).signum()
    };
    let within = |k: usize| a[k].min(b[k]) <= c[k].max(d[k]) && c[k].min(d[k]) <= a[k].max(b[k]);
    within(0) && within(1) && turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0
}
