//! Draws what tiles of the valley hand up: `cargo run --release --example residual_picture --
//! OUT.svg`.

use std::error::Error;
use std::fmt::Write;

use breakline::io::points;
use breakline::terrain::Selection;
use breakline::terrain::tiles::{TileLayout, Work, leaf};

fn main() -> Result<(), Box<dyn Error>> {
    let target = std::env::args_os()
        .nth(1)
        .ok_or("usage: residual_picture OUT.svg")?;
    let mut selection = Selection::default();
    let mut source = points::open(std::path::Path::new("fixtures/valley.laz"))?;
    selection.add_source(source.as_mut())?;
    let (mut all, _) = selection.finish();
    // Every eighth: a picture has room for no more.
    all = all.into_iter().step_by(8).collect();
    let (low, high) = all
        .iter()
        .fold(([f64::MAX; 2], [f64::MIN; 2]), |(low, high), p| {
            (
                [low[0].min(p[0]), low[1].min(p[1])],
                [high[0].max(p[0]), high[1].max(p[1])],
            )
        });
    let on_page = |p: [f64; 3]| (2.0 * (p[0] - low[0]), 2.0 * (high[1] - p[1]));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-4 -4 {:.0} {:.0}\">\n<rect x=\"-4\" y=\"-4\" width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        2.0 * (high[0] - low[0]) + 8.0,
        2.0 * (high[1] - low[1]) + 8.0
    );
    let dots = |points: &[[f64; 3]], size: f64, color: &str, svg: &mut String| {
        let _ = write!(
            svg,
            "<path fill=\"none\" stroke=\"{color}\" stroke-width=\"{size}\" stroke-linecap=\"round\" d=\""
        );
        for &point in points {
            let (x, y) = on_page(point);
            let _ = write!(svg, "M{x:.1} {y:.1}h0");
        }
        svg.push_str("\"/>\n");
    };
    dots(&all, 1.0, "#cccccc", &mut svg);
    let layout = TileLayout::grid(low, high, [4, 4]);
    for step in layout.steps() {
        let Work::Leaf(number) = &step.work else {
            continue;
        };
        let own: Vec<[f64; 3]> = all
            .iter()
            .copied()
            .filter(|p| step.tile.holds([p[0], p[1]]))
            .collect();
        let rest = leaf(&step.tile, *number, &own, &[], 0.0, &mut |_| ())?;
        let vertices: Vec<[f64; 3]> = rest.vertices.iter().map(|vertex| vertex.position).collect();
        svg.push_str("<path fill=\"none\" stroke=\"#1f6fb2\" stroke-width=\"0.8\" d=\"");
        for edge in &rest.edges {
            let [(x0, y0), (x1, y1)] = edge.ends.map(|end| on_page(vertices[end as usize]));
            let _ = write!(svg, "M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}");
        }
        svg.push_str("\"/>\n");
        dots(&vertices, 2.2, "#c0392b", &mut svg);
    }
    svg.push_str("</svg>\n");
    std::fs::write(target, svg)?;
    Ok(())
}
