//! Contours for maps: on surfaces where heights are often equal to levels, and on random ones.

use super::map_judge::{
    Ground, box_of, boxes_meet, check_crossings, check_polygon, doubled_area, is_inside, meet,
};
use breakline::data::{ContourLine, Mesh, Surface};
use breakline::error::Error;
use breakline::terrain::{
    Band, ContourLabel, LabelRules, LabelTops, Levels, Locator, MapContours, MapLine, MapRules,
    Tin, TinBuilder, contour_labels, contours, map_contours, map_contours_while, map_work,
};
use std::sync::atomic::{AtomicU64, Ordering};
use testkit::random::Random;

/// The number of random surfaces that is asked for.
fn asked() -> Option<u64> {
    std::env::var("BREAKLINE_MAP_SURFACES").ok()?.parse().ok()
}

/// Returns the number of random surfaces for each test: `BREAKLINE_MAP_SURFACES` asks for more,
/// which are counted with `--nocapture`.
fn rounds() -> u64 {
    asked().unwrap_or(200)
}

/// A surface, its interval, and the lines that hold it.
struct Case {
    points: Vec<[f64; 3]>,
    lines: Vec<Vec<[f64; 3]>>,
    interval: f64,
}

impl Case {
    fn tin(&self) -> Tin {
        self.tin_of(&self.points)
    }

    fn tin_of(&self, points: &[[f64; 3]]) -> Tin {
        let mut builder = TinBuilder::default();
        let column = |axis: usize| points.iter().map(|p| p[axis]).collect::<Vec<f64>>();
        builder.add_points(&column(0), &column(1), &column(2));
        self.lines
            .iter()
            .for_each(|line| builder.add_breakline(line));
        builder.build().unwrap()
    }
}

/// A grid of whole coordinates, with heights that are multiples of half an interval, flats and
/// saddles among them, and lines along rows and diagonals.
fn grid(random: &mut Random) -> Case {
    let side = 4 + random.index(9);
    let interval = random.pick(&[0.25, 1.0, 5.0]);
    let spacing = random.pick(&[1.0, 2.0, 16.0]);
    let offset = random.pick(&[0.0, -64.0, 500_000.0]);
    let steps = random.pick(&[2, 4, 12]);
    let slope = random.pick(&[0.0, 0.5, 2.0]);
    let mut height = |x: usize| {
        let step = random.below(steps) as f64 / 2.0;
        interval * (step + (slope * x as f64 * 2.0).round() / 2.0)
    };
    let at = |i: usize| offset + spacing * i as f64;
    let points: Vec<[f64; 3]> = (0..side * side)
        .map(|i| [at(i % side), at(i / side), height(i % side)])
        .collect();
    let mut lines = Vec::new();
    for _ in 0..random.index(3) {
        let row = random.index(side);
        let [first, last] = [random.index(side), random.index(side)];
        let diagonal = random.below(2) == 0;
        let vertex = |i: usize| points[if diagonal { i } else { row } * side + i];
        let line: Vec<[f64; 3]> = (first.min(last)..=first.max(last)).map(vertex).collect();
        if line.len() > 1 {
            lines.push(line);
        }
    }
    Case {
        points,
        lines,
        interval,
    }
}

/// Scattered points with waves, a slope and noise.
fn scattered(random: &mut Random) -> Case {
    let count = 30 + random.index(300);
    let width = random.pick(&[30.0, 100.0, 300.0]);
    let interval = random.pick(&[0.25, 1.0, 5.0]);
    let noise = random.pick(&[0.0, 0.3, 2.0]) * interval;
    let waves = random.pick(&[0.0, 1.5, 6.0]) * interval;
    let slope = random.pick(&[0.0, 8.0]) * interval / width;
    let offset = random.pick(&[0.0, 4_000_000.0]);
    let is_rounded = random.below(3) == 0;
    let points: Vec<[f64; 3]> = (0..count)
        .map(|_| {
            let [x, y] = [0, 1].map(|_| width * random.unit());
            let wave = waves * (7.0 * x / width).sin() * (5.0 * y / width).cos();
            let z = wave + slope * x + noise * (random.unit() + random.unit() - 1.0);
            let half = 0.5 * interval;
            let z = if is_rounded {
                (z / half).round() * half
            } else {
                z
            };
            [offset + x, offset + y, z]
        })
        .collect();
    let mut lines = Vec::new();
    for _ in 0..random.index(4) {
        let [a, b] = [0, 1].map(|_| points[random.index(count)]);
        if [a[0], a[1]] != [b[0], b[1]] {
            lines.push(vec![a, b]);
        }
    }
    Case {
        points,
        lines,
        interval,
    }
}

