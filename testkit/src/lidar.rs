//! Small LAS files.

/// A LAS 1.2 file of point format 0, in steps of 0.01: points as x, y, z and class.
pub fn las(points: &[([f64; 3], u8)], epsg: Option<u16>) -> Vec<u8> {
    let keys = epsg.map_or(Vec::new(), |code| {
        vec![1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, code]
    });
    with_keys(points, &keys)
}

/// Returns the bytes of a LAS file with a coordinate system whose heights are in US survey feet.
pub fn las_with_heights_in_feet(points: &[([f64; 3], u8)], epsg: u16) -> Vec<u8> {
    let keys = [
        1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, epsg, 4099, 0, 1, 9003,
    ];
    with_keys(points, &keys)
}

fn with_keys(points: &[([f64; 3], u8)], keys: &[u16]) -> Vec<u8> {
    let records = if keys.is_empty() { 0u32 } else { 1 };
    let points_start = 227 + records * (54 + 2 * keys.len() as u32);
    let mut file = b"LASF".to_vec();
    file.resize(24, 0);
    file.extend([1, 2]);
    file.resize(94, 0);
    file.extend(227u16.to_le_bytes());
    file.extend(points_start.to_le_bytes());
    file.extend(records.to_le_bytes());
    file.push(0);
    file.extend(20u16.to_le_bytes());
    file.extend((points.len() as u32).to_le_bytes());
    file.resize(131, 0);
    file.extend([0.01f64; 3].map(f64::to_le_bytes).concat());
    file.extend([0.0f64; 3].map(f64::to_le_bytes).concat());
    for axis in 0..3 {
        let values = || points.iter().map(|(position, _)| position[axis]);
        file.extend(values().fold(f64::MIN, f64::max).to_le_bytes());
        file.extend(values().fold(f64::MAX, f64::min).to_le_bytes());
    }
    if records > 0 {
        let mut record = vec![0, 0];
        record.extend(b"LASF_Projection\0");
        record.extend(34735u16.to_le_bytes());
        record.extend((2 * keys.len() as u16).to_le_bytes());
        record.resize(54, 0);
        file.extend(record);
        file.extend(keys.iter().flat_map(|key| key.to_le_bytes()));
    }
    assert_eq!(file.len(), points_start as usize);
    for (position, class) in points {
        file.extend(
            position
                .map(|value| ((value * 100.0).round() as i32).to_le_bytes())
                .concat(),
        );
        file.extend([0, 0, 0x09, *class, 0, 0, 0, 0]);
    }
    file
}

/// A square of points a metre apart, all of one class.
pub fn tile([x, y]: [f64; 2], class: u8) -> Vec<([f64; 3], u8)> {
    (0..16)
        .map(|i| {
            (
                [x + f64::from(i % 4), y + f64::from(i / 4), f64::from(i)],
                class,
            )
        })
        .collect()
}
