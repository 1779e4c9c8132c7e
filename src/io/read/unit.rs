//! The unit that a mesh file says its numbers have: formats have no place for it, so programs say it
//! in a comment (`# units: mm`, `# File units = meters`).

use super::raw::RawMesh;
use super::{MeshUnit, ReadNote, ReadOptions, stl};
use crate::io::format::MeshFormat;

/// Comments at the top are looked through as far as this many bytes.
const TOP: usize = 16 << 10;
/// As long as the head of a binary STL file.
const STL_HEAD: usize = 80;

/// What to say when the file names another unit than the options do.
pub(super) fn note(
    format: Option<MeshFormat>,
    bytes: &[u8],
    text: &[u8],
    raw: &RawMesh,
    options: &ReadOptions,
) -> Option<ReadNote> {
    if options.size.is_some() {
        return None;
    }
    if let Some(unit) = raw.own_unit {
        let is_asked = options.units != MeshUnit::default() && options.units.name() != unit.name;
        return is_asked.then_some(ReadNote::OwnUnit { unit: unit.name });
    }
    let is_binary = format == Some(MeshFormat::Stl) && stl::is_binary(bytes);
    let stated = stated_unit(if is_binary { bytes } else { text }, is_binary);
    let other = stated.filter(|&unit| unit != options.units);
    other.map(|stated| ReadNote::OtherUnit { stated, taken: options.units })
}

/// What the comments at the top of a file say; `None` when they say nothing that is understood.
fn stated_unit(bytes: &[u8], is_binary_stl: bool) -> Option<MeshUnit> {
    if is_binary_stl {
        return unit_in(&String::from_utf8_lossy(&bytes[..bytes.len().min(STL_HEAD)]));
    }
    let top = String::from_utf8_lossy(&bytes[..bytes.len().min(TOP)]);
    let comment = |line: &str| -> Option<String> {
        let line = line.trim_start();
        let begins = ["#", "comment ", "obj_info ", "solid "];
        begins.iter().find_map(|begin| line.strip_prefix(begin)).map(str::to_owned)
    };
    // The command line in our own files has flags in it, and says nothing about the file itself.
    let is_command = |line: &String| line.trim_start().starts_with("kerfold ");
    top.lines().filter_map(comment).filter(|line| !is_command(line)).find_map(|line| unit_in(&line))
}

fn unit_in(line: &str) -> Option<MeshUnit> {
    let lower = line.to_ascii_lowercase();
    let mut words = lower.split(|c: char| !c.is_ascii_alphanumeric()).filter(|w| !w.is_empty());
    words.find(|word| matches!(*word, "unit" | "units"))?;
    let word = words.find(|word| !matches!(*word, "is" | "are"))?;
    match word {
        "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => Some(MeshUnit::Mm),
        "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => Some(MeshUnit::Cm),
        "m" | "meter" | "meters" | "metre" | "metres" => Some(MeshUnit::M),
        "in" | "inch" | "inches" => Some(MeshUnit::In),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_as_programs_write_them() {
        for (text, unit) in [
            ("# kerfold solid cube --units m\n# units: mm\nv 0 0 0\n", Some(MeshUnit::Mm)),
            ("# 3ds Max Wavefront OBJ Exporter\n# File units = meters\n", Some(MeshUnit::M)),
            ("ply\nformat ascii 1.0\ncomment Units are inches\n", Some(MeshUnit::In)),
            ("solid part units=cm\n", Some(MeshUnit::Cm)),
            ("# kerfold info x.obj --units m\nv 0 0 0\n", None),
            ("# a unit cube\nv 0 0 0\n", None),
            ("o units\nv 1 2 3\n", None),
        ] {
            assert_eq!(stated_unit(text.as_bytes(), false), unit, "{text}");
        }
        assert_eq!(stated_unit(b"binary STL, units: mm: kerfold", true), Some(MeshUnit::Mm));
    }
}
