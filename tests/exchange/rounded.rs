//! Formats that round coordinates: GLB and CityJSON.

use breakline::crs::Crs;
use breakline::data::{Mesh, Surface};
use breakline::io::mesh;
use serde_json::Value;

use crate::refused;
use crate::sample::field;

/// The largest difference that a note states.
fn stated(notes: &[String]) -> f64 {
    let (_, number) = notes[0].rsplit_once(' ').unwrap();
    number.parse().unwrap()
}

fn difference(one: &Mesh, other: &Mesh) -> f64 {
    assert_eq!(one.face_count(), other.face_count());
    let mut largest: f64 = 0.0;
    for number in 0..one.face_count() as u32 {
        assert_eq!(one.face(number), other.face(number));
        let pairs = one
            .triangle(number)
            .unwrap()
            .into_iter()
            .zip(other.triangle(number).unwrap());
        for (a, b) in pairs {
            (0..3).for_each(|k| largest = largest.max((a[k] - b[k]).abs()));
        }
    }
    largest
}

/// The text and the arrays of a GLB, by a naive reader.
fn chunks(bytes: &[u8]) -> (Value, &[u8]) {
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(
        (&bytes[..4], number(4), number(8)),
        (&b"glTF"[..], 2, bytes.len())
    );
    let text = number(12);
    assert_eq!((&bytes[16..20], text % 4), (&b"JSON"[..], 0));
    let data = &bytes[28 + text..];
    assert_eq!(
        (&bytes[24 + text..28 + text], number(20 + text)),
        (&b"BIN\0"[..], data.len())
    );
    (serde_json::from_slice(&bytes[20..20 + text]).unwrap(), data)
}

#[test]
fn glb_counts_from_an_origin_in_the_node_and_in_extras() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    let field = field(Some("EPSG:25832"));
    let summary = mesh::write(&path, &field).unwrap();
    let back = mesh::read(&path).unwrap();
    assert!(back.crs().unwrap().is_same(field.crs().unwrap()));
    let largest = difference(&back, &field);
    assert!(largest > 0.0 && largest < 1e-6);
    assert!(stated(&summary.notes) >= 0.95 * largest && stated(&summary.notes) <= 1.05 * largest);
    assert!(
        summary.notes[0]
            .starts_with("coordinates are 32-bit floats relative to 512003.25 5403001.5"),
        "{}",
        summary.notes[0]
    );

    let bytes = std::fs::read(&path).unwrap();
    let (json, data) = chunks(&bytes);
    let extras = &json["asset"]["extras"]["breakline"];
    assert_eq!(extras["epsg"], 25832);
    let origin: Vec<f64> = serde_json::from_value(extras["origin"].clone()).unwrap();
    let translation: Vec<f64> =
        serde_json::from_value(json["nodes"][0]["translation"].clone()).unwrap();
    assert_eq!(translation, [origin[0], origin[2], -origin[1]]);
    let float = |at: usize| f32::from_le_bytes(data[at..at + 4].try_into().unwrap());
    let triple = |at: usize| [float(at), float(at + 4), float(at + 8)];
    let vertices = 36;
    let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for vertex in 0..vertices {
        let [x, up, south] = triple(12 * vertex);
        for (k, c) in [x, up, south].into_iter().enumerate() {
            (min[k], max[k]) = (min[k].min(c), max[k].max(c));
        }
        let normal = triple(12 * (vertices + vertex));
        let length: f32 = normal.iter().map(|c| c * c).sum();
        assert!((length - 1.0).abs() < 1e-5 && normal[1] > 0.0, "up");
    }
    let corner = |name: &str| -> Vec<f32> {
        serde_json::from_value(json["accessors"][0][name].clone()).unwrap()
    };
    assert_eq!((corner("min"), corner("max")), (min.to_vec(), max.to_vec()));
    // Seen from above, triangles are counter-clockwise: front faces.
    let indices = 28 * vertices;
    let index = |at: usize| u32::from_le_bytes(data[at..at + 4].try_into().unwrap()) as usize;
    for face in (indices..data.len()).step_by(12) {
        let [a, b, c] = [0, 4, 8].map(|k| triple(12 * index(face + k)));
        let turn = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
        assert!(turn > 0.0);
    }
}

#[test]
fn glb_of_what_is_flat_in_32_bits_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    let thin = 2e7 + 1e-3;
    let vertices = vec![
        [0.0, 0.0, 1.0],
        [4e7, 0.0, 1.0],
        [2e7, 1e-3, 1.0],
        [thin, 2e7, 1.0],
    ];
    let mesh = Mesh::new(vertices, vec![[0, 1, 2], [0, 2, 3], [1, 3, 2]], &[], None).unwrap();
    let notes = mesh::write(&path, &mesh).unwrap().notes;
    assert_eq!(notes.len(), 2, "{notes:?}");
    assert_eq!(notes[1], "1 triangles have no area in these coordinates");
    let large = vec![[0.0, 0.0, 1.0], [1e300, 0.0, 1.0], [0.0, 1e300, 1.0]];
    let mesh = Mesh::new(large, vec![[0, 1, 2]], &[], None).unwrap();
    let error = mesh::write(&path, &mesh).unwrap_err().to_string();
    assert!(
        error.ends_with("the surface is too large for 32-bit floats"),
        "{error}"
    );
    let empty = Mesh::new(Vec::new(), Vec::new(), &[], None).unwrap();
    assert!(mesh::write(&path, &empty).is_err());
}

