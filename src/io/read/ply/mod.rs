//! Stanford PLY: polygons as text or binary in either byte order. Properties and elements that a
//! mesh does not need are skipped.

use glam::DVec3;

use super::ReadNote;
use super::raw::RawMesh;
use super::text::words;
use crate::io::error::{ContentFault, Located, excerpt};

mod header;
mod values;

use header::{Element, Encoding, Header, Property};
use values::{Binary, Text, Values};

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
    let (header, body_line, body) = header::read(bytes)?;
    let mut raw = match header.encoding {
        Encoding::Text => text(&header, body, body_line),
        Encoding::BinaryLittleEndian => elements(&header, Binary::new(body, false)),
        Encoding::BinaryBigEndian => elements(&header, Binary::new(body, true)),
    }?;
    let passed_over = header.passed_over;
    raw.notes
        .extend(passed_over.map(|(count, first_line)| ReadNote::PassedOver { count, first_line }));
    Ok(raw)
}

/// Elements in lines of their own where there are as many lines as elements; each line then has at
/// least the numbers that the header says. Else numbers in any lines, as long as they come out to
/// the last.
fn text(header: &Header, body: &[u8], body_line: usize) -> Result<RawMesh, Located> {
    let is_left_over = |raw: &RawMesh| raw.notes.iter().any(|n| matches!(n, ReadNote::Rest { .. }));
    let has_values = |element: &&Element| !element.properties.is_empty();
    let count = header.elements.iter().filter(has_values).map(|e| e.count);
    if count.fold(0, u64::saturating_add) == lines_with_text(body) {
        return elements(header, Text::by_lines(body, body_line));
    }
    let in_a_row = elements(header, Text::new(body, body_line));
    if in_a_row.as_ref().is_ok_and(|raw| !is_left_over(raw)) {
        return in_a_row;
    }
    match elements(header, Text::by_lines(body, body_line)) {
        Ok(by_lines) if in_a_row.is_err() || !is_left_over(&by_lines) => Ok(by_lines),
        _ => in_a_row,
    }
}

fn lines_with_text(body: &[u8]) -> u64 {
    let lines = body.split(|&b| b == b'\n' || b == b'\r');
    lines.filter(|line| !line.trim_ascii().is_empty()).count() as u64
}

fn elements(header: &Header, mut values: impl Values) -> Result<RawMesh, Located> {
    let mut raw = RawMesh::default();
    for element in &header.elements {
        check_count(element, &values)?;
        match element.name.as_str() {
            "vertex" => vertices(element, &mut values, &mut raw)?,
            "face" => faces(element, &mut values, &mut raw)?,
            _ if element.is_strips() => strips(element, &mut values, &mut raw)?,
            // Elements without properties have nothing to skip.
            _ if element.properties.is_empty() => {}
            _ => {
                for index in 0..element.count as usize {
                    for property in &element.properties {
                        skip(element, index, property, &mut values)?;
                    }
                    values.end_element();
                }
            }
        }
    }
    raw.notes.extend(values.notes());
    Ok(raw)
}

/// Before anything is reserved: whether the rest of the file can hold so many elements at all.
fn check_count(element: &Element, values: &impl Values) -> Result<(), Located> {
    let least =
        element.properties.iter().map(|p| values.least_bytes(p)).sum::<usize>().max(1) as u64;
    let bytes = values.remaining();
    if element.count <= bytes as u64 / least
        || (element.properties.is_empty() && !element.is_needed())
    {
        return Ok(());
    }
    let fault =
        ContentFault::CountTooLarge { element: element.name.clone(), count: element.count, bytes };
    Err(Located::anywhere(fault))
}

