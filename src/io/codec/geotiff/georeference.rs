//! Converts the model tags of GeoTIFF (OGC 19-008r4) to one affine transform in GDAL's order.

use crate::error::Wording;
/// The tags that locate a raster, as stored in the file.
#[derive(Debug, Default)]
pub(super) struct ModelTags {
    pub(super) pixel_scale: Option<Vec<f64>>,
    pub(super) tiepoints: Option<Vec<f64>>,
    pub(super) transformation: Option<Vec<f64>>,
    /// True if the coordinates are those of cell centers (PixelIsPoint).
    pub(super) is_point: bool,
}

/// Tiepoints within this fraction of a cell of an affine transform are considered to lie on it.
const TIEPOINT_TOLERANCE: f64 = 1e-4;

impl ModelTags {
    /// Returns the transform, and warnings for the user.
    pub(super) fn transform(&self) -> (Option<[f64; 6]>, Vec<Wording>) {
        let mut warnings = Vec::new();
        let transform = self
            .exact(&mut warnings)
            .map(|t| if self.is_point { shifted_by_half(t) } else { t });
        match transform {
            Some(t) if !t.iter().all(|v| v.is_finite()) || t[1] * t[5] - t[2] * t[4] == 0.0 => {
                warnings.push(format!("the georeferencing is not usable: transform {t:?}").into());
                (None, warnings)
            }
            other => (other, warnings),
        }
    }

    fn exact(&self, warnings: &mut Vec<Wording>) -> Option<[f64; 6]> {
        let scale = self
            .pixel_scale
            .as_deref()
            .filter(|scale| scale.len() >= 2 && scale[0] != 0.0 && scale[1] != 0.0);
        let tiepoints = self.tiepoints.as_deref().unwrap_or(&[]);
        if let (Some(scale), Some(tie)) = (scale, tiepoints.get(..6)) {
            if scale[1] < 0.0 {
                warnings.push(
                    format!(
                        "negative y scale {} in ModelPixelScaleTag: taken as positive, north up, as GDAL does",
                        scale[1]
                    )
                    .into(),
                );
            }
            let (x_step, y_step) = (scale[0], -scale[1].abs());
            return Some([
                tie[3] - tie[0] * x_step,
                x_step,
                0.0,
                tie[4] - tie[1] * y_step,
                0.0,
                y_step,
            ]);
        }
        if let Some(m) = self.transformation.as_deref().filter(|m| m.len() >= 8) {
            return Some([m[3], m[0], m[1], m[7], m[4], m[5]]);
        }
        let count = tiepoints.len() / 6;
        if count == 0 {
            return None;
        }
        let fit = fit(tiepoints);
        if fit.is_none() {
            warnings.push(format!(
                "unsupported georeferencing: {count} ground control points (tiepoints without a pixel scale) that do \
                 not lie on one affine transform"
            ).into());
        }
        fit
    }
}

fn shifted_by_half(t: [f64; 6]) -> [f64; 6] {
    [
        t[0] - (t[1] + t[2]) / 2.0,
        t[1],
        t[2],
        t[3] - (t[4] + t[5]) / 2.0,
        t[4],
        t[5],
    ]
}

