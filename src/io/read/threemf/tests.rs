use std::io::{Cursor, Write as _};
use std::path::Path;

use glam::DVec3;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::*;
use crate::io::{MeshUnit, ReadMesh, ReadOptions, read_mesh_bytes};

fn packed(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts {
        zip.start_file(*name, SimpleFileOptions::default()).expect("a part");
        zip.write_all(text.as_bytes()).expect("written");
    }
    zip.finish().expect("a zip").into_inner()
}

fn model(attributes: &str, inside: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><model {attributes} \
        xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
        xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\">{inside}</model>"
    )
}

const TETRA: &str = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>\
    <vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"0.1\"/></vertices><triangles>\
    <triangle v1=\"0\" v2=\"2\" v3=\"1\" p1=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>\
    <triangle v1=\"1\" v2=\"2\" v3=\"3\" pid=\"9\" p1=\"0\"/><triangle v1=\"0\" v2=\"3\" v3=\"2\"/>\
    </triangles></mesh>";

fn taken(bytes: &[u8]) -> Result<ReadMesh, String> {
    let read = read_mesh_bytes(Path::new("x.3mf"), bytes, &ReadOptions::default());
    read.map_err(|error| error.to_string())
}

fn one(attributes: &str, inside: &str) -> Result<ReadMesh, String> {
    taken(&packed(&[("3D/3dmodel.model", &model(attributes, inside))]))
}

fn groups(read: &ReadMesh) -> Vec<&str> {
    read.mesh.faces().map(|f| read.mesh.group(f).unwrap_or("-")).collect()
}

#[test]
fn units_places_and_materials_are_read() {
    let inside = format!(
        "<resources><basematerials id=\"9\"><base name=\"red\"/><base name=\"blue\"/></basematerials>\
        <object id=\"1\" name=\"lid\" pid=\"9\" pindex=\"0\">{TETRA}</object>\
        <object id=\"2\" type=\"support\">{TETRA}</object>\
        <object id=\"3\" name=\"all\"><components>\
        <component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 -1 0 0\"/></components></object></resources>\
        <build><item objectid=\"1\"/><item objectid=\"3\"/><item objectid=\"2\"/></build>"
    );
    let read = one("unit=\"inch\"", &inside).expect("two solids");
    assert_eq!((read.scale, read.mesh.face_count(), read.mesh.vertex_count()), (25.4, 8, 8));
    assert_eq!(read.mesh.position(crate::mesh::VertexId::new(3)), DVec3::Z * 0.1 * 25.4);
    assert_eq!(groups(&read)[..4], ["blue", "red", "red", "red"]);
    // The mirror image is no hole.
    let volume = crate::measure::volume(&read.mesh);
    let wanted = 2.0 * 0.1 / 6.0 * 25.4_f64.powi(3);
    assert!((volume - wanted).abs() < 1e-9 * wanted, "{volume} and {wanted}");
    let (low, high) = read.mesh.bounds().expect("points");
    assert!((low.x + 2.0 * 25.4).abs() < 1e-9 && (high.x - 25.4).abs() < 1e-9, "{low} {high}");
    assert!(read.notes.contains(&ReadNote::LeftOut { count: 1, what: SUPPORTS }));
    let bytes = packed(&[("3D/3dmodel.model", &model("unit=\"inch\"", &inside))]);
    let metres = ReadOptions { units: MeshUnit::M, ..ReadOptions::default() };
    let read = read_mesh_bytes(Path::new("no ending"), &bytes, &metres).expect("two solids");
    assert!(read.scale == 25.4 && read.notes.contains(&ReadNote::OwnUnit { unit: "in" }));
}

#[test]
fn parts_in_other_files_are_followed() {
    let root = model(
        "requiredextensions=\"p\"",
        "<resources><object id=\"7\" name=\"both\"><components>\
        <component p:path=\"/3D/Objects/a.model\" objectid=\"1\"/>\
        <component p:path=\"/3D/Objects/a.model\" objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/>\
        </components></object></resources><build><item objectid=\"7\"/></build>",
    );
    let part = model("", &format!("<resources><object id=\"1\">{TETRA}</object></resources>"));
    let links = "<Relationships><Relationship Target=\"/3D/other.model\" \
        Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    let bytes =
        packed(&[("_rels/.rels", links), ("3D/other.model", &root), ("3D/Objects/a.model", &part)]);
    let read = taken(&bytes).expect("two solids");
    assert_eq!((read.mesh.face_count(), read.scale), (8, 1.0));
    assert!(groups(&read).iter().all(|name| *name == "both"));
    let lost = packed(&[("_rels/.rels", links), ("3D/other.model", &root)]);
    let error = taken(&lost).expect_err("a part is missing");
    assert!(error.contains("3D/Objects/a.model cannot be opened"), "{error}");
}

#[test]
fn damaged_files_are_told_what_is_wrong() {
    let object = |mesh: &str| {
        format!(
            "<resources><object id=\"1\">{mesh}</object></resources><build><item objectid=\"1\"/></build>"
        )
    };
    let good = object(TETRA);
    assert!(one("", &good).is_ok());
    for (attributes, inside, told) in [
        ("unit=\"ell\"", good.clone(), "unit `ell`"),
        ("", good.replace("x=\"1\"", "x=\"one\""), "vertex 1 of object 1 has no number x"),
        ("", good.replace("v3=\"1\"", "v3=\"4\""), "triangle 0 of object 1 names vertex `4` of 4"),
        ("", good.replace("objectid=\"1\"", "objectid=\"2\""), "object 2 of 3D/3dmodel.model"),
        ("", good.replace("</object>", ""), "no XML"),
        ("", good.replace("objectid=\"1\"", "objectid=\"1\" transform=\"1 2\""), "not 12 numbers"),
        ("requiredextensions=\"zz\"", good.clone(), "extension `zz`"),
    ] {
        let error = one(attributes, &inside).expect_err(told);
        assert!(error.contains(told), "{error}");
    }
    let whole = packed(&[("3D/3dmodel.model", &model("", &good))]);
    for cut in 4..whole.len() {
        assert!(read(&whole[..cut]).is_err(), "{cut}");
    }
}

#[test]
fn bombs_are_bounded() {
    // Each object is the one before it twice.
    let mut objects = format!("<object id=\"0\">{TETRA}</object>");
    for id in 1..32 {
        let before = id - 1;
        let twice = format!("<component objectid=\"{before}\"/>").repeat(2);
        objects += &format!("<object id=\"{id}\"><components>{twice}</components></object>");
    }
    let build = "<build><item objectid=\"31\"/></build>";
    let text = model("", &format!("<resources>{objects}</resources>{build}"));
    let error = read(&packed(&[("3D/3dmodel.model", &text)])).expect_err("a bomb");
    assert_eq!(error.fault, ContentFault::TooMuchMesh { most: MOST });
    let ring = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    let text =
        model("", &format!("<resources>{ring}</resources><build><item objectid=\"1\"/></build>"));
    let error = read(&packed(&[("3D/3dmodel.model", &text)])).expect_err("a ring");
    assert!(error.fault.to_string().contains("too deep"), "{}", error.fault);
    let blank = " ".repeat(130 << 20);
    let error = read(&packed(&[("3D/3dmodel.model", &blank)])).expect_err("a bomb");
    assert_eq!(error.fault, ContentFault::TooMuchUnpacked { most: 128 });
}
