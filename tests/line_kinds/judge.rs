//! What each kind of line promises, asked of a finished surface, with whole numbers.

use breakline::data::{EdgeKind, Surface};
use breakline::terrain::{River, Tin};
use breakline::triangulation::{LineId, Location};

use super::scene::{Line, RIVER, Ring, SIDE, Scene, WALL, floats};

/// Four units in the last place of the largest coordinate.
const MOVED: f64 = 4.0 * SIDE as f64 * f64::EPSILON;

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
    let without = Scene {
        draped: Vec::new(),
        holes: Vec::new(),
        bounds: None,
        ..scene.clone()
    };
    let whole = without
        .build(0)
        .map_err(|error| format!("without draped lines and holes: {error}"))?;
    walls(scene, &whole)?;
    rivers(scene, &whole)?;
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
    if error.starts_with("no triangle is left")
        && (!scene.holes.is_empty() || scene.bounds.is_some())
    {
        return Ok(());
    }
    Err(format!("refused: {error}"))
}

/// Returns true if two lakes of different heights share a point.
fn two_lakes_meet(scene: &Scene) -> bool {
    let lakes = &scene.lakes;
    (0..lakes.len())
        .any(|i| (0..i).any(|j| lakes[i].1 != lakes[j].1 && meet(&lakes[i].0, &lakes[j].0)))
}

/// Returns true if two closed rings or their insides share a point.
fn meet(p: &Ring, q: &Ring) -> bool {
    let inside = |ring: &Ring, at: [i64; 2]| position(ring, at, 1) != Position::Outside;
    let crossing = p
        .windows(2)
        .any(|s| q.windows(2).any(|t| cross([s[0], s[1]], [t[0], t[1]])));
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
                return Err(format!(
                    "an edge of line {} is not constrained",
                    line.index()
                ));
            }
            let face = cell.index() as u32;
            if tin.face(face).is_some() {
                let found = tin.edge_kind(face, i);
                let lines = triangulation.lines_through(pair[0], pair[1]);
                let kinds: Vec<EdgeKind> = lines
                    .filter_map(|line| tin.line_kind(line.index()))
                    .collect();
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
    let order = [
        EdgeKind::Shore,
        EdgeKind::Bank,
        EdgeKind::Wall,
        EdgeKind::Breakline,
        EdgeKind::Soft,
    ];
    order.into_iter().find(|kind| kinds.contains(kind))
}

/// The vertices of hard and soft lines that meet no line of a kind before theirs have the lowest of
/// their heights.
fn heights_of_lines(scene: &Scene, tin: &Tin) -> Result<(), String> {
    let in_water = |[x, y, _]: [f64; 3]| near_water(scene, [(x * 16.0) as i64, (y * 16.0) as i64]);
    for (lines, before) in [(&scene.hard, &[][..]), (&scene.soft, &scene.hard[..])] {
        for p in lines.iter().flat_map(|line| floats(line)) {
            let same = lines
                .iter()
                .flatten()
                .filter(|q| q[0] as f64 == p[0] && q[1] as f64 == p[1]);
            let lowest = same.map(|q| q[2] as f64).fold(f64::INFINITY, f64::min);
            let Location::Vertex(vertex) = tin.triangulation().locate(&p, None) else {
                return Err(format!("no vertex at {p:?} of a line"));
            };
            let found = tin.triangulation().point(vertex)[2];
            let is_theirs = scene
                .walls
                .iter()
                .chain(before)
                .any(|line| near_line(line, [p[0], p[1]], 4.0 * WALL));
            if !is_theirs && !in_water(p) && found != lowest {
                return Err(format!(
                    "the vertex {p:?} of a line is at {found}, expected {lowest}"
                ));
            }
        }
    }
    Ok(())
}

/// Where a segment of a wall meets nothing else, its upper edge has the heights of its line, and
/// its lower edge is 3 lower.
fn walls(scene: &Scene, tin: &Tin) -> Result<(), String> {
    let shores: Vec<Line> = scene
        .lakes
        .iter()
        .map(|(ring, _)| ring.iter().map(|p| [p[0], p[1], 0]).collect())
        .collect();
    for (number, wall) in scene.walls.iter().enumerate() {
        let others = scene
            .walls
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != number)
            .map(|(_, wall)| wall);
        let others: Vec<&Line> = others
            .chain(&scene.hard)
            .chain(&scene.soft)
            .chain(&shores)
            .collect();
        for (k, pair) in wall.windows(2).enumerate() {
            let own = wall
                .windows(2)
                .enumerate()
                .filter(|(other, _)| *other != k)
                .map(|(_, pair)| pair);
            let is_sharp = own.into_iter().any(|other| turns_sharply(pair, other));
            let is_met = others.iter().any(|other| are_close(pair, other, 0.05))
                || scene
                    .rivers
                    .iter()
                    .any(|river| are_close(pair, river, 1.5 * RIVER))
                || near_lake(scene, [pair[0][0] as f64, pair[0][1] as f64]);
            if is_sharp || is_met {
                continue;
            }
            let ends = floats(pair);
            let along = [0, 1, 2].map(|axis| ends[1][axis] - ends[0][axis]);
            let length = along[0].hypot(along[1]);
            for part in [0.3, 0.5, 0.8] {
                let [x, y, z] = [0, 1, 2].map(|axis| ends[0][axis] + part * along[axis]);
                // At corners the lower edge is up to two widths further along, and has slopes of up
                // to 8. A position is rounded to 1e-15, where the slope is 3 / WALL.
                for (by, expected, bound) in [(0.0, z, 1e-9), (WALL, z - 3.0, 16.0 * WALL)] {
                    let [x, y] = [x + by * along[1] / length, y - by * along[0] / length];
                    let found = tin
                        .elevation(x, y)
                        .ok_or_else(|| format!("no surface at {x} {y}, on a wall"))?;
                    if (found - expected).abs() > bound {
                        return Err(format!(
                            "the wall at {x} {y} is at {found}, expected {expected}"
                        ));
                    }
                }
            }
        }
    }
    Ok(())
}