/// Returns the affine transform through all tiepoints, by least squares about their mean; `None` if
/// they do not determine one or do not lie on it.
fn fit(tiepoints: &[f64]) -> Option<[f64; 6]> {
    let points: Vec<&[f64]> = tiepoints.chunks_exact(6).collect();
    let n = points.len() as f64;
    let mean = |i: usize| points.iter().map(|p| p[i]).sum::<f64>() / n;
    let [column, row, x, y] = [mean(0), mean(1), mean(3), mean(4)];
    // Normal equations of (column, row) -> x and (column, row) -> y.
    let (mut cc, mut cr, mut rr) = (0.0, 0.0, 0.0);
    let (mut cx, mut rx, mut cy, mut ry) = (0.0, 0.0, 0.0, 0.0);
    for p in &points {
        let (c, r) = (p[0] - column, p[1] - row);
        cc += c * c;
        cr += c * r;
        rr += r * r;
        cx += c * (p[3] - x);
        rx += r * (p[3] - x);
        cy += c * (p[4] - y);
        ry += r * (p[4] - y);
    }
    let determinant = cc * rr - cr * cr;
    if points.len() < 3 || determinant <= 1e-12 * cc * rr {
        return None;
    }
    let solve = |cv: f64, rv: f64| {
        [
            (cv * rr - rv * cr) / determinant,
            (rv * cc - cv * cr) / determinant,
        ]
    };
    let ([x_column, x_row], [y_column, y_row]) = (solve(cx, rx), solve(cy, ry));
    let transform = [
        x - x_column * column - x_row * row,
        x_column,
        x_row,
        y - y_column * column - y_row * row,
        y_column,
        y_row,
    ];
    let cell = x_column.hypot(y_column).min(x_row.hypot(y_row));
    let is_met = points.iter().all(|p| {
        let dx = transform[0] + p[0] * x_column + p[1] * x_row - p[3];
        let dy = transform[3] + p[0] * y_column + p[1] * y_row - p[4];
        dx.hypot(dy) <= TIEPOINT_TOLERANCE * cell
    });
    is_met.then_some(transform)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tiepoints(t: [f64; 6], positions: &[[f64; 2]]) -> Vec<f64> {
        let tie = |[c, r]: [f64; 2]| {
            [
                c,
                r,
                0.0,
                t[0] + c * t[1] + r * t[2],
                t[3] + c * t[4] + r * t[5],
                0.0,
            ]
        };
        positions.iter().flat_map(|&p| tie(p)).collect()
    }

    fn transform(tags: ModelTags) -> Option<[f64; 6]> {
        tags.transform().0
    }

    #[test]
    fn scale_and_tiepoint_may_tie_any_cell() {
        let tags = ModelTags {
            pixel_scale: Some(vec![2.0, 3.0, 0.0]),
            tiepoints: Some(vec![10.0, 20.0, 0.0, 1000.0, 5000.0, 0.0]),
            ..ModelTags::default()
        };
        assert_eq!(transform(tags), Some([980.0, 2.0, 0.0, 5060.0, 0.0, -3.0]));
    }

    #[test]
    fn a_point_raster_begins_half_a_cell_before_its_first_center() {
        let tags = ModelTags {
            transformation: Some(vec![1.5, -5.0, 0.0, 1841000.0, -5.0, -1.5, 0.0, 1144000.0]),
            is_point: true,
            ..ModelTags::default()
        };
        assert_eq!(
            transform(tags),
            Some([1841001.75, 1.5, -5.0, 1144003.25, -5.0, -1.5])
        );
    }

    #[test]
    fn tiepoints_on_one_affine_transform_give_it() {
        let wanted = [4302000.0, 30.0, 4.0, 2811000.0, -2.0, -31.0];
        let positions = [[0.0, 0.0], [507.0, 3.0], [11.0, 190.0], [300.0, 170.0]];
        let found = transform(ModelTags {
            tiepoints: Some(tiepoints(wanted, &positions)),
            ..ModelTags::default()
        })
        .unwrap();
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-6, "{found} is not {wanted}");
        }
    }

    #[test]
    fn tiepoints_off_any_affine_transform_are_named_and_give_none() {
        let mut bent = tiepoints(
            [0.0, 1.0, 0.0, 0.0, 0.0, -1.0],
            &[[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [9.0, 9.0]],
        );
        bent[3] += 0.5;
        let two = tiepoints([0.0, 1.0, 0.0, 0.0, 0.0, -1.0], &[[0.0, 0.0], [1.0, 1.0]]);
        let in_line = tiepoints(
            [0.0, 1.0, 0.0, 0.0, 0.0, -1.0],
            &[[0.0, 0.0], [1.0, 1.0], [5.0, 5.0]],
        );
        for tiepoints in [bent, two, in_line] {
            let (transform, warnings) = ModelTags {
                tiepoints: Some(tiepoints),
                ..ModelTags::default()
            }
            .transform();
            assert_eq!(transform, None);
            assert!(
                warnings[0].plain().contains("ground control points"),
                "{warnings:?}"
            );
        }
    }

    #[test]
    fn a_transform_that_is_flat_or_not_finite_is_refused() {
        for m in [[0.0; 8], [f64::NAN; 8]] {
            let (transform, warnings) = ModelTags {
                transformation: Some(m.to_vec()),
                ..ModelTags::default()
            }
            .transform();
            assert!(transform.is_none() && warnings.len() == 1);
        }
    }
}
