//! 3MF: triangles with shared vertices, all digits, the unit, and a material for each group.
//!
//! Faces are cut into triangles, since 3MF knows nothing else. Groups are base materials, each with a
//! colour of its own, so that slicers show them and the reader finds them again. A closed mesh is an
//! object of the type `model`, an open one of the type `surface`.
//!
//! Source: the 3MF core specification 1.3 of the 3MF Consortium.

use std::fmt::Write as _;
use std::io::{Cursor, Write as _};

use zip::result::ZipResult;
use zip::write::SimpleFileOptions;
use zip::{DateTime, ZipWriter};

use super::plates::COLOURS;
use super::polygons::Polygons;
use super::{WriteOptions, one_line};
use crate::io::error::IoError;
use crate::io::number::{hex, xml};
use crate::mesh::Mesh;

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"#;
const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Id="rel0" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;
/// What faces without a group are made of.
const NO_GROUP: &str = "default";
const GREY: [u8; 3] = [205, 205, 205];

pub(super) fn write(mesh: &Mesh, options: &WriteOptions) -> Result<Vec<u8>, IoError> {
    packed(&model(mesh, options)).map_err(|fault| IoError::Packing { fault: fault.to_string() })
}

fn packed(model: &str) -> ZipResult<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    // The same day for every file, so that the same mesh gives the same bytes.
    let options = SimpleFileOptions::default()
        .last_modified_time(DateTime::default())
        .large_file(model.len() >= u32::MAX as usize);
    for (name, text) in [
        ("[Content_Types].xml", CONTENT_TYPES),
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/3dmodel.model", model),
    ] {
        zip.start_file(name, options)?;
        zip.write_all(text.as_bytes())?;
    }
    Ok(zip.finish()?.into_inner())
}

/// The part with the model.
fn model(mesh: &Mesh, options: &WriteOptions) -> String {
    let polygons = Polygons::of(mesh);
    let mut text = String::with_capacity(80 * (polygons.positions.len() + polygons.face_count()));
    write_model(&mut text, mesh, &polygons, options).expect("writing into a string cannot fail");
    text
}

fn write_model(
    text: &mut String,
    mesh: &Mesh,
    polygons: &Polygons,
    options: &WriteOptions,
) -> std::fmt::Result {
    let names = group_names(mesh, polygons);
    let kind = if mesh.is_closed() { "model" } else { "surface" };
    writeln!(text, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(
        text,
        r#"<model unit="millimeter" xml:lang="en" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">"#
    )?;
    writeln!(text, r#"<metadata name="Application">kerfold</metadata>"#)?;
    if let Some(command) = options.comment() {
        writeln!(text, r#"<metadata name="Description">{}</metadata>"#, xml(&command))?;
    }
    writeln!(text, "<resources>")?;
    let has_groups = names != [None];
    let material = if has_groups { r#" pid="1" pindex="0""# } else { "" };
    if has_groups {
        write_materials(text, &names)?;
    }
    writeln!(text, r#"<object id="2" type="{kind}"{material}><mesh><vertices>"#)?;
    for p in &polygons.positions {
        writeln!(text, r#"<vertex x="{}" y="{}" z="{}"/>"#, p.x, p.y, p.z)?;
    }
    writeln!(text, "</vertices><triangles>")?;
    for (f, corners) in polygons.faces() {
        let group = names.iter().position(|name| name.as_deref() == mesh.group(f)).unwrap_or(0);
        let material = match group {
            0 => String::new(),
            _ => format!(r#" pid="1" p1="{group}""#),
        };
        for triangle in polygons.triangles(mesh, f, corners) {
            let [a, b, c] = triangle.map(|i| corners[i]);
            writeln!(text, r#"<triangle v1="{a}" v2="{b}" v3="{c}"{material}/>"#)?;
        }
    }
    writeln!(text, "</triangles></mesh></object></resources>")?;
    writeln!(text, r#"<build><item objectid="2"/></build></model>"#)
}

fn write_materials(text: &mut String, names: &[Option<String>]) -> std::fmt::Result {
    writeln!(text, r#"<basematerials id="1">"#)?;
    for (i, name) in names.iter().enumerate() {
        let colour = if name.is_some() { COLOURS[i % COLOURS.len()] } else { GREY };
        let name = xml(&one_line(name.as_deref().unwrap_or(NO_GROUP)));
        writeln!(text, r#"<base name="{name}" displaycolor="{}"/>"#, hex(colour))?;
    }
    writeln!(text, "</basematerials>")
}

/// The groups in the order in which they come.
fn group_names(mesh: &Mesh, polygons: &Polygons) -> Vec<Option<String>> {
    let mut names: Vec<Option<String>> = Vec::new();
    for (f, _) in polygons.faces() {
        let group = mesh.group(f);
        if !names.iter().any(|name| name.as_deref() == group) {
            names.push(group.map(str::to_owned));
        }
    }
    names
}