fn vertices(element: &Element, values: &mut impl Values, raw: &mut RawMesh) -> Result<(), Located> {
    let mut axes = Vec::with_capacity(element.properties.len());
    for property in &element.properties {
        let is_number = property.list_count.is_none();
        axes.push(["x", "y", "z"].iter().position(|&axis| is_number && property.name == axis));
    }
    for (axis, property) in ["x", "y", "z"].into_iter().enumerate() {
        if !axes.contains(&Some(axis)) {
            return Err(Located::anywhere(ContentFault::NoProperty {
                element: "vertex",
                property,
            }));
        }
    }
    raw.positions.reserve(element.count as usize);
    for index in 0..element.count as usize {
        let mut position = DVec3::ZERO;
        for (property, axis) in element.properties.iter().zip(&axes) {
            match axis {
                Some(axis) => {
                    position[*axis] =
                        values.next(property.item).map_err(|e| e.within(element, index))?
                }
                None => skip(element, index, property, values)?,
            }
        }
        raw.positions.push(position);
        raw.vertex_lines.extend(values.line().map(|line| line as u32));
        values.end_element();
    }
    Ok(())
}

fn faces(element: &Element, values: &mut impl Values, raw: &mut RawMesh) -> Result<(), Located> {
    if element.count > 0 && !element.properties.iter().any(is_corners) {
        let property = "vertex_indices";
        return Err(Located::anywhere(ContentFault::NoProperty { element: "face", property }));
    }
    for index in 0..element.count as usize {
        for property in &element.properties {
            if is_corners(property) {
                for _ in 0..list_length(element, index, property, values)? {
                    raw.corners.push(vertex_number(element, index, property, values)?);
                }
                raw.ends.push(raw.corners.len());
            } else {
                skip(element, index, property, values)?;
            }
        }
        raw.face_lines.extend(values.line().map(|line| line as u32));
        values.end_element();
    }
    Ok(())
}

/// Strips of triangles: each vertex makes a triangle with the two before it, every second one
/// turned round; −1 begins a new strip.
fn strips(element: &Element, values: &mut impl Values, raw: &mut RawMesh) -> Result<(), Located> {
    for index in 0..element.count as usize {
        for property in &element.properties {
            if !is_corners(property) {
                skip(element, index, property, values)?;
                continue;
            }
            let mut strip: Vec<u32> = Vec::new();
            for _ in 0..list_length(element, index, property, values)? {
                let value = values.next(property.item).map_err(|e| e.within(element, index))?;
                if value == -1.0 {
                    strip.clear();
                    continue;
                }
                strip.push(checked_vertex(element, index, value, values.line())?);
                let [.., a, b, c] = strip[..] else { continue };
                // A vertex that comes twice only leads the strip to another place.
                if a == b || b == c || c == a {
                    continue;
                }
                raw.push_face(if strip.len() % 2 == 1 { [a, b, c] } else { [b, a, c] });
                raw.face_lines.extend(values.line().map(|line| line as u32));
            }
        }
        values.end_element();
    }
    Ok(())
}

fn is_corners(property: &Property) -> bool {
    property.list_count.is_some() && ["vertex_indices", "vertex_index"].contains(&&*property.name)
}

/// Vertex numbers beyond the vertices are left for the builder to tell.
fn vertex_number(
    element: &Element,
    index: usize,
    property: &Property,
    values: &mut impl Values,
) -> Result<u32, Located> {
    let value = values.next(property.item).map_err(|e| e.within(element, index))?;
    checked_vertex(element, index, value, values.line())
}

fn checked_vertex(
    element: &Element,
    index: usize,
    value: f64,
    line: Option<usize>,
) -> Result<u32, Located> {
    let is_number = value >= 0.0 && value < f64::from(u32::MAX) && value.fract() == 0.0;
    let wanted = "the number of a vertex, counted from 0";
    if is_number { Ok(value as u32) } else { Err(bad_value(element, index, value, wanted, line)) }
}

/// The number of items in a list, which the rest of the file must be able to hold.
fn list_length(
    element: &Element,
    index: usize,
    property: &Property,
    values: &mut impl Values,
) -> Result<usize, Located> {
    let Some(count) = property.list_count else { return Ok(1) };
    let length = values.next(count).map_err(|e| e.within(element, index))?;
    if length < 0.0 || length.fract() != 0.0 || length.is_nan() {
        return Err(bad_value(element, index, length, "the length of a list", values.line()));
    }
    let most = values.remaining() / values.least_item_bytes(property.item);
    if length > most as f64 {
        return Err(values::Missing::End.within(element, index));
    }
    Ok(length as usize)
}