/// Returns true if a segment touches a line or is no farther from it than a distance.
fn are_close(segment: &[[i64; 3]], line: &[[i64; 3]], distance: f64) -> bool {
    let plan = |pair: &[[i64; 3]]| [[pair[0][0], pair[0][1]], [pair[1][0], pair[1][1]]];
    line.windows(2).any(|other| {
        let near =
            |line: &[[i64; 3]], p: &[i64; 3]| near_line(line, [p[0] as f64, p[1] as f64], distance);
        cross(plan(segment), plan(other))
            || segment.iter().any(|p| near(other, p))
            || other.iter().any(|p| near(segment, p))
    })
}

/// Returns true if two segments of a line are not consecutive, or turn by more than 45 degrees.
fn turns_sharply(segment: &[[i64; 3]], other: &[[i64; 3]]) -> bool {
    let [p, q] = [segment, other].map(|pair| [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]]);
    let is_next = segment[1] == other[0] || other[1] == segment[0];
    let dot = (p[0] * q[0] + p[1] * q[1]) as f64;
    !is_next || dot < 0.7 * (p[0] as f64).hypot(p[1] as f64) * (q[0] as f64).hypot(q[1] as f64)
}

/// Where a river meets no other water, it is level across at each vertex of its middle line, at the
/// lowest height upstream.
fn rivers(scene: &Scene, tin: &Tin) -> Result<(), String> {
    for (number, river) in scene.rivers.iter().enumerate() {
        let mut line = floats(river);
        if line[0][2] < line[line.len() - 1][2] {
            line.reverse();
        }
        if River::along(&line, RIVER).is_ok_and(|river| river.overlap().is_some()) {
            continue;
        }
        let directions: Vec<[f64; 2]> = line
            .windows(2)
            .map(|pair| direction(pair[0], pair[1]))
            .collect();
        let mut level = f64::INFINITY;
        for (k, &[x, y, z]) in line.iter().enumerate() {
            level = level.min(z);
            let [before, after] = [
                directions[k.saturating_sub(1)],
                directions[k.min(directions.len() - 1)],
            ];
            let sum = [before[0] + after[0], before[1] + after[1]];
            let half_cosine = sum[0].hypot(sum[1]) / 2.0;
            let near = |line: &Line, by| near_line(line, [x, y], by);
            let is_met = scene
                .rivers
                .iter()
                .enumerate()
                .any(|(other, line)| other != number && near(line, 4.0))
                || scene
                    .lakes
                    .iter()
                    .any(|(ring, _)| near(&ring.iter().map(|p| [p[0], p[1], 0]).collect(), 2.0))
                || near_lake(scene, [x, y]);
            // At sharp bends, level lines meet on the inner bank.
            if is_met || half_cosine < 0.9 {
                continue;
            }
            let normal =
                [-sum[1], sum[0]].map(|c| c / (2.0 * half_cosine) / half_cosine * RIVER / 2.0);
            // Banks and ends are rounded: stay within.
            let inward = match k {
                0 => after,
                k if k == directions.len() => before.map(|c| -c),
                _ => [0.0; 2],
            };
            for part in [-1.0, -0.6, 0.0, 0.25, 1.0] {
                let part = part * (1.0 - 1e-9);
                let [u, v] =
                    [0, 1].map(|axis| [x, y][axis] + part * normal[axis] + 1e-9 * inward[axis]);
                let found = tin
                    .elevation(u, v)
                    .ok_or_else(|| format!("no surface at {u} {v}, in a river"))?;
                if (found - level).abs() > 1e-6 {
                    return Err(format!(
                        "the river at {u} {v} is at {found}, expected {level}"
                    ));
                }
            }
        }
    }
    Ok(())
}

fn direction(from: [f64; 3], to: [f64; 3]) -> [f64; 2] {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    [(to[0] - from[0]) / length, (to[1] - from[1]) / length]
}