fn lines_of(found: &MapContours) -> Vec<ContourLine> {
    found.lines.iter().map(|line| line.line.clone()).collect()
}

fn levels(case: &Case) -> Levels {
    Levels::every(case.interval, 0.0).unwrap()
}

/// Checks all that is promised of the lines of a surface, and returns how many there are.
fn check(case: &Case, rules: &MapRules, largest: f64) -> usize {
    let tin = case.tin();
    let found = map_contours(&tin, &levels(case), rules).unwrap();
    let lines = lines_of(&found);
    check_crossings(&lines);
    let ground = Ground::new(&tin);
    let mut most = 0.0_f64;
    for line in &lines {
        most = most.max(ground.deviation(line));
    }
    assert!(
        most <= largest,
        "{most} off the surface, {largest} promised"
    );
    let rounding = 1e-7 * case.interval;
    assert!(
        (most - found.deviation).abs() <= rounding,
        "{most} is not {}",
        found.deviation
    );
    check_held(&tin, &lines, case.interval);
    lines.len()
}

/// Each line crosses a held edge once at most, where the heights along the edge say.
fn check_held(tin: &Tin, lines: &[ContourLine], interval: f64) {
    for face in 0..tin.face_count() as u32 {
        for i in 0..3 {
            let is_held = tin.edge_kind(face, i).is_hard()
                && tin.neighbor(face, i).is_some_and(|other| other > face);
            let Some(corners) = tin.triangle(face).filter(|_| is_held) else {
                continue;
            };
            let [a, b] = [1, 2].map(|k| corners[(i + k) % 3]);
            let edge = [a, b].map(|p| [p[0], p[1]]);
            for line in lines {
                // Heights near a level are raised, by two ten-thousandths of an interval at most.
                let slack = 3e-4 * interval;
                let may_cross =
                    a[2].min(b[2]) - slack < line.level && line.level < a[2].max(b[2]) + slack;
                let meetings = line
                    .points
                    .windows(2)
                    .filter(|ends| meet([ends[0], ends[1]], edge));
                let count = meetings.count();
                // The two segments at a vertex on the edge count as one crossing.
                assert!(
                    count == 0 || may_cross && count <= 2,
                    "{count} meetings of level {} with an edge from {a:?} to {b:?}",
                    line.level
                );
            }
        }
    }
}

fn each_case(seed: u64, mut check: impl FnMut(&Case, &mut Random)) {
    for round in 0..rounds() {
        let mut random = Random(seed + round);
        let case = match round % 2 {
            0 => grid(&mut random),
            _ => scattered(&mut random),
        };
        check(&case, &mut random);
        if asked().is_some() && round % 500 == 499 {
            eprintln!("{} surfaces from seed {seed} on passed", round + 1);
        }
    }
}

#[test]
fn smoothed_lines_stay_near_the_surface_and_cross_nothing() {
    let mut count = 0;
    each_case(1, |case, random| {
        let share = random.pick(&[0.5, 0.25]);
        let rules = MapRules {
            smooth: Some(share * case.interval),
            simplify: random.pick(&[None, Some(0.05 * case.interval), Some(case.interval)]),
            min_area: random.pick(&[0.0, 50.0, 1.0]) * case.interval * case.interval,
            ..MapRules::default()
        };
        count += check(case, &rules, share * case.interval);
    });
    assert!(count as u64 > rounds(), "{count} lines");
}

#[test]
fn simplified_lines_stay_in_their_corridor() {
    each_case(2, |case, random| {
        let rules = MapRules {
            simplify: Some(random.pick(&[0.1, 1.0, 10.0]) * case.interval),
            ..MapRules::default()
        };
        check(case, &rules, 0.5 * case.interval);
    });
}

#[test]
fn lines_are_a_function_of_the_surface() {
    each_case(3, |case, random| {
        let rules = MapRules {
            min_length: random.pick(&[0.0, 10.0]),
            ..MapRules::cartographic(case.interval)
        };
        let expected = map_contours(&case.tin(), &levels(case), &rules).unwrap();
        let mut points = case.points.clone();
        random.shuffle(&mut points);
        let tin = case.tin_of(&points);
        let one = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .build()
            .unwrap();
        let again = one.install(|| map_contours(&tin, &levels(case), &rules).unwrap());
        assert_eq!(expected, again);
    });
}

