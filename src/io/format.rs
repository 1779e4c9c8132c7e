//! Which mesh format a file has.

use std::fmt;
use std::path::Path;

/// A format of mesh files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeshFormat {
    /// Wavefront OBJ: polygons, groups, seams.
    Obj,
    /// Stanford PLY: polygons, text or binary.
    Ply,
    /// STL: triangles without shared vertices, text or binary.
    Stl,
    /// Object File Format: polygons, text.
    Off,
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Off => "OFF",
        })
    }
}

impl MeshFormat {
    /// The format that the name tells, by its extension in any case; `-` (a standard stream) is
    /// OBJ.
    pub fn of_path(path: &Path) -> Option<Self> {
        if path.as_os_str() == "-" {
            return Some(Self::Obj);
        }
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "off" => Some(Self::Off),
            _ => None,
        }
    }

    /// The format that the content tells, for files whose name does not.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        let start = &bytes[..bytes.len().min(4096)];
        let mut words = start.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let is_stl = |word: &[u8]| {
            [&b"solid"[..], b"facet"].iter().any(|name| word.eq_ignore_ascii_case(name))
        };
        match words.next()? {
            b"ply" => Some(Self::Ply),
            _ if super::read::is_binary_stl(bytes) => Some(Self::Stl),
            word if super::read::begins_off(word) => Some(Self::Off),
            word if is_stl(word) && words.any(|word| word.eq_ignore_ascii_case(b"vertex")) => {
                Some(Self::Stl)
            }
            _ => start
                .split(|&b| b == b'\n')
                .any(|line| line.starts_with(b"v "))
                .then_some(Self::Obj),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_contents_tell_the_format() {
        let named = |name: &str| MeshFormat::of_path(Path::new(name));
        assert_eq!(named("a/b.OBJ"), Some(MeshFormat::Obj));
        assert_eq!(named("-"), Some(MeshFormat::Obj));
        assert_eq!(named("x.stl"), Some(MeshFormat::Stl));
        assert_eq!(named("x.step"), None);
        assert_eq!(named("obj"), None);
        let holds = |text: &str| MeshFormat::of_content(text.as_bytes());
        assert_eq!(holds("ply\r\nformat ascii 1.0"), Some(MeshFormat::Ply));
        assert_eq!(holds("OFF 8 6 12\n"), Some(MeshFormat::Off));
        assert_eq!(holds("OFF8 6 12\n"), Some(MeshFormat::Off));
        assert_eq!(holds("OFFICE\n"), None);
        assert_eq!(holds("# made by hand\nv 0 0 0\n"), Some(MeshFormat::Obj));
        assert_eq!(
            holds("solid x\n facet normal 0 0 1\n outer loop\n vertex 0 0 0"),
            Some(MeshFormat::Stl)
        );
        assert_eq!(holds("hello"), None);
        assert_eq!(holds(""), None);
    }
}
