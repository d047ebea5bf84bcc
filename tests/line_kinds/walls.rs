//! Walls that turn sharply, in one record and in several, and walls that meet at one vertex.

use std::sync::Arc;

use breakline::data::{Layer, Shape};
use breakline::run::{
    Context, Input, LineRequest, LowerEdge, PerRecord, Source, SurfaceProduct, SurfaceRequest,
    TinRequest, WallOptions, triangles,
};
use breakline::terrain::{HighSide, TinBuilder, Wall};
use breakline::triangulation::LineId;
use rayon::prelude::*;
use testkit::random::Random;

use super::count;
use super::scene::SIDE;

type Line = Vec<[f64; 3]>;

/// Points at 0; none lies on a line between sites of the grid.
fn field() -> Line {
    let along = || (-SIDE..=2 * SIDE).step_by(4).map(|c| c as f64);
    let sites = along().flat_map(|x| along().map(move |y| [x, y]));
    sites
        .map(|[x, y]| [x + 0.371 + 0.013 * y, y + 0.249 - 0.0017 * x, 0.0])
        .collect()
}

/// Builds a surface over a field at 0 with walls, 3 high, in layers of records.
fn build(layers: &[Vec<Line>], width: f64, high: HighSide) -> breakline::Result<SurfaceProduct> {
    let layer = |records: &Vec<Line>| {
        let shapes = records
            .iter()
            .map(|line| Shape::Lines(vec![line.clone()]))
            .collect();
        Input::Memory(Arc::new(Layer {
            shapes,
            ..Layer::default()
        }))
    };
    let wall = WallOptions {
        lower: Some(LowerEdge::Drop(PerRecord::Number(3.0))),
        width: Some(width),
        high,
    };
    let lines = LineRequest {
        walls: layers.iter().map(layer).collect(),
        wall,
        ..LineRequest::default()
    };
    let tin = TinRequest {
        points: vec![Input::of_points(&field(), None)],
        lines,
        ..TinRequest::default()
    };
    let request = SurfaceRequest {
        source: Source::Points(Box::new(tin)),
        ..SurfaceRequest::default()
    };
    triangles(&request, &Context::default())
}

/// The height of upper edges: where several meet, they agree.
fn height([x, y]: [f64; 2]) -> f64 {
    10.0 + x / 8.0 - y / 4.0
}

fn with_heights(line: &[[f64; 2]]) -> Line {
    line.iter().map(|&[x, y]| [x, y, height([x, y])]).collect()
}

/// The vertices on upper edges have their heights. Returns their number.
fn upper_edges(lines: &[Line], width: f64, high: HighSide) -> Result<usize, String> {
    let uppers: Vec<&[[f64; 3]]> = lines.iter().map(Vec::as_slice).collect();
    let mut builder = TinBuilder::default();
    let [x, y, z] = [0, 1, 2].map(|axis| field().iter().map(|p| p[axis]).collect::<Vec<f64>>());
    builder.add_points(&x, &y, &z);
    let mut numbers = Vec::new();
    for (upper, ends) in uppers.iter().zip(Wall::neighbors(&uppers, high)) {
        let lower: Vec<f64> = upper.iter().map(|p| p[2] - 3.0).collect();
        let wall =
            Wall::continued(upper, &lower, width, high, ends).map_err(|error| error.to_string())?;
        numbers.push(builder.add_wall(&wall).start);
    }
    let tin = builder.build().map_err(|error| error.to_string())?;
    let triangulation = tin.triangulation();
    let mut judged = 0;
    for vertex in numbers
        .into_iter()
        .flat_map(|number| triangulation.chain(LineId::new(number)))
    {
        let [x, y, z] = *triangulation.point(vertex);
        judged += 1;
        if (z - height([x, y])).abs() > 1e-9 {
            return Err(format!(
                "the upper edge at {x} {y} is at {z}, expected {}",
                height([x, y])
            ));
        }
    }
    Ok(judged)
}

/// A line with sharp corners, vertices at which it turns back, and segments shorter than the width.
fn bent(random: &mut Random, width: f64) -> Line {
    let count = 3 + random.below(6);
    let mut line: Vec<[f64; 2]> = Vec::new();
    while (line.len() as u64) < count {
        let near =
            |p: [f64; 2], random: &mut Random, by: f64| p.map(|c| c + by * random.around(3) as f64);
        let next = match (random.below(6), line.as_slice()) {
            (0, &[.., p, _]) => p,
            (1, &[.., p, q]) => [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0],
            (2, &[.., p, _]) => near(p, random, width),
            (3, &[.., p]) => near(p, random, width / 4.0),
            _ => [0, 0].map(|_| random.below(SIDE as u64) as f64),
        };
        if line.last() != Some(&next) {
            line.push(next);
        }
    }
    if random.below(3) == 0 && line.last() != line.first() {
        line.push(line[0]);
    }
    with_heights(&line)
}

/// The parts of a line, in a random order, in up to three layers.
fn in_parts(line: &[[f64; 3]], random: &mut Random) -> Vec<Vec<Line>> {
    let last = line.len() - 1;
    let cuts: Vec<usize> = (1..last).filter(|_| random.below(2) == 0).collect();
    let from = std::iter::once(0).chain(cuts.iter().copied());
    let to = cuts.iter().copied().chain([last]);
    let mut parts: Vec<Line> = from
        .zip(to)
        .map(|(from, to)| line[from..=to].to_vec())
        .collect();
    random.shuffle(&mut parts);
    let mut layers: Vec<Vec<Line>> = vec![Vec::new(); 3];
    for part in parts {
        layers[random.index(3)].push(part);
    }
    layers.retain(|layer| !layer.is_empty());
    layers
}

