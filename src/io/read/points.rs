//! Points in order from a file of their own: `x,y,z` in each line, or the `l` lines of an OBJ file.

use std::path::Path;

use glam::DVec3;

use super::decode::as_utf8;
use super::text::{Lines, number, words};
use crate::io::error::{ContentFault, IoError, Place, excerpt};

/// Reads the points of a polyline, in mm.
///
/// A file whose name ends in `.obj` is read as OBJ: its `l` lines, one after the other, tell which
/// of its `v` points come in which order, counted from 1 (from the last back when negative);
/// without `l` lines all of its points in order. Any other file has one point in a line, three
/// numbers with commas or spaces between. `#` begins a comment.
///
/// # Errors
/// [`IoError`] when the file cannot be read, a line is no point, or there is none; with the line.
///
/// # Example
/// ```
/// let path = std::env::temp_dir().join(format!("kerfold-doc-{}-axis.txt", std::process::id()));
/// std::fs::write(&path, "0,0,0  # x,y,z in mm\n0,0,5\n3,0,9\n")?;
/// let points = kerfold::io::read_points(&path)?;
/// # std::fs::remove_file(&path)?;
/// assert_eq!(points[2], glam::DVec3::new(3.0, 0.0, 9.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_points(path: &Path) -> Result<Vec<DVec3>, IoError> {
    Ok(read_curves(path)?.concat())
}

/// Reads polylines from a file; see [`read_curves_bytes`].
///
/// # Errors
/// As [`read_points`].
pub fn read_curves(path: &Path) -> Result<Vec<Vec<DVec3>>, IoError> {
    let bytes = std::fs::read(path).map_err(|source| IoError::reading(path, source))?;
    read_curves_bytes(path, &bytes)
}

/// Reads the points of a polyline from the content of a file; `path` shows the format and is named
/// in messages.
///
/// # Errors
/// As [`read_points`].
///
/// # Example
/// ```
/// use std::path::Path;
///
/// let text = b"0,0,0  # x,y,z in mm\n0,0,5\n";
/// let points = kerfold::io::read_points_bytes(Path::new("axis.txt"), text)?;
/// assert_eq!(points[1], glam::DVec3::new(0.0, 0.0, 5.0));
/// # Ok::<(), kerfold::io::IoError>(())
/// ```
pub fn read_points_bytes(path: &Path, bytes: &[u8]) -> Result<Vec<DVec3>, IoError> {
    Ok(read_curves_bytes(path, bytes)?.concat())
}

/// Reads polylines, as [`read_points`] does but each `l` line of an OBJ file by itself. In other
/// files, and in OBJ files without `l` lines, all points are one.
///
/// # Errors
/// As [`read_points`].
///
/// # Example
/// ```
/// use std::path::Path;
///
/// let text = b"v 0 0 0\nv 0 0 5\nv 3 0 9\nl 1 2\nl 2 3\n";
/// let curves = kerfold::io::read_curves_bytes(Path::new("rows.obj"), text)?;
/// assert_eq!((curves.len(), curves[1][1].z), (2, 9.0));
/// # Ok::<(), kerfold::io::IoError>(())
/// ```
pub fn read_curves_bytes(path: &Path, bytes: &[u8]) -> Result<Vec<Vec<DVec3>>, IoError> {
    let is_obj = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("obj"));
    let (mut points, mut orders): (Vec<DVec3>, Vec<Vec<usize>>) = (Vec::new(), Vec::new());
    let text = as_utf8(bytes);
    let mut lines = Lines::new(&text);
    while let Some((line, text)) = lines.next_content() {
        let at = |fault| IoError::Content {
            place: Place { path: path.to_owned(), line: Some(line) },
            fault,
        };
        let mut rest = words(text);
        match (is_obj, is_obj.then(|| rest.next()).flatten()) {
            (false, _) => points.push(point(text).ok_or_else(|| at(fault(text)))?),
            (true, Some(b"v")) => points.push(point(&text[1..]).ok_or_else(|| at(fault(text)))?),
            (true, Some(b"l")) => {
                orders.push(Vec::new());
                for word in rest {
                    let count = points.len();
                    let missing =
                        |index| ContentFault::NoSuchVertex { text: excerpt(text), index, count };
                    let found = index(word, count).map_err(|index| at(missing(index)))?;
                    orders.last_mut().into_iter().for_each(|order| order.push(found));
                }
            }
            (true, _) => {}
        }
    }
    orders.retain(|order| !order.is_empty());
    let curve = |order: Vec<usize>| order.into_iter().map(|i| points[i]).collect();
    let curves: Vec<Vec<DVec3>> =
        if orders.is_empty() { vec![points] } else { orders.into_iter().map(curve).collect() };
    if curves[0].is_empty() { Err(IoError::Empty { path: path.to_owned() }) } else { Ok(curves) }
}

fn fault(text: &[u8]) -> ContentFault {
    ContentFault::NotAVertex { text: excerpt(text), example: "0,0,25" }
}

/// Three finite numbers, and nothing else.
fn point(text: &[u8]) -> Option<DVec3> {
    let spaced: Vec<u8> = text.iter().map(|&b| if b == b',' { b' ' } else { b }).collect();
    let numbers: Vec<f64> = words(&spaced).map(number).collect::<Option<_>>()?;
    match numbers[..] {
        [x, y, z] => Some(DVec3::new(x, y, z)).filter(|p| p.is_finite()),
        _ => None,
    }
}

/// The place of a point that an `l` line names, from 0; or the number that names none, 0 for a word
/// that is no number.
fn index(word: &[u8], count: usize) -> Result<usize, i64> {
    let word = word.split(|&b| b == b'/').next().unwrap_or(word);
    let index: i64 = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok()).unwrap_or(0);
    let from_0 = if index < 0 { index + count as i64 } else { index - 1 };
    usize::try_from(from_0).ok().filter(|&i| i < count).ok_or(index)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, text: &str) -> Result<Vec<DVec3>, IoError> {
        let path =
            std::env::temp_dir().join(format!("kerfold-points-{}-{name}", std::process::id()));
        std::fs::write(&path, text).expect("a file");
        let points = read_points(&path);
        std::fs::remove_file(&path).expect("the file");
        points
    }

    #[test]
    fn points_stand_in_lines_or_in_an_obj_file() {
        let wanted = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.5, 6e1)];
        assert_eq!(
            read("a.txt", "# axis\n1,2,3\n\n -4 0.5,6e1 # end\n").expect("two points"),
            wanted
        );
        assert_eq!(
            read("b.obj", "v -4 0.5 60\nv 9 9 9\nv 1 2 3\nl 3 1\n").expect("two points"),
            wanted
        );
        assert_eq!(read("c.obj", "v 1 2 3\nv -4 0.5 60\n").expect("two points"), wanted);
    }

    #[test]
    fn what_is_no_point_is_told_with_its_line() {
        for (name, text) in
            [("d.txt", "1,2,3\n1,2\n"), ("e.txt", "0 0 0\n1 2 nan"), ("f.obj", "v 1 2 3\nl 1 2\n")]
        {
            let error = read(name, text).expect_err("no point").to_string();
            assert!(error.contains(":2: "), "{error}");
        }
        assert!(matches!(read("g.txt", "# nothing\n"), Err(IoError::Empty { .. })));
        assert!(matches!(
            read_points(Path::new("there-is-no-such.txt")),
            Err(IoError::Missing { .. })
        ));
    }
}
