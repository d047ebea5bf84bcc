//! LandXML.

use std::path::Path;

use breakline::crs::{Crs, Unit};
use breakline::data::{EdgeKind, Surface};
use breakline::io::mesh;

use crate::program::{folder_with, run_in};
use crate::refused;
use crate::sample::{content, field};

/// Two surfaces and more, as other programs write them: ids with gaps, a hidden face, other
/// elements, a prefix, a surface without triangles.
const FOREIGN: &str = "\u{feff}<?xml version=\"1.0\"?>\r\n\
<!-- made by hand -->\r\n\
<lx:LandXML xmlns:lx=\"http://www.landxml.org/schema/LandXML-1.2\" version=\"1.2\">\r\n\
<lx:Units><lx:Imperial linearUnit=\"USSurveyFoot\" areaUnit=\"squareFoot\"/></lx:Units>\r\n\
<lx:CgPoints><lx:CgPoint name=\"P\">1 2 3</lx:CgPoint></lx:CgPoints>\r\n\
<lx:Surfaces>\r\n\
<lx:Surface name=\"empty\"/>\r\n\
<lx:Surface name=\"EG &amp; more\"><lx:SourceData><lx:Breaklines>\
<lx:Breakline brkType=\"wall\"><lx:PntList3D>0 0 1 0 10 2\t7 7 7</lx:PntList3D></lx:Breakline>\
<lx:Breakline><lx:PntList2D>1 2 3 4</lx:PntList2D></lx:Breakline></lx:Breaklines></lx:SourceData>\
<lx:Definition surfType=\"TIN\"><lx:Pnts>\
<lx:P id=\"7\">0. 0 1</lx:P><lx:P id=\"3\">0 10 2.</lx:P><lx:P id=\"900\"> 20.5 <!-- x -->10 3 </lx:P>\
<lx:P id=\"4\"><![CDATA[20.5 0 4]]></lx:P></lx:Pnts>\
<lx:Faces><lx:F n=\"0 0 2\">7 3 900</lx:F><lx:F i=\"1\">7 900 4</lx:F></lx:Faces></lx:Definition></lx:Surface>\r\n\
<lx:Surface name=\"FG\"><lx:Definition surfType=\"TIN\"><lx:Pnts>\
<lx:P id=\"1\">0 0 1</lx:P><lx:P id=\"2\">0 10 2</lx:P><lx:P id=\"3\">20 10 3</lx:P></lx:Pnts>\
<lx:Faces><lx:F>1 2 3</lx:F></lx:Faces></lx:Definition></lx:Surface>\r\n\
</lx:Surfaces></lx:LandXML>\r\n";

fn named(folder: &tempfile::TempDir, name: &str) -> std::path::PathBuf {
    folder.path().join(name)
}

#[test]
fn what_is_written_is_read_again_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    for system in [
        None,
        Some("EPSG:25832"),
        Some("EPSG:25832+7837"),
        Some("EPSG:2994"),
        Some("EPSG:2264"),
        Some("LOCAL_CS[\"a \"\"site\"\" <&>\",UNIT[\"foot\",0.3048]]"),
    ] {
        let field = field(system);
        let path = named(&folder, "a.xml");
        let summary = mesh::write(&path, &field).unwrap();
        assert_eq!((summary.lost_edges, summary.origin), (0, None));
        assert_eq!(summary.notes.is_empty(), system.is_some());
        let back = mesh::read(&path).unwrap();
        assert_eq!(content(&back), content(&field), "{system:?}");
        match (back.crs(), field.crs()) {
            (Some(back), Some(crs)) => {
                assert!(back.is_same(crs), "{back:?} is not {crs:?}");
                assert_eq!(back.vertical_unit, crs.vertical_unit);
            }
            (back, crs) => assert_eq!(back, crs),
        }
        let again = named(&folder, "a.landxml");
        mesh::write(&again, &back).unwrap();
        let [one, other] = [&path, &again].map(|path| std::fs::read_to_string(path).unwrap());
        assert_eq!(one, other);
    }
}

