//! Seams from a file of their own: the `l` lines of an OBJ file, or one edge as `v0 v1` per line.

use std::path::Path;

use super::decode::as_utf8;
use super::text::{Lines, words};
use crate::io::error::{ContentFault, IoError, Place, excerpt};
use crate::mesh::{EdgeId, Mesh, SplitVertex, VertexId};

/// Reads the edges that a seam file names, ascending, each once.
///
/// A file whose name ends in `.obj` is read as OBJ: every `l` line is a seam along its vertices,
/// counted from 1 (from the last back when negative) in the order of the model's own file; all
/// other lines are passed over. Any other file is a list of edges, one in a line, each as the two
/// numbers of its vertices counted from 0, as `pieces.json` and reports give them. `#` begins a
/// comment. `splits` are the vertices that reading the model added.
///
/// # Errors
/// [`IoError`] when the file cannot be read, a line is no seam, or the model has no such edge; with
/// the line.
///
/// # Example
/// ```
/// let path = std::env::temp_dir().join(format!("kerfold-doc-{}-seams.txt", std::process::id()));
/// std::fs::write(&path, "0 1  # two vertices of an edge\n")?;
/// let cube = kerfold::shape::cube(10.0);
/// let seams = kerfold::io::read_seams(&path, &cube, &[]);
/// # std::fs::remove_file(&path)?;
/// assert_eq!(seams?.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_seams(
    path: &Path,
    mesh: &Mesh,
    splits: &[SplitVertex],
) -> Result<Vec<EdgeId>, IoError> {
    let bytes = std::fs::read(path).map_err(|source| IoError::reading(path, source))?;
    read_seams_bytes(path, &bytes, mesh, splits)
}

/// Reads the edges that the content of a seam file names; `path` shows the format and is named in
/// messages.
///
/// # Errors
/// As [`read_seams`].
///
/// # Example
/// ```
/// use std::path::Path;
///
/// let cube = kerfold::shape::cube(10.0);
/// let text = b"0 1  # two vertices of an edge\n";
/// let seams = kerfold::io::read_seams_bytes(Path::new("seams.txt"), text, &cube, &[])?;
/// assert_eq!(seams.len(), 1);
/// # Ok::<(), kerfold::io::IoError>(())
/// ```
pub fn read_seams_bytes(
    path: &Path,
    bytes: &[u8],
    mesh: &Mesh,
    splits: &[SplitVertex],
) -> Result<Vec<EdgeId>, IoError> {
    let is_obj = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("obj"));
    let given = mesh.vertex_slots() - splits.len();
    let mut edges = Vec::new();
    let text = as_utf8(bytes);
    let mut lines = Lines::new(&text);
    while let Some((line, text)) = lines.next_content() {
        let place = || Place { path: path.to_owned(), line: Some(line) };
        let chain = if is_obj { obj_chain(text, given) } else { edge(text).map(Some) };
        let chain = chain.map_err(|fault| IoError::Content { place: place(), fault })?;
        for ends in chain.iter().flat_map(|chain| chain.windows(2)) {
            let [a, b] = [ends[0], ends[1]];
            let missing = || match is_obj {
                true => IoError::SeamOffEdges { place: place(), a, b },
                false => IoError::NoSuchEdge { place: place(), a, b },
            };
            edges.push(edge_between(mesh, splits, a, b).ok_or_else(missing)?);
        }
    }
    if edges.is_empty() {
        return Err(IoError::NoSeams { path: path.to_owned() });
    }
    edges.sort_unstable();
    edges.dedup();
    Ok(edges)
}