/// Two hills joined by a narrow neck: the short lines across it are on the side of one hill.
#[test]
fn a_short_line_takes_no_longer_one_along() {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for x in 0..=60_i32 {
        for y in 0..=20_i32 {
            let to = |middle: i32| f64::from((x - middle).pow(2) + (y - 10).pow(2)).sqrt();
            let height = 12.25 - 0.5 * to(10).min(to(50) + 3.0);
            vertices.push([f64::from(x), f64::from(y), height]);
        }
    }
    for x in 0..60_u32 {
        for y in 0..20_u32 {
            if !(20..40).contains(&x) || (9..11).contains(&y) {
                let [a, b] = [x * 21 + y, (x + 1) * 21 + y];
                faces.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
            }
        }
    }
    let mesh = Mesh::new(vertices, faces, &[], None).unwrap();
    let levels = Levels::every(1.0, 0.0).unwrap();
    let lines = |min_length| {
        let rules = MapRules {
            min_length,
            ..MapRules::default()
        };
        let found = map_contours(&mesh, &levels, &rules).unwrap();
        let length = |line: &MapLine| -> f64 {
            let sides = line.line.points.windows(2);
            sides
                .map(|p| (p[0][0] - p[1][0]).hypot(p[0][1] - p[1][1]))
                .sum()
        };
        found.lines.iter().map(length).collect::<Vec<f64>>()
    };
    let all = lines(1e-9);
    let is_long = |length: &&f64| **length >= 10.0;
    assert!(all.iter().any(|length| *length < 4.0));
    let long = all.iter().filter(is_long).count();
    let found = lines(10.0);
    assert!(long > 10 && found.len() < all.len());
    assert_eq!(found.iter().filter(is_long).count(), long);
}

#[test]
fn lines_that_are_left_out_take_along_what_they_enclose() {
    each_case(4, |case, random| {
        let least = random.pick(&[1.0, 10.0, 100.0]) * case.interval * case.interval;
        let tin = case.tin();
        let all_rules = MapRules {
            min_area: f64::MIN_POSITIVE,
            keep_depressions: true,
            ..MapRules::default()
        };
        let all = map_contours(&tin, &levels(case), &all_rules).unwrap();
        let rules = MapRules {
            min_area: least,
            keep_depressions: random.below(2) == 0,
            ..MapRules::default()
        };
        let found = map_contours(&tin, &levels(case), &rules).unwrap();
        assert_eq!(found.traced, all.traced);
        for line in &found.lines {
            assert!(all.lines.contains(line));
            let [first, last] = [0, line.line.points.len() - 1].map(|i| line.line.points[i]);
            if first == last && !(rules.keep_depressions && line.is_depression) {
                let area = doubled_area(&line.line.points).abs() / 2.0;
                assert!(area >= 0.2 * least * (1.0 - 1e-6), "{area} of {least}");
            }
        }
        // No line is inside of a ring that was left out.
        let gone = all.lines.iter().filter(|line| !found.lines.contains(line));
        for ring in gone.filter(|line| line.line.is_closed()) {
            let inside = |line: &ContourLine| is_inside(&ring.line.points, line.points[1]);
            assert!(!found.lines.iter().any(|line| inside(&line.line)));
        }
    });
}

#[test]
fn without_rules_lines_are_exact() {
    each_case(5, |case, _| {
        let tin = case.tin();
        let exact: Vec<ContourLine> = contours(&tin, &levels(case)).unwrap().collect();
        let found = map_contours(&tin, &levels(case), &MapRules::default()).unwrap();
        assert_eq!(lines_of(&found), exact);
    });
}

#[test]
fn a_tolerance_of_more_than_half_of_the_interval_is_refused() {
    let mut random = Random(6);
    let case = grid(&mut random);
    let rules = MapRules {
        smooth: Some(0.6 * case.interval),
        ..MapRules::default()
    };
    let error = map_contours(&case.tin(), &levels(&case), &rules).unwrap_err();
    assert!(
        error.to_string().contains("half of the interval"),
        "{error}"
    );
}