#[test]
fn elements_say_what_the_schema_means() {
    let folder = tempfile::tempdir().unwrap();
    let path = named(&folder, "my <site>.xml");
    mesh::write(&path, &field(Some("EPSG:2264"))).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    for part in [
        "<Imperial linearUnit=\"USSurveyFoot\" areaUnit=\"squareFoot\"",
        "epsgCode=\"2264\" ogcWktCode=\"PROJCS[&quot;",
        "<Surface name=\"my &lt;site&gt;\">",
        // North before east.
        "<P id=\"1\">5403000.7 512000.1 250</P>\n",
        "<Boundary bndType=\"outer\"",
        "<Boundary bndType=\"void\"",
        "<Breakline brkType=\"wall\" name=\"walls\">",
        "<Breakline brkType=\"nondestructive\" name=\"draped lines\">",
        "<Breakline brkType=\"standard\" name=\"soft lines\">",
        "</Faces>\n</Definition>\n</Surface>\n</Surfaces>\n</LandXML>\n",
    ] {
        assert!(text.contains(part), "{part}");
    }
    assert_eq!(text.matches("<Boundary ").count(), 2);
    assert_eq!(text.matches("<F>").count(), 46);
}

#[test]
fn files_of_other_programs_are_read_surface_by_surface() {
    let folder = folder_with(&[("a.xml", FOREIGN)]);
    let read = |name: &str| mesh::read(&named(&folder, name));
    let ground = read("a.xml:EG & more").unwrap();
    assert_eq!(
        (ground.vertex_count(), ground.face_count()),
        (4, 1),
        "a hidden face is a hole"
    );
    let corners = ground.triangle(0).unwrap();
    assert_eq!(
        corners,
        [[0.0, 0.0, 1.0], [10.0, 0.0, 2.0], [10.0, 20.5, 3.0]]
    );
    assert_eq!(ground.edge_kind(0, 2), EdgeKind::Wall);
    assert_eq!(ground.edge_kind(0, 0), EdgeKind::Rim);
    let feet = Unit::length_from_name("USSurveyFoot").unwrap();
    assert_eq!(ground.crs().unwrap().unit, feet);
    let triangles = mesh::read_triangles(&named(&folder, "a.xml:EG & more")).unwrap();
    assert_eq!(triangles.warnings.len(), 1);
    assert_eq!(read("a.xml:FG").unwrap().face_count(), 1);
    for (name, said) in [
        ("a.xml", "the file has 2 surfaces: EG & more, FG"),
        ("a.xml:empty", "there is no surface 'empty'"),
        ("a.xml:eg", "there is no surface 'eg'"),
    ] {
        let error = read(name).unwrap_err().to_string();
        assert!(
            error.ends_with(&format!("a.xml: Surfaces: {said}")),
            "{error}"
        );
    }
}

