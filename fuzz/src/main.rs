//! Bytes as points and lines, for a fuzzer that learns which ones lead to new states; the checks
//! are those of `tests/fuzz`.
//!
//! `breakline-fuzz --poly FILE` prints what the bytes of a file mean.
#![allow(clippy::print_stdout)]

use testkit::case::{Case, Point};
use testkit::judge;

/// More is slow, and shows nothing that less does not.
const MOST_POINTS: usize = 60;

/// Every sequence of bytes is a set: the first says how coordinates are written, the second how
/// many points there are; after the points, each byte is the next point of a line, those above 239
/// begin another line.
fn case(bytes: &[u8]) -> Case {
    let [how, count, rest @ ..] = bytes else {
        return Case::default();
    };
    let (origin, step): (Point, f64) = match how >> 2 & 3 {
        0 => ([0.0, 0.0], 1.0),
        1 => ([500_000.0, 4_649_000.0], 0.01),
        2 => ([1.0, 1.0], f64::EPSILON),
        _ => ([-0.5, 0.25], 0.1),
    };
    let width = [1, 1, 2, 8][usize::from(how & 3)];
    let coordinate = |axis: usize, bytes: &[u8]| match *bytes {
        [a] => origin[axis] + step * f64::from(a as i8),
        [a, b] => origin[axis] + step * f64::from(i16::from_le_bytes([a, b])),
        _ => f64::from_le_bytes(bytes.try_into().expect("these are eight")),
    };
    let count = usize::from(*count)
        .min(MOST_POINTS)
        .min(rest.len() / (2 * width));
    let (coordinates, order) = rest.split_at(count * 2 * width);
    let point = |bytes: &[u8]| {
        [
            coordinate(0, &bytes[..width]),
            coordinate(1, &bytes[width..]),
        ]
    };
    let points: Vec<Point> = coordinates.chunks_exact(2 * width).map(point).collect();
    let mut lines = Vec::new();
    if count > 0 {
        for line in order[..order.len().min(2 * MOST_POINTS)].split(|&byte| byte > 239) {
            lines.push(
                line.iter()
                    .map(|&byte| u32::from(byte) % count as u32)
                    .collect(),
            );
        }
    }
    Case { points, lines }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [option, file] = &words[..]
        && option == "--poly"
    {
        print!(
            "{}",
            case(&std::fs::read(file).expect("the file can be read")).to_poly()
        );
        return;
    }
    afl::fuzz!(|bytes: &[u8]| {
        let case = case(bytes);
        if case.points.iter().flatten().all(|x| x.is_finite())
            && let Err(what) = judge::pass(&case)
        {
            panic!("{what}\n{}", case.to_poly());
        }
    });
}