/// Returns true if a line visits a site twice other than by closing, so that its parts do not say
/// which one goes on in which.
fn is_ambiguous(line: &[[f64; 3]]) -> bool {
    let open = if line[0][..2] == line[line.len() - 1][..2] {
        &line[1..]
    } else {
        line
    };
    (0..open.len()).any(|i| (0..i).any(|j| open[i][..2] == open[j][..2]))
}

fn judge_bent(seed: u64) -> Result<usize, String> {
    let mut random = Random(seed);
    let width = random.pick(&[1.0 / 1024.0, 0.01, 0.3]);
    let high = random.pick(&[HighSide::Left, HighSide::Right]);
    let line = bent(&mut random, width);
    let whole = build(&[vec![line.clone()]], width, high).map_err(|error| error.to_string())?;
    let whole = whole.triangles().map_err(|error| error.to_string())?;
    let layers = in_parts(&line, &mut random);
    let parts = build(&layers, width, high).map_err(|error| error.to_string())?;
    let parts = parts.triangles().map_err(|error| error.to_string())?;
    let judged = upper_edges(std::slice::from_ref(&line), width, high);
    let judged = judged.and_then(|_| upper_edges(&layers.concat(), width, high));
    if !is_ambiguous(&line) && super::content(whole) != super::content(parts) {
        return Err(format!(
            "in parts it differs: {line:?}, {layers:?}, width {width}, {high:?}"
        ));
    }
    judged.map_err(|what| format!("{what}: {line:?}, {layers:?}, width {width}, {high:?}"))
}

/// Walls that begin, end or pass at one vertex.
fn judge_star(seed: u64) -> Result<usize, String> {
    let mut random = Random(seed);
    let width = random.pick(&[1.0 / 1024.0, 0.01, 0.3]);
    let high = random.pick(&[HighSide::Left, HighSide::Right]);
    let middle = [6.0, 6.0];
    let away = |random: &mut Random| match [random.around(3), random.around(3)] {
        [0, 0] => [6.0, 7.0],
        by => by.map(|by| 6.0 + by as f64),
    };
    let lines = (0..2 + random.below(4)).map(|_| match random.below(5) {
        0 | 1 => with_heights(&[away(&mut random), middle]),
        2 | 3 => with_heights(&[middle, away(&mut random)]),
        _ => with_heights(&[away(&mut random), middle, away(&mut random)]),
    });
    let lines: Vec<Line> = lines.collect();
    let built =
        build(std::slice::from_ref(&lines), width, high).map_err(|error| error.to_string())?;
    let built = built.triangles().map_err(|error| error.to_string())?;
    let mut shuffled = lines.clone();
    random.shuffle(&mut shuffled);
    let again = build(
        &shuffled.chunks(1).map(<[Line]>::to_vec).collect::<Vec<_>>(),
        width,
        high,
    );
    let again = again.map_err(|error| error.to_string())?;
    if super::content(built)
        != super::content(again.triangles().map_err(|error| error.to_string())?)
    {
        return Err(format!(
            "in another order it differs: {lines:?}, width {width}, {high:?}"
        ));
    }
    upper_edges(&lines, width, high)
        .map_err(|what| format!("{what}: {lines:?}, width {width}, {high:?}"))
}

/// However a wall turns, its upper edge has its heights, and its parts are the whole.
#[test]
fn upper_edges_are_never_tilted() {
    for (name, judge) in [
        ("bent", judge_bent as fn(u64) -> Result<usize, String>),
        ("star", judge_star),
    ] {
        let judged = (0..30 * count())
            .into_par_iter()
            .map(|seed| judge(seed).map_err(|what| (seed, what)));
        let judged: Vec<Result<usize, (u64, String)>> = judged.collect();
        let wrong: Vec<_> = judged
            .iter()
            .filter_map(|judged| judged.as_ref().err())
            .collect();
        if !wrong.is_empty() {
            panic!(
                "{name}: {} of {} are wrong: {:#?}",
                wrong.len(),
                judged.len(),
                &wrong[..wrong.len().min(8)]
            );
        }
        let vertices: usize = judged.iter().flatten().sum();
        assert!(
            vertices > 3 * judged.len(),
            "{name}: {vertices} vertices were judged"
        );
    }
}

/// Walls in two records that meet at less than 60 degrees.
#[test]
fn two_records_at_a_sharp_angle_are_level() {
    let line = with_heights(&[[0.0, 0.0], [10.0, 0.0], [1.0, -5.0]]);
    let [first, second] = [&line[..2], &line[1..]];
    for high in [HighSide::Left, HighSide::Right] {
        let whole = build(&[vec![line.clone()]], 0.01, high).unwrap();
        for layers in [
            vec![vec![first.to_vec(), second.to_vec()]],
            vec![vec![second.to_vec()], vec![first.to_vec()]],
        ] {
            let found = build(&layers, 0.01, high).unwrap();
            assert!(
                super::content(found.triangles().unwrap())
                    == super::content(whole.triangles().unwrap())
            );
            upper_edges(&layers.concat(), 0.01, high).unwrap();
        }
    }
}