/// Checks that polygons are valid and cover a surface, and that the heights in each are those that
/// it states, but for a tolerance.
fn check_bands(tin: &Tin, bands: &[Band], tolerance: f64, random: &mut Random) {
    let mut area = 0.0;
    for band in bands {
        check_polygon(&band.rings);
        assert!(band.low < band.high || bands.len() == 1, "{band:?}");
        area -= band
            .rings
            .iter()
            .map(|ring| doubled_area(ring))
            .sum::<f64>();
    }
    let triangles: Vec<[[f64; 3]; 3]> = (0..tin.face_count() as u32)
        .filter_map(|face| tin.triangle(face))
        .collect();
    let plan = |p: &[f64; 3]| [p[0], p[1]];
    let of_triangle = |t: &[[f64; 3]; 3]| doubled_area(&[0, 1, 2, 0].map(|i| plan(&t[i])));
    let whole: f64 = triangles.iter().map(of_triangle).sum();
    assert!((area - whole).abs() <= 1e-9 * whole, "{area} of {whole}");
    for _ in 0..30 {
        let triangle = triangles[random.index(triangles.len())];
        let (u, v) = (random.unit(), random.unit());
        let shares = if u + v < 1.0 {
            [u, v]
        } else {
            [1.0 - u, 1.0 - v]
        };
        let [x, y, z] = [0, 1, 2].map(|k| {
            let steps = [1, 2].map(|i| shares[i - 1] * (triangle[i][k] - triangle[0][k]));
            triangle[0][k] + steps[0] + steps[1]
        });
        let is_at = |band: &&Band| {
            band.rings
                .iter()
                .filter(|ring| is_inside(ring, [x, y]))
                .count()
                % 2
                == 1
        };
        let found: Vec<&Band> = bands.iter().filter(is_at).collect();
        let [band] = found[..] else {
            panic!("{} bands at {x} {y}", found.len());
        };
        let is_within = band.low - tolerance <= z && z <= band.high + tolerance;
        assert!(is_within, "{z} at {x} {y} in {} to {}", band.low, band.high);
    }
}

#[test]
fn bands_of_exact_contours_cover_the_surface() {
    each_case(7, |case, random| {
        let rules = MapRules {
            with_bands: true,
            ..MapRules::default()
        };
        let tin = case.tin();
        let found = map_contours(&tin, &levels(case), &rules).unwrap();
        check_bands(&tin, &found.bands, 1e-9 * (1.0 + case.interval), random);
    });
}

#[test]
fn bands_of_smoothed_contours_cover_the_surface() {
    each_case(8, |case, random| {
        // None is left out, so that heights are off by the tolerance at most.
        let rules = MapRules {
            min_area: 0.0,
            with_bands: true,
            ..MapRules::cartographic(case.interval)
        };
        let tin = case.tin();
        let found = map_contours(&tin, &levels(case), &rules).unwrap();
        // A line may be off by half, and so is the surface that it bounds.
        check_bands(&tin, &found.bands, case.interval, random);
    });
}

#[test]
fn bands_without_small_lines_cover_the_surface() {
    each_case(9, |case, random| {
        let rules = MapRules {
            with_bands: true,
            min_length: random.pick(&[0.0, 20.0]),
            ..MapRules::cartographic(case.interval)
        };
        let tin = case.tin();
        let found = map_contours(&tin, &levels(case), &rules).unwrap();
        check_bands(&tin, &found.bands, f64::INFINITY, random);
    });
}

#[test]
fn labels_overlap_nothing_and_stand_upright() {
    let mut count = 0;
    each_case(10, |case, _| {
        let tin = case.tin();
        let rules = MapRules::cartographic(case.interval);
        let found = map_contours(&tin, &levels(case), &rules).unwrap();
        let locator = Locator::new(&tin).unwrap();
        let small = LabelRules {
            spacing: 0.0,
            height: 0.5 * case.interval,
            ..LabelRules::of_interval(case.interval)
        };
        let uphill = LabelRules {
            tops: LabelTops::Uphill,
            ..small
        };
        let labels = contour_labels(&found.lines, |_| true, &small);
        let turned = contour_labels(&found.lines, |_| true, &uphill);
        assert_eq!(labels.len(), turned.len());
        count += labels.len();
        for (i, label) in labels.iter().enumerate() {
            assert!(-90.0 < label.rotation && label.rotation <= 90.0);
            let difference = (turned[i].rotation - label.rotation).rem_euclid(360.0);
            assert!(difference == 0.0 || (difference - 180.0).abs() < 1e-9);
            let own = box_of(label);
            assert!(!labels[..i].iter().any(|other| boxes_meet(label, other)));
            let near = found
                .lines
                .iter()
                .filter(|line| line.line.level != label.level);
            for ends in near.flat_map(|line| line.line.points.windows(2)) {
                for side in own.windows(2) {
                    assert!(!meet([ends[0], ends[1]], [side[0], side[1]]));
                }
            }
            assert!(locator.height(label.at).is_some());
        }
    });
    assert!(count > 0);
}