/// A GLB of a text and arrays.
fn glb(text: &str, data: &[u8]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = 28 + text.len() + data.len();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((total as u32).to_le_bytes());
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(text);
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(data);
    bytes
}

#[test]
fn glb_of_other_programs_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    // Interleaved positions, 16-bit indices, two nodes with one mesh.
    let mut data = Vec::new();
    for p in [[0f32, 5.0, 0.0], [1.0, 6.0, 0.0], [0.0, 7.0, -1.0]] {
        p.iter()
            .chain(&[9.0])
            .for_each(|c| data.extend(c.to_le_bytes()));
    }
    [0u16, 1, 2, 0]
        .iter()
        .for_each(|i| data.extend(i.to_le_bytes()));
    let text = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0},{"mesh":0,"translation":[10,1,-20]},{}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
                     {"bufferView":1,"componentType":5123,"type":"SCALAR","count":3}],
        "bufferViews":[{"buffer":0,"byteLength":48,"byteStride":16},{"buffer":0,"byteOffset":48,"byteLength":8}],
        "buffers":[{"byteLength":56}]}"#;
    let read = |text: &str| {
        std::fs::write(&path, glb(text, &data)).unwrap();
        mesh::read(&path)
    };
    let mesh = read(text).unwrap();
    assert_eq!(
        mesh.triangle(0).unwrap(),
        [[0.0, 0.0, 5.0], [1.0, 0.0, 6.0], [0.0, 1.0, 7.0]]
    );
    assert_eq!(mesh.triangle(1).unwrap()[0], [10.0, 20.0, 6.0]);
    let changes = [
        (
            "\"mesh\":0,\"tr",
            "\"mesh\":0,\"scale\":[1,1,1],\"tr",
            "node 1: the node has a scale",
        ),
        (
            "[10,1,-20]",
            "[10,1]",
            "node 1: the translation is [10,1], expected three numbers",
        ),
        (
            "\"count\":3}]",
            "\"count\":4}]",
            "node 0: 4 corners are not those of triangles",
        ),
        (
            "\"count\":3},",
            "\"count\":4},",
            "node 0, accessor 0: the array is not within",
        ),
        (
            "\"count\":3},",
            "\"count\":99999999999999999999},",
            "accessor 0: the array is not",
        ),
        (
            "\"byteOffset\":48",
            "\"byteOffset\":50",
            "node 0, accessor 1: the array is not within",
        ),
        (
            "\"POSITION\":0",
            "\"POSITION\":7",
            "node 0: 7 is not the number of one of accessors",
        ),
        (
            "5126",
            "5125",
            "node 0, accessor 0: numbers of type 5125 \"VEC3\", expected VEC3",
        ),
        (
            "\"asset\"",
            "\"extensionsRequired\":[\"KHR_draco\"],\"asset\"",
            "needs the extension",
        ),
        ("{}]", "{\"children\":[0]}]", "nodes: nodes have children"),
        ("{}]", "{}", "chunk 0: not JSON"),
    ];
    refused::with_each_change(text, "a.glb: ", read, &changes);
}

#[test]
fn cityjson_has_whole_numbers_and_says_what_they_lose() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a site.cityjson");
    let crs = Crs::from_epsg(25832).unwrap();
    let field = field(Some("EPSG:25832"));
    let summary = mesh::write(&path, &field).unwrap();
    let json: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(json["version"], "2.0");
    assert_eq!(
        Crs::from_user(json["metadata"]["referenceSystem"].as_str().unwrap()).unwrap(),
        crs
    );
    let relief = &json["CityObjects"]["a site"];
    assert_eq!(relief["type"], "TINRelief");
    let boundaries: Vec<[[u32; 3]; 1]> =
        serde_json::from_value(relief["geometry"][0]["boundaries"].clone()).unwrap();
    let whole: Vec<[i64; 3]> = serde_json::from_value(json["vertices"].clone()).unwrap();
    let numbers = |name: &str| -> [f64; 3] {
        serde_json::from_value(json["transform"][name].clone()).unwrap()
    };
    let (scale, translate) = (numbers("scale"), numbers("translate"));
    let vertices = whole
        .iter()
        .map(|v| [0, 1, 2].map(|k| v[k] as f64 * scale[k] + translate[k]))
        .collect();
    let faces = boundaries.iter().map(|[face]| *face).collect();
    let back = Mesh::new(vertices, faces, &[], None).unwrap();
    let largest = difference(&back, &field);
    assert!(largest > 1e-4 && largest <= 5.001e-4);
    assert!((stated(&summary.notes) - largest).abs() < 0.06 * largest);
    assert!(
        summary.notes[0]
            .starts_with("coordinates are whole numbers of 0.001 and 0.001 relative to 512000 ")
    );
}
