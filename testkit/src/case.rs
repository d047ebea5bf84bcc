//! Points and lines as a test input, and as a readable file: Triangle's `.poly`.

use std::fmt::Write;

pub type Point = [f64; 2];

/// Points, and lines as positions in the list of points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Case {
    pub points: Vec<Point>,
    pub lines: Vec<Vec<u32>>,
}

impl Case {
    /// Returns a case of these points, and of each segment as a line with two points of its own.
    pub fn of_segments(points: &[Point], segments: &[[Point; 2]]) -> Case {
        let mut case = Case {
            points: points.to_vec(),
            lines: Vec::new(),
        };
        segments.iter().for_each(|segment| case.draw(segment));
        case
    }

    /// Adds a line through points of its own.
    pub fn draw(&mut self, line: &[Point]) {
        let first = self.points.len() as u32;
        self.points.extend(line);
        self.lines.push((first..self.points.len() as u32).collect());
    }

    /// The number of segments, including those of zero length.
    pub fn segment_count(&self) -> usize {
        self.lines
            .iter()
            .map(|line| line.len().saturating_sub(1))
            .sum()
    }

    /// Returns the case in Triangle's format; the marker of a segment is the number of its line.
    pub fn to_poly(&self) -> String {
        let mut text = format!("{} 2 0 0\n", self.points.len());
        for (i, [x, y]) in self.points.iter().enumerate() {
            writeln!(text, "{i} {x:?} {y:?}").unwrap();
        }
        writeln!(text, "{} 1", self.segment_count()).unwrap();
        let segments = self
            .lines
            .iter()
            .enumerate()
            .flat_map(|(k, line)| line.windows(2).map(move |s| (k + 1, s)));
        for (i, (line, ends)) in segments.enumerate() {
            writeln!(text, "{i} {} {} {line}", ends[0], ends[1]).unwrap();
        }
        text + "0\n"
    }

    /// Parses what [`Case::to_poly`] writes: numbers from 0, and consecutive segments with one
    /// marker are a line.
    pub fn from_poly(text: &str) -> Case {
        let content = text.lines().map(|line| line.split('#').next().unwrap());
        let mut rows = content
            .map(|line| line.split_whitespace().collect::<Vec<_>>())
            .filter(|row| !row.is_empty());
        let mut case = Case::default();
        for _ in 0..rows.next().unwrap()[0].parse().unwrap() {
            let row = rows.next().unwrap();
            case.points.push([1, 2].map(|i| row[i].parse().unwrap()));
        }
        let mut last = None;
        for _ in 0..rows.next().unwrap()[0].parse().unwrap() {
            let row: Vec<u32> = rows
                .next()
                .unwrap()
                .iter()
                .map(|n| n.parse().unwrap())
                .collect();
            let (ends, marker) = ([row[1], row[2]], row.get(3).copied());
            match case.lines.last_mut() {
                Some(line)
                    if marker.is_some() && marker == last && line.last() == Some(&ends[0]) =>
                {
                    line.push(ends[1])
                }
                _ => case.lines.push(ends.to_vec()),
            }
            last = marker;
        }
        case
    }
}