fn bad_value(
    element: &Element,
    index: usize,
    value: f64,
    wanted: &'static str,
    line: Option<usize>,
) -> Located {
    let fault = ContentFault::BadValue {
        text: value.to_string(),
        element: element.name.clone(),
        index,
        wanted,
    };
    Located { line, fault }
}

fn skip(
    element: &Element,
    index: usize,
    property: &Property,
    values: &mut impl Values,
) -> Result<(), Located> {
    let length = list_length(element, index, property, values)?;
    (0..length).try_for_each(|_| {
        values.next(property.item).map(drop).map_err(|e| e.within(element, index))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "element vertex 3\nproperty double x\nproperty uchar red\nproperty float \
    y\nproperty int16 z\n\
        element extra 1\nproperty list uint short many\nproperty char one\n\
        element face 1\nproperty float weight\nproperty list int32 uint vertex_index\nend_header\n";

    fn text() -> String {
        format!(
            "ply\nformat ascii 1.0\ncomment x\n{HEADER}0.1 7 0 0\n1 7 0 -2\n0\n7 1 0\n2 5 6 \
            -1\n0.5 3 0 1 2\n"
        )
    }

    fn binary(is_big: bool) -> Vec<u8> {
        let order = if is_big { "big" } else { "little" };
        let mut bytes =
            format!("ply\nformat binary_{order}_endian 1.0\nobj_info x\n{HEADER}").into_bytes();
        let mut put = |value: &[u8]| {
            if is_big { bytes.extend(value.iter().rev()) } else { bytes.extend(value) }
        };
        for (x, y, z) in [(0.1_f64, 0.0_f32, 0_i16), (1., 0., -2), (0., 1., 0)] {
            put(&x.to_le_bytes());
            put(&[7]);
            put(&y.to_le_bytes());
            put(&z.to_le_bytes());
        }
        put(&2_u32.to_le_bytes());
        [5_i16, 6].iter().for_each(|v| put(&v.to_le_bytes()));
        put(&[0xff]);
        put(&0.5_f32.to_le_bytes());
        put(&3_i32.to_le_bytes());
        [0_u32, 1, 2].iter().for_each(|v| put(&v.to_le_bytes()));
        bytes
    }

    #[test]
    fn all_three_encodings_say_the_same() {
        let expected = [DVec3::new(0.1, 0., 0.), DVec3::new(1., 0., -2.), DVec3::Y];
        let windows = text().replace('\n', "\r\n");
        for bytes in [text().into_bytes(), windows.into_bytes(), binary(false), binary(true)] {
            let raw = read(&bytes).expect("a PLY");
            assert_eq!(raw.positions, expected);
            assert_eq!((raw.face(0), raw.ends.len()), (&[0, 1, 2][..], 1));
        }
        let raw = read(text().as_bytes()).expect("a PLY");
        assert_eq!((raw.vertex_lines, raw.face_lines), (vec![16, 17, 19], vec![21]));
    }

    const CORNERS: &str =
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    const POINTS: &str = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

    #[test]
    fn strips_make_triangles_that_run_one_way() {
        let text = format!(
            "ply\nformat ascii 1.0\n{CORNERS}element tristrips 1\nproperty list int int \
            vertex_indices\nend_header\n{POINTS}11 0 2 1 3 -1 0 3 2 2 -1 1\n"
        );
        let raw = read(text.as_bytes()).expect("a PLY");
        assert_eq!(raw.corners, [0, 2, 1, 1, 2, 3, 0, 3, 2]);
        let low = text.replace("-1 1\n", "-2 1\n");
        assert!(matches!(read(low.as_bytes()), Err(Located { line: Some(_), .. })));
    }

    #[test]
    fn columns_and_header_lines_too_many_are_noted() {
        let faces = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
        let text = format!("ply\nformat ascii 1.0\nMade by hand\n{CORNERS}{faces}{POINTS}");
        let raw = read(format!("{text}3 0 1 2 255\n3 1 2 3 9 9\n").as_bytes()).expect("a PLY");
        assert_eq!(raw.corners, [0, 1, 2, 1, 2, 3]);
        let extra = ReadNote::ExtraColumns { count: 2, first_line: 15 };
        let header = ReadNote::PassedOver { count: 1, first_line: 3 };
        assert_eq!(raw.notes, [extra, header]);
        // In a row, whatever the lines.
        let raw = read(format!("{text}3 0\n1 2 3 1 2\n3 \n").as_bytes()).expect("a PLY");
        assert_eq!((raw.corners, raw.notes), (vec![0, 1, 2, 1, 2, 3], vec![header]));
        // A line that is short takes nothing from the next one.
        let short = read(format!("{text}3 0 1\n3 2 1 0\n").as_bytes()).expect_err("short");
        assert_eq!(short.line, Some(15));
        // A statement that is misspelt is none of this.
        for line in ["propertee float x", "element face", "format"] {
            let bad = text.replace("Made by hand", line);
            assert!(read(bad.as_bytes()).is_err(), "{line}");
        }
        let binary = text.replace("ascii", "binary_little_endian");
        assert!(matches!(
            read(binary.as_bytes()),
            Err(Located { line: Some(3), fault: ContentFault::BadHeader { .. } })
        ));
    }

    #[test]
    fn a_file_cut_anywhere_is_refused_and_never_panics() {
        let lengths = |bytes: &[u8]| {
            (0..bytes.len()).filter(|&n| read(&bytes[..n]).is_ok()).collect::<Vec<_>>()
        };
        assert!(lengths(&binary(false)).is_empty());
        // Only the last line end can be missing from a text.
        let text = text();
        assert_eq!(lengths(text.as_bytes()), [text.len() - 1]);
    }

    #[test]
    fn huge_counts_are_refused_before_anything_is_reserved() {
        let fault = |text: &str| read(text.as_bytes()).expect_err("too many").fault;
        for format in ["ascii", "binary_little_endian"] {
            let head = format!("ply\nformat {format} 1.0\nelement vertex");
            let xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
            let huge = fault(&format!("{head} 4294967295\n{xyz}0 0 0\n"));
            assert!(matches!(
                huge,
                ContentFault::CountTooLarge { count: 4_294_967_295, bytes: 6, .. }
            ));
            let none = fault(&format!("{head} 4294967295\nend_header\n"));
            assert!(matches!(none, ContentFault::CountTooLarge { .. }));
            let longer = fault(&format!("{head} 99999999999999999999999\n{xyz}"));
            assert!(matches!(longer, ContentFault::BadHeader { .. }));
        }
        let list = text().replace("0.5 3 0 1 2", "0.5 4000000000 0 1 2");
        assert!(matches!(fault(&list), ContentFault::CutShort { .. }));
        let negative = text().replace("0.5 3 0 1 2", "0.5 -3 0 1 2");
        assert!(matches!(fault(&negative), ContentFault::BadValue { .. }));
    }

    #[test]
    fn faults_carry_their_lines() {
        let located = |from: &str, to: &str| {
            read(text().replacen(from, to, 1).as_bytes()).expect_err("a fault")
        };
        assert_eq!(located("1 7 0 -2", "1 7 zero -2").line, Some(17));
        assert_eq!(located("3 0 1 2", "3 0 -1 2").line, Some(21));
        assert_eq!(located("property double x", "property quad x").line, Some(5));
        assert_eq!(
            located("property double x", "property double u").fault.to_string(),
            "`vertex` has no property `x`; export the model again with its vertices and faces"
        );
        assert!(matches!(
            located("vertex_index", "corners").fault,
            ContentFault::NoProperty { .. }
        ));
        assert_eq!(located("ascii", "ebcdic").line, Some(2));
        assert!(matches!(located("ply", "plx").fault, ContentFault::NotThisFormat { .. }));
    }
}
