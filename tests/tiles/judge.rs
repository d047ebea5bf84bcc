//! Pairs of one piece and tiles, at random: every kind of clip, line and method, on points whose
//! coordinates are nearly on lines.

use std::path::Path;

use testkit::random::Random;

use super::{bytes, layer};
use crate::program::{Run, run_in};

/// The number of pairs, which the environment sets:
/// `BREAKLINE_PAIRS=3000 cargo test --release --test tiles pairs`.
fn count() -> usize {
    std::env::var("BREAKLINE_PAIRS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(16)
}

/// The first of them, to begin in the middle: `BREAKLINE_FIRST_PAIR`.
fn first() -> usize {
    std::env::var("BREAKLINE_FIRST_PAIR")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(0)
}

/// Pairs that differed once: a point that is in a lake by a rounding error kept its height in
/// tiles, and so did points beside the straight end of a river, of which one bank is a point.
const SEEN: [usize; 2] = [148, 2503];

type Site = [f64; 2];

/// Steps on a grid, and how they become positions.
struct Scene {
    side: usize,
    kind: usize,
    random: Random,
}

impl Scene {
    fn new(pair: usize) -> Self {
        // Sets do not depend on those before.
        Scene {
            side: [5, 9, 16][pair % 3],
            kind: pair / 3 % 4,
            random: Random(977 + pair as u64),
        }
    }

    /// Whole numbers; a grid turned by a triangle of sides 3, 4 and 5; steps of 0.1; groups.
    fn position(&self, [i, j]: Site) -> Site {
        match self.kind {
            0 => [i, j],
            1 => [
                500_000.0 + (3.0 * i - 4.0 * j) / 5.0,
                5_000_000.0 + (4.0 * i + 3.0 * j) / 5.0,
            ],
            2 => [1e6 + i * 0.1, 2e6 + j * 0.1],
            _ => [
                300.0 + i + (j * 1e-4).sin(),
                j.trunc() + (j - j.trunc()) * 1e-3,
            ],
        }
    }

    /// A site of the grid.
    fn site(&mut self) -> Site {
        let own = [0, 1].map(|_| self.random.below(self.side as u64 + 1) as f64);
        self.position(own)
    }

    /// A corner of what is drawn: a site, half of one, or anywhere, also outside.
    fn corner(&mut self) -> Site {
        let side = self.side as f64;
        let halves = 2 * self.side as u64 + 1;
        let own = match self.random.below(4) {
            0 | 1 => return self.site(),
            2 => [0, 1].map(|_| self.random.below(halves) as f64 / 2.0),
            _ => [0, 1].map(|_| side * (1.4 * self.random.unit() - 0.2)),
        };
        self.position(own)
    }

    fn height(&mut self) -> f64 {
        self.random.below(9) as f64 * 0.5
    }

    fn line(&mut self) -> Vec<[f64; 3]> {
        let count = 2 + self.random.index(3);
        (0..count)
            .map(|_| (self.corner(), self.height()))
            .map(|([x, y], z)| [x, y, z])
            .collect()
    }

    /// A ring of one height; now and then without an area, or with a part that has none.
    fn ring(&mut self) -> Vec<[f64; 3]> {
        let z = self.height();
        let [a, b] = [self.site(), self.corner()];
        let mut ring = match self.random.below(8) {
            0 => vec![a, a, a],
            1 => vec![a, b, a],
            2 => vec![a, b, self.corner(), a, b, a],
            3 => {
                let tip = self.site();
                vec![a, b, self.corner(), self.corner(), tip, self.corner()]
            }
            4 => {
                let (c, tip) = (self.corner(), self.site());
                vec![a, b, tip, b, c]
            }
            _ => (0..3 + self.random.index(4))
                .map(|_| self.corner())
                .collect(),
        };
        ring.push(ring[0]);
        ring.into_iter().map(|[x, y]| [x, y, z]).collect()
    }

    /// Writes the points and lines of a surface, and returns the words that name them.
    fn write(&mut self, folder: &Path) -> String {
        let share = [2, 3, 9][self.random.index(3)];
        let mut rows = String::new();
        for i in 0..=self.side {
            for j in 0..=self.side {
                if self.random.below(10) < share || share == 9 {
                    let ([x, y], z) = (self.position([i as f64, j as f64]), self.height());
                    rows += &format!("{x} {y} {z}\n");
                }
            }
        }
        std::fs::write(folder.join("points.xyz"), rows).unwrap();
        let mut words = "points.xyz --a-srs EPSG:25832".to_owned();
        let mut add = |scene: &mut Self, option: &str, kind: &str, count: usize, more: &str| {
            let shapes: Vec<Vec<[f64; 3]>> = (0..count)
                .map(|_| {
                    if kind == "Polygon" {
                        scene.ring()
                    } else {
                        scene.line()
                    }
                })
                .collect();
            if !shapes.is_empty() {
                std::fs::write(
                    folder.join(format!("{option}.geojson")),
                    layer(&shapes, kind),
                )
                .unwrap();
                words += &format!(" --{option} {option}.geojson{more}");
            }
        };
        let some = |scene: &mut Self, of: u64, most: usize| match scene.random.below(of) {
            0 => 1 + scene.random.index(most),
            _ => 0,
        };
        for (option, kind, of, most, more) in [
            ("breaklines", "LineString", 3, 3, ""),
            ("soft-lines", "LineString", 4, 2, ""),
            ("walls", "LineString", 8, 1, " --wall-drop 2"),
            ("flat", "Polygon", 8, 1, ""),
            ("rivers", "LineString", 10, 1, " --river-width 1"),
            ("draped-lines", "LineString", 4, 2, ""),
            ("boundary", "Polygon", 2, 2, ""),
            ("holes", "Polygon", 4, 2, ""),
        ] {
            let count = some(self, of, most);
            add(self, option, kind, count, more);
        }
        if self.random.below(4) == 0 {
            let ([a, b], [c, d]) = (self.corner(), self.corner());
            words += &format!(
                " --bounds {},{},{},{}",
                a.min(c),
                b.min(d),
                a.max(c),
                b.max(d)
            );
        }
        words + ["", " --max-edge none", " --max-edge 2.5"][self.random.index(3)]
    }
}

#[test]
fn pairs_of_one_piece_and_tiles_are_the_same() {
    let (mut built, mut refused) = (0, 0);
    for pair in SEEN.into_iter().chain(first()..first() + count()) {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = Scene::new(pair);
        let words = scene.write(folder.path());
        let tiles = format!(
            "--tiles {}x{}",
            1 + scene.random.below(6),
            1 + scene.random.below(6)
        );
        let run = |words: &str, out: &str| -> Run {
            let words: Vec<&str> = words.split_whitespace().chain(["-o", out]).collect();
            run_in(&folder, &words)
        };
        // Each of both, which must end alike.
        let both = |whole: &str, tiled: &str, outs: [&str; 2]| -> bool {
            let [one, other] = [run(whole, outs[0]), run(tiled, outs[1])];
            let said = format!(
                "pair {pair}: {whole} {tiled}\n{}\n{}",
                one.stderr, other.stderr
            );
            assert_eq!(one.code == 0, other.code == 0, "{said}");
            assert!(!other.stderr.contains("not local"), "{said}");
            one.code == 0
        };
        if !both(
            &format!("tin {words}"),
            &format!("tin {words} {tiles}"),
            ["whole.tin", "parts.tins"],
        ) {
            refused += 1;
            continue;
        }
        built += 1;
        let cell = if scene.kind == 2 { 0.05 } else { 0.5 };
        let method = scene
            .random
            .pick(&["linear", "nearest", "natural", "laplace", "smooth", "idw"]);
        let [dem, contour] = [
            format!("dem --resolution {cell}"),
            "contour --interval 0.25".to_owned(),
        ];
        let hillshade = format!("hillshade --resolution {cell}");
        let (direct, out) =
            [(&dem, "tif"), (&hillshade, "png"), (&contour, "geojson")][scene.random.index(3)];
        for (whole, tiled, out) in [
            (
                format!("{dem} --method {method} whole.tin"),
                format!("{dem} --method {method} parts.tins"),
                "tif",
            ),
            (
                format!("{contour} whole.tin"),
                format!("{contour} parts.tins"),
                "geojson",
            ),
            (
                format!("{direct} {words}"),
                format!("{direct} {words} {tiles}"),
                out,
            ),
        ] {
            let outs = [format!("a.{out}"), format!("b.{out}")];
            if both(&whole, &tiled, [&outs[0], &outs[1]]) {
                let [a, b] = outs.each_ref().map(|name| bytes(folder.path().join(name)));
                assert!(a == b, "pair {pair}: {whole}, {tiled}: {words} {tiles}");
                outs.iter()
                    .for_each(|name| std::fs::remove_file(folder.path().join(name)).unwrap());
            }
        }
    }
    assert!(
        built > refused,
        "{built} pairs, and {refused} sets that are refused"
    );
}