/// Judges the height at a position, in units of 1 / 16. Returns false if it is too close to a line
/// to be judged.
fn probe(scene: &Scene, tin: &Tin, whole: &Tin, at: [i64; 2]) -> Result<bool, String> {
    let [x, y] = at.map(|c| c as f64 / 16.0);
    let height = tin.elevation(x, y);
    let before = whole.elevation(x, y);
    // Draped lines and holes change no height.
    if let Some([min, max]) = scene.bounds
        && (0..2).any(|k| at[k] < 16 * min[k] || at[k] > 16 * max[k])
    {
        return match height {
            None => Ok(true),
            Some(height) => Err(format!(
                "at {x} {y}, outside of the bounds, the surface is at {height}"
            )),
        };
    }
    let in_hole: Vec<Position> = scene
        .holes
        .iter()
        .map(|hole| position(hole, at, 16))
        .collect();
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
        return Err(format!(
            "at {x} {y} the surface is {height:?}, without draped lines and holes {before:?}"
        ));
    };
    // A cut moves lines by some units in the last place, and the surface by that times its slope,
    // which is unlimited where lines cross between grid points.
    let around = [[-MOVED, 0.0], [MOVED, 0.0], [0.0, -MOVED], [0.0, MOVED]];
    let heights = around.map(|[u, v]| whole.elevation(x + u, y + v).unwrap_or(before));
    let lowest = heights.into_iter().fold(before, f64::min) - 1e-6;
    let highest = heights.into_iter().fold(before, f64::max) + 1e-6;
    let is_as_before =
        (lowest..=highest).contains(&height) || may_be_exchanged(whole, [x, y], height);
    if !is_as_before && !near_wall(scene, [x, y]) {
        return Err(format!(
            "at {x} {y} draped lines change the height from {before} to {height}"
        ));
    }
    for (lake, level) in &scene.lakes {
        if position(lake, at, 16) == Position::Inside && height != *level as f64 {
            return Err(format!(
                "at {x} {y}, in a lake at {level}, the surface is at {height}"
            ));
        }
    }
    Ok(true)
}

/// Returns true if the triangle at a position may have a height there once a cut has exchanged
/// corners for vertices at most [`MOVED`] away.
fn may_be_exchanged(tin: &Tin, p: [f64; 2], height: f64) -> bool {
    let triangulation = tin.triangulation();
    let Location::Cell { cell, .. } = triangulation.locate(&[p[0], p[1], 0.0], None) else {
        return false;
    };
    let Some(corners) = tin.triangle(cell.index() as u32) else {
        return false;
    };
    let twice = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let [a, b, c] = corners.map(|[x, y, _]| [x, y]);
    let shares = [twice(b, c, p), twice(c, a, p), twice(a, b, p)].map(|area| area / twice(a, b, c));
    let near = corners.map(|[x, y, _]| {
        let vertices = triangulation
            .tds()
            .vertices()
            .map(|vertex| *triangulation.point(vertex));
        let near = vertices.filter(|q| (q[0] - x).abs().max((q[1] - y).abs()) <= MOVED);
        near.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| {
            [low.min(q[2]), high.max(q[2])]
        })
    });
    let [low, high] = [0, 1].map(|end| (0..3).map(|i| shares[i] * near[i][end]).sum::<f64>());
    (low - 1e-6..=high + 1e-6).contains(&height)
}

fn near_wall(scene: &Scene, p: [f64; 2]) -> bool {
    scene
        .walls
        .iter()
        .any(|wall| near_line(wall, p, 4.0 * WALL))
}

/// Returns true if a position is no farther than a distance from a line.
fn near_line(line: &[[i64; 3]], [x, y]: [f64; 2], distance: f64) -> bool {
    floats(line).windows(2).any(|pair| {
        let [a, b] = [pair[0], pair[1]];
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = along[0].hypot(along[1]);
        let part =
            (((x - a[0]) * along[0] + (y - a[1]) * along[1]) / (length * length)).clamp(0.0, 1.0);
        (a[0] + part * along[0] - x).hypot(a[1] + part * along[1] - y) <= distance
    })
}

fn near_lake(scene: &Scene, [x, y]: [f64; 2]) -> bool {
    let at = [(x * 16.0) as i64, (y * 16.0) as i64];
    scene
        .lakes
        .iter()
        .any(|(lake, _)| position(lake, at, 16) != Position::Outside)
}

/// Returns true if a position, in units of 1 / 16, lies in a lake or on its shore, or may lie in a
/// river.
fn near_water(scene: &Scene, at: [i64; 2]) -> bool {
    let p = at.map(|c| c as f64 / 16.0);
    near_lake(scene, p)
        || scene
            .rivers
            .iter()
            .any(|river| near_line(river, p, 1.5 * RIVER))
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
    if is_odd {
        Position::Inside
    } else {
        Position::Outside
    }
}

/// Returns true if two segments share a point.
fn cross([a, b]: [[i64; 2]; 2], [c, d]: [[i64; 2]; 2]) -> bool {
    let turn = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
        ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).signum()
    };
    let within = |k: usize| a[k].min(b[k]) <= c[k].max(d[k]) && c[k].min(d[k]) <= a[k].max(b[k]);
    within(0)
        && within(1)
        && turn(a, b, c) * turn(a, b, d) <= 0
        && turn(c, d, a) * turn(c, d, b) <= 0
}
