//! Meshes for models of water: 2DM and UGRID.

use breakline::data::{Mesh, Surface};
use breakline::io::mesh;

use crate::program::folder_with;
use crate::refused;
use crate::sample::{content, field};

#[test]
fn a_2dm_gives_the_same_doubles_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.2dm");
    let field = field(Some("EPSG:25832"));
    let summary = mesh::write(&path, &field).unwrap();
    assert_eq!(summary.lost_edges, 10);
    assert_eq!(
        summary.notes,
        [
            "the format has no coordinate system, which is left out: EPSG:25832 (ETRS89 / UTM zone 32N)"
        ]
    );
    let vertices = (0..36).map(|v| field.position(v)).collect();
    let faces = (0..46).map(|f| field.face(f).unwrap()).collect();
    let without = Mesh::new(vertices, faces, &[], None).unwrap();
    assert_eq!(content(&mesh::read(&path).unwrap()), content(&without));
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("MESH2D\nE3T 1 "));
    assert!(text.contains("\nND 1 512000.1 5403000.7 250\n"));
}

#[test]
fn a_2dm_of_other_programs_is_read() {
    let folder = folder_with(&[]);
    let path = folder.path().join("a.2dm");
    let read = |text: &str| {
        std::fs::write(&path, text).unwrap();
        mesh::read(&path).map_err(|e| e.to_string())
    };
    let text = "MESH2D\r\nMESHNAME \"Mesh 1\"\r\nNUM_MATERIALS_PER_ELEM 1\r\nE4Q  1  10 20 30 40  1\r\n\
                E3T 2 40 30 5 2\r\nND 10 0 0 1.0e+00\r\nND 20 1 0 2\r\nND 30 1 1 3\r\nND 40 0 1 4\r\nND 5 0.5 2 5\r\n\
                NS 10 20 -30 1\r\nBEGPARAMDEF\r\nGM \"Mesh\"\r\nSI 0\r\nENDPARAMDEF\r\n";
    assert_eq!(read(text).unwrap().face_count(), 3);
    let changes = [
        (
            "MESH2D",
            "MESH3D",
            "line 1: the file begins with 'MESH3D', not with 'MESH2D'",
        ),
        (
            "E3T 2 40 30 5",
            "E3T 2 40 30 6",
            "line 5: there is no node 6",
        ),
        (
            "E3T 2 40 30 5 2",
            "E3T 2 40 30",
            "line 5: there is no node number",
        ),
        (
            "ND 20 1 0 2",
            "ND 10 1 0 2",
            "line 7: two nodes have the number 10",
        ),
        (
            "ND 20 1 0 2",
            "ND 20 1 0",
            "line 7: there is no z coordinate",
        ),
        (
            "ND 20 1 0 2",
            "MD 20 1 0 2",
            "line 7: 'MD' is not a card of 2DM",
        ),
        (
            "E3T 2",
            "E6T 2",
            "line 5: elements E6T have nodes on their edges",
        ),
        (
            "ENDPARAMDEF",
            "",
            "the end: the card ENDPARAMDEF is missing",
        ),
    ];
    refused::with_each_change(text, "a.2dm: ", read, &changes);
}

/// The header of a NetCDF file, by a naive reader.
struct Header<'a>(&'a [u8], usize);

impl Header<'_> {
    fn number(&mut self) -> u32 {
        self.1 += 4;
        u32::from_be_bytes(self.0[self.1 - 4..self.1].try_into().unwrap())
    }

    fn name(&mut self) -> String {
        let length = self.number() as usize;
        let text = String::from_utf8(self.0[self.1..self.1 + length].to_vec()).unwrap();
        self.1 += length.next_multiple_of(4);
        text
    }

    fn attributes(&mut self) -> Vec<(String, String)> {
        assert_eq!(self.number(), 12);
        let count = self.number();
        (0..count)
            .map(|_| {
                let name = self.name();
                let value = match self.number() {
                    2 => self.name(),
                    _ => {
                        assert_eq!(self.number(), 1);
                        self.number().to_string()
                    }
                };
                (name, value)
            })
            .collect()
    }
}

#[test]
fn ugrid_is_netcdf_with_a_topology() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.nc");
    let field = field(Some("EPSG:25832"));
    let summary = mesh::write(&path, &field).unwrap();
    assert_eq!((summary.notes.len(), summary.lost_edges), (0, 10));
    let back = mesh::read(&path).unwrap();
    let corners = |mesh: &Mesh| (0..46).map(|f| mesh.triangle(f)).collect::<Vec<_>>();
    assert_eq!(corners(&back), corners(&field));
    assert!(back.crs().unwrap().is_same(field.crs().unwrap()));
    let bytes = std::fs::read(&path).unwrap();
    assert!(bytes.starts_with(b"CDF\x02\0\0\0\0"));
    let mut header = Header(&bytes, 8);
    assert_eq!([header.number(), header.number()], [10, 3]);
    let dimensions: Vec<(String, u32)> = (0..3).map(|_| (header.name(), header.number())).collect();
    assert_eq!(
        dimensions.iter().map(|d| d.1).collect::<Vec<_>>(),
        [36, 46, 3]
    );
    assert_eq!(header.attributes()[0].1, "CF-1.8 UGRID-1.0");
    assert_eq!([header.number(), header.number()], [11, 6]);
    let (mut at, mut found) = (None, Vec::new());
    for _ in 0..6 {
        let name = header.name();
        let dimensions: Vec<u32> = (0..header.number()).map(|_| header.number()).collect();
        let attributes = header.attributes();
        let (kind, size) = (header.number(), header.number() as usize);
        assert_eq!(header.number(), 0);
        let begin = header.number() as usize;
        assert_eq!(*at.get_or_insert(begin), begin, "{name}");
        at = Some(begin + size);
        found.push((name, dimensions, attributes, kind, begin, size));
    }
    assert_eq!(found[0].4, header.1, "values follow the header");
    assert_eq!(at, Some(bytes.len()));
    let double = |at: usize| f64::from_be_bytes(bytes[at..at + 8].try_into().unwrap());
    for axis in 0..3 {
        let (_, dimensions, _, kind, begin, _) = &found[2 + axis];
        assert_eq!((&dimensions[..], *kind), (&[0][..], 6));
        for vertex in 0..36 {
            assert_eq!(
                double(begin + 8 * vertex),
                field.position(vertex as u32)[axis]
            );
        }
    }
    let (name, dimensions, _, _, begin, _) = &found[5];
    assert_eq!(
        (name.as_str(), &dimensions[..]),
        ("mesh2d_face_nodes", &[1, 2][..])
    );
    let node = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    for face in 0..46 {
        let corners = [0, 4, 8].map(|k| node(begin + 12 * face + k));
        assert_eq!(Some(corners), field.face(face as u32));
    }
    let of = |name: &str| found[1].2.iter().find(|a| a.0 == name).map(|a| a.1.clone());
    assert_eq!(of("epsg").unwrap(), "25832");
    assert_eq!(of("EPSG_code").unwrap(), "EPSG:25832");
}