#[test]
fn the_program_takes_a_surface_of_several() {
    let folder = folder_with(&[("a.xml", FOREIGN)]);
    run_in(&folder, &["tin", "a.xml:FG", "-o", "fg.ply"]).works(&["triangles   1"]);
    run_in(&folder, &["tin", "a.xml", "-o", "x.ply"]).fails(
        2,
        &[
            "has 2 surfaces: EG & more, FG",
            "hint: name one after the file",
        ],
    );
    run_in(&folder, &["tin", "a.xml:FG", "-o", "a.xml", "--overwrite"])
        .fails(2, &["the output is one of the inputs"]);
    run_in(&folder, &["info", "a.xml:FG"]).ends(0, &["TIN, LandXML", "US survey foot"]);
    run_in(&folder, &["tin", "fg.ply:FG", "-o", "x.ply"]).fails(2, &["a PLY mesh has one surface"]);
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let whole = "<LandXML>\n<Units><Metric linearUnit=\"meter\"/></Units>\n\
                 <CoordinateSystem name=\"here\"/>\n<Surfaces><Surface name=\"s\">\n\
                 <Definition surfType=\"TIN\"><Pnts>\n<P id=\"1\">0 0 1</P>\n<P id=\"2\">0 9 1</P>\n\
                 <P id=\"3\">9 0 1</P></Pnts><Faces>\n<F>1 2 3</F>\n</Faces></Definition>\n\
                 </Surface></Surfaces></LandXML>\n";
    let folder = folder_with(&[]);
    let read = |text: &str| {
        let path = named(&folder, "a.xml");
        std::fs::write(&path, text).unwrap();
        mesh::read_triangles(&path).map_err(|e| e.to_string())
    };
    let warnings = read(whole).unwrap().warnings;
    assert_eq!(warnings.len(), 1);
    assert_eq!(
        warnings[0],
        "the coordinate system 'here' is not understood"
    );
    let changes = [
        ("0 9 1", "0 9", "line 7: a point without height"),
        (
            "0 9 1",
            "0 9 1 1",
            "line 7: '1' follows the height of a point",
        ),
        (
            "0 9 1",
            "0 9,5 1",
            "line 7: the easting is '9,5', expected a finite number",
        ),
        (
            "0 9 1",
            "0 inf 1",
            "line 7: the easting is 'inf', expected a finite number",
        ),
        ("id=\"2\"", "id=\"1\"", "line 7: two points have the id 1"),
        (
            "id=\"2\"",
            "id=\"-2\"",
            "line 7: '-2' is not the id of a point",
        ),
        ("<P id=\"2\">", "<P>", "line 7: '' is not the id of a point"),
        (
            "1 2 3",
            "1 2",
            "line 9: a face has 2 corners, expected 3 or more",
        ),
        ("1 2 3", "1 2 x", "line 9: 'x' is not the id of a point"),
        (
            "1 2 3",
            "1 2 18446744073709551615",
            "face 0: no point has the id 18446744073709551615",
        ),
        ("</F>", "", "line 10: not XML"),
        ("</Faces></Definition>", "", "line 11: not XML"),
        (
            "\"TIN\"",
            "\"grid\"",
            "line 5: the surface 's' is a grid, expected a TIN",
        ),
        ("meter", "cubit", "line 2: 'cubit' is not a unit of length"),
        (
            "<LandXML>",
            "<kml>",
            "line 1: the file begins with the element 'kml', expected 'LandXML'",
        ),
        (
            "name=\"here\"",
            "epsgCode=\"2264\"",
            "CoordinateSystem: the coordinates are in metre by 'Units', in US survey foot by",
        ),
        (
            "</Surface></Surfaces></LandXML>\n",
            "",
            "the file ends within the element 'Surface'",
        ),
        (
            "0 0 1",
            "0 &bomb; 1",
            "line 6: the easting is '&bomb;', expected a finite number",
        ),
    ];
    refused::with_each_change(whole, "a.xml: ", read, &changes);
    let path = named(&folder, "a.xml");
    std::fs::write(&path, b"\xff\xfe<\0L\0").unwrap();
    let error = mesh::read_triangles(&path).unwrap_err();
    assert!(error.to_string().ends_with("a.xml: the text is UTF-16"));
}

#[test]
fn units_that_landxml_lacks_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |system: &str| {
        let field = field(Some(system));
        mesh::write(&named(&folder, "a.xml"), &field).map(|summary| summary.notes)
    };
    let refused = |system: &str| write(system).unwrap_err().to_string();
    assert!(refused("EPSG:4326").ends_with("LandXML has no surfaces in degrees"));
    assert!(refused("EPSG:2136").ends_with("LandXML does not have the unit Gold Coast foot"));
    assert!(!Path::new(&named(&folder, "a.xml")).exists());
    // Feet of heights over meters, as far as it can be stated.
    let compound = |vertical: &str| {
        let wkt = Crs::from_user(&format!("EPSG:26910+{vertical}"))
            .unwrap()
            .to_wkt();
        write(&wkt).unwrap()
    };
    assert_eq!(compound("8228"), [""; 0]);
    assert!(
        std::fs::read_to_string(named(&folder, "a.xml"))
            .unwrap()
            .contains("elevationUnit=\"feet\"")
    );
    let notes = compound("6360");
    assert_eq!(
        notes,
        ["heights are in US survey foot: only the attribute ogcWktCode states it"]
    );
}