/// Rings of a steep cone are nearer to each other than the spacing: each has a label nevertheless,
/// and further labels keep the spacing from all.
#[test]
fn no_line_stays_bare_where_there_is_room() {
    let points: Vec<[f64; 3]> = (0..61 * 61)
        .map(|i| {
            let [x, y] = [i % 61, i / 61].map(|c| 8.0 * f64::from(c) - 240.0);
            [x, y, (240.0 - x.hypot(y)) / 8.0 + 0.3]
        })
        .collect();
    let case = Case {
        points,
        lines: Vec::new(),
        interval: 1.0,
    };
    let rules = MapRules::cartographic(1.0);
    let found = map_contours(&case.tin(), &levels(&case), &rules).unwrap();
    let of_interval = LabelRules {
        height: 4.0,
        ..LabelRules::of_interval(1.0)
    };
    let is_index = |line: &MapLine| line.number % 5 == 0;
    let labels = contour_labels(&found.lines, is_index, &of_interval);
    let mut several = 0;
    for line in found.lines.iter().filter(|line| is_index(line)) {
        let line = &line.line;
        let own = labels.iter().filter(|label| label.level == line.level);
        let count = own.count();
        // The innermost ring bends too much.
        assert!(count > 0 || line.level > 27.0, "no label at {}", line.level);
        several += usize::from(count > 1);
    }
    assert!(several > 2, "{several}");
    for (k, label) in labels.iter().enumerate() {
        let distance =
            |other: &ContourLabel| (label.at[0] - other.at[0]).hypot(label.at[1] - other.at[1]);
        let nearest = labels[..k]
            .iter()
            .map(distance)
            .fold(f64::INFINITY, f64::min);
        assert!(nearest >= 1.5 * label.size[0], "{nearest}");
    }
}

/// Work that is stopped at any point ends with that error; work that is not is counted.
#[test]
fn work_is_counted_and_can_be_stopped() {
    let mut random = Random(11);
    let case = scattered(&mut random);
    let (tin, levels) = (case.tin(), levels(&case));
    let rules = MapRules {
        with_bands: true,
        ..MapRules::cartographic(case.interval)
    };
    let expected = map_contours(&tin, &levels, &rules).unwrap();
    let most = map_work(&tin, &rules);
    let mut last = 0;
    for asked in 0.. {
        let (calls, work) = (AtomicU64::new(0), AtomicU64::new(0));
        let go_on = |done| {
            work.fetch_add(done, Ordering::Relaxed);
            match calls.fetch_add(1, Ordering::Relaxed) < 1 << asked {
                true => Ok(()),
                false => Err(Error::usage("stopped")),
            }
        };
        let found = map_contours_while(&tin, &levels, &rules, &go_on);
        last = work.into_inner();
        assert!(last <= most, "{last} of {most}");
        match found {
            Ok(found) => {
                assert_eq!(found, expected);
                assert!(asked > 3, "stopped at {asked} points");
                break;
            }
            Err(error) => assert_eq!(error.to_string(), "stopped"),
        }
    }
    assert!(last >= most / 6 * 4, "{last} of {most}");
}

/// Tops are uphill on a plane that rises in each of many directions.
#[test]
fn tops_are_uphill() {
    for k in 0..24 {
        let angle = (f64::from(k) * 15.0 + 1.0).to_radians();
        let (sin, cos) = angle.sin_cos();
        let at = |x: f64, y: f64| [x, y, 0.1 * (x * cos + y * sin)];
        let points: Vec<[f64; 3]> = (0..100)
            .map(|i| at(f64::from(i % 10) * 10.0, f64::from(i / 10) * 10.0))
            .collect();
        let case = Case {
            points,
            lines: Vec::new(),
            interval: 1.0,
        };
        let found = map_contours(&case.tin(), &levels(&case), &MapRules::default()).unwrap();
        let rules = LabelRules {
            tops: LabelTops::Uphill,
            ..LabelRules::of_interval(1.0)
        };
        let labels = contour_labels(&found.lines, |_| true, &rules);
        assert!(!labels.is_empty());
        for label in labels {
            let up = (label.rotation + 90.0).to_radians();
            let off = (up.cos() - cos).hypot(up.sin() - sin);
            assert!(off < 1e-6, "{} on a slope to {angle}", label.rotation);
        }
    }
}
