//! Maps of errors.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Pixels along the longer side.
const SIDE: f64 = 1200.0;

/// What is drawn over what, from below: objects and ground as they are, then the errors.
const COLORS: [(bool, bool, [u8; 3], i64); 4] = [
    (false, false, [200, 200, 210], 1),
    (true, true, [120, 180, 120], 1),
    (false, true, [20, 60, 230], 2),
    (true, false, [220, 20, 20], 2),
];

/// Writes a picture with a square for each point.
pub(super) fn write(
    target: &Path,
    points: &[[f64; 3]],
    is_ground: &[bool],
    found: &[bool],
) -> Result<(), Box<dyn Error>> {
    let low = [0, 1].map(|axis| points.iter().fold(f64::INFINITY, |low, p| low.min(p[axis])));
    let high = [0, 1].map(|axis| {
        points
            .iter()
            .fold(f64::NEG_INFINITY, |high, p| high.max(p[axis]))
    });
    let extent = [0, 1].map(|axis| high[axis] - low[axis]);
    let scale = (SIDE - 1.0) / extent[0].max(extent[1]).max(1e-9);
    let [width, height] = extent.map(|extent| (extent * scale) as usize + 1);
    // About a point's share of the picture.
    let spacing = (width as f64 * height as f64 / points.len() as f64).sqrt();
    let mut pixels = vec![255u8; 3 * width * height];
    for (ground, called, color, weight) in COLORS {
        let reach = (0.3 * spacing * weight as f64).ceil() as i64;
        let chosen = (0..points.len()).filter(|&at| (is_ground[at], found[at]) == (ground, called));
        for at in chosen {
            let column = ((points[at][0] - low[0]) * scale) as i64;
            let row = ((high[1] - points[at][1]) * scale) as i64;
            for y in (row - reach).max(0)..(row + reach).min(height as i64) {
                for x in (column - reach).max(0)..(column + reach).min(width as i64) {
                    let pixel = 3 * (y as usize * width + x as usize);
                    pixels[pixel..pixel + 3].copy_from_slice(&color);
                }
            }
        }
    }
    let mut encoder = png::Encoder::new(
        BufWriter::new(File::create(target)?),
        width as u32,
        height as u32,
    );
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}