/// The vertices of an `l` line, counted from 0; `None` for any other line.
fn obj_chain(text: &[u8], count: usize) -> Result<Option<Vec<usize>>, ContentFault> {
    let mut words = words(text);
    if words.next() != Some(b"l") {
        return Ok(None);
    }
    let not_a_seam = || ContentFault::NotASeam { text: excerpt(text) };
    let vertex = |word: &[u8]| {
        let word = word.split(|&b| b == b'/').next().unwrap_or(word);
        let index: i64 =
            std::str::from_utf8(word).ok().and_then(|w| w.parse().ok()).ok_or_else(not_a_seam)?;
        let from_0 = if index < 0 { index + count as i64 } else { index - 1 };
        let inside = usize::try_from(from_0).ok().filter(|&v| v < count);
        inside.ok_or_else(|| ContentFault::NoSuchVertex { text: excerpt(text), index, count })
    };
    let chain = words.map(vertex).collect::<Result<Vec<_>, _>>()?;
    if chain.len() < 2 { Err(not_a_seam()) } else { Ok(Some(chain)) }
}

/// The two vertices of a line of an edge list.
fn edge(text: &[u8]) -> Result<Vec<usize>, ContentFault> {
    let numbers: Option<Vec<usize>> =
        words(text).map(|w| std::str::from_utf8(w).ok()?.parse().ok()).collect();
    numbers.filter(|n| n.len() == 2).ok_or_else(|| ContentFault::NotAnEdge { text: excerpt(text) })
}

/// The edge between two vertices of the file, which may have been split.
fn edge_between(mesh: &Mesh, splits: &[SplitVertex], a: usize, b: usize) -> Option<EdgeId> {
    let all = |given: usize| {
        let added = splits.iter().filter(move |s| s.given.index() == given).map(|s| s.added);
        let own = (given < mesh.vertex_slots()).then(|| VertexId::new(given));
        own.into_iter().chain(added).filter(|&v| mesh.has_vertex(v))
    };
    all(a).flat_map(|v| all(b).map(move |w| (v, w))).find_map(|(v, w)| mesh.edge_between(v, w))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{SolidParams, solid};

    fn read(name: &str, text: &str) -> Result<Vec<EdgeId>, String> {
        let mesh =
            solid(&SolidParams { name: "cube".parse().expect("a name"), ..SolidParams::default() })
                .expect("a cube");
        let path = std::env::temp_dir().join(format!("kerfold-{}-{name}", std::process::id()));
        std::fs::write(&path, text).expect("a file");
        let edges = read_seams(&path, &mesh, &[]).map_err(|e| e.to_string());
        std::fs::remove_file(&path).expect("the file is there");
        edges
    }

    #[test]
    fn lists_and_lines_name_the_same_edges() {
        let mesh =
            solid(&SolidParams { name: "cube".parse().expect("a name"), ..SolidParams::default() })
                .expect("a cube");
        let pairs: Vec<[usize; 2]> =
            mesh.edges().take(3).map(|e| mesh.edge_vertices(e).map(|v| v.index())).collect();
        let list: String = pairs.iter().map(|[a, b]| format!("{a} {b} # a seam\n")).collect();
        let lines: String = pairs.iter().map(|[a, b]| format!("l {} {}\n", a + 1, b + 1)).collect();
        let expected: Vec<EdgeId> = mesh.edges().take(3).collect();
        assert_eq!(read("list.txt", &list).expect("edges"), expected);
        assert_eq!(
            read("lines.obj", &format!("v 0 0 0\n{lines}{lines}")).expect("edges"),
            expected
        );
    }

    #[test]
    fn faults_carry_their_lines() {
        for (name, text, message) in [
            ("a.txt", "0 0\n", ":1: there is no edge between vertices 0 and 0"),
            ("b.txt", "\n0 1 2\n", ":2: `0 1 2` is not an edge"),
            ("c.obj", "l 1 99\n", ":1: `l 1 99` names vertex 99"),
            ("d.obj", "l 1\n", ":1: `l 1` is not a seam"),
            ("e.obj", "v 0 0 0\n", "names no seam"),
        ] {
            let error = read(name, text).expect_err(text);
            assert!(error.contains(message), "{error}");
        }
    }
}
